//! Splits edges of a triangle mesh, and knows what its faces and edges were.

use glam::DVec3;

use crate::mesh::{FaceId, FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

const NONE: u32 = u32::MAX;

/// A place on an edge.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Place {
    /// The edge, from either side.
    pub edge: HalfedgeId,
    /// How far along the halfedge, in 0..1.
    pub share: f64,
}

/// A mesh whose faces are pieces of another's.
#[derive(Clone, PartialEq, Debug)]
pub struct Pieces {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// The face of the other mesh that each face is or was a piece of.
    pub source: FaceMap<FaceId>,
    /// The halfedge of the other mesh that each halfedge is or was a piece of; none across a face.
    pub sides: HalfedgeMap<Option<HalfedgeId>>,
}

impl Pieces {
    /// A mesh as its own only pieces.
    pub fn whole(mesh: &TriangleMesh) -> Self {
        Self {
            mesh: mesh.clone(),
            source: mesh.face_ids().collect(),
            sides: mesh.halfedge_ids().map(Some).collect(),
        }
    }

    /// The same with edges split, each at most once: the vertex of place i is the i-th new one.
    ///
    /// The first piece of a face stands where the face stood, the others follow all faces.
    pub fn split(&self, places: &[Place], progress: &Progress) -> Result<Self, Cancelled> {
        let mesh = &self.mesh;
        let mut positions = mesh.positions().to_vec();
        let mut on = vec![NONE; 3 * mesh.n_faces()];
        let mut touched = Vec::new();
        for place in places {
            let [a, b] = [mesh.origin(place.edge), mesh.target(place.edge)];
            let new = positions.len() as u32;
            positions.push(mesh.position(a).lerp(mesh.position(b), place.share));
            for h in [Some(place.edge), mesh.twin(place.edge)]
                .into_iter()
                .flatten()
            {
                debug_assert_eq!(on[h.index()], NONE, "an edge is split once");
                on[h.index()] = new;
                touched.push(h.face());
            }
        }
        touched.sort_unstable();
        touched.dedup();
        let mut made = Made {
            faces: mesh.faces().to_vec(),
            source: self.source.clone(),
            sides: self.sides.clone(),
        };
        for face in touched {
            let pieces = self.pieces(face, &on, &positions);
            made.replace(face, &pieces, self.source[face]);
        }
        let mesh = TriangleMesh::build(positions, made.faces, progress)?;
        Ok(Self {
            mesh: mesh.expect("split edges leave a manifold mesh"),
            source: made.source,
            sides: made.sides,
        })
    }

    /// What becomes of a face.
    fn pieces(&self, face: FaceId, on: &[u32], positions: &[DVec3]) -> Vec<Piece> {
        let first = self.mesh.halfedge(face);
        let turns = [first, first.next(), first.prev()];
        let is_split = |h: HalfedgeId| on[h.index()] != NONE;
        let n_split = turns.into_iter().filter(|&h| is_split(h)).count();
        // The one split side first, or the one that is not last.
        let start = turns.into_iter().find(|&h| match n_split {
            1 => is_split(h),
            2 => !is_split(h.prev()),
            _ => true,
        });
        let sides = start.map(|h| [h, h.next(), h.prev()]);
        let sides = sides.expect("a face has three sides");
        let [a, b, c] = sides.map(|h| self.mesh.origin(h));
        let [m, n, o] = sides.map(|h| VertexId(on[h.index()]));
        let [ab, bc, ca] = sides.map(|h| self.sides[h]);
        let gap =
            |p: VertexId, q: VertexId| positions[p.index()].distance_squared(positions[q.index()]);
        match n_split {
            1 => vec![[(a, ab), (m, None), (c, ca)], [(m, ab), (b, bc), (c, None)]],
            2 if gap(a, n) <= gap(m, c) => vec![
                [(a, ab), (m, None), (n, None)],
                [(m, ab), (b, bc), (n, None)],
                [(a, None), (n, bc), (c, ca)],
            ],
            2 => vec![
                [(a, ab), (m, None), (c, ca)],
                [(m, ab), (b, bc), (n, None)],
                [(m, None), (n, bc), (c, None)],
            ],
            _ => vec![
                [(a, ab), (m, None), (o, ca)],
                [(m, ab), (b, bc), (n, None)],
                [(n, bc), (c, ca), (o, None)],
                [(m, None), (n, None), (o, None)],
            ],
        }
    }
}

/// The corners of a face, each with what the side was that leaves it.
type Piece = [(VertexId, Option<HalfedgeId>); 3];

/// The arrays of a mesh in the making.
struct Made {
    faces: Vec<[VertexId; 3]>,
    source: FaceMap<FaceId>,
    sides: HalfedgeMap<Option<HalfedgeId>>,
}

impl Made {
    fn replace(&mut self, face: FaceId, pieces: &[Piece], source: FaceId) {
        for (i, piece) in pieces.iter().enumerate() {
            let corners = piece.map(|(v, _)| v);
            if i == 0 {
                self.faces[face.index()] = corners;
                for (k, (_, side)) in piece.iter().enumerate() {
                    self.sides[HalfedgeId::from_index(3 * face.index() + k)] = *side;
                }
            } else {
                self.faces.push(corners);
                self.source.push(source);
                for (_, side) in piece {
                    self.sides.push(*side);
                }
            }
        }
    }
}
