//! A flat metric laid into the field's frames.

use std::collections::VecDeque;

use glam::DVec2;

use super::metric::Metric;
use crate::elementary::direction;
use crate::flow::complex::{Complex, Turn};
use crate::mesh::{FaceId, HalfedgeId};

impl Metric {
    /// Lays face after face into the frames, then turns and scales the whole to fit the wish.
    pub fn into_layout(mut self) -> Complex {
        let mut is_laid = vec![false; self.complex.n_faces()];
        let mut queue = VecDeque::new();
        self.lay(HalfedgeId(0), DVec2::new(self.lengths[HalfedgeId(0)], 0.0));
        is_laid[0] = true;
        queue.push_back(FaceId(0));
        while let Some(face) = queue.pop_front() {
            let first = self.complex.halfedge(face);
            for h in [first, first.next(), first.prev()] {
                let t = self.complex.twins[h];
                let seen = &mut is_laid[t.face().0 as usize];
                if !std::mem::replace(seen, true) {
                    let vector = -self.complex.start[h].turned(self.complex.turns[h]);
                    self.lay(t, vector);
                    queue.push_back(t.face());
                }
            }
        }
        self.fit_to_wish();
        self.complex
    }

    fn lay(&mut self, h: HalfedgeId, vector: DVec2) {
        let [angle, side] = [self.angle(h), self.lengths[h.prev()]];
        let along = vector / self.lengths[h];
        let apex = along.rotate(direction(angle)) * side;
        let start = &mut self.complex.start;
        start[h] = vector;
        start[h.next()] = apex - vector;
        start[h.prev()] = -apex;
    }

    /// Multiplies the metric by the complex number that brings it nearest to the wish, with long
    /// and short edges counting alike.
    fn fit_to_wish(&mut self) {
        let (mut fit, mut size) = (DVec2::ZERO, 0.0);
        for h in self.complex.halfedge_ids() {
            let [start, wish] = [self.complex.start[h], self.complex.wish[h]];
            fit += DVec2::new(start.x, -start.y).rotate(wish) / self.lengths[h];
            size += start.length_squared() / self.lengths[h];
        }
        if fit.length_squared() > 0.0 {
            let factor = fit / size;
            for vector in self.complex.start.as_mut_slice() {
                *vector = vector.rotate(factor);
            }
        }
    }
}
