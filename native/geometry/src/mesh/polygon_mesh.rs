//! Polygon meshes: what comes in and what goes out.

use glam::DVec3;
use thiserror::Error;

use super::{FaceId, Id, TriangleMesh, VertexId};

/// The largest number of vertices, faces or corners that a mesh may have.
pub const MAX_ELEMENTS: usize = u32::MAX as usize / 4;

/// Polygons over shared vertices, nothing more: no manifoldness, no orientation is promised.
///
/// Promised: every position is finite, every corner names a vertex, every face has at least three
/// corners. A corner may repeat within a face; `clean` sorts that out.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct PolygonMesh {
    positions: Vec<DVec3>,
    starts: Vec<u32>,
    corners: Vec<VertexId>,
}

/// Why arrays do not make a [`PolygonMesh`].
#[derive(Clone, PartialEq, Debug, Error)]
pub enum PolygonMeshError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite: ({x}, {y}, {z})", x = position.x, y = position.y, z = position.z)]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
        /// Its position.
        position: DVec3,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are {n_vertices} vertices")]
    IndexOutOfRange {
        /// The first such face.
        face: FaceId,
        /// What it names.
        vertex: i64,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// A face has fewer than three corners.
    #[error("face {face} has {n_corners} corners; at least 3 are needed")]
    TooFewCorners {
        /// The first such face.
        face: FaceId,
        /// How many corners it has.
        n_corners: usize,
    },
    /// The starts of the faces do not rise from 0 to the number of corners.
    #[error(
        "face starts must rise from 0 to the number of corners ({n_corners}); entry {entry} does not"
    )]
    BadStarts {
        /// The first entry that is wrong.
        entry: usize,
        /// How many corners there are.
        n_corners: usize,
    },
    /// More elements than 32-bit ids can name.
    #[error("{n} elements; at most {MAX_ELEMENTS} can be handled")]
    TooLarge {
        /// How many there are.
        n: usize,
    },
}

impl From<&TriangleMesh> for PolygonMesh {
    /// The same vertices and faces.
    fn from(mesh: &TriangleMesh) -> Self {
        let faces: Vec<_> = mesh.faces().iter().map(|f| f.map(|v| v.0)).collect();
        Self::from_faces(mesh.positions().to_vec(), &faces)
            .expect("a triangle mesh is a polygon mesh")
    }
}

impl PolygonMesh {
    /// Builds a mesh from positions and faces given as corner lists.
    ///
    /// # Errors
    /// The promises of the type, the first one broken.
    pub fn from_faces<F: AsRef<[u32]>>(
        positions: Vec<DVec3>,
        faces: &[F],
    ) -> Result<Self, PolygonMeshError> {
        let n_corners: usize = faces.iter().map(|face| face.as_ref().len()).sum();
        if n_corners > MAX_ELEMENTS {
            return Err(PolygonMeshError::TooLarge { n: n_corners });
        }
        let mut starts = Vec::with_capacity(faces.len() + 1);
        let mut corners = Vec::with_capacity(n_corners);
        starts.push(0);
        for face in faces {
            corners.extend(face.as_ref().iter().map(|&v| VertexId(v)));
            starts.push(corners.len() as u32);
        }
        Self::new(positions, starts, corners)
    }

    /// Builds a mesh from positions, face starts (one more than faces) and corners.
    ///
    /// # Errors
    /// The promises of the type, the first one broken.
    pub fn new(
        positions: Vec<DVec3>,
        starts: Vec<u32>,
        corners: Vec<VertexId>,
    ) -> Result<Self, PolygonMeshError> {
        let n = positions.len().max(corners.len()).max(starts.len());
        if n > MAX_ELEMENTS {
            return Err(PolygonMeshError::TooLarge { n });
        }
        if let Some((i, &position)) = positions.iter().enumerate().find(|(_, p)| !p.is_finite()) {
            return Err(PolygonMeshError::NotFinite {
                vertex: VertexId::from_index(i),
                position,
            });
        }
        check_starts(&starts, corners.len())?;
        let mesh = Self {
            positions,
            starts,
            corners,
        };
        let n_vertices = mesh.n_vertices();
        for face in mesh.face_ids() {
            let bad = mesh.face(face).iter().find(|v| v.index() >= n_vertices);
            if let Some(&VertexId(vertex)) = bad {
                let vertex = vertex.into();
                return Err(PolygonMeshError::IndexOutOfRange {
                    face,
                    vertex,
                    n_vertices,
                });
            }
        }
        Ok(mesh)
    }

    /// How many vertices there are.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// How many faces there are.
    pub fn n_faces(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// How many faces have four corners.
    pub fn n_quads(&self) -> usize {
        self.starts.windows(2).filter(|w| w[1] - w[0] == 4).count()
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
    /// When the number of positions differs.
    #[must_use]
    pub fn with_positions(&self, positions: Vec<DVec3>) -> Self {
        assert_eq!(
            positions.len(),
            self.positions.len(),
            "one position per vertex"
        );
        Self {
            positions,
            ..self.clone()
        }
    }

    /// Where each face's corners start, and at the end where they stop.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The corners of all faces, face after face.
    pub fn corners(&self) -> &[VertexId] {
        &self.corners
    }

    /// How many faces each vertex has.
    pub fn faces_per_vertex(&self) -> Vec<usize> {
        let mut n = vec![0; self.positions.len()];
        for v in &self.corners {
            n[v.index()] += 1;
        }
        n
    }

    /// The corners of one face, in order.
    pub fn face(&self, face: FaceId) -> &[VertexId] {
        let [start, end] = [self.starts[face.index()], self.starts[face.index() + 1]];
        &self.corners[start as usize..end as usize]
    }

    /// The ids of the faces.
    pub fn face_ids(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.n_faces()).map(FaceId::from_index)
    }

    /// The corners of every face, in the order of ids.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = &[VertexId]> {
        self.face_ids().map(|face| self.face(face))
    }

    /// Smallest and largest corner of the axis-parallel bounding box; zeros when there is no vertex.
    pub fn bounds(&self) -> [DVec3; 2] {
        bounds(&self.positions)
    }
}

/// Smallest and largest corner of the bounding box of some points; zeros when there is none.
pub fn bounds(points: &[DVec3]) -> [DVec3; 2] {
    let Some(&first) = points.first() else {
        return [DVec3::ZERO; 2];
    };
    points
        .iter()
        .fold([first; 2], |[low, high], &p| [low.min(p), high.max(p)])
}

fn check_starts(starts: &[u32], n_corners: usize) -> Result<(), PolygonMeshError> {
    let bad = |entry| Err(PolygonMeshError::BadStarts { entry, n_corners });
    match (starts.first(), starts.last()) {
        (None, None) if n_corners == 0 => return Ok(()),
        (Some(0), Some(&last)) if last as usize == n_corners => {}
        (Some(0), _) => return bad(starts.len() - 1),
        _ => return bad(0),
    }
    for (i, w) in starts.windows(2).enumerate() {
        if w[1] < w[0] {
            return bad(i + 1);
        }
        if w[1] - w[0] < 3 {
            let n_corners = (w[1] - w[0]) as usize;
            return Err(PolygonMeshError::TooFewCorners {
                face: FaceId::from_index(i),
                n_corners,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y]
    }

    #[test]
    fn mixed_faces_are_read_back_as_given() {
        let mesh = PolygonMesh::from_faces(square(), &[vec![0, 1, 2, 3], vec![0, 2, 1]]).unwrap();
        assert_eq!((mesh.n_faces(), mesh.n_quads()), (2, 1));
        assert_eq!(
            mesh.face(FaceId(1)),
            [VertexId(0), VertexId(2), VertexId(1)]
        );
        assert_eq!(mesh.bounds(), [DVec3::ZERO, DVec3::X + DVec3::Y]);
    }

    #[test]
    fn broken_arrays_are_named_with_numbers() {
        let message = |faces: &[Vec<u32>], points| {
            PolygonMesh::from_faces(points, faces)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            message(&[vec![0, 1, 9]], square()),
            "face 0 names vertex 9, but there are 4 vertices"
        );
        assert_eq!(
            message(&[vec![0, 1]], square()),
            "face 0 has 2 corners; at least 3 are needed"
        );
        let mut points = square();
        points[2].y = f64::NAN;
        assert_eq!(
            message(&[vec![0, 1, 2]], points),
            "vertex 2 has a coordinate that is not finite: (1, NaN, 0)"
        );
    }

    #[test]
    fn starts_that_do_not_fit_the_corners_are_refused() {
        let corners = vec![VertexId(0); 3];
        for starts in [vec![], vec![1, 3], vec![0, 4], vec![0, 3, 2, 3]] {
            let error = PolygonMesh::new(square(), starts, corners.clone()).unwrap_err();
            assert!(
                matches!(error, PolygonMeshError::BadStarts { .. }),
                "{error}"
            );
        }
    }

    #[test]
    fn an_empty_mesh_is_a_mesh() {
        assert_eq!(
            PolygonMesh::new(vec![], vec![], vec![]).unwrap().n_faces(),
            0
        );
    }
}
