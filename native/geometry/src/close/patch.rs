//! Triangles over a loop whose connectivity changes.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::split::{key, pieces};
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, VertexId, VertexMap};

/// An edge must be off by more than this share to be turned: equal ones, as of a square, differ by
/// rounding alone and would turn for ever.
const CLEARLY: f64 = 1e-9;

/// How much larger two triangles may become when their edge is turned. More folds membranes, less
/// keeps slivers in them; in a plane nothing grows.
const GROWTH: f64 = 1.05;

/// A disc of triangles, as halfedges: `3 f + i` leaves corner `i` of face `f`. The first vertices
/// are the loop's, in its order, and stay; no edge joins two vertices twice.
pub struct Patch {
    pub positions: VertexMap<DVec3>,
    origins: HalfedgeMap<VertexId>,
    twins: HalfedgeMap<Option<HalfedgeId>>,
    outgoing: VertexMap<HalfedgeId>,
    /// Pairs of vertices that an edge joins, here or beyond the loop.
    joined: HashSet<[VertexId; 2]>,
    n_loop: usize,
}

impl Patch {
    /// Triangles over a loop, with the pairs of its vertices that edges beyond it join already: edges
    /// that would join them again are split.
    pub fn new(
        points: &[DVec3],
        triangles: &[[VertexId; 3]],
        beyond: HashSet<[VertexId; 2]>,
    ) -> Self {
        let mut positions: VertexMap<DVec3> = points.iter().copied().collect();
        let mut middles = HashMap::new();
        let mut middle = |a: VertexId, b: VertexId| {
            let point = positions[a].midpoint(positions[b]);
            *middles
                .entry(key(a, b))
                .or_insert_with(|| positions.push(point))
        };
        let mut origins = HalfedgeMap::from_vec(Vec::new());
        for &corners in triangles {
            let between = [0, 1, 2].map(|k| {
                let [a, b] = [corners[k], corners[(k + 1) % 3]];
                beyond.contains(&key(a, b)).then(|| middle(a, b))
            });
            for v in pieces(corners, between).into_iter().flatten() {
                origins.push(v);
            }
        }
        let mut patch = Self {
            twins: HalfedgeMap::filled(origins.len(), None),
            outgoing: VertexMap::filled(positions.len(), HalfedgeId(0)),
            positions,
            origins,
            joined: beyond,
            n_loop: points.len(),
        };
        patch.find_twins();
        patch
    }

    fn find_twins(&mut self) {
        let mut sides: Vec<([VertexId; 2], HalfedgeId)> =
            self.origins.ids().map(|h| (self.edge(h), h)).collect();
        sides.sort_unstable();
        for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            self.link(pair[0].1, Some(pair[1].1));
        }
        for h in self.origins.ids() {
            self.outgoing[self.origins[h]] = h;
            self.joined.insert(self.edge(h));
        }
    }

    pub fn n_faces(&self) -> usize {
        self.origins.len() / 3
    }

    pub fn halfedge_ids(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<> {
        self.origins.ids()
    }

    /// The vertices inside of the loop.
    pub fn inner(&self) -> impl Iterator<Item = VertexId> + use<> {
        (self.n_loop..self.positions.len()).map(VertexId::from_index)
    }

    pub fn face(&self, face: usize) -> [VertexId; 3] {
        [0, 1, 2].map(|i| self.origins[HalfedgeId::from_index(3 * face + i)])
    }

    pub fn faces(&self) -> impl Iterator<Item = [VertexId; 3]> {
        (0..self.n_faces()).map(|face| self.face(face))
    }

    pub fn origin(&self, h: HalfedgeId) -> VertexId {
        self.origins[h]
    }

    fn edge(&self, h: HalfedgeId) -> [VertexId; 2] {
        key(self.origins[h], self.origins[h.next()])
    }

    /// The halfedges that leave a vertex inside of the loop.
    pub fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> {
        let start = self.outgoing[vertex];
        let turn = move |h: &HalfedgeId| self.twins[h.prev()].filter(|&next| next != start);
        std::iter::successors(Some(start), turn)
    }

    fn link(&mut self, a: HalfedgeId, b: Option<HalfedgeId>) {
        self.twins[a] = b;
        if let Some(b) = b {
            self.twins[b] = Some(a);
        }
    }

    /// Puts a vertex into a face, which becomes three.
    pub fn split_face(&mut self, face: usize, position: DVec3) -> VertexId {
        let [ab, bc, ca] = [0, 1, 2].map(|i| HalfedgeId::from_index(3 * face + i));
        let [a, b, c] = self.face(face);
        let [beyond_bc, beyond_ca] = [self.twins[bc], self.twins[ca]];
        let new = self.positions.push(position);
        self.outgoing.push(ca);
        let first = HalfedgeId::from_index(self.origins.len());
        for origin in [b, c, new, c, a, new] {
            self.origins.push(origin);
            self.twins.push(None);
        }
        let second = HalfedgeId(first.0 + 3);
        self.origins[ca] = new;
        self.link(first, beyond_bc);
        self.link(second, beyond_ca);
        self.link(bc, Some(first.prev()));
        self.link(first.next(), Some(second.prev()));
        self.link(second.next(), Some(ca));
        self.outgoing[a] = ab;
        self.outgoing[b] = bc;
        self.outgoing[c] = second;
        for v in [a, b, c] {
            self.joined.insert(key(v, new));
        }
        new
    }

    /// Turns an edge within the two triangles at it, so that it joins their other corners.
    fn flip(&mut self, h: HalfedgeId) {
        let t = self.twins[h].expect("an edge of the loop is never turned");
        let [a, b] = [self.origins[h], self.origins[t]];
        let [c, d] = [h, t].map(|x| self.origins[x.prev()]);
        let outer = [h.prev(), t.next(), t.prev(), h.next()].map(|x| self.twins[x]);
        for (slot, origin) in [
            (h, d),
            (h.next(), c),
            (h.prev(), a),
            (t, c),
            (t.next(), d),
            (t.prev(), b),
        ] {
            self.origins[slot] = origin;
            self.outgoing[origin] = slot;
        }
        let slots = [h.next(), h.prev(), t.next(), t.prev()];
        for (slot, twin) in slots.into_iter().zip(outer) {
            self.link(slot, twin);
        }
        self.joined.remove(&key(a, b));
        self.joined.insert(key(c, d));
    }

    /// Turns edges whose opposite angles are more than half a turn together until there are none,
    /// beginning with some; where an edge lies already, or the area would grow, they stay.
    pub fn settle(&mut self, mut open: Vec<HalfedgeId>) {
        // In space there need not be an end to it.
        let mut budget = 8 * open.len() + 64;
        while let Some(h) = open.pop() {
            if budget == 0 {
                return;
            }
            if let Some(twin) = self.twins[h].filter(|&twin| self.is_better_turned(h, twin)) {
                budget -= 1;
                self.flip(h);
                open.extend([h.next(), h.prev(), twin.next(), twin.prev()]);
            }
        }
    }

    fn is_better_turned(&self, h: HalfedgeId, twin: HalfedgeId) -> bool {
        let ends = [self.origins[h], self.origins[twin]];
        let apexes = [h, twin].map(|x| self.origins[x.prev()]);
        let [a, b] = ends.map(|v| self.positions[v]);
        let [c, d] = apexes.map(|v| self.positions[v]);
        let sides = [[a - c, b - c], [a - d, b - d]];
        let [sin_c, sin_d] = sides.map(|[u, v]| u.cross(v).length());
        let [cos_c, cos_d] = sides.map(|[u, v]| u.dot(v));
        let size: f64 = sides.iter().flatten().map(|side| side.length()).product();
        let old = sin_c + sin_d;
        let new = (a - c).cross(d - c).length() + (b - d).cross(c - d).length();
        sin_c * cos_d + cos_c * sin_d < -CLEARLY * size
            && new <= GROWTH * old
            && !self.joined.contains(&key(apexes[0], apexes[1]))
    }
}
