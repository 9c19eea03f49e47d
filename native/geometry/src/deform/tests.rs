use glam::DVec3;

use super::*;
use crate::elementary::sin;
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

/// Crosses about along the lines of a quad sphere.
fn crosses(mesh: &TriangleMesh) -> FaceMap<DVec3> {
    let cross = |face| {
        let n = crate::measure::face_normal(mesh, face);
        let axis = DVec3::AXES[(n.abs().max_position() + 1) % 3];
        (axis - n * axis.dot(n)).normalize_or_zero()
    };
    mesh.face_ids().map(cross).collect()
}

/// Quads without sharp lines.
fn flowing<'a>(
    quads: &'a PolygonMesh,
    wanted: &'a [DVec3],
    (crosses, sizes): (&'a FaceMap<DVec3>, &'a FaceMap<f64>),
) -> Flowing<'a> {
    Flowing {
        quads,
        wanted,
        crosses,
        sizes,
        seams: &[],
    }
}

/// A quad sphere whose vertices are led away from their places by `noise`, then relaxed.
fn flowed(mesh: &TriangleMesh, noise: f64, settings: &Settings) -> Deformed {
    let map = radial_map(mesh);
    let quads = quad_sphere([7, 7, 7]);
    let crosses = crosses(mesh);
    let sizes = FaceMap::filled(crosses.len(), 1.0);
    let wanted: Vec<_> = quads
        .positions()
        .iter()
        .map(|&p| map.surface_position(map.locate(p)) + noise * (p * 97.0).map(sin))
        .collect();
    let flowing = flowing(&quads, &wanted, (&crosses, &sizes));
    let target = target(mesh.clone());
    deform_flow(&map, flowing, &target, settings, &Progress::none()).unwrap()
}

#[test]
fn flowing_quads_turn_along_the_crosses() {
    let mesh = shapes::sphere(16);
    let map = radial_map(&mesh);
    let crosses = crosses(&mesh);
    // The mean |sin 2θ| between edges and arms.
    let misalignment = |result: &Deformed| {
        let corners = result
            .mesh
            .faces()
            .flat_map(|face| [0, 1, 2, 3].map(|i| [face[i], face[(i + 1) % 4]]));
        let sines: Vec<f64> = corners
            .map(|[a, b]| {
                let edge = (result.mesh.position(b) - result.mesh.position(a)).normalize_or_zero();
                let arm = crosses[map.locate(result.sphere[a.0 as usize]).face];
                2.0 * (edge.dot(arm) * edge.cross(arm).length()).abs()
            })
            .collect();
        sines.iter().sum::<f64>() / sines.len() as f64
    };
    // The fit makes squares of the quads, which hides how they lay.
    let [before, after] = [0, 60].map(|n_flow_relaxations| {
        let settings = Settings {
            n_flow_relaxations,
            n_flow_straddles: 0,
            ..Settings::default()
        };
        misalignment(&flowed(&mesh, 0.1, &settings))
    });
    assert!(after < 0.5 * before, "{after} {before}");
}

#[test]
fn momentum_lasts_from_one_call_to_the_next() {
    let mesh = shapes::sphere(12);
    let (map, crosses) = (radial_map(&mesh), crosses(&mesh));
    let sizes = FaceMap::filled(crosses.len(), 1.0);
    let quads = quad_sphere([5, 6, 7]);
    let flowing = flowing(&quads, quads.positions(), (&crosses, &sizes));
    let after = |calls: &[usize]| {
        let mut sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quads);
        let mut follower = Follower::new(&map, &sheet, flowing, 0.0);
        for &n in calls {
            follower.follow(&mut sheet, n, &Progress::none()).unwrap();
        }
        sheet.into_mesh().0
    };
    assert_eq!(after(&[8]), after(&[4, 1, 3]));
}

#[test]
fn evenness_makes_edges_of_one_length() {
    // Of a blob, whose lumps make them differ.
    let spread = |mesh: &TriangleMesh, evenness| {
        let settings = Settings {
            evenness,
            ..Settings::default()
        };
        let result = flowed(mesh, 0.1, &settings);
        assert_eq!(result.report.n_inverted, 0);
        let corners = result
            .mesh
            .faces()
            .flat_map(|f| [0, 1, 2, 3].map(|i| [f[i], f[(i + 1) % 4]]));
        let position = |v| result.mesh.position(v);
        let lengths: Vec<f64> = corners
            .map(|[a, b]| position(a).distance(position(b)))
            .collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let squares = lengths.iter().map(|l| (l / mean - 1.0).powi(2));
        (squares.sum::<f64>() / lengths.len() as f64).sqrt()
    };
    for seed in 0..3 {
        let mesh = shapes::blob(seed, 10);
        let [usual, even] = [0.0, 1.0].map(|evenness| spread(&mesh, evenness));
        assert!(even < 0.9 * usual, "{seed}: {even} {usual}");
    }
}

#[test]
fn flowing_quads_stay_a_cover_without_inverted_quads() {
    for seed in 0..4 {
        let mesh = shapes::blob(seed, 10);
        let result = flowed(&mesh, 0.1, &Settings::default());
        assert_eq!(check_cover(&result.mesh, &result.sphere), Ok(()));
        for face in result.mesh.faces() {
            let p = [0, 1, 2, 3].map(|i| result.mesh.position(face[i]));
            let normal = (p[2] - p[0]).cross(p[3] - p[1]);
            for i in 0..4 {
                let [a, b, c] = [p[(i + 3) % 4], p[i], p[(i + 1) % 4]];
                assert!((c - b).cross(a - b).dot(normal) > 0.0, "{seed}");
            }
        }
    }
}

#[test]
fn what_flows_needs_a_cross_for_every_face() {
    let mesh = shapes::sphere(6);
    let map = radial_map(&mesh);
    let quads = quad_sphere([3, 3, 3]);
    let crosses = FaceMap::filled(5, DVec3::X);
    let sizes = FaceMap::filled(5, 1.0);
    let flowing = flowing(&quads, quads.positions(), (&crosses, &sizes));
    let target = target(mesh);
    let result = deform_flow(
        &map,
        flowing,
        &target,
        &Settings::default(),
        &Progress::none(),
    );
    let error = result.unwrap_err();
    assert!(
        matches!(
            error,
            Error::Counts {
                counts: [_, 5, 5],
                ..
            }
        ),
        "{error}"
    );
}
