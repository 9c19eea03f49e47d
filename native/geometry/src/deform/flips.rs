//! Edge flips: triangles trade their common edge for the other diagonal where that is better.

use super::sheet::Sheet;
use crate::mesh::{FaceId, VertexId};

/// Fewest faces that a flip leaves at a vertex.
const FEWEST_FACES: usize = 4;

/// Flips edges until the worse of each two triangles is as good as it can be, and returns how many.
///
/// Kept: the number of faces, and that both triangles are positive on the sphere. Kept edges stay. A flip always improves the sorted list of qualities, so this ends; the
/// number of passes is bounded all the same, since later ones find next to nothing.
pub(super) fn flip_edges(sheet: &mut Sheet) -> usize {
    let mut n_flips = 0;
    for _ in 0..4 {
        let before = n_flips;
        for face in sheet.faces().ids() {
            n_flips += usize::from(flip_one(sheet, face));
        }
        if n_flips == before {
            break;
        }
    }
    n_flips
}

/// Flips the first edge of a triangle that gains by it.
fn flip_one(sheet: &mut Sheet, left: FaceId) -> bool {
    for corner in 0..3 {
        let face = &sheet.faces()[left];
        if face.corners().len() != 3 {
            return false;
        }
        let [a, b, c] = [0, 1, 2].map(|i| face.corner(corner, i));
        // Each edge is looked at from one side.
        if a > b || sheet.is_kept(a, b) {
            continue;
        }
        if let Some((right, d)) = gain(sheet, left, [a, b, c]) {
            sheet.flip([left, right], [a, b, c, d]);
            return true;
        }
    }
    false
}

/// The triangle beyond the edge a b and its apex, if the other diagonal is allowed and better.
fn gain(sheet: &Sheet, left: FaceId, [a, b, c]: [VertexId; 3]) -> Option<(FaceId, VertexId)> {
    let right = sheet.face_left_of(b, a)?;
    let other = &sheet.faces()[right];
    let d = (other.corners().len() == 3).then(|| other.corner(other.find(b).unwrap_or(0), 2))?;
    let now = sheet.quality(left).min(sheet.quality(right));
    let [first, second] = [[a, d, c], [d, b, c]];
    // A gain below rounding could be undone by the neighbour's flip for ever.
    let better = sheet.quality_of(&first).min(sheet.quality_of(&second)) > now + 1e-9;
    let spare = sheet.ring(a).len() > FEWEST_FACES && sheet.ring(b).len() > FEWEST_FACES;
    let apart = || sheet.face_left_of(c, d).is_none() && sheet.face_left_of(d, c).is_none();
    let allowed = better && spare && apart();
    let unfolded = allowed && sheet.is_unfolded(&first) && sheet.is_unfolded(&second);
    unfolded.then_some((right, d))
}
