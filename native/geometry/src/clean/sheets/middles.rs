//! Vertices in the middle of edges that join the same two vertices.
//!
//! Sheets that meet at an edge have vertices of their own there, unless one fan leads from the one
//! to the other at both ends. Then a triangle mesh could not tell their edges apart; all but one
//! get a vertex in the middle, and their triangles are cut.

use std::collections::HashMap;

use super::super::edges::{Edges, Twins, halfedges};
use super::super::triangulate::Triangulated;
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// Which triangles were cut, and where.
pub(in super::super) struct Middles {
    /// The triangles before.
    pub(super) faces: Vec<[VertexId; 3]>,
    /// The vertex in the middle of a side.
    pub(super) at: HashMap<HalfedgeId, VertexId>,
    /// Where the pieces of each triangle start.
    pub(super) starts: Vec<FaceId>,
}

/// Cuts edges that join the same vertices as others do. Every vertex has one fan.
pub(in super::super) fn split_at_middles(
    triangulated: &mut Triangulated,
    twins: &Twins,
) -> Middles {
    let mut at = HashMap::new();
    for run in Edges::new(&triangulated.faces).runs() {
        let is_first = |h: &&HalfedgeId| twins.of(**h).is_none_or(|twin| twin > **h);
        for &h in run.iter().filter(is_first).skip(1) {
            let [a, b] = triangulated.ends(h);
            let [p, q] = [a, b].map(|v| triangulated.positions[v.index()]);
            let middle = triangulated.add(p.midpoint(q), a);
            at.insert(h, middle);
            at.extend(twins.of(h).map(|twin| (twin, middle)));
        }
    }
    let faces = triangulated.faces.clone();
    let mut starts = Vec::with_capacity(faces.len());
    let mut pieces = Vec::with_capacity(faces.len());
    for (i, &corners) in faces.iter().enumerate() {
        let face = FaceId::from_index(i);
        starts.push(FaceId::from_index(pieces.len()));
        let sides = halfedges(face).map(|h| at.get(&h).copied());
        let mut around = Vec::new();
        for (corner, middle) in corners.into_iter().zip(sides) {
            around.push(corner);
            around.extend(middle);
        }
        if around.len() == 3 {
            pieces.push((face, corners));
            continue;
        }
        // Edges from the centre are those of no other triangle.
        let third = corners.map(|v| triangulated.positions[v.index()] / 3.0);
        let centre = triangulated.add(third.into_iter().sum(), corners[0]);
        let next = around.iter().cycle().skip(1);
        pieces.extend(
            around
                .iter()
                .zip(next)
                .map(|(&a, &b)| (face, [centre, a, b])),
        );
    }
    if !at.is_empty() {
        triangulated.replace(&pieces);
    }
    Middles { faces, at, starts }
}
