use super::*;
use crate::mesh::{FaceId, VertexId};
use crate::shapes;
use glam::DVec3;

fn sizes_of(mesh: &TriangleMesh, n_quads: usize, settings: &Settings) -> FaceMap<f64> {
    sizes(mesh, n_quads, settings, &Progress::none()).unwrap()
}

/// How many quads of these sizes cover the mesh.
fn count(mesh: &TriangleMesh, sizes: &FaceMap<f64>) -> f64 {
    let quads = |face| area_vector(mesh.triangle(face)).length() / sizes[face].powi(2);
    mesh.face_ids().map(quads).sum()
}

/// A blob drawn out into a limb along x.
fn limb(thickness: f64) -> TriangleMesh {
    let mesh = shapes::sphere(40);
    let thin = |p: &DVec3| DVec3::new(p.x * 4.0, p.y * thickness, p.z * thickness);
    mesh.with_positions(mesh.positions().iter().map(thin).collect())
}

#[test]
fn a_sphere_of_many_quads_gets_even_ones() {
    let mesh = shapes::sphere(16);
    let even = (total_area(&mesh) / 200.0).sqrt();
    for adaptivity in [0.0, 1.0] {
        let settings = Settings {
            adaptivity,
            weights: None,
        };
        for size in &sizes_of(&mesh, 200, &settings) {
            assert!(
                (size / even - 1.0).abs() < 0.1,
                "{adaptivity} {size} {even}"
            );
        }
    }
}

#[test]
fn the_count_is_kept() {
    for (name, mesh) in shapes::closed(16) {
        for adaptivity in [0.0, 1.0] {
            let weights = mesh.positions().iter().map(|p| 1.0 + p.x.abs()).collect();
            let settings = Settings {
                adaptivity,
                weights: Some(weights),
            };
            let n_quads = count(&mesh, &sizes_of(&mesh, 400, &settings));
            assert!((n_quads / 400.0 - 1.0).abs() < 0.05, "{name} {n_quads}");
        }
    }
}

#[test]
fn a_thin_limb_keeps_quads_around() {
    let mesh = limb(0.1);
    let sizes = sizes_of(&mesh, 100, &Settings::default());
    let at = |x: f64| {
        let distance = |f: &FaceId| (mesh.triangle(*f)[0].x - x).abs();
        let nearest = |a: &FaceId, b: &FaceId| distance(a).total_cmp(&distance(b));
        sizes[mesh.face_ids().min_by(nearest).unwrap()]
    };
    assert!(at(3.5) < 0.8 * at(0.0), "{} {}", at(3.5), at(0.0));
}

#[test]
fn a_limb_gets_four_quads_around_once_sizes_follow_the_shape() {
    // 0.2 π round, quads of 0.3.
    let mesh = limb(0.1);
    let n_quads = (total_area(&mesh) / 0.3f64.powi(2)) as usize;
    for (adaptivity, around) in [(0.0, 3.0), (1.0, 4.0)] {
        let settings = Settings {
            adaptivity,
            weights: None,
        };
        let shares = limb_shares(&mesh, n_quads, &settings, &Progress::none()).unwrap();
        let middle = |v: &VertexId| mesh.position(*v).x.abs() < 0.5;
        for v in mesh.vertex_ids().filter(middle) {
            let found = std::f64::consts::TAU * 0.1 / (shares[v] * 0.3);
            assert!((found / around - 1.0).abs() < 0.2, "{found} {around}");
        }
    }
}

#[test]
fn what_is_no_limb_keeps_even_edges() {
    let ball = shapes::sphere(16);
    let shares = limb_shares(&ball, 200, &Settings::default(), &Progress::none()).unwrap();
    assert!(shares.iter().all(|&share| share >= 1.0));
}

#[test]
fn what_is_no_limb_has_no_girth_whatever_the_limit() {
    // Means of like numbers round, here and there, to less than the number.
    let ball = shapes::sphere(8);
    for i in 1..60 {
        let girths = girths(&ball, 0.01 * f64::from(i), &Progress::none()).unwrap();
        assert!(girths.iter().all(|girth| girth.is_infinite()), "{i}");
    }
}

#[test]
fn the_girth_of_a_limb_is_the_way_around_it() {
    let mesh = limb(0.1);
    let girths = girths(&mesh, 10.0, &Progress::none()).unwrap();
    let circle = std::f64::consts::TAU * 0.1;
    for v in mesh
        .vertex_ids()
        .filter(|&v| mesh.position(v).x.abs() < 0.8)
    {
        let girth = girths[v] / circle;
        assert!((0.9..1.2).contains(&girth), "{girth}");
    }
}

#[test]
fn weights_ask_for_more_quads() {
    let mesh = shapes::sphere(16);
    let half = |v| if mesh.position(v).x > 0.0 { 4.0 } else { 1.0 };
    let settings = Settings {
        adaptivity: 0.0,
        weights: Some(mesh.vertex_ids().map(half).collect()),
    };
    let sizes = sizes_of(&mesh, 400, &settings);
    let at = |side: f64| {
        let is_far = |f: &FaceId| mesh.triangle(*f)[0].x * side > 0.8;
        sizes[mesh.face_ids().find(is_far).unwrap()]
    };
    assert!(at(1.0) < 0.6 * at(-1.0), "{} {}", at(1.0), at(-1.0));
}

#[test]
fn weights_that_do_not_fit_are_refused() {
    let mesh = shapes::sphere(4);
    let n = mesh.n_vertices();
    for weights in [vec![1.0; n - 1], vec![0.0; n], vec![f64::NAN; n]] {
        let settings = Settings {
            adaptivity: 0.0,
            weights: Some(VertexMap::from_vec(weights)),
        };
        let result = sizes(&mesh, 50, &settings, &Progress::none());
        assert!(matches!(result, Err(SizesError::Weights { .. })));
    }
}
