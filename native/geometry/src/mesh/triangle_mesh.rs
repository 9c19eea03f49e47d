//! Oriented manifold triangle meshes, with or without border.

use glam::DVec3;
use thiserror::Error;

use super::polygon_mesh::MAX_ELEMENTS;
use super::{FaceId, HalfedgeId, Id, VertexId};

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

/// Why arrays do not make a [`TriangleMesh`].
#[derive(Clone, PartialEq, Debug, Error)]
pub enum TriangleMeshError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are {n_vertices} vertices")]
    IndexOutOfRange {
        /// The first such face.
        face: FaceId,
        /// What it names.
        vertex: VertexId,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// Two corners of a face are the same vertex.
    #[error("face {face} has vertex {vertex} twice")]
    RepeatedCorner {
        /// The first such face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// More than two faces at an edge.
    #[error("{n_faces} faces meet at the edge between vertices {a} and {b}; at most 2 can")]
    NonManifoldEdge {
        /// How many faces meet.
        n_faces: usize,
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// Two faces run through their common edge in the same direction.
    #[error("two faces run through the edge between vertices {a} and {b} in the same direction")]
    Orientation {
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// The faces at a vertex form more than one fan.
    #[error("the faces at vertex {vertex} form more than one fan")]
    NonManifoldVertex {
        /// The first such vertex.
        vertex: VertexId,
    },
    /// A vertex has no face.
    #[error("vertex {vertex} has no face")]
    IsolatedVertex {
        /// The first such vertex.
        vertex: VertexId,
    },
    /// More elements than 32-bit ids can name.
    #[error("{n} elements; at most {MAX_ELEMENTS} can be handled")]
    TooLarge {
        /// How many there are.
        n: usize,
    },
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
        let n = positions.len().max(3 * faces.len());
        if n > MAX_ELEMENTS {
            return Err(TriangleMeshError::TooLarge { n });
        }
        if let Some(i) = positions.iter().position(|p| !p.is_finite()) {
            return Err(TriangleMeshError::NotFinite {
                vertex: VertexId::from_index(i),
            });
        }
        check_corners(&faces, positions.len())?;
        let twins = match_twins(&faces)?;
        let mut mesh = Self {
            positions,
            faces,
            twins,
            outgoing: Vec::new(),
        };
        mesh.outgoing = mesh.find_fans()?;
        Ok(mesh)
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

    fn find_fans(&self) -> Result<Vec<HalfedgeId>, TriangleMeshError> {
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
            let vertex = VertexId::from_index(i);
            if start.0 == BORDER {
                return Err(TriangleMeshError::IsolatedVertex { vertex });
            }
            let fan = Outgoing {
                mesh: self,
                start,
                next: Some(start),
            }
            .count();
            if fan != n_corners[i] as usize {
                return Err(TriangleMeshError::NonManifoldVertex { vertex });
            }
        }
        Ok(outgoing)
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

fn check_corners(faces: &[[VertexId; 3]], n_vertices: usize) -> Result<(), TriangleMeshError> {
    for (i, corners) in faces.iter().enumerate() {
        let face = FaceId::from_index(i);
        if let Some(&vertex) = corners.iter().find(|v| v.index() >= n_vertices) {
            return Err(TriangleMeshError::IndexOutOfRange {
                face,
                vertex,
                n_vertices,
            });
        }
        let [a, b, c] = *corners;
        if a == b || b == c || c == a {
            let vertex = if b == c { b } else { a };
            return Err(TriangleMeshError::RepeatedCorner { face, vertex });
        }
    }
    Ok(())
}

/// Pairs the halfedges of each edge, by sorting them on their unordered ends.
fn match_twins(faces: &[[VertexId; 3]]) -> Result<Vec<u32>, TriangleMeshError> {
    let ends = |h: u32| {
        let [f, i] = [(h / 3) as usize, (h % 3) as usize];
        (faces[f][i], faces[f][(i + 1) % 3])
    };
    let mut order: Vec<(u64, u32)> = (0..3 * faces.len() as u32)
        .map(|h| {
            let (a, b) = ends(h);
            (u64::from(a.min(b).0) << 32 | u64::from(a.max(b).0), h)
        })
        .collect();
    order.sort_unstable();
    let mut twins = vec![BORDER; order.len()];
    for run in order.chunk_by(|x, y| x.0 == y.0) {
        let (a, b) = ends(run[0].1);
        match *run {
            [_] => {}
            [(_, g), (_, h)] if ends(g) != ends(h) => {
                twins[g as usize] = h;
                twins[h as usize] = g;
            }
            [_, _] => return Err(TriangleMeshError::Orientation { a, b }),
            _ => {
                return Err(TriangleMeshError::NonManifoldEdge {
                    n_faces: run.len(),
                    a,
                    b,
                });
            }
        }
    }
    Ok(twins)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids<const N: usize>(faces: [[u32; 3]; N]) -> Vec<[VertexId; 3]> {
        faces.into_iter().map(|f| f.map(VertexId)).collect()
    }

    fn points(n: usize) -> Vec<DVec3> {
        (0..n)
            .map(|i| DVec3::new(i as f64, (i * i) as f64, (i % 2) as f64))
            .collect()
    }

    fn tetrahedron() -> TriangleMesh {
        let faces = ids([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        TriangleMesh::new(points(4), faces).unwrap()
    }

    #[test]
    fn a_tetrahedron_is_closed_and_every_ring_has_three_neighbours() {
        let mesh = tetrahedron();
        assert!(mesh.is_closed() && mesh.border_loops().is_empty());
        assert_eq!((mesh.euler_number(), mesh.face_components().1), (2, 1));
        for v in mesh.vertex_ids() {
            let ring: Vec<_> = mesh.neighbours(v).collect();
            assert_eq!(ring.len(), 3);
            for h in mesh.outgoing(v) {
                assert_eq!(mesh.origin(h), v);
                assert_eq!(mesh.twin(mesh.twin(h).unwrap()), Some(h));
            }
        }
    }

    #[test]
    fn consecutive_neighbours_are_the_faces_at_the_vertex_counter_clockwise() {
        let mesh = tetrahedron();
        let ring: Vec<_> = mesh.neighbours(VertexId(0)).collect();
        for i in 0..3 {
            let wanted = [VertexId(0), ring[i], ring[(i + 1) % 3]];
            let found = mesh
                .faces()
                .iter()
                .any(|f| (0..3).any(|k| [f[k], f[(k + 1) % 3], f[(k + 2) % 3]] == wanted));
            assert!(found, "{wanted:?}");
        }
    }

    #[test]
    fn a_border_ring_starts_and_ends_on_the_border() {
        let mesh = TriangleMesh::new(points(4), ids([[0, 1, 2], [0, 2, 3]])).unwrap();
        let ring: Vec<_> = mesh.neighbours(VertexId(0)).collect();
        assert_eq!(ring, [1, 2, 3].map(VertexId));
        assert_eq!(mesh.valence(VertexId(0)), 3);
        assert_eq!(mesh.border_loops().len(), 1);
        assert_eq!(mesh.border_loops()[0].len(), 4);
        assert_eq!(mesh.euler_number(), 1);
    }

    #[test]
    fn broken_meshes_are_refused_with_numbers() {
        let message = |n, faces| TriangleMesh::new(points(n), faces).unwrap_err().to_string();
        assert_eq!(
            message(5, ids([[0, 1, 2], [1, 0, 3], [0, 1, 4]])),
            "3 faces meet at the edge between vertices 0 and 1; at most 2 can"
        );
        assert_eq!(
            message(4, ids([[0, 1, 2], [0, 1, 3]])),
            "two faces run through the edge between vertices 0 and 1 in the same direction"
        );
        assert_eq!(
            message(5, ids([[0, 1, 2], [0, 3, 4]])),
            "the faces at vertex 0 form more than one fan"
        );
        assert_eq!(message(4, ids([[0, 1, 2]])), "vertex 3 has no face");
        assert_eq!(message(3, ids([[0, 1, 1]])), "face 0 has vertex 1 twice");
        assert_eq!(
            message(3, ids([[0, 1, 5]])),
            "face 0 names vertex 5, but there are 3 vertices"
        );
    }
}
