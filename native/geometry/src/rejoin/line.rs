//! Places along lines.

use glam::DVec3;

use super::Line;

impl Line {
    /// Its pieces.
    pub(super) fn pieces(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let next = self.points.iter().cycle().skip(1);
        let n = self.points.len() - usize::from(!self.is_closed);
        self.points.iter().zip(next).take(n).map(|(&a, &b)| [a, b])
    }

    /// The nearest point on the line.
    pub(super) fn closest(&self, point: DVec3) -> DVec3 {
        let places = self.pieces().map(|piece| on_segment(piece, point));
        let off = |p: &DVec3| p.distance_squared(point);
        let nearest = places.min_by(|p, q| off(p).total_cmp(&off(q)));
        nearest.unwrap_or(point)
    }

    /// How far a point is from the line.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        self.closest(point).distance(point)
    }

    /// The share of the line before the place that is nearest to a point.
    pub(super) fn share(&self, point: DVec3) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        let mut length = 0.0;
        for [a, b] in self.pieces() {
            let at = on_segment([a, b], point);
            if at.distance(point) < best.0 {
                best = (at.distance(point), length + a.distance(at));
            }
            length += a.distance(b);
        }
        best.1 / length.max(f64::MIN_POSITIVE)
    }

    /// The place at a share of the line.
    pub(super) fn at(&self, share: f64) -> DVec3 {
        let length: f64 = self.pieces().map(|[a, b]| a.distance(b)).sum();
        let mut left = share * length;
        for [a, b] in self.pieces() {
            let step = a.distance(b);
            if left <= step && step > 0.0 {
                return a.lerp(b, (left / step).clamp(0.0, 1.0));
            }
            left -= step;
        }
        self.points[if self.is_closed {
            0
        } else {
            self.points.len() - 1
        }]
    }
}

/// The point of a segment nearest to another.
pub(super) fn on_segment([a, b]: [DVec3; 2], point: DVec3) -> DVec3 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared();
    let share = if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    };
    a + along * share
}
