//! One vertex for each fan of faces.

use glam::DVec3;

use super::edges::{Edges, halfedges};
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// Gives each fan at a vertex but the first a vertex of its own at the same point, after all
/// others. Faces agree and have at most one neighbour at each edge.
pub(super) fn split(faces: &mut [[VertexId; 3]], edges: &Edges, positions: &mut Vec<DVec3>) {
    let mut has_fan = vec![false; positions.len()];
    let mut seen = vec![false; 3 * faces.len()];
    let mut fan = Vec::new();
    for face in (0..faces.len()).map(FaceId::from_index) {
        if !edges.is_kept(face) {
            continue;
        }
        for corner in halfedges(face) {
            if seen[corner.index()] {
                continue;
            }
            collect_fan(corner, edges, &mut fan);
            for h in &fan {
                seen[h.index()] = true;
            }
            let vertex = faces[face.index()][corner.corner()];
            if std::mem::replace(&mut has_fan[vertex.index()], true) {
                let own = VertexId::from_index(positions.len());
                positions.push(positions[vertex.index()]);
                for h in &fan {
                    faces[h.face().index()][h.corner()] = own;
                }
            }
        }
    }
}

/// The halfedges that leave a vertex between the borders on both sides of one of them.
fn collect_fan(start: HalfedgeId, edges: &Edges, fan: &mut Vec<HalfedgeId>) {
    fan.clear();
    fan.push(start);
    let mut at = start;
    while let Some(turned) = edges.twin(at.prev()) {
        if turned == start {
            return;
        }
        fan.push(turned);
        at = turned;
    }
    at = start;
    while let Some(twin) = edges.twin(at) {
        at = twin.next();
        fan.push(at);
    }
}
