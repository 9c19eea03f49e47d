use glam::DVec3;

use super::*;
use crate::mesh::TriangleMesh;
use crate::progress::CancelToken;
use crate::shapes;
use crate::sphere::{icosphere, quad_sphere};

/// A map by radial projection, for shapes that are star-shaped from the origin.
fn radial_map(mesh: &TriangleMesh) -> SphereMap {
    let sphere = mesh
        .positions()
        .iter()
        .map(|p| p.normalize_or(DVec3::Z))
        .collect();
    SphereMap::prove(mesh.clone(), sphere).unwrap()
}

fn target(mesh: TriangleMesh) -> Target {
    Target::new(mesh, &Progress::none()).unwrap()
}

fn run(map: &SphereMap, primitive: &PolygonMesh, target: &Target) -> Deformed {
    deform(
        map,
        primitive,
        target,
        &Settings::default(),
        &Progress::none(),
    )
    .unwrap()
}

#[test]
fn an_icosphere_on_a_sphere_stays_on_it() {
    let ball = shapes::sphere(24);
    let (map, target) = (radial_map(&ball), target(ball));
    let result = run(&map, &icosphere(6), &target);
    for &p in result.mesh.positions() {
        assert!((p.length() - 1.0).abs() < 0.02, "{}", p.length());
    }
    assert_eq!(result.report.n_unprojected, 0);
}

#[test]
fn every_result_is_a_closed_cover_with_the_counts_of_the_primitive() {
    for (name, mesh) in shapes::closed(10) {
        if name == "limbs" {
            continue;
        }
        let (map, target) = (radial_map(&mesh), target(mesh));
        for primitive in [icosphere(6), quad_sphere([6, 7, 8])] {
            let result = run(&map, &primitive, &target);
            assert_eq!(check_cover(&result.mesh, &result.sphere), Ok(()), "{name}");
            assert_eq!(result.mesh.n_faces(), primitive.n_faces());
            assert_eq!(result.mesh.n_vertices(), primitive.n_vertices());
        }
    }
}

#[test]
fn a_scaled_input_gives_the_scaled_result() {
    let mesh = shapes::blob(3, 10);
    let primitive = icosphere(6);
    let at_scale = |scale: f64| {
        let positions = mesh.positions().iter().map(|&p| p * scale).collect();
        let mesh = mesh.with_positions(positions);
        let map = radial_map(&mesh);
        run(&map, &primitive, &target(mesh))
    };
    // Powers of two scale without rounding.
    for scale in [2.0f64.powi(-30), 2.0f64.powi(30)] {
        let [one, other] = [at_scale(1.0), at_scale(scale)];
        assert_eq!(one.report, other.report);
        for (a, b) in one.mesh.positions().iter().zip(other.mesh.positions()) {
            assert!((*a * scale).distance(*b) < 1e-9 * scale);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let mesh = shapes::blob(5, 12);
    let (map, target) = (radial_map(&mesh), target(mesh));
    let with_threads = |n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        pool.install(|| run(&map, &quad_sphere([6, 6, 6]), &target))
    };
    assert_eq!(with_threads(1), with_threads(2));
}

#[test]
fn what_is_no_sphere_is_refused() {
    let mesh = shapes::sphere(6);
    let (map, target) = (radial_map(&mesh), target(mesh));
    let deform = |primitive: &PolygonMesh, progress: &Progress| {
        deform(&map, primitive, &target, &Settings::default(), progress)
    };
    let ball = icosphere(3);
    let inside_out = ball.with_positions(ball.positions().iter().map(|&p| -p).collect());
    let error = deform(&inside_out, &Progress::none()).unwrap_err();
    assert!(
        matches!(error, Error::Primitive(NotACover::Folded { .. })),
        "{error}"
    );
    let five = PolygonMesh::from_faces(vec![DVec3::X; 5], &[[0, 1, 2, 3, 4]]).unwrap();
    let error = deform(&five, &Progress::none()).unwrap_err();
    assert!(
        matches!(error, Error::TooManyCorners { n_corners: 5, .. }),
        "{error}"
    );
    let token = CancelToken::new();
    token.cancel();
    let error = deform(&ball, &Progress::silent(token)).unwrap_err();
    assert_eq!(error, Error::Cancelled(Cancelled));
}

#[test]
fn a_box_keeps_its_corners_and_edges() {
    let mesh = shapes::cuboid(16);
    let corners: Vec<_> = (0..8u32)
        .map(|i| {
            let sign = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
            DVec3::new(0.5 * sign(0), 0.4 * sign(1), 0.3 * sign(2))
        })
        .collect();
    let (map, target) = (radial_map(&mesh), target(mesh));
    for primitive in [icosphere(9), quad_sphere([9, 9, 9])] {
        let result = run(&map, &primitive, &target);
        let points = result.mesh.positions();
        for corner in &corners {
            assert!(
                points.iter().any(|p| p.distance(*corner) < 1e-9),
                "{corner}"
            );
        }
        let Report {
            n_feature_goals,
            n_feature_vertices,
            ..
        } = result.report;
        assert!(
            10 * n_feature_vertices >= 9 * n_feature_goals,
            "{:?}",
            result.report
        );
    }
}
