//! The checks at the door of a triangle mesh.

use glam::DVec3;
use thiserror::Error;

use super::super::polygon_mesh::MAX_ELEMENTS;
use super::super::{FaceId, Id, VertexId};
use super::BORDER;
use crate::progress::{Cancelled, Progress};

/// Why arrays do not make a [`TriangleMesh`](super::TriangleMesh).
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

/// Checks all that can be seen without the edges.
pub(super) fn check_arrays(
    positions: &[DVec3],
    faces: &[[VertexId; 3]],
) -> Result<(), TriangleMeshError> {
    let n = positions.len().max(3 * faces.len());
    if n > MAX_ELEMENTS {
        return Err(TriangleMeshError::TooLarge { n });
    }
    if let Some(i) = positions.iter().position(|p| !p.is_finite()) {
        return Err(TriangleMeshError::NotFinite {
            vertex: VertexId::from_index(i),
        });
    }
    check_corners(faces, positions.len())
}

/// Checks that corners exist and differ within their face.
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

/// Pairs the halfedges of each edge: they share the bucket of their smaller end, where they are
/// sorted by the larger.
pub(super) fn match_twins(
    faces: &[[VertexId; 3]],
    n_vertices: usize,
    progress: &Progress,
) -> Result<Result<Vec<u32>, TriangleMeshError>, Cancelled> {
    let ends = |h: u32| {
        let [f, i] = [(h / 3) as usize, (h % 3) as usize];
        (faces[f][i], faces[f][(i + 1) % 3])
    };
    let n_halfedges = 3 * faces.len() as u32;
    let mut bucket_ends = vec![0u32; n_vertices + 1];
    for h in 0..n_halfedges {
        let (a, b) = ends(h);
        bucket_ends[a.min(b).index() + 1] += 1;
    }
    progress.check()?;
    for v in 0..n_vertices {
        bucket_ends[v + 1] += bucket_ends[v];
    }
    // Each start moves on as its bucket fills and becomes its end.
    let mut entries = vec![(VertexId(0), 0u32); n_halfedges as usize];
    for h in 0..n_halfedges {
        progress.check()?;
        let (a, b) = ends(h);
        let end = &mut bucket_ends[a.min(b).index()];
        entries[*end as usize] = (a.max(b), h);
        *end += 1;
    }
    let mut twins = vec![BORDER; entries.len()];
    let mut start = 0;
    for &end in &bucket_ends[..n_vertices] {
        progress.check()?;
        let bucket = &mut entries[start..end as usize];
        start = end as usize;
        bucket.sort_unstable();
        for run in bucket.chunk_by(|x, y| x.0 == y.0) {
            if let Err(error) = pair(run, ends, &mut twins) {
                return Ok(Err(error));
            }
        }
    }
    Ok(Ok(twins))
}

/// Pairs the halfedges of one edge.
fn pair(
    run: &[(VertexId, u32)],
    ends: impl Fn(u32) -> (VertexId, VertexId),
    twins: &mut [u32],
) -> Result<(), TriangleMeshError> {
    let (a, b) = ends(run[0].1);
    match *run {
        [_] => Ok(()),
        [(_, g), (_, h)] if ends(g) != ends(h) => {
            twins[g as usize] = h;
            twins[h as usize] = g;
            Ok(())
        }
        [_, _] => Err(TriangleMeshError::Orientation { a, b }),
        _ => Err(TriangleMeshError::NonManifoldEdge {
            n_faces: run.len(),
            a,
            b,
        }),
    }
}
