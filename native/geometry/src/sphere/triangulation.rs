//! A closed triangulation whose connectivity changes.

use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};

/// Triangles around a sphere, as halfedges: `3 f + i` leaves corner `i` of face `f`, and each has
/// a twin. Where the vertices lie is kept elsewhere.
#[derive(Clone, Debug)]
pub struct Triangulation {
    origins: HalfedgeMap<VertexId>,
    twins: HalfedgeMap<HalfedgeId>,
    outgoing: VertexMap<HalfedgeId>,
}

impl Triangulation {
    /// The connectivity of a closed mesh.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let twin = |h| mesh.twin(h).expect("the mesh is closed");
        let start = |v| mesh.outgoing(v).next().expect("every vertex has a face");
        Self {
            origins: mesh.faces().iter().flatten().copied().collect(),
            twins: mesh.halfedge_ids().map(twin).collect(),
            outgoing: mesh.vertex_ids().map(start).collect(),
        }
    }

    pub fn n_faces(&self) -> usize {
        self.origins.len() / 3
    }

    pub fn halfedge_ids(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<> {
        self.origins.ids()
    }

    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        self.outgoing.ids()
    }

    pub fn origin(&self, h: HalfedgeId) -> VertexId {
        self.origins[h]
    }

    pub fn target(&self, h: HalfedgeId) -> VertexId {
        self.origins[h.next()]
    }

    /// The corner of the triangle that faces a halfedge.
    pub fn apex(&self, h: HalfedgeId) -> VertexId {
        self.origins[h.prev()]
    }

    pub fn twin(&self, h: HalfedgeId) -> HalfedgeId {
        self.twins[h]
    }

    pub fn face(&self, face: FaceId) -> [VertexId; 3] {
        [0, 1, 2].map(|i| self.origins[HalfedgeId(face.0 * 3 + i)])
    }

    pub fn faces(&self) -> impl ExactSizeIterator<Item = [VertexId; 3]> {
        (0..self.n_faces()).map(|f| self.face(FaceId::from_index(f)))
    }

    /// The halfedges that leave a vertex, counter-clockwise.
    pub fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> {
        let start = self.outgoing[vertex];
        let turn = move |&h: &HalfedgeId| Some(self.twins[h.prev()]).filter(|&next| next != start);
        std::iter::successors(Some(start), turn)
    }

    pub fn neighbours(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        self.outgoing(vertex).map(|h| self.target(h))
    }

    pub fn valence(&self, vertex: VertexId) -> usize {
        self.outgoing(vertex).count()
    }

    /// Puts a new vertex into a face, which becomes three.
    pub fn split(&mut self, face: FaceId) -> VertexId {
        let [ab, bc, ca] = [0, 1, 2].map(|i| HalfedgeId(face.0 * 3 + i));
        let [a, b, c] = self.face(face);
        let [beyond_bc, beyond_ca] = [self.twins[bc], self.twins[ca]];
        let new = self.outgoing.push(bc.next());
        let first = HalfedgeId::from_index(self.origins.len());
        for origin in [b, c, new, c, a, new] {
            self.origins.push(origin);
            self.twins.push(first);
        }
        let second = HalfedgeId(first.0 + 3);
        self.origins[ca] = new;
        self.link(first, beyond_bc);
        self.link(second, beyond_ca);
        self.link(bc, first.prev());
        self.link(first.next(), second.prev());
        self.link(second.next(), ca);
        self.outgoing[a] = ab;
        self.outgoing[b] = bc;
        self.outgoing[c] = second;
        self.outgoing[new] = ca;
        new
    }

    /// Turns an edge within the two triangles at it, so that it joins their other corners.
    pub fn flip(&mut self, h: HalfedgeId) {
        let t = self.twins[h];
        let [a, b, c, d] = [self.origin(h), self.origin(t), self.apex(h), self.apex(t)];
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
    }

    /// Whether an edge can be flipped: the other corners must not be joined yet, and every vertex
    /// keeps three neighbours.
    pub fn can_flip(&self, h: HalfedgeId) -> bool {
        let [c, d] = [self.apex(h), self.apex(self.twins[h])];
        let ends = [self.origin(h), self.target(h)];
        c != d
            && ends.into_iter().all(|v| self.outgoing(v).nth(3).is_some())
            && self.neighbours(c).all(|v| v != d)
    }

    fn link(&mut self, h: HalfedgeId, twin: HalfedgeId) {
        self.twins[h] = twin;
        self.twins[twin] = h;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    /// The triangulation is what a mesh built from its faces has.
    fn check(triangulation: &Triangulation) {
        let faces: Vec<_> = triangulation.faces().collect();
        let positions = vec![glam::DVec3::ZERO; triangulation.vertex_ids().len()];
        let mesh = TriangleMesh::new(positions, faces).unwrap();
        for h in mesh.halfedge_ids() {
            assert_eq!(mesh.twin(h), Some(triangulation.twin(h)));
            assert_eq!(triangulation.origin(triangulation.twin(h)), mesh.target(h));
        }
        for v in mesh.vertex_ids() {
            assert_eq!(triangulation.valence(v), mesh.valence(v));
            assert!(
                triangulation
                    .outgoing(v)
                    .all(|h| triangulation.origin(h) == v)
            );
        }
    }

    #[test]
    fn edits_keep_a_closed_triangulation() {
        let mut triangulation = Triangulation::of(&shapes::sphere(2));
        let mut random = crate::random::Random::new(3);
        for _ in 0..60 {
            triangulation.split(FaceId::from_index(random.below(triangulation.n_faces())));
            for _ in 0..4 {
                let h = HalfedgeId::from_index(random.below(3 * triangulation.n_faces()));
                if triangulation.can_flip(h) {
                    triangulation.flip(h);
                }
            }
        }
        check(&triangulation);
        assert_eq!(
            triangulation.n_faces(),
            2 * triangulation.vertex_ids().len() - 4
        );
    }
}
