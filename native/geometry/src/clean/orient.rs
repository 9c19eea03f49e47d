//! Turns faces so that neighbours agree.

use super::edges::{Twins, halfedges};
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// Turns faces so that both faces of every edge run through it in opposite directions; in each
/// component the smaller part is turned. Returns an edge of each component that cannot be done and
/// stays as it was.
pub(super) fn agree(faces: &mut [[VertexId; 3]], twins: &mut Twins) -> Vec<HalfedgeId> {
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    let mut component = Vec::new();
    let mut one_sided = Vec::new();
    for seed in (0..faces.len()).map(FaceId::from_index) {
        if turned[seed.index()].is_some() {
            continue;
        }
        component.clear();
        component.push(seed);
        turned[seed.index()] = Some(false);
        if let Some(h) = spread(faces, twins, &mut component, &mut turned) {
            one_sided.push(h);
            continue;
        }
        let is_turned = |f: &FaceId| turned[f.index()] == Some(true);
        let n = component.iter().filter(|f| is_turned(f)).count();
        let smaller = 2 * n <= component.len();
        component.retain(|f| is_turned(f) == smaller);
        for &face in &component {
            faces[face.index()].swap(1, 2);
            twins.turn_face(face);
        }
    }
    one_sided
}

/// Visits the component of the one face in the list, face after face, and decides for each whether
/// to turn it; the first edge where faces disagree whichever way they are turned.
fn spread(
    faces: &[[VertexId; 3]],
    twins: &Twins,
    component: &mut Vec<FaceId>,
    turned: &mut [Option<bool>],
) -> Option<HalfedgeId> {
    let origin = |h: HalfedgeId| faces[h.face().index()][h.corner()];
    let mut wrong = None;
    let mut i = 0;
    while let Some(&face) = component.get(i) {
        i += 1;
        for h in halfedges(face) {
            let Some(twin) = twins.of(h) else {
                continue;
            };
            let disagrees = origin(h) == origin(twin);
            let wanted = turned[face.index()].map(|turned| turned != disagrees);
            let known = &mut turned[twin.face().index()];
            if known.is_none() {
                *known = wanted;
                component.push(twin.face());
            } else if *known != wanted {
                wrong = wrong.or(Some(h));
            }
        }
    }
    wrong
}
