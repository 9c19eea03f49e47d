//! Oriented manifold triangle meshes, with or without border.

mod build;
mod submesh;

use glam::DVec3;

use super::{FaceId, HalfedgeId, Id, VertexId};
use crate::progress::{Cancelled, Progress};

pub use build::TriangleMeshError;
use build::{check_arrays, match_twins};

const BORDER: u32 = u32::MAX;

/// An oriented manifold triangle mesh.
///
/// Promised: positions are finite; the three corners of a face differ; every edge has one or two
/// faces, two faces run through it in opposite directions; the faces at a vertex form one fan;
/// every vertex has a face. Halfedge `3 f + i` runs from corner `i` of face `f` to the next corner.
#[derive(Clone, PartialEq, Debug)]
pub struct TriangleMesh {
    positions: Vec<DVec3>,
    faces: Vec<[VertexId; 3]>,
    twins: Vec<u32>,
    /// One outgoing halfedge per vertex; at a border the one without a twin, where the
    /// counter-clockwise fan starts.
    outgoing: Vec<HalfedgeId>,
}

impl TriangleMesh {
    /// Builds a mesh from positions and triangles.
    ///
    /// # Errors
    /// The promises of the type, the first one broken.
    pub fn new(
        positions: Vec<DVec3>,
        faces: Vec<[VertexId; 3]>,
    ) -> Result<Self, TriangleMeshError> {
        let built = Self::build(positions, faces, &Progress::none());
        built.expect("nobody cancels")
    }

    /// The same for large meshes: it can be cancelled.
    ///
    /// # Errors
    /// When cancelled; inside, the promises of the type, the first one broken.
    pub fn build(
        positions: Vec<DVec3>,
        faces: Vec<[VertexId; 3]>,
        progress: &Progress,
    ) -> Result<Result<Self, TriangleMeshError>, Cancelled> {
        if let Err(error) = check_arrays(&positions, &faces) {
            return Ok(Err(error));
        }
        progress.check()?;
        let twins = match match_twins(&faces, positions.len(), progress)? {
            Ok(twins) => twins,
            Err(error) => return Ok(Err(error)),
        };
        let mut mesh = Self {
            positions,
            faces,
            twins,
            outgoing: Vec::new(),
        };
        let outgoing = mesh.find_fans(progress)?;
        Ok(outgoing.map(|outgoing| {
            mesh.outgoing = outgoing;
            mesh
        }))
    }

    /// Checks every promise of the type again; for tests and debug assertions after edits.
    ///
    /// # Errors
    /// The first promise that is broken.
    pub fn check(&self) -> Result<(), TriangleMeshError> {
        let again = Self::new(self.positions.clone(), self.faces.clone())?;
        debug_assert_eq!(again.twins, self.twins);
        Ok(())
    }

    /// How many vertices there are.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// How many faces there are.
    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// How many edges there are.
    pub fn n_edges(&self) -> usize {
        let border = self.twins.iter().filter(|&&t| t == BORDER).count();
        usize::midpoint(self.twins.len(), border)
    }

    /// The positions, by vertex id.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The position of one vertex.
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// The same faces over other positions.
    ///
    /// # Panics
    /// When the number of positions differs or one is not finite.
    #[must_use]
    pub fn with_positions(&self, positions: Vec<DVec3>) -> Self {
        assert_eq!(
            positions.len(),
            self.positions.len(),
            "one position per vertex"
        );
        assert!(
            positions.iter().all(|p| p.is_finite()),
            "positions must be finite"
        );
        Self {
            positions,
            ..self.clone()
        }
    }

    /// The corners of all faces.
    pub fn faces(&self) -> &[[VertexId; 3]] {
        &self.faces
    }

    /// The corners of one face.
    pub fn face(&self, face: FaceId) -> [VertexId; 3] {
        self.faces[face.index()]
    }

    /// The corner positions of one face.
    pub fn triangle(&self, face: FaceId) -> [DVec3; 3] {
        self.face(face).map(|v| self.position(v))
    }

    /// The ids of the vertices.
    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        (0..self.n_vertices()).map(VertexId::from_index)
    }

    /// The ids of the faces.
    pub fn face_ids(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.n_faces()).map(FaceId::from_index)
    }

    /// The ids of the halfedges.
    pub fn halfedge_ids(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<> {
        (0..self.twins.len()).map(HalfedgeId::from_index)
    }

    /// The first halfedge of a face, the one that leaves corner 0.
    pub fn halfedge(&self, face: FaceId) -> HalfedgeId {
        HalfedgeId(face.0 * 3)
    }

    /// Where a halfedge starts.
    pub fn origin(&self, h: HalfedgeId) -> VertexId {
        self.faces[h.face().index()][h.corner()]
    }

    /// Where a halfedge ends.
    pub fn target(&self, h: HalfedgeId) -> VertexId {
        self.origin(h.next())
    }

    /// The halfedge of the neighbouring face, or none at a border.
    pub fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        Some(self.twins[h.index()])
            .filter(|&t| t != BORDER)
            .map(HalfedgeId)
    }

    /// The halfedges that leave a vertex, counter-clockwise; at a border from the first to the last.
    /// A border vertex has one neighbour more than outgoing halfedges.
    pub fn outgoing(&self, vertex: VertexId) -> Outgoing<'_> {
        let start = self.outgoing[vertex.index()];
        Outgoing {
            mesh: self,
            start,
            next: Some(start),
        }
    }

    /// The neighbours of a vertex, counter-clockwise; at a border from the first to the last.
    pub fn neighbours(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        let mut last = None;
        let inner = self.outgoing(vertex).map(move |h| (self.target(h), h));
        let mut inner = inner.peekable();
        std::iter::from_fn(move || {
            if let Some((target, h)) = inner.next() {
                if inner.peek().is_none() && self.is_border(vertex) {
                    last = Some(self.origin(h.prev()));
                }
                return Some(target);
            }
            last.take()
        })
    }

    /// How many edges meet at a vertex.
    pub fn valence(&self, vertex: VertexId) -> usize {
        self.outgoing(vertex).count() + usize::from(self.is_border(vertex))
    }

    /// Whether a vertex lies on the border.
    pub fn is_border(&self, vertex: VertexId) -> bool {
        self.twins[self.outgoing[vertex.index()].index()] == BORDER
    }

    /// Whether there is no border.
    pub fn is_closed(&self) -> bool {
        !self.twins.contains(&BORDER)
    }

    /// The border halfedge that follows a border halfedge.
    fn next_on_border(&self, h: HalfedgeId) -> HalfedgeId {
        self.outgoing[self.target(h).index()]
    }

    /// The border, as loops of halfedges whose faces lie on their left.
    pub fn border_loops(&self) -> Vec<Vec<HalfedgeId>> {
        let mut seen = vec![false; self.twins.len()];
        let mut loops = Vec::new();
        for h in self.halfedge_ids().filter(|&h| self.twin(h).is_none()) {
            let mut border = Vec::new();
            let mut at = h;
            while !std::mem::replace(&mut seen[at.index()], true) {
                border.push(at);
                at = self.next_on_border(at);
            }
            if !border.is_empty() {
                loops.push(border);
            }
        }
        loops
    }

    /// The component (0, 1, …) of each face, numbered by first face, and how many there are.
    pub fn face_components(&self) -> (Vec<u32>, usize) {
        let mut component = vec![BORDER; self.n_faces()];
        let mut n = 0;
        let mut stack = Vec::new();
        for seed in self.face_ids() {
            if component[seed.index()] != BORDER {
                continue;
            }
            component[seed.index()] = n;
            stack.push(seed);
            while let Some(face) = stack.pop() {
                for i in 0..3 {
                    let Some(twin) = self.twin(HalfedgeId(face.0 * 3 + i)) else {
                        continue;
                    };
                    let next = twin.face().index();
                    if component[next] == BORDER {
                        component[next] = n;
                        stack.push(twin.face());
                    }
                }
            }
            n += 1;
        }
        (component, n as usize)
    }

    /// Vertices − edges + faces.
    pub fn euler_number(&self) -> i64 {
        self.n_vertices() as i64 - self.n_edges() as i64 + self.n_faces() as i64
    }

    fn find_fans(
        &self,
        progress: &Progress,
    ) -> Result<Result<Vec<HalfedgeId>, TriangleMeshError>, Cancelled> {
        let n_vertices = self.n_vertices();
        let mut outgoing = vec![HalfedgeId(BORDER); n_vertices];
        let mut n_corners = vec![0u32; n_vertices];
        for h in self.halfedge_ids() {
            let v = self.origin(h).index();
            n_corners[v] += 1;
            // A border halfedge starts the counter-clockwise fan of its origin.
            if outgoing[v].0 == BORDER || self.twin(h).is_none() {
                outgoing[v] = h;
            }
        }
        for (i, &start) in outgoing.iter().enumerate() {
            progress.check()?;
            let vertex = VertexId::from_index(i);
            if start.0 == BORDER {
                return Ok(Err(TriangleMeshError::IsolatedVertex { vertex }));
            }
            let fan = Outgoing {
                mesh: self,
                start,
                next: Some(start),
            }
            .count();
            if fan != n_corners[i] as usize {
                return Ok(Err(TriangleMeshError::NonManifoldVertex { vertex }));
            }
        }
        Ok(Ok(outgoing))
    }
}

/// The halfedges that leave a vertex, counter-clockwise.
#[derive(Clone)]
pub struct Outgoing<'a> {
    mesh: &'a TriangleMesh,
    start: HalfedgeId,
    next: Option<HalfedgeId>,
}

impl Iterator for Outgoing<'_> {
    type Item = HalfedgeId;

    fn next(&mut self) -> Option<HalfedgeId> {
        let h = self.next?;
        self.next = self
            .mesh
            .twin(h.prev())
            .filter(|&turned| turned != self.start);
        Some(h)
    }
}

#[cfg(test)]
mod tests;
