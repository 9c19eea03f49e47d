//! The flip of an edge.

use glam::DVec2;

use super::{Complex, Turn};
use crate::mesh::{HalfedgeId, HalfedgeMap};

/// The part of its neighbour's area below which a face is flat.
const NO_AREA: f64 = 1e-9;

/// From where to where halfedges move.
type Moves = [(HalfedgeId, HalfedgeId); 4];

/// The four sides of the quadrilateral around an edge: the slot each leaves and the one it gets.
pub(in crate::flow) fn flip_moves(h: HalfedgeId, t: HalfedgeId) -> Moves {
    [
        (h.prev(), h.next()),
        (t.next(), h.prev()),
        (t.prev(), t.next()),
        (h.next(), t.prev()),
    ]
}

/// Moves one value per halfedge as a flip does.
pub(in crate::flow) fn move_values<T: Copy>(values: &mut HalfedgeMap<T>, moves: &Moves) {
    let taken = moves.map(|(from, _)| values[from]);
    for (&(_, to), value) in moves.iter().zip(taken) {
        values[to] = value;
    }
}

/// The weights of a point at the corners from `base` on, given the corners' places.
pub(in crate::flow) fn weights_at(base: HalfedgeId, corners: [DVec2; 3], point: DVec2) -> [f64; 3] {
    let [a, b, c] = corners;
    let area = (b - a).perp_dot(c - a);
    let second = (point - a).perp_dot(c - a) / area;
    let third = (b - a).perp_dot(point - a) / area;
    let mut weights = [1.0 - second - third, second, third];
    weights.rotate_right(base.corner());
    weights
}

impl Complex {
    /// Whether the two faces at an edge form a convex quadrilateral, so that its other diagonal
    /// lies inside. The sine of no new angle at the old ends falls below `tolerance`.
    pub fn is_flippable(&self, h: HalfedgeId, tolerance: f64) -> bool {
        self.flipped_sine(h).is_some_and(|sine| sine > tolerance)
    }

    /// The smaller sine of the two angles that the flip of an edge would join.
    pub(in crate::flow) fn flipped_sine(&self, h: HalfedgeId) -> Option<f64> {
        let twin = self.twins[h];
        if twin.face() == h.face() {
            return None;
        }
        let turns = self.turns[twin];
        let sine =
            |a: DVec2, b: DVec2| a.perp_dot(b) / (a.length_squared() * b.length_squared()).sqrt();
        let there = self.start[twin.next()].turned(turns);
        let back = self.start[twin.prev()].turned(turns);
        Some(sine(self.start[h.prev()], there).min(sine(back, self.start[h.next()])))
    }

    /// Replaces an edge by the other diagonal of its two faces; located points are found again.
    ///
    /// With h from a to b, c left and d right of it, h then runs from d to c with a on its left.
    ///
    /// # Panics
    /// When both sides of the edge belong to one face.
    pub fn flip(&mut self, h: HalfedgeId) {
        self.align(h);
        let points = self.lift_points(h);
        let b = self.start[h];
        self.flip_edge(h);
        self.settle_points(h, b, &points);
    }

    /// The flip without located points: all of it but the `start` vectors' geometry.
    pub(in crate::flow) fn flip_edge(&mut self, h: HalfedgeId) {
        let t = self.twins[h];
        assert_ne!(
            h.face(),
            t.face(),
            "an edge inside of one face has no other diagonal"
        );
        self.align(h);
        let moves = flip_moves(h, t);
        self.detour(h);
        self.chains.move_all(&moves);
        let [c, d] = [self.origins[h.prev()], self.origins[t.prev()]];
        move_values(&mut self.origins, &moves);
        move_values(&mut self.turns, &moves);
        move_values(&mut self.start, &moves);
        move_values(&mut self.wish, &moves);
        self.coefficients.move_all(&moves);
        self.move_twins(&moves);
        [self.origins[h], self.origins[t]] = [d, c];
        [self.turns[h], self.turns[t]] = [0, 0];
        for vectors in [&mut self.start, &mut self.wish] {
            let sum = vectors[h.next()] + vectors[h.prev()];
            [vectors[h], vectors[t]] = [-sum, sum];
        }
        self.coefficients.close(h, t);
        for e in [h, h.next(), h.prev(), t, t.next(), t.prev()] {
            self.outgoing[self.origins[e]] = e;
        }
        self.tighten(h);
        self.tighten(t);
    }

    pub(super) fn move_twins(&mut self, moves: &[(HalfedgeId, HalfedgeId)]) {
        let place = |e: HalfedgeId| moves.iter().find(|m| m.0 == e).map_or(e, |m| m.1);
        let twins: Vec<HalfedgeId> = moves.iter().map(|m| place(self.twins[m.0])).collect();
        for (&(_, to), twin) in moves.iter().zip(twins) {
            self.twins[to] = twin;
            self.twins[twin] = to;
        }
    }

    /// The points of the two faces at an edge, in the plane with the origin of the edge at 0.
    fn lift_points(&mut self, h: HalfedgeId) -> Vec<(usize, DVec2)> {
        let t = self.twins[h];
        let [b, c, d] = [self.start[h], -self.start[h.prev()], self.start[t.next()]];
        let mut lifted = Vec::new();
        for (base, corners) in [(h, [DVec2::ZERO, b, c]), (t, [b, DVec2::ZERO, d])] {
            for point in self.located.take(base.face()) {
                let mut weights = self.located.points()[point].weights;
                weights.rotate_left(base.corner());
                let place = (0..3).map(|i| corners[i] * weights[i]).sum();
                lifted.push((point, place));
            }
        }
        lifted
    }

    fn settle_points(&mut self, h: HalfedgeId, b: DVec2, points: &[(usize, DVec2)]) {
        let t = self.twins[h];
        let [c, d] = [-self.start[h.next()], self.start[h.prev()]];
        // A face that is flat for a moment holds no point: its weights would be 0 / 0.
        let [left, right] = [c.perp_dot(-d), (c - b).perp_dot(d - b)].map(f64::abs);
        for &(point, place) in points {
            let is_left = if left.min(right) > NO_AREA * left.max(right) {
                (c - d).perp_dot(place - d) >= 0.0
            } else {
                left > right
            };
            let (base, corners) = if is_left {
                (h, [d, c, DVec2::ZERO])
            } else {
                (t, [c, d, b])
            };
            let weights = weights_at(base, corners, place);
            self.located.put(point, base.face(), weights);
        }
    }
}
