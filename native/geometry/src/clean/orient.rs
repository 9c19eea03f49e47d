//! Turns faces so that neighbours agree.

use super::edges::{Twins, halfedges};
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// Turns faces so that both faces of every edge run through it in opposite directions; in each
/// component the smaller part is turned. Returns how many faces were turned, or the ends of an
/// edge where it cannot be done.
pub(super) fn agree(
    faces: &mut [[VertexId; 3]],
    twins: &mut Twins,
) -> Result<usize, [VertexId; 2]> {
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    let mut component = Vec::new();
    let mut n_turned = 0;
    for seed in (0..faces.len()).map(FaceId::from_index) {
        if turned[seed.index()].is_some() {
            continue;
        }
        component.clear();
        component.push(seed);
        turned[seed.index()] = Some(false);
        spread(faces, twins, &mut component, &mut turned)?;
        let is_turned = |f: &FaceId| turned[f.index()] == Some(true);
        let n = component.iter().filter(|f| is_turned(f)).count();
        let smaller = 2 * n <= component.len();
        component.retain(|f| is_turned(f) == smaller);
        n_turned += component.len();
        for &face in &component {
            faces[face.index()].swap(1, 2);
            twins.turn_face(face);
        }
    }
    Ok(n_turned)
}

/// Visits the component of the one face in the list, face after face, and decides for each whether
/// to turn it.
fn spread(
    faces: &[[VertexId; 3]],
    twins: &Twins,
    component: &mut Vec<FaceId>,
    turned: &mut [Option<bool>],
) -> Result<(), [VertexId; 2]> {
    let origin = |h: HalfedgeId| faces[h.face().index()][h.corner()];
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
                let ends = [origin(h), origin(h.next())];
                return Err([ends[0].min(ends[1]), ends[0].max(ends[1])]);
            }
        }
    }
    Ok(())
}
