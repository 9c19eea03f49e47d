//! Removing vertices, and dropping what was removed.

use glam::DVec2;

use super::flip::weights_at;
use super::{Complex, Located, NO_HALFEDGE};
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, IdMap, VertexId};

impl Complex {
    /// Removes a flat vertex of three different neighbouring faces; it becomes a located point.
    /// What remains is the face of `h`, which left the vertex, between its former neighbours.
    pub(in crate::flow) fn remove_vertex(&mut self, h: HalfedgeId) -> HalfedgeId {
        let vertex = self.origins[h];
        let second = self.twins[h.prev()];
        let third = self.twins[second.prev()];
        let spokes = [h, second, third];
        self.align(h.prev());
        self.align(second.prev());
        let corners = spokes.map(|e| self.start[e]);
        let points = self.lift_fan(spokes);
        // The outer sides take the places of the one face that stays.
        let slots = [h, h.next(), h.prev()];
        let moves = [0, 1, 2].map(|i| (spokes[i].next(), slots[i]));
        self.bypass(spokes);
        self.chains.move_all(&moves);
        self.replace_face(&moves);
        for e in [second, third] {
            for side in [e, e.next(), e.prev()] {
                self.twins[side] = side;
            }
        }
        self.outgoing[vertex] = NO_HALFEDGE;
        for (point, place) in points {
            self.located
                .put(point, h.face(), weights_at(h, corners, place));
        }
        let weights = weights_at(h, corners, DVec2::ZERO);
        let face = h.face();
        self.located.add(Located {
            vertex: self.original[vertex.index()],
            face,
            weights,
        });
        h
    }

    fn lift_fan(&mut self, spokes: [HalfedgeId; 3]) -> Vec<(usize, DVec2)> {
        let mut lifted = Vec::new();
        for spoke in spokes {
            let [a, b] = [self.start[spoke], -self.start[spoke.prev()]];
            for point in self.located.take(spoke.face()) {
                let mut weights = self.located.points()[point].weights;
                weights.rotate_left(spoke.corner());
                lifted.push((point, a * weights[1] + b * weights[2]));
            }
        }
        lifted
    }

    fn replace_face(&mut self, moves: &[(HalfedgeId, HalfedgeId); 3]) {
        let old = moves.map(|(e, _)| (self.origins[e], self.turns[e], self.start[e], self.wish[e]));
        self.coefficients.move_all(moves);
        self.move_twins(moves);
        for (&(_, to), (origin, turns, start, wish)) in moves.iter().zip(old) {
            self.origins[to] = origin;
            self.turns[to] = turns;
            self.start[to] = start;
            self.wish[to] = wish;
            self.outgoing[origin] = to;
        }
    }

    /// Drops removed faces and vertices and renumbers what is left, in the old order.
    pub(in crate::flow) fn compact(&mut self) {
        let faces: Vec<usize> = self
            .face_ids()
            .filter(|&f| !self.is_removed(self.halfedge(f)))
            .map(Id::index)
            .collect();
        let kept = |v: &VertexId| self.outgoing[*v] != NO_HALFEDGE;
        let vertices: Vec<VertexId> = self.outgoing.ids().filter(kept).collect();
        let mut new_vertex = vec![VertexId(0); self.n_vertices()];
        for (i, v) in vertices.iter().enumerate() {
            new_vertex[v.index()] = VertexId::from_index(i);
        }
        let mut new_face = vec![0; self.n_faces()];
        for (i, &f) in faces.iter().enumerate() {
            new_face[f] = i as u32;
        }
        let moved = |h: HalfedgeId| HalfedgeId(3 * new_face[h.face().index()] + h.0 % 3);
        self.origins = kept_values(&self.origins, &faces, |v| new_vertex[v.index()]);
        self.twins = kept_values(&self.twins, &faces, moved);
        self.turns = kept_values(&self.turns, &faces, |r| r);
        self.start = kept_values(&self.start, &faces, |w| w);
        self.wish = kept_values(&self.wish, &faces, |w| w);
        self.coefficients.keep_faces(&faces);
        self.located.keep_faces(&faces);
        self.chains.keep_faces(&faces);
        self.indices = vertices.iter().map(|&v| self.indices[v]).collect();
        self.outgoing = vertices.iter().map(|&v| moved(self.outgoing[v])).collect();
        self.original = vertices.iter().map(|v| self.original[v.index()]).collect();
    }
}

fn kept_values<T: Copy>(
    values: &HalfedgeMap<T>,
    faces: &[usize],
    change: impl Fn(T) -> T,
) -> HalfedgeMap<T> {
    let old = values.as_slice();
    IdMap::from_vec(
        faces
            .iter()
            .flat_map(|&f| [0, 1, 2].map(|i| change(old[3 * f + i])))
            .collect(),
    )
}
