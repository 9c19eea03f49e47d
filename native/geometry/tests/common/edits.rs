//! Meshes damaged by drawn bytes: what the property tests and the fuzzer feed to the pipeline.

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMesh;

use super::{blob, cuboid, limbs, polygons, sphere};

/// A small closed mesh, then one edit for every eight bytes; none when no mesh is left.
///
/// Edits drop, repeat and turn faces, tear corners to other vertices, cut corners off and move
/// vertices, some onto each other, some very far.
pub fn damaged(bytes: &[u8]) -> Option<PolygonMesh> {
    let (&first, rest) = bytes.split_first()?;
    let base = match first % 4 {
        0 => sphere(2),
        1 => cuboid(3),
        2 => blob(u64::from(first), 3),
        _ => limbs(u64::from(first), 4),
    };
    let mut points = base.positions().to_vec();
    let mut faces: Vec<Vec<u32>> = polygons(&base)
        .faces()
        .map(|face| face.iter().map(|v| v.0).collect())
        .collect();
    for edit in rest.chunks_exact(8) {
        if faces.is_empty() {
            return None;
        }
        apply(edit, &mut points, &mut faces);
    }
    PolygonMesh::from_faces(points, &faces).ok()
}

fn apply(edit: &[u8], points: &mut [DVec3], faces: &mut Vec<Vec<u32>>) {
    let word = |i: usize| usize::from(u16::from_le_bytes([edit[i], edit[i + 1]]));
    let [face, vertex, other] = [word(1) % faces.len(), word(3) % points.len(), word(5)];
    match edit[0] % 8 {
        0 => {
            faces.swap_remove(face);
        }
        1 => faces.push(faces[face].clone()),
        2 => faces[face].reverse(),
        3 => {
            let corner = other % faces[face].len();
            faces[face][corner] = vertex as u32;
        }
        4 => points[vertex] = points[other % points.len()],
        5 => points[vertex] *= 10_f64.powi(i32::from(edit[7] as i8) / 4),
        6 => {
            let face = &mut faces[face];
            face.insert(other % face.len(), vertex as u32);
        }
        _ => {
            let push = DVec3::new(f64::from(edit[5]), f64::from(edit[6]), f64::from(edit[7]));
            points[vertex] += push / 128.0 - 1.0;
        }
    }
}
