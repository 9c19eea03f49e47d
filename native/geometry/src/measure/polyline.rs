//! Lines of straight pieces by their arc length, and vertices of a mesh along them.

use glam::DVec3;

use crate::mesh::VertexId;

/// A line of straight pieces.
#[derive(Clone, PartialEq, Debug)]
pub struct Polyline {
    points: Vec<DVec3>,
    /// Arc length from the beginning to each of the points.
    lengths: Vec<f64>,
    is_closed: bool,
}

impl Polyline {
    /// The line through some points, two at least; a closed one ends at the point it begins with.
    pub fn new(points: Vec<DVec3>, is_closed: bool) -> Self {
        let mut lengths = vec![0.0];
        for (i, pair) in points.windows(2).enumerate() {
            lengths.push(lengths[i] + pair[0].distance(pair[1]));
        }
        Self {
            points,
            lengths,
            is_closed,
        }
    }

    /// Whether the line ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The length of the whole line.
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The straight pieces, by their ends.
    pub fn pieces(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.points.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// The point at an arc length; a closed line goes on at its beginning, an open one stops at
    /// its ends.
    pub fn point(&self, at: f64) -> DVec3 {
        let (i, share) = self.piece_at(at);
        self.points[i].lerp(self.points[i + 1], share)
    }

    /// The straight piece at an arc length, and the share of it that lies before.
    pub fn piece_at(&self, at: f64) -> (usize, f64) {
        let at = if self.is_closed {
            at.rem_euclid(self.length())
        } else {
            at
        };
        let after = self.lengths.partition_point(|&l| l <= at);
        let i = after.clamp(1, self.lengths.len() - 1) - 1;
        let step = self.lengths[i + 1] - self.lengths[i];
        let share = ((at - self.lengths[i]) / step.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (i, share)
    }

    /// The same moved outward where it bends, by half of what chords of some length would cut off:
    /// so chords between its points are on both sides of it. Ends stay.
    #[must_use]
    pub fn balanced(&self, chord: f64) -> Self {
        let whole = self.length();
        let moved = |(&p, &at): (&DVec3, &f64)| {
            let room = if self.is_closed {
                whole / 4.0
            } else {
                at.min(whole - at)
            };
            let half = room.min(chord / 2.0);
            let middle = (self.point(at - half) + self.point(at + half)) / 2.0;
            p + (p - middle) * 0.5
        };
        let points = self.points.iter().zip(&self.lengths).map(moved);
        Self::new(points.collect(), self.is_closed)
    }

    /// How far a position is from it.
    pub fn distance(&self, position: DVec3) -> f64 {
        let from = |[a, b]: [DVec3; 2]| {
            let way = b - a;
            let share = (position - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
            position.distance_squared(a + way * share.clamp(0.0, 1.0))
        };
        self.pieces().map(from).fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The arc length of the corner nearest to a position.
    pub fn nearest_corner(&self, position: DVec3) -> f64 {
        let distance = |p: &DVec3| p.distance_squared(position);
        let corners = self.points.iter().zip(&self.lengths);
        let nearest = corners.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        nearest.map_or(0.0, |(_, &length)| length)
    }
}

/// Vertices of a mesh along a line.
#[derive(Clone, PartialEq, Debug)]
pub struct Seam {
    /// The vertices, each joined to the next by an edge; a closed seam ends with the one it begins
    /// with.
    pub vertices: Vec<VertexId>,
    /// The arc length at which each belongs. Where a seam is closed the line goes on at its
    /// beginning.
    pub at: Vec<f64>,
    /// The line.
    pub line: Polyline,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::sin_cos;

    fn square(is_closed: bool) -> Polyline {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let points = corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        Polyline::new(points, is_closed)
    }

    #[test]
    fn chords_of_a_balanced_line_are_on_both_sides_of_it() {
        let circle = |radius: f64, n: u32| {
            let point = |i: u32| {
                let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / f64::from(n));
                DVec3::new(radius * cos, radius * sin, 0.0)
            };
            Polyline::new((0..=n).map(point).collect(), true)
        };
        let line = circle(1.0, 240).balanced(circle(1.0, 8).length() / 8.0);
        let [corner, next] = [0.0, line.length() / 8.0].map(|at| line.point(at));
        let [out, within] = [
            corner.length() - 1.0,
            1.0 - ((corner + next) / 2.0).length(),
        ];
        assert!(
            out > 0.03 && within > 0.03 && (out - within).abs() < 0.01,
            "{out} {within}"
        );
        let open = square(false).balanced(0.5);
        assert_eq!([open.point(0.0), open.point(9.0)], [DVec3::ZERO; 2]);
    }

    #[test]
    fn closed_lines_go_round_and_open_ones_stop() {
        for (is_closed, after, before) in [
            (true, DVec3::X * 0.5, DVec3::Y * 0.5),
            (false, DVec3::ZERO, DVec3::ZERO),
        ] {
            let line = square(is_closed);
            assert_eq!((line.length(), line.is_closed()), (4.0, is_closed));
            assert_eq!(line.point(1.25), DVec3::new(1.0, 0.25, 0.0));
            assert_eq!([line.point(4.5), line.point(-0.5)], [after, before]);
            let at = line.nearest_corner(DVec3::new(0.8, 1.3, 0.1));
            assert_eq!(line.point(at), DVec3::new(1.0, 1.0, 0.0));
        }
    }
}
