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

    fn square(is_closed: bool) -> Polyline {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let points = corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        Polyline::new(points, is_closed)
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
