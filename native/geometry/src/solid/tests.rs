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
    assert!(farthest(&made.mesh, &all) < 0.02);
    // Places of the outer surface are inside no ball.
    for shell in &shells {
        let middle = shell.positions().iter().sum::<DVec3>() / shell.n_vertices() as f64;
        let mut gaps = made.mesh.positions().iter().map(|p| p.distance(middle));
        assert!(gaps.all(|gap| gap > 0.66));
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

/// A ball less the faces whose middles a condition names.
fn opened(n: u32, is_gone: impl Fn(DVec3) -> bool) -> TriangleMesh {
    let ball = shapes::sphere(n);
    let middle = |f| ball.triangle(f).iter().sum::<DVec3>() / 3.0;
    let left = ball.face_ids().filter(|&f| !is_gone(middle(f)));
    let left = left.map(|f| ball.face(f));
    TriangleMesh::of_faces(ball.positions(), left).unwrap().0
}

#[test]
fn a_wall_with_a_hole_bounds_a_body_whichever_way_it_faces() {
    let open = opened(12, |p| p.z > 0.8);
    let faces = open.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = TriangleMesh::new(open.positions().to_vec(), faces).unwrap();
    for (shell, n_turned) in [(open, 0), (turned, 1)] {
        let made = solid(&shell, 0.05);
        check(&made);
        let report = made.report;
        let told = (
            report.n_walls,
            report.n_turned,
            report.n_sheets,
            report.n_pieces,
        );
        assert_eq!(told, (1, n_turned, 0, 1));
        assert_eq!(made.mesh.euler_number(), 2);
        // All but the cap, which is cut off somewhere about its rim.
        assert!((0.85..1.0).contains(&(volume(&made.mesh) / 4.18)));
    }
}

#[test]
fn a_sheet_is_made_thick_and_a_scrap_goes() {
    let sheet = opened(12, |p| p.z < 0.8);
    let scrap = moved(&sheet, 0.02, DVec3::X * 2.0);
    let ball = moved(&shapes::sphere(6), 0.5, DVec3::NEG_Z);
    let made = solid(&together(&[sheet.clone(), scrap, ball]), 0.05);
    check(&made);
    let report = made.report;
    let told = (
        report.n_closed,
        report.n_sheets,
        report.n_scraps,
        report.n_pieces,
    );
    assert_eq!(told, (1, 1, 1, 2));
    // Nine tenths of a cell to either side, and farther off at the corners of the rim.
    let above = made.mesh.positions().iter().filter(|p| p.z > 0.2);
    let tree = Bvh::of_mesh(&sheet);
    for &p in above {
        let gap = tree.closest(p).distance_squared.sqrt() / 0.05;
        assert!((0.6..1.7).contains(&gap), "{gap}");
    }
}

#[test]
fn a_plate_thinner_than_a_cell_stays_whole() {
    let plate = shapes::mapped_cube(4, |p| p * DVec3::new(0.5, 0.4, 0.004));
    let turn = glam::DMat3::from_rotation_x(0.4) * glam::DMat3::from_rotation_y(0.3);
    let plate = plate.with_positions(plate.positions().iter().map(|&p| turn * p).collect());
    let made = solid(&plate, 0.02);
    check(&made);
    assert_eq!((made.report.n_pieces, made.mesh.euler_number()), (1, 2));
    assert!(farthest(&made.mesh, &plate) < 0.04);
}

#[test]
fn triangles_without_area_change_nothing() {
    let cuboid = shapes::cuboid(2);
    let point = DVec3::splat(0.2);
    let line = [0.0, 0.2, 0.1].map(|x| point + DVec3::X * x);
    let loose = [[point; 3], line];
    let with = |loose: &[[DVec3; 3]]| {
        let shells = Shells {
            surfaces: &cuboid,
            loose,
            lines: &[],
        };
        let settings = Settings { cell: 0.05 };
        solidify(&shells, &settings, &Progress::none())
            .unwrap()
            .mesh
    };
    assert!(with(&loose) == with(&[]));
}

#[test]
fn vertices_lie_on_lines_that_are_given() {
    let cuboid = shapes::cuboid(1);
    let line = [DVec3::new(-0.4, 0.17, 0.3), DVec3::new(0.4, 0.03, 0.3)];
    let shells = Shells {
        surfaces: &cuboid,
        loose: &[],
        lines: &[line],
    };
    let made = solidify(&shells, &Settings { cell: 0.03 }, &Progress::none()).unwrap();
    check(&made);
    let on: Vec<DVec3> = made
        .mesh
        .vertex_ids()
        .filter(|&v| made.is_on_line[v])
        .map(|v| made.mesh.position(v))
        .collect();
    assert!(on.len() >= 26, "{}", on.len());
    let way = (line[1] - line[0]).normalize_or_zero();
    for p in on {
        assert!((p - line[0]).cross(way).length() < 1e-3);
    }
}
