//! Cuts a surface along a loop of edges.

use super::split::Pieces;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// The halfedge between two vertices, if they are joined; found from the first.
pub fn between(mesh: &TriangleMesh, [a, b]: [VertexId; 2]) -> Option<HalfedgeId> {
    mesh.outgoing(a).find(|&h| mesh.target(h) == b)
}

/// Doubles the vertices of a loop that passes none twice and none on a border: the faces on its
/// left get the copies, which are returned in the order of the loop.
pub fn slit(
    pieces: Pieces,
    line: &[VertexId],
    progress: &Progress,
) -> Result<(Pieces, Vec<VertexId>), Cancelled> {
    let (pieces, mut copies) = slit_all(pieces, &[line], progress)?;
    let copies = copies.pop().expect("one loop has one list of copies");
    Ok((pieces, copies))
}

/// The same with loops no two of which share a vertex.
pub fn slit_all<L: AsRef<[VertexId]>>(
    pieces: Pieces,
    lines: &[L],
    progress: &Progress,
) -> Result<(Pieces, Vec<Vec<VertexId>>), Cancelled> {
    let mesh = &pieces.mesh;
    let mut positions = mesh.positions().to_vec();
    let mut faces = mesh.faces().to_vec();
    let mut all = Vec::with_capacity(lines.len());
    for line in lines.iter().map(AsRef::as_ref) {
        let mut copies = Vec::with_capacity(line.len());
        for (i, &v) in line.iter().enumerate() {
            let [before, after] = [(i + line.len() - 1) % line.len(), (i + 1) % line.len()];
            let copy = VertexId::from_index(positions.len());
            copies.push(copy);
            positions.push(mesh.position(v));
            for h in fan(mesh, [line[before], v, line[after]]) {
                faces[h.face().index()][h.corner()] = copy;
            }
        }
        all.push(copies);
    }
    let mesh = TriangleMesh::build(positions, faces, progress)?;
    let mesh = mesh.expect("loops that touch nothing can be cut");
    Ok((Pieces { mesh, ..pieces }, all))
}

/// The halfedges that leave a vertex on the left of a way through it, from the one that goes on
/// to the last before the one that came.
pub fn fan(mesh: &TriangleMesh, [from, v, to]: [VertexId; 3]) -> Vec<HalfedgeId> {
    let mut h = between(mesh, [v, to]).expect("a loop goes along edges");
    let mut fan = Vec::new();
    while mesh.target(h) != from {
        fan.push(h);
        h = mesh.twin(h.prev()).expect("a loop passes no border");
    }
    fan
}
