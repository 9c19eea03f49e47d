//! How much pages turn where they go on into each other.

use glam::DVec3;

use super::super::triangulate::Triangulated;
use super::is_against;
use super::lines::{Line, LineEdge};
use crate::elementary::atan2;
use crate::mesh::{HalfedgeId, VertexId};

/// How much pages that are turned against each other count as turning more, in radians.
const AGAINST: f64 = 0.2;
/// What pages turn between which no angle can be told, because faces have no area.
const UNKNOWN: f64 = std::f64::consts::FRAC_PI_2;
/// Pieces of one polygon go on into each other before all others do.
const OF_ONE_POLYGON: f64 = -1.0;

/// The turn between each two of some pages of a line, the mean along the line, a little more where
/// faces disagree.
///
/// The same numbers come out in whichever order faces are given.
pub(super) fn turns(triangulated: &Triangulated, line: &Line, pages: &[usize]) -> Vec<Vec<f64>> {
    let n = pages.len();
    let mut sums = vec![vec![0.0; n]; n];
    let mut known = vec![vec![0.0; n]; n];
    let mut of_one = vec![vec![false; n]; n];
    for edge in &line.edges {
        let spread = Spread::new(triangulated, edge, pages);
        for a in 0..n {
            for b in a + 1..n {
                of_one[a][b] |= spread.are_of_one_polygon(triangulated, [a, b]);
                if let Some(turn) = spread.turn(triangulated, [a, b]) {
                    sums[a][b] += spread.length * turn;
                    known[a][b] += spread.length;
                }
            }
        }
    }
    for a in 0..n {
        for b in a + 1..n {
            sums[a][b] = match known[a][b] {
                _ if of_one[a][b] => OF_ONE_POLYGON,
                0.0 => UNKNOWN,
                length => sums[a][b] / length,
            };
        }
    }
    sums
}

/// The pages at one edge.
struct Spread {
    length: f64,
    sides: Vec<HalfedgeId>,
    /// Where each page lies, seen along the edge.
    arms: Vec<Option<DVec3>>,
}

impl Spread {
    fn new(triangulated: &Triangulated, edge: &LineEdge, pages: &[usize]) -> Self {
        let place = |v: VertexId| triangulated.scaled(v);
        // Whichever way the line runs, rounding is the same.
        let [a, b] = edge.ends;
        let [from, to] = [a.min(b), a.max(b)].map(place);
        let along = (to - from).try_normalize();
        let arm = |h: &HalfedgeId| {
            let along = along?;
            let arm = place(triangulated.ends(h.prev())[0]) - from;
            (arm - along * arm.dot(along)).try_normalize()
        };
        let sides: Vec<HalfedgeId> = pages.iter().map(|&page| edge.pages[page]).collect();
        Self {
            length: from.distance(to),
            arms: sides.iter().map(arm).collect(),
            sides,
        }
    }

    fn turn(&self, triangulated: &Triangulated, [a, b]: [usize; 2]) -> Option<f64> {
        let (of_a, of_b) = (self.arms[a]?, self.arms[b]?);
        let between = atan2(of_a.cross(of_b).length(), of_a.dot(of_b));
        let sides = [self.sides[a], self.sides[b]];
        let more = if is_against(triangulated, sides) {
            AGAINST
        } else {
            0.0
        };
        Some(std::f64::consts::PI - between + more)
    }

    fn are_of_one_polygon(&self, triangulated: &Triangulated, [a, b]: [usize; 2]) -> bool {
        let sides = [self.sides[a], self.sides[b]];
        let [of_a, of_b] = sides.map(|h| triangulated.polygon_of(h.face()));
        of_a == of_b && !is_against(triangulated, sides)
    }
}
