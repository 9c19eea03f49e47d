//! Intrinsic Delaunay triangulations by flips.

use super::Complex;
use crate::mesh::HalfedgeId;

/// How far below 0 the sum of two cotangents must lie to be worth a flip: above the rounding of
/// a cotangent, so that four points on a circle do not flip for ever.
const SLACK: f64 = 1e-9;
/// The least sine of an angle that a flip may make at the ends of the old edge.
const FLAT: f64 = 1e-12;

impl Complex {
    /// Flips edges until the triangulation is Delaunay in the metric; returns how many.
    ///
    /// Ends because each flip lowers the Dirichlet energy; a cap guards against rounding.
    pub fn delaunay(&mut self) -> usize {
        let mut waiting: Vec<HalfedgeId> =
            self.halfedge_ids().filter(|&h| h < self.twins[h]).collect();
        self.delaunay_from(&mut waiting)
    }

    /// The same, from some edges on; the rest is taken to be Delaunay. Empties the list.
    pub fn delaunay_from(&mut self, waiting: &mut Vec<HalfedgeId>) -> usize {
        let most = 200 * waiting.len() + 20_000;
        let mut n_flips = 0;
        while let Some(h) = waiting.pop() {
            let t = self.twins[h];
            let is_bad = self.cotangent(h) + self.cotangent(t) < -SLACK;
            if !is_bad || !self.is_flippable(h, FLAT) {
                continue;
            }
            self.flip(h);
            n_flips += 1;
            if n_flips == most {
                waiting.clear();
            } else {
                waiting.extend([h.next(), h.prev(), t.next(), t.prev()]);
            }
        }
        n_flips
    }
}
