use glam::DVec3;

use super::*;
use crate::elementary::sin_cos;
use crate::measure::volume;
use crate::mesh::VertexId;
use crate::nearest::{Bvh, crossing_pairs};
use crate::random::Random;
use crate::shapes;

/// Shells put side by side, one component each.
fn together(shells: &[TriangleMesh]) -> TriangleMesh {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for shell in shells {
        let first = positions.len() as u32;
        positions.extend_from_slice(shell.positions());
        faces.extend(
            shell
                .faces()
                .iter()
                .map(|f| f.map(|v| VertexId(v.0 + first))),
        );
    }
    TriangleMesh::new(positions, faces).unwrap()
}

fn moved(mesh: &TriangleMesh, scale: f64, by: DVec3) -> TriangleMesh {
    mesh.with_positions(mesh.positions().iter().map(|&p| p * scale + by).collect())
}

fn solid(shells: &TriangleMesh, cell: f64) -> Solid {
    let shells = Shells {
        surfaces: shells,
        loose: &[],
        lines: &[],
    };
    solidify(&shells, &Settings { cell }, &Progress::none()).unwrap()
}

/// Closed, one piece where that is said, and nothing crosses.
fn check(solid: &Solid) {
    let mesh = &solid.mesh;
    mesh.check().unwrap();
    assert!(mesh.is_closed());
    let tree = Bvh::of_mesh(mesh);
    let at = |v| mesh.position(v);
    let pairs = crossing_pairs(&tree, mesh.faces(), at, &Progress::none()).unwrap();
    assert_eq!(pairs.len(), 0);
    assert!(volume(mesh) > 0.0);
}

/// How far the farthest vertex or middle of a face is from other triangles.
fn farthest(mesh: &TriangleMesh, from: &TriangleMesh) -> f64 {
    let tree = Bvh::of_mesh(from);
    let middles = mesh
        .face_ids()
        .map(|f| mesh.triangle(f).iter().sum::<DVec3>() / 3.0);
    let places = mesh.positions().iter().copied().chain(middles);
    let gaps = places.map(|p| tree.closest(p).distance_squared.sqrt());
    gaps.fold(0.0, f64::max)
}

#[test]
fn a_box_keeps_its_corners_and_its_volume() {
    let cuboid = shapes::cuboid(1);
    let made = solid(&cuboid, 0.0413);
    check(&made);
    assert!((volume(&made.mesh) / volume(&cuboid) - 1.0).abs() < 1e-3);
    assert!(farthest(&cuboid, &made.mesh) < 1e-3);
    assert!(farthest(&made.mesh, &cuboid) < 1e-3);
    assert_eq!(made.mesh.euler_number(), 2);
}

#[test]
fn balls_that_intersect_become_one_surface() {
    let ball = shapes::sphere(8);
    let mut random = Random::new(3);
    let shells: Vec<_> = (0..15)
        .map(|i| {
            let mut unit = || 2.0 * random.unit() - 1.0;
            let by = DVec3::new(unit(), unit(), unit());
            let mut shell = moved(&ball, 0.7, by);
            if i % 3 == 0 {
                // Which way a closed shell faces does not matter.
                let faces = shell.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
                shell = TriangleMesh::new(shell.positions().to_vec(), faces).unwrap();
            }
            shell
        })
        .collect();
    let all = together(&shells);
    let made = solid(&all, 0.03);
    check(&made);
    assert_eq!((made.report.n_shells, made.report.n_pieces), (15, 1));
    // Places of the outer surface lie on some shell and inside none.
    let far = farthest(&made.mesh, &all);
    assert!(far < 0.01, "{far}");
    for &p in made.mesh.positions() {
        for i in 0..15 {
            let middle =
                shells[i].positions().iter().sum::<DVec3>() / shells[i].n_vertices() as f64;
            assert!(p.distance(middle) > 0.66);
        }
    }
}

#[test]
fn of_two_walls_the_outer_one_is_left_and_cavities_go() {
    let ball = shapes::sphere(10);
    let walls = together(&[
        ball.clone(),
        moved(&ball, 0.97, DVec3::ZERO),
        moved(&ball, 0.3, DVec3::X * 0.3),
    ]);
    let made = solid(&walls, 0.06);
    check(&made);
    assert_eq!((made.report.n_pieces, made.mesh.euler_number()), (1, 2));
    assert!((volume(&made.mesh) / volume(&ball) - 1.0).abs() < 5e-3);
    assert!(farthest(&made.mesh, &ball) < 0.01);
}

#[test]
fn specks_go_and_other_pieces_stay() {
    let ball = shapes::sphere(6);
    let mut shells = vec![ball.clone(), moved(&ball, 0.2, DVec3::X * 2.0)];
    let (s, c) = sin_cos(1.0);
    shells.push(moved(&ball, 0.02, DVec3::new(c, s, 0.0) * 1.2));
    let made = solid(&together(&shells), 0.02);
    check(&made);
    assert_eq!((made.report.n_pieces, made.report.n_dropped), (2, 1));
    assert_eq!(made.mesh.euler_number(), 4);
}

#[test]
fn two_boxes_that_overlap_meet_in_sharp_edges() {
    let cuboid = shapes::cuboid(1);
    let other = moved(&cuboid, 1.0, DVec3::new(0.313, 0.227, 0.181));
    let made = solid(&together(&[cuboid.clone(), other.clone()]), 0.0317);
    check(&made);
    let common = (1.0 - 0.313) * (0.8 - 0.227) * (0.6 - 0.181);
    let wanted = 2.0 * volume(&cuboid) - common;
    assert!((volume(&made.mesh) / wanted - 1.0).abs() < 1e-3);
    assert!(farthest(&made.mesh, &together(&[cuboid, other])) < 3e-3);
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads() {
    let shells = together(&[
        shapes::blob(4, 12),
        moved(&shapes::limbs(2, 12), 0.3, DVec3::X),
    ]);
    let with = |n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        pool.install(|| solid(&shells, 0.05))
    };
    let [one, four] = [with(1), with(4)];
    check(&one);
    assert_eq!(one, four);
}

#[test]
fn cells_that_are_too_small_are_refused_with_numbers() {
    let ball = shapes::sphere(4);
    let shells = Shells {
        surfaces: &ball,
        loose: &[],
        lines: &[],
    };
    let error = solidify(&shells, &Settings { cell: 1e-4 }, &Progress::none()).unwrap_err();
    let Error::TooFine { n_hits, fit } = error else {
        panic!("{error}");
    };
    assert!(n_hits > 1e9 && (7.0..12.0).contains(&fit), "{n_hits} {fit}");
}
