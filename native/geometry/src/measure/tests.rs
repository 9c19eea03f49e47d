use std::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::mesh::{PolygonMesh, VertexId};
use crate::progress::Progress;
use crate::shapes;

#[test]
fn a_sphere_has_the_area_volume_and_normals_of_a_sphere() {
    let mesh = shapes::sphere(40);
    assert!((total_area(&mesh) / (4.0 * PI) - 1.0).abs() < 1e-3);
    assert!((face_areas(&mesh).iter().sum::<f64>() - total_area(&mesh)).abs() < 1e-12);
    assert!((volume(&mesh) / (4.0 / 3.0 * PI) - 1.0).abs() < 2e-3);
    for (normal, position) in vertex_normals(&mesh).iter().zip(mesh.positions()) {
        assert!(normal.distance(*position) < 0.01);
    }
}

#[test]
fn a_cube_has_flat_and_right_angles() {
    let mesh = shapes::mapped_cube(3, |p| p);
    assert!((total_area(&mesh) - 24.0).abs() < 1e-12);
    assert!((volume(&mesh) - 8.0).abs() < 1e-12);
    let angles: Vec<f64> = mesh
        .halfedge_ids()
        .map(|h| dihedral_angle(&mesh, h))
        .collect();
    let right = angles
        .iter()
        .filter(|&&a| (a - FRAC_PI_2).abs() < 1e-12)
        .count();
    assert_eq!(right, 12 * 3 * 2);
    assert_eq!(
        angles.iter().filter(|&&a| a.abs() < 1e-12).count(),
        angles.len() - right
    );
    let corner = mesh
        .vertex_ids()
        .find(|&v| mesh.position(v) == DVec3::ONE)
        .unwrap();
    assert!(vertex_normals(&mesh)[corner].distance(DVec3::splat((1.0f64 / 3.0).sqrt())) < 1e-12);
}

#[test]
fn volume_does_not_move_with_the_mesh_and_turns_with_its_faces() {
    let mesh = shapes::blob(3, 6);
    let far = mesh.with_positions(mesh.positions().iter().map(|&p| p + 1e6).collect());
    assert!((volume(&mesh) / volume(&far) - 1.0).abs() < 1e-8);
    let mirrored = mesh.with_positions(mesh.positions().iter().map(|&p| -p).collect());
    assert!((volume(&mesh) + volume(&mirrored)).abs() < 1e-12);
}

#[test]
fn a_face_without_area_has_no_normal_and_poisons_nothing() {
    let positions = [0.0, 1.0, 2.0].map(|x| DVec3::X * x).to_vec();
    let mesh = TriangleMesh::new(positions, vec![[0, 1, 2].map(VertexId)]).unwrap();
    assert_eq!(face_normals(&mesh).as_slice(), [DVec3::ZERO]);
    assert_eq!(vertex_normals(&mesh).as_slice(), [DVec3::ZERO; 3]);
    assert!((mean_edge_length(&mesh) - 4.0 / 3.0).abs() < 1e-15);
}

#[test]
fn closed_shapes_have_genus_zero_in_one_piece() {
    for (name, mesh) in shapes::closed(4) {
        let found = topology(&shapes::polygons(&mesh), &Progress::none()).unwrap();
        assert!(found.closed && found.manifold, "{name}");
        let counts = (
            found.n_components,
            found.genus,
            found.n_borders,
            found.n_vertices,
        );
        assert_eq!(counts, (1, Some(0), 0, mesh.n_vertices()), "{name}");
    }
}

fn flat(faces: &[Vec<u32>]) -> Topology {
    let positions = (0..12).map(|i| DVec3::splat(f64::from(i))).collect();
    topology(
        &PolygonMesh::from_faces(positions, faces).unwrap(),
        &Progress::none(),
    )
    .unwrap()
}

#[test]
fn a_tube_has_two_borders_and_unused_vertices_do_not_count() {
    let tube = flat(&[vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![2, 0, 3, 5]]);
    let wanted = Topology {
        n_vertices: 6,
        n_faces: 3,
        n_quads: 3,
        n_components: 1,
        genus: Some(0),
        closed: false,
        manifold: true,
        n_borders: 2,
    };
    assert_eq!(tube, wanted);
}

#[test]
fn a_torus_has_one_handle() {
    let at = |i: u32, j: u32| i % 3 * 3 + j % 3;
    let quad = |i, j| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    let faces: Vec<_> = (0..9).map(|k| quad(k / 3, k % 3)).collect();
    let torus = flat(&faces);
    assert_eq!(
        (torus.genus, torus.closed, torus.n_vertices),
        (Some(1), true, 9)
    );
}

#[test]
fn a_fin_two_fans_and_a_wrong_turn_are_not_manifold() {
    assert!(!flat(&[vec![0, 1, 2], vec![1, 0, 3], vec![0, 1, 4]]).manifold);
    let bow = flat(&[vec![0, 1, 2], vec![0, 3, 4]]);
    assert_eq!(
        (bow.manifold, bow.genus, bow.n_components, bow.n_borders),
        (false, None, 1, 1)
    );
    assert!(!flat(&[vec![0, 1, 2], vec![0, 1, 3]]).manifold);
}
