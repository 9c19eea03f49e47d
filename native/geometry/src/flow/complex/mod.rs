//! A flat metric with cones on a closed surface, as triangles that may be glued to themselves.
//!
//! Every face has its own frame; across a halfedge h with r = `turns[h]` quarter turns, a vector
//! w of h and the one of its twin are −iʳ w, so that the metric is flat but for the corners.
//! An edge may join a vertex to itself and two edges may join the same two vertices (a
//! Δ-complex): what is left when a mesh is reduced to its cones. Edges flip; everything that
//! hangs on a halfedge goes along, because each of it is linear in the vectors.

mod chains;
mod check;
mod delaunay;
mod flip;
mod located;
mod remove;
mod rows;
mod turn;

use glam::DVec2;

use crate::elementary::angle_to;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};

pub use chains::{Chains, Counted, FirmLine, Tie};
pub use check::BrokenComplex;
pub(in crate::flow) use flip::{flip_moves, move_values};
pub use located::{Located, LocatedPoints};
pub use rows::Rows;
pub use turn::Turn;

/// No halfedge: what a vertex leaves once it was removed.
pub(super) const NO_HALFEDGE: HalfedgeId = HalfedgeId(u32::MAX);

/// A closed surface of triangles in the plane, each in its own frame, and what hangs on it.
///
/// Halfedges 3 f, 3 f + 1, 3 f + 2 bound face f. A face that was removed has halfedges that are
/// their own twins, until the complex is made compact.
#[derive(Clone, PartialEq, Debug)]
pub struct Complex {
    /// Where each halfedge starts.
    pub origins: HalfedgeMap<VertexId>,
    /// The other side of each edge.
    pub twins: HalfedgeMap<HalfedgeId>,
    /// r in Z₄: the twin's vector is −iʳ times this one's.
    pub turns: HalfedgeMap<u8>,
    /// The metric: the vector of each halfedge in its face's frame.
    pub start: HalfedgeMap<DVec2>,
    /// The wanted vector of each halfedge, in the same frame.
    pub wish: HalfedgeMap<DVec2>,
    /// Each halfedge as an integer combination of chosen periods; of no column until chosen.
    pub coefficients: Rows,
    /// k of each vertex: its cone angle is (4 − k) · 90°.
    pub indices: VertexMap<i32>,
    /// A halfedge that leaves each vertex.
    pub outgoing: VertexMap<HalfedgeId>,
    /// The vertex of the mesh that each vertex was.
    pub original: Vec<VertexId>,
    /// Vertices of the mesh that lie inside faces.
    pub located: LocatedPoints,
    /// Lines along edges, which flips lead round what they take away.
    pub chains: Chains,
}

/// What a complex carries from the orientation field.
#[derive(Clone, PartialEq, Debug)]
pub struct Dressing {
    /// Quarter turns across each halfedge.
    pub turns: HalfedgeMap<u8>,
    /// k of each vertex.
    pub indices: VertexMap<i32>,
    /// The wanted vector of each halfedge.
    pub wish: HalfedgeMap<DVec2>,
}

impl Complex {
    /// The faces of a closed mesh with the given vectors; nothing is located yet.
    ///
    /// # Panics
    /// When the mesh has a border.
    pub fn over(mesh: &TriangleMesh, start: HalfedgeMap<DVec2>, dressing: Dressing) -> Self {
        let twins = mesh
            .halfedge_ids()
            .map(|h| mesh.twin(h).expect("a complex is closed"))
            .collect();
        Self {
            origins: mesh.halfedge_ids().map(|h| mesh.origin(h)).collect(),
            twins,
            turns: dressing.turns,
            start,
            wish: dressing.wish,
            coefficients: Rows::default(),
            indices: dressing.indices,
            outgoing: mesh
                .vertex_ids()
                .map(|v| mesh.outgoing(v).next().unwrap_or(NO_HALFEDGE))
                .collect(),
            original: mesh.vertex_ids().collect(),
            located: LocatedPoints::new(mesh.n_faces()),
            chains: Chains::default(),
        }
    }

    /// How many faces there are, those removed included.
    pub fn n_faces(&self) -> usize {
        self.twins.len() / 3
    }

    /// How many vertices there are, those removed included.
    pub fn n_vertices(&self) -> usize {
        self.outgoing.len()
    }

    /// The ids of the halfedges, those of removed faces included.
    pub fn halfedge_ids(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<> {
        (0..self.twins.len()).map(HalfedgeId::from_index)
    }

    /// The ids of the faces, those removed included.
    pub fn face_ids(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.n_faces()).map(FaceId::from_index)
    }

    /// The first halfedge of a face.
    pub fn halfedge(&self, face: FaceId) -> HalfedgeId {
        HalfedgeId(3 * face.0)
    }

    /// Whether a halfedge belongs to a face that was removed.
    pub fn is_removed(&self, h: HalfedgeId) -> bool {
        self.twins[h] == h
    }

    /// Where a halfedge ends.
    pub fn target(&self, h: HalfedgeId) -> VertexId {
        self.origins[h.next()]
    }

    /// The halfedges that leave a vertex, counter-clockwise; a loop comes twice, once for each end.
    pub fn fan(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let first = self.outgoing[vertex];
        let mut next = (first != NO_HALFEDGE).then_some(first);
        std::iter::from_fn(move || {
            let h = next?;
            next = Some(self.twins[h.prev()]).filter(|&turned| turned != first);
            Some(h)
        })
    }

    /// Twice the signed area of a face.
    pub fn double_area(&self, face: FaceId) -> f64 {
        let h = self.halfedge(face);
        self.start[h].perp_dot(self.start[h.next()])
    }

    /// The area of the metric: the number of quads once every vector is integral.
    pub fn area(&self) -> f64 {
        let whole = |&f: &FaceId| !self.is_removed(self.halfedge(f));
        let double: f64 = self
            .face_ids()
            .filter(whole)
            .map(|f| self.double_area(f))
            .sum();
        0.5 * double
    }

    /// The cotangent of the angle that lies opposite to a halfedge in its face.
    pub fn cotangent(&self, h: HalfedgeId) -> f64 {
        let [a, b] = [-self.start[h.next()], self.start[h.prev()]];
        a.dot(b) / b.perp_dot(a).abs().max(f64::MIN_POSITIVE) * b.perp_dot(a).signum()
    }

    /// The angle of the corner that a halfedge leaves.
    pub fn angle(&self, h: HalfedgeId) -> f64 {
        angle_to(self.start[h], -self.start[h.prev()])
    }

    /// Turns the frame of a face by −`turns` quarter turns: its vectors turn by `turns`.
    pub fn reframe(&mut self, face: FaceId, turns: u8) {
        if turns.is_multiple_of(4) {
            return;
        }
        let first = self.halfedge(face);
        for h in [first, first.next(), first.prev()] {
            self.start[h] = self.start[h].turned(turns);
            self.wish[h] = self.wish[h].turned(turns);
            self.coefficients.turn(h, turns);
            let twin = self.twins[h];
            self.turns[h] = (self.turns[h] + 4 - turns % 4) % 4;
            self.turns[twin] = (self.turns[twin] + turns) % 4;
        }
        self.chains.turn_face(face, turns);
    }

    /// Turns the frame of the face across a halfedge so that both faces agree along it.
    pub fn align(&mut self, h: HalfedgeId) {
        let twin = self.twins[h];
        if twin.face() != h.face() {
            self.reframe(twin.face(), self.turns[twin]);
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
