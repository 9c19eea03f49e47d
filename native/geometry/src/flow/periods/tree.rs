//! A tree of short edges, and every other edge as a sum of its vectors.

use glam::IVec2;

use super::NotASphere;
use crate::flow::complex::{Complex, Turn};
use crate::groups::Groups;
use crate::mesh::{FaceId, HalfedgeId, Id};

/// The halfedges of a spanning tree of least length, shortest first.
pub(super) fn shortest_tree(complex: &Complex) -> Vec<HalfedgeId> {
    let mut edges: Vec<HalfedgeId> = complex
        .halfedge_ids()
        .filter(|&h| h < complex.twins[h])
        .collect();
    let length = |h: HalfedgeId| complex.start[h].length_squared();
    edges.sort_by(|&a, &b| length(a).total_cmp(&length(b)).then(a.cmp(&b)));
    let mut groups = Groups::new(complex.n_vertices());
    edges.retain(|&h| groups.link(complex.origins[h].index(), complex.target(h).index()));
    edges
}

/// The row of each halfedge over the vectors of the tree, and the face whose sum stays open.
///
/// The edges off the tree are a tree of the dual graph. A leaf of it is a face with one unknown
/// edge, which the other two decide. One face is never used: its sum is the closing equation.
pub(super) fn peel(
    complex: &Complex,
    tree: &[HalfedgeId],
) -> Result<(Vec<Vec<IVec2>>, FaceId), NotASphere> {
    let mut rows = vec![vec![IVec2::ZERO; tree.len()]; complex.twins.len()];
    let mut is_known = vec![false; complex.twins.len()];
    for (column, &h) in tree.iter().enumerate() {
        rows[h.index()][column] = IVec2::X;
        know(complex, &mut rows, &mut is_known, h);
    }
    let mut is_used = vec![false; complex.n_faces()];
    let mut waiting: Vec<FaceId> = complex.face_ids().collect();
    while let Some(face) = waiting.pop() {
        let Some(h) = only_unknown(complex, face, &is_known) else {
            continue;
        };
        let [a, b] = [h.next(), h.prev()].map(|e| &rows[e.index()]);
        rows[h.index()] = a.iter().zip(b).map(|(&a, &b)| -a - b).collect();
        know(complex, &mut rows, &mut is_known, h);
        is_used[face.index()] = true;
        waiting.push(complex.twins[h].face());
    }
    let mut unused = complex.face_ids().filter(|f| !is_used[f.index()]);
    match (unused.next(), unused.next()) {
        (Some(face), None) => Ok((rows, face)),
        _ => Err(NotASphere),
    }
}

fn only_unknown(complex: &Complex, face: FaceId, is_known: &[bool]) -> Option<HalfedgeId> {
    let h = complex.halfedge(face);
    let mut unknown = [h, h.next(), h.prev()]
        .into_iter()
        .filter(|e| !is_known[e.index()]);
    unknown.next().filter(|_| unknown.next().is_none())
}

/// Carries the row of a halfedge to its twin.
fn know(complex: &Complex, rows: &mut [Vec<IVec2>], is_known: &mut [bool], h: HalfedgeId) {
    let twin = complex.twins[h];
    let turned = |c: &IVec2| -c.turned(complex.turns[h]);
    rows[twin.index()] = rows[h.index()].iter().map(turned).collect();
    [is_known[h.index()], is_known[twin.index()]] = [true; 2];
}
