//! Pieces of the surface that hang together, and which of them are specks.

use glam::DVec3;

use super::{Error, Report};
use crate::mesh::{Id, TriangleMesh};

/// A piece that measures less than this share of the diagonal is a speck, unless it is the largest.
/// Above, buttons and eyes go; below, what a scan has around it stays.
pub const SPECK: f64 = 0.03;

/// A mesh, and which of its vertices lie on lines.
type OnLines = (TriangleMesh, Vec<bool>);

/// The pieces that are no specks.
pub fn largest(
    (mesh, is_on_line): OnLines,
    [low, high]: [DVec3; 2],
) -> Result<(OnLines, Report), Error> {
    let (piece, n_pieces) = mesh.face_components();
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; n_pieces];
    for (face, &piece) in mesh.face_ids().zip(&piece) {
        for p in mesh.triangle(face) {
            let [low, high] = &mut boxes[piece as usize];
            (*low, *high) = (low.min(p), high.max(p));
        }
    }
    let sizes: Vec<f64> = boxes
        .iter()
        .map(|[low, high]| low.distance(*high))
        .collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let least = most.min(SPECK * low.distance(high));
    let is_left = |face: usize| sizes[piece[face] as usize] >= least;
    let n_dropped = sizes.iter().filter(|&&size| size < least).count();
    let report = Report {
        n_pieces: n_pieces - n_dropped,
        n_dropped,
        ..Report::default()
    };
    if n_dropped == 0 {
        return Ok(((mesh, is_on_line), report));
    }
    let faces = mesh.face_ids().filter(|face| is_left(face.index()));
    let faces = faces.map(|face| mesh.face(face));
    let (mesh, was) = TriangleMesh::of_faces(mesh.positions(), faces)?;
    let is_on_line = was.iter().map(|v| is_on_line[v.index()]).collect();
    Ok(((mesh, is_on_line), report))
}
