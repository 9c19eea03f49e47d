//! Where what is kept and what is not meet, by places: vertices of one place are one.

use std::collections::HashMap;

use crate::mesh::{FaceId, FaceMap, Id, PolygonMesh, VertexId};
use crate::pipeline::frame::bits;

fn ids(mesh: &PolygonMesh) -> impl Iterator<Item = VertexId> + use<> {
    (0..mesh.n_vertices()).map(VertexId::from_index)
}

/// The first vertex at the place of each.
pub fn names(mesh: &PolygonMesh) -> Vec<VertexId> {
    let mut first = HashMap::new();
    let name = |v| *first.entry(bits(mesh.position(v))).or_insert(v);
    ids(mesh).map(name).collect()
}

/// The edges that have faces that are kept and others, and these others.
pub fn line(
    mesh: &PolygonMesh,
    names: &[VertexId],
    is_kept: &FaceMap<bool>,
) -> (Vec<[VertexId; 2]>, Vec<FaceId>) {
    let mut sides = Vec::with_capacity(mesh.corners().len());
    for face in mesh.face_ids() {
        let corners = mesh.face(face);
        let next = corners.iter().cycle().skip(1);
        for (a, b) in corners.iter().zip(next) {
            let [a, b] = [a, b].map(|v| names[v.index()]);
            sides.push(([a.min(b), a.max(b)], face));
        }
    }
    sides.sort_unstable();
    let (mut line, mut beside) = (Vec::new(), Vec::new());
    for run in sides.chunk_by(|a, b| a.0 == b.0) {
        let others = run
            .iter()
            .map(|&(_, face)| face)
            .filter(|&face| !is_kept[face]);
        let others: Vec<FaceId> = others.collect();
        if !others.is_empty() && others.len() < run.len() && run[0].0[0] != run[0].0[1] {
            line.push(run[0].0);
            beside.extend(others);
        }
    }
    (line, beside)
}

/// The first vertices at places that faces that are kept have with others in common, and how many
/// places they have alone.
pub fn shared(
    mesh: &PolygonMesh,
    names: &[VertexId],
    is_kept: &FaceMap<bool>,
) -> (Vec<VertexId>, usize) {
    let mut has = [
        vec![false; mesh.n_vertices()],
        vec![false; mesh.n_vertices()],
    ];
    for face in mesh.face_ids() {
        for v in mesh.face(face) {
            has[usize::from(is_kept[face])][names[v.index()].index()] = true;
        }
    }
    let [others, kept] = has;
    let of_kept = ids(mesh).filter(|v| kept[v.index()]);
    let (shared, inner): (Vec<_>, Vec<_>) = of_kept.partition(|v| others[v.index()]);
    (shared, inner.len())
}

/// The same mesh with faces that are points where it is kept.
pub fn hollow(mesh: &PolygonMesh, is_kept: &FaceMap<bool>) -> PolygonMesh {
    let mut corners = mesh.corners().to_vec();
    for face in mesh.face_ids().filter(|&face| is_kept[face]) {
        let [from, to] = [0, 1].map(|k| mesh.starts()[face.index() + k] as usize);
        let first = corners[from];
        corners[from..to].fill(first);
    }
    PolygonMesh::new(mesh.positions().to_vec(), mesh.starts().to_vec(), corners)
        .expect("corners of a mesh are in range")
}
