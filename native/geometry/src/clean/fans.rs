//! One vertex for each fan of faces.

use super::edges::{Twins, halfedges};
use super::triangulate::Triangulated;
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// Gives each fan at a vertex but the first a vertex of its own at the same point, after all
/// others, and returns how many. Faces agree and have at most one neighbour at each edge.
pub(super) fn split(triangulated: &mut Triangulated, twins: &Twins) -> usize {
    let Triangulated {
        positions,
        origins,
        faces,
        ..
    } = triangulated;
    let n_before = positions.len();
    let mut has_fan = vec![false; positions.len()];
    let mut seen = vec![false; 3 * faces.len()];
    let mut fan = Vec::new();
    for face in (0..faces.len()).map(FaceId::from_index) {
        for corner in halfedges(face) {
            if seen[corner.index()] {
                continue;
            }
            collect_fan(corner, twins, &mut fan);
            for h in &fan {
                seen[h.index()] = true;
            }
            let vertex = faces[face.index()][corner.corner()];
            if std::mem::replace(&mut has_fan[vertex.index()], true) {
                let own = VertexId::from_index(positions.len());
                positions.push(positions[vertex.index()]);
                origins.push(origins[vertex.index()]);
                for h in &fan {
                    faces[h.face().index()][h.corner()] = own;
                }
            }
        }
    }
    positions.len() - n_before
}

/// The halfedges that leave a vertex between the borders on both sides of one of them.
fn collect_fan(start: HalfedgeId, twins: &Twins, fan: &mut Vec<HalfedgeId>) {
    fan.clear();
    fan.push(start);
    let mut at = start;
    while let Some(turned) = twins.of(at.prev()) {
        if turned == start {
            return;
        }
        fan.push(turned);
        at = turned;
    }
    at = start;
    while let Some(twin) = twins.of(at) {
        at = twin.next();
        fan.push(at);
    }
}
