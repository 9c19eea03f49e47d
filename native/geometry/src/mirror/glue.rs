//! Closes one side of a plane by its image.

use glam::DVec3;

use super::cut::{Side, positive_side};
use super::{DoubleError, Doubled, Reflection};
use crate::groups::Groups;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};

/// Cuts a closed mesh of genus 0 at the plane where a coordinate is 0 and closes the largest piece
/// on the positive side by its image.
///
/// Vertices nearer to the plane than the share `snap` of an edge across it are moved onto it. What
/// lies on the positive side keeps its faces but for those that are cut. Linear in time.
///
/// # Errors
/// [`DoubleError`].
pub fn double(mesh: &TriangleMesh, axis: usize, snap: f64) -> Result<Doubled, DoubleError> {
    let (half, sources) = disc(&positive_side(mesh, (axis, snap), None))?;
    glue(&half, sources, Reflection::Across(axis))
}

/// The same of a closed mesh with lines, whose vertices stay on them; marked on both sides of each.
///
/// # Errors
/// [`DoubleError`].
pub fn double_along(
    mesh: &TriangleMesh,
    lines: &HalfedgeMap<bool>,
    (axis, snap): (usize, f64),
) -> Result<Doubled, DoubleError> {
    let (half, sources) = disc(&positive_side(mesh, (axis, snap), Some(lines)))?;
    glue(&half, sources, Reflection::Across(axis))
}

/// A sheet without holes and its other side, glued along its border; of its vertices the names in
/// another mesh are given.
///
/// # Errors
/// [`DoubleError`].
pub fn double_sheet(sheet: &TriangleMesh, names: &[VertexId]) -> Result<Doubled, DoubleError> {
    let mut sources = names.iter().map(|&v| [v, v]).collect();
    let sheet = checked_disc(sheet.clone(), &mut sources)?;
    glue(&sheet, sources, Reflection::Onto)
}

/// The largest piece of a side, if it is a disc; no inner edge joins two vertices of its border.
fn disc(side: &Side) -> Result<(TriangleMesh, Vec<[VertexId; 2]>), DoubleError> {
    let (piece, mut sources) = largest_piece(side)?;
    Ok((checked_disc(piece, &mut sources)?, sources))
}

/// A piece that is a disc, without chords.
fn checked_disc(
    piece: TriangleMesh,
    sources: &mut Vec<[VertexId; 2]>,
) -> Result<TriangleMesh, DoubleError> {
    let loops = piece.border_loops();
    let euler = piece.euler_number();
    match loops.len() {
        0 => Err(DoubleError::NotCut),
        1 if euler == 1 => without_chords(piece, sources),
        n_loops => Err(DoubleError::NotADisc { n_loops, euler }),
    }
}

pub(super) fn largest_piece(
    side: &Side,
) -> Result<(TriangleMesh, Vec<[VertexId; 2]>), DoubleError> {
    if side.faces.is_empty() {
        return Err(DoubleError::NotCut);
    }
    let (component, n) = components(side);
    let mut areas = vec![0.0; n];
    for (face, &c) in side.faces.iter().zip(&component) {
        let [p, q, r] = face.map(|v| side.positions[v.index()]);
        areas[c as usize] += (q - p).cross(r - p).length();
    }
    let largest = (0..n).max_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(b.cmp(&a)));
    let of_piece = side.faces.iter().zip(&component);
    let of_piece = of_piece.filter(|(_, c)| Some(**c as usize) == largest);
    let faces = of_piece.map(|(face, _)| *face);
    let (piece, vertices) = TriangleMesh::of_faces(&side.positions, faces)?;
    let sources = vertices.iter().map(|v| side.sources[v.index()]).collect();
    Ok((piece, sources))
}

/// The component of each face, joined over edges, and how many there are.
fn components(side: &Side) -> (Vec<u32>, usize) {
    let mut sides: Vec<([VertexId; 2], usize)> = Vec::with_capacity(3 * side.faces.len());
    for (i, face) in side.faces.iter().enumerate() {
        for k in 0..3 {
            let [a, b] = [face[k], face[(k + 1) % 3]];
            sides.push(([a.min(b), a.max(b)], i));
        }
    }
    sides.sort_unstable();
    let mut groups = Groups::new(side.faces.len());
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        groups.link(pair[0].1, pair[1].1);
    }
    groups.numbered()
}

/// Splits inner edges between two vertices of the border: their images would join the same two.
fn without_chords(
    mesh: TriangleMesh,
    sources: &mut Vec<[VertexId; 2]>,
) -> Result<TriangleMesh, DoubleError> {
    let is_chord = |h: &HalfedgeId| {
        let ends = [mesh.origin(*h), mesh.target(*h)];
        mesh.twin(*h).is_some_and(|twin| *h < twin) && ends.iter().all(|&v| mesh.is_border(v))
    };
    let chords: Vec<HalfedgeId> = mesh.halfedge_ids().filter(is_chord).collect();
    if chords.is_empty() {
        return Ok(mesh);
    }
    let mut positions = mesh.positions().to_vec();
    let mut faces = mesh.faces().to_vec();
    for h in chords {
        let [a, b] = [mesh.origin(h), mesh.target(h)];
        let middle = VertexId::from_index(positions.len());
        positions.push(mesh.position(a).midpoint(mesh.position(b)));
        let source = match [a, b].map(|v| sources[v.index()]) {
            [[a, p], [b, q]] if a == p && b == q => [a, b],
            // The end of one that lies on an edge itself stands for it.
            [first, _] => first,
        };
        sources.push(source);
        for i in 0..faces.len() {
            let Some(k) = (0..3).find(|&k| {
                let ends = [faces[i][k], faces[i][(k + 1) % 3]];
                ends == [a, b] || ends == [b, a]
            }) else {
                continue;
            };
            let [from, to, apex] = [0, 1, 2].map(|j| faces[i][(k + j) % 3]);
            faces[i] = [from, middle, apex];
            faces.push([middle, to, apex]);
        }
    }
    Ok(TriangleMesh::new(positions, faces)?)
}

fn glue(
    half: &TriangleMesh,
    sources: Vec<[VertexId; 2]>,
    reflection: Reflection,
) -> Result<Doubled, DoubleError> {
    let mut positions: Vec<DVec3> = half.positions().to_vec();
    let mut images: Vec<VertexId> = half.vertex_ids().collect();
    for v in half.vertex_ids() {
        if half.is_border(v) {
            if let Reflection::Across(axis) = reflection {
                positions[v.index()][axis] = 0.0;
            }
        } else {
            images[v.index()] = VertexId::from_index(positions.len());
            images.push(v);
            positions.push(reflection.of(half.position(v)));
        }
    }
    let image = |face: FaceId| {
        let [a, b, c] = half.face(face).map(|v| images[v.index()]);
        [a, c, b]
    };
    let faces = half.faces().iter().copied();
    let faces = faces.chain(half.face_ids().map(image)).collect();
    Ok(Doubled {
        mesh: TriangleMesh::new(positions, faces)?,
        images: images.into_iter().collect(),
        border: half.border_loops().remove(0),
        sources,
        reflection,
    })
}
