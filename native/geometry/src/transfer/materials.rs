//! The material of every face.

use glam::DVec3;
use rayon::prelude::*;

use super::Source;
use crate::mesh::{FaceId, Id, PolygonMesh};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Faces between two looks at the progress: some milliseconds of work.
const CHUNK: usize = 2048;

/// Gives every face of the output the material that most of its area has on the source.
///
/// A face is asked at its middle and at the middles of the triangles around it, each for its share
/// of the area; of equal shares the smallest material wins. `source_materials` has one index for
/// every triangle of `source`. Without a source all get 0.
///
/// # Errors
/// When cancelled.
///
/// # Panics
/// When the number of materials is not the number of triangles.
pub fn materials(
    source: &Bvh,
    source_materials: &[i32],
    output: &PolygonMesh,
    progress: &Progress,
) -> Result<Vec<i32>, Cancelled> {
    assert_eq!(
        source.n_faces(),
        source_materials.len(),
        "one material per triangle"
    );
    let Some(source) = Source::new(source) else {
        return Ok(vec![0; output.n_faces()]);
    };
    let mut found = Vec::with_capacity(output.n_faces());
    let faces: Vec<FaceId> = output.face_ids().collect();
    for chunk in faces.chunks(CHUNK) {
        progress.at(found.len() as f64 / faces.len() as f64)?;
        let material = |&face: &FaceId| material_of(source, source_materials, output, face);
        found.par_extend(chunk.par_iter().map(material));
    }
    Ok(found)
}

fn material_of(
    source: Source,
    source_materials: &[i32],
    output: &PolygonMesh,
    face: FaceId,
) -> i32 {
    let corners: Vec<DVec3> = output
        .face(face)
        .iter()
        .map(|&v| output.position(v))
        .collect();
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let ahead = corners.iter().cycle().skip(1);
    let around = corners.iter().zip(ahead).map(|(&a, &b)| {
        let area = (a - middle).cross(b - middle) * 0.5;
        ((middle + a + b) / 3.0, area)
    });
    let around: Vec<(DVec3, DVec3)> = around.collect();
    let normal: DVec3 = around.iter().map(|(_, area)| *area).sum();
    let total: f64 = around.iter().map(|(_, area)| area.length()).sum();
    let material_at = |p| source_materials[source.at(p, normal, total.sqrt()).face.index()];
    // The middle is a corner of every triangle around it: a third of the area is closest to it.
    let mut shares = vec![(material_at(middle), total / 3.0)];
    for (p, area) in around {
        shares.push((material_at(p), area.length() * 2.0 / 3.0));
    }
    most(shares)
}

/// The material with the largest sum of shares, the smallest of several.
fn most(mut shares: Vec<(i32, f64)>) -> i32 {
    shares.sort_by_key(|&(material, _)| material);
    let mut best = (shares[0].0, -1.0);
    for run in shares.chunk_by(|a, b| a.0 == b.0) {
        let share = run.iter().map(|(_, share)| share).sum();
        // A hair of rounding makes no majority.
        if share > best.1 * (1.0 + 1e-9) {
            best = (run[0].0, share);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::progress::CancelToken;
    use crate::shapes;

    /// Which of the six directions a face looks at.
    fn sides(mesh: &TriangleMesh) -> Vec<i32> {
        let side = |face| {
            let [a, b, c] = mesh.triangle(face);
            let normal = (b - a).cross(c - a);
            let axis = normal.abs().max_position();
            2 * axis as i32 + i32::from(normal[axis] < 0.0)
        };
        mesh.face_ids().map(side).collect()
    }

    fn carried(source: &TriangleMesh, materials_of: &[i32], output: &PolygonMesh) -> Vec<i32> {
        materials(
            &Bvh::of_mesh(source),
            materials_of,
            output,
            &Progress::none(),
        )
        .unwrap()
    }

    #[test]
    fn a_mesh_gets_its_own_materials_back() {
        for (name, mesh) in shapes::closed(5) {
            let own = sides(&mesh);
            assert_eq!(
                carried(&mesh, &own, &shapes::polygons(&mesh)),
                own,
                "{name}"
            );
        }
    }

    #[test]
    fn the_sides_of_a_finer_cube_are_told_apart() {
        let [coarse, fine] = [3, 8].map(|n| shapes::mapped_cube(n, |p| p));
        let found = carried(&coarse, &sides(&coarse), &shapes::polygons(&fine));
        assert_eq!(found, sides(&fine));
    }

    #[test]
    fn a_thin_wall_keeps_the_material_of_each_side() {
        let thin = |n| shapes::mapped_cube(n, |p| p * DVec3::new(1.0, 1.0, 1e-3));
        let [source, output] = [thin(4), thin(7)];
        let sunk = output.with_positions(
            output
                .positions()
                .iter()
                .map(|&p| p * DVec3::new(1.0, 1.0, -0.5))
                .collect(),
        );
        let flipped: Vec<_> = sunk
            .faces()
            .iter()
            .map(|f| [f[0].0, f[2].0, f[1].0])
            .collect();
        let sunk = PolygonMesh::from_faces(sunk.positions().to_vec(), &flipped).unwrap();
        let found = carried(&source, &sides(&source), &sunk);
        // Turned over, the upper side of the output is the one that was below.
        let wanted = sides(&output)
            .into_iter()
            .map(|side| if side > 3 { 9 - side } else { side });
        for (face, (found, wanted)) in found.into_iter().zip(wanted).enumerate() {
            assert!(
                found == wanted || wanted <= 3,
                "face {face}: {found} for {wanted}"
            );
        }
    }

    #[test]
    fn the_larger_share_wins_and_the_smallest_of_equal_ones() {
        assert_eq!(most(vec![(3, 0.2), (1, 0.3), (3, 0.2)]), 3);
        assert_eq!(most(vec![(3, 0.1), (1, 0.2), (3, 0.1)]), 1);
        assert_eq!(most(vec![(2, 0.0), (-1, 0.0)]), -1);
    }

    #[test]
    fn faces_without_area_have_a_material_too() {
        let mesh = shapes::sphere(3);
        let point = PolygonMesh::from_faces(vec![DVec3::X; 3], &[[0, 1, 2]]).unwrap();
        let found = carried(&mesh, &vec![7; mesh.n_faces()], &point);
        assert_eq!(found, [7]);
    }

    #[test]
    fn a_raised_flag_stops_it() {
        let mesh = shapes::sphere(3);
        let token = CancelToken::new();
        token.cancel();
        let progress = Progress::silent(token);
        let all = vec![0; mesh.n_faces()];
        let found = materials(
            &Bvh::of_mesh(&mesh),
            &all,
            &shapes::polygons(&mesh),
            &progress,
        );
        assert_eq!(found, Err(Cancelled));
    }
}
