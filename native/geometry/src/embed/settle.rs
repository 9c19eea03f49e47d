//! Bringing vertices that a repair moved back to where they were proposed, as far as nothing folds.

use glam::DVec3;

use crate::mesh::{FaceId, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::stays_cover;

/// Rounds over all vertices that are not where they were proposed.
const N_ROUNDS: usize = 30;
/// Shares of the way that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];

/// Moves every vertex towards its proposal, or towards the middle of its neighbours where that way
/// is blocked, round by round. A proposal of length zero is none.
pub(super) fn settle(
    mesh: &PolygonMesh,
    sphere: &mut VertexMap<DVec3>,
    proposals: &VertexMap<DVec3>,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let rings = rings(mesh);
    let mut moved: Vec<_> = rings.ids().filter(|&v| sphere[v] != proposals[v]).collect();
    for _ in 0..N_ROUNDS {
        progress.check()?;
        moved.retain(|&v| sphere[v] != proposals[v]);
        for &v in &moved {
            let ways = [proposals[v], middle(mesh, &rings[v], sphere, v)];
            for to in ways {
                if to != DVec3::ZERO && approach(mesh, &rings[v], sphere, (v, to)) {
                    break;
                }
            }
        }
    }
    Ok(())
}

/// The faces at each vertex.
fn rings(mesh: &PolygonMesh) -> VertexMap<Vec<FaceId>> {
    let mut rings = VertexMap::filled(mesh.n_vertices(), Vec::with_capacity(6));
    for face in mesh.face_ids() {
        for &v in mesh.face(face) {
            rings[v].push(face);
        }
    }
    rings
}

/// The middle of the neighbours of a vertex.
fn middle(mesh: &PolygonMesh, ring: &[FaceId], sphere: &VertexMap<DVec3>, v: VertexId) -> DVec3 {
    let next = |&face: &FaceId| {
        let face = mesh.face(face);
        let i = face.iter().position(|&w| w == v).unwrap_or(0);
        sphere[face[(i + 1) % face.len()]]
    };
    ring.iter().map(next).sum::<DVec3>().normalize_or_zero()
}

/// Moves a vertex towards a point as far as nothing folds; false if that is nowhere.
fn approach(
    mesh: &PolygonMesh,
    ring: &[FaceId],
    sphere: &mut VertexMap<DVec3>,
    (v, to): (VertexId, DVec3),
) -> bool {
    let from = sphere[v];
    for share in SHARES {
        let there = if share < 1.0 {
            from.lerp(to, share).normalize_or(from)
        } else {
            to
        };
        let faces = ring.iter().map(|&face| mesh.face(face));
        if stays_cover(faces, (v, there), |v| sphere[v]) {
            sphere[v] = there;
            return true;
        }
    }
    false
}
