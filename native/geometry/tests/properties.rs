//! What must hold for every mesh that goes through the whole pipeline.

mod common;

use std::sync::Mutex;

use glam::DVec3;
use orbflow_geometry::clean;
use orbflow_geometry::elementary::powf;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::{self, Topology};
use orbflow_geometry::mesh::{FaceId, PolygonMesh, TriangleMesh};
use orbflow_geometry::pipeline::{self, Input, Kind, Primitive, Remeshed, Settings};
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_geometry::random::Random;
use orbflow_geometry::sphere_map::check_cover;
use proptest::prelude::*;

fn remesh(mesh: &PolygonMesh, settings: &Settings) -> Remeshed {
    pipeline::remesh(
        Input::new(mesh),
        settings,
        &Solver::default(),
        &Progress::none(),
    )
    .expect("a closed mesh of genus 0 can always be done")
}

fn quick(faces: usize, kind: Kind) -> Settings {
    Settings {
        faces,
        kind,
        score: None,
        ..Settings::default()
    }
}

/// A closed mesh whose shape, size, place and roughness are drawn.
fn any_ball() -> impl Strategy<Value = TriangleMesh> {
    let shape = (0_u8..5, any::<u64>(), 4_u32..9);
    let frame = (
        -6.0_f64..6.0,
        prop::array::uniform3(-1e3_f64..1e3),
        0.0_f64..0.2,
    );
    (shape, frame).prop_map(|((which, seed, n), (scale, shift, noise))| {
        let mesh = match which {
            0 => common::sphere(n),
            1 => common::cuboid(n),
            2 => common::capsule(8.0, n),
            3 => common::blob(seed, n),
            _ => common::limbs(seed, n),
        };
        moved(
            &roughened(&mesh, seed, noise),
            powf(10_f64, scale),
            DVec3::from_array(shift),
        )
    })
}

/// Vertices pushed about by a share of the mean edge: faces may cross, which must not matter.
fn roughened(mesh: &TriangleMesh, seed: u64, noise: f64) -> TriangleMesh {
    let mut random = Random::new(seed);
    let reach = noise * measure::mean_edge_length(mesh);
    let mut push = |p: DVec3| {
        p + reach * (2.0 * DVec3::new(random.unit(), random.unit(), random.unit()) - 1.0)
    };
    let points = mesh.positions().iter().map(|&p| push(p)).collect();
    TriangleMesh::new(points, mesh.faces().to_vec()).expect("the same faces")
}

fn moved(mesh: &TriangleMesh, scale: f64, shift: DVec3) -> TriangleMesh {
    let points = mesh
        .positions()
        .iter()
        .map(|&p| (p + shift) * scale)
        .collect();
    TriangleMesh::new(points, mesh.faces().to_vec()).expect("the same faces")
}

fn any_settings() -> impl Strategy<Value = Settings> {
    let primitive = prop_oneof![
        Just(Primitive::Adaptive),
        Just(Primitive::Flow),
        Just(Primitive::QuadSphere),
        Just(Primitive::Icosphere)
    ];
    (60_usize..500, primitive, any::<u64>()).prop_map(|(faces, primitive, seed)| Settings {
        primitive: Some(primitive),
        seed,
        ..quick(faces, primitive.kind())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_remeshed_ball_is_a_ball_that_covers_the_sphere_once(
        mesh in any_ball(), settings in any_settings()
    ) {
        let made = remesh(&common::polygons(&mesh), &settings);
        let corners = if settings.kind == Kind::Quads { 4 } else { 3 };
        prop_assert!(made.mesh.faces().all(|face| face.len() == corners));
        let topology = measure::topology(&made.mesh, &Progress::none()).unwrap();
        prop_assert_eq!((topology.closed, topology.genus), (true, Some(0)));
        prop_assert_eq!(topology.n_components, 1);
        prop_assert_eq!(check_cover(&made.mesh, &made.sphere), Ok(()));
        prop_assert_eq!((made.report.embedding.n_folds, made.report.embedding.degree), (0, 1));
    }

    #[test]
    fn a_remeshed_ball_lies_in_the_box_of_its_input(
        mesh in any_ball(), settings in any_settings()
    ) {
        let polygons = common::polygons(&mesh);
        let made = remesh(&polygons, &settings);
        let [low, high] = polygons.bounds();
        let margin = 0.05 * low.distance(high);
        for &p in made.mesh.positions() {
            prop_assert!(p.cmpge(low - margin).all() && p.cmple(high + margin).all(), "{p}");
        }
    }

    #[test]
    fn every_part_is_kept_and_every_material_comes_from_the_input(
        seed in any::<u64>(), n_parts in 1_usize..4, faces in 150_usize..500
    ) {
        let (mesh, materials) = row_of_parts(seed, n_parts);
        let input = Input { materials: Some(&materials), ..Input::new(&mesh) };
        let settings = quick(faces, Kind::Quads);
        let made = pipeline::remesh(input, &settings, &Solver::default(), &Progress::none())
            .expect("separate balls can be done");
        prop_assert_eq!(measure::topology(&made.mesh, &Progress::none()).unwrap().n_components, n_parts);
        let given = made.materials.expect("materials were given");
        prop_assert_eq!(given.len(), made.mesh.n_faces());
        for (f, &material) in given.iter().enumerate() {
            // Part i stands at 10 i along x and has the material i.
            let x = made.mesh.position(made.mesh.face(FaceId(f as u32))[0]).x;
            prop_assert_eq!(material, (x / 10.0).round() as i32);
        }
    }

    #[test]
    fn a_damaged_mesh_keeps_its_shape_or_is_refused(
        bytes in prop::collection::vec(any::<u8>(), 1..60), is_quads in any::<bool>()
    ) {
        check_damaged(&bytes, is_quads);
    }

    #[test]
    fn what_is_closed_cut_filled_and_sealed_has_the_topology_that_this_makes(
        bytes in prop::collection::vec(any::<u8>(), 3..60)
    ) {
        common::closing::check(&bytes);
    }

    #[test]
    fn a_run_cancelled_anywhere_says_so(n_calls in 0_usize..60) {
        let mesh = common::polygons(&common::blob(3, 8));
        let token = CancelToken::new();
        let calls = Mutex::new(0);
        let listener = |_: &str, _: f64| {
            let mut calls = calls.lock().expect("no listener panics");
            *calls += 1;
            if *calls > n_calls {
                token.cancel();
            }
        };
        let progress = Progress::new(token.clone(), &listener);
        let settings = quick(300, Kind::Triangles);
        match pipeline::remesh(Input::new(&mesh), &settings, &Solver::default(), &progress) {
            Err(error) => prop_assert!(error.is_cancelled(), "{error}"),
            Ok(_) => prop_assert!(!token.is_cancelled(), "finished although cancelled"),
        }
    }
}

/// A damaged mesh keeps its topology, or is refused.
fn check_damaged(bytes: &[u8], is_quads: bool) {
    let Some(mesh) = common::edits::damaged(bytes) else {
        return;
    };
    let kind = if is_quads {
        Kind::Quads
    } else {
        Kind::Triangles
    };
    let settings = Settings {
        weld: None,
        ..quick(60, kind)
    };
    let quiet = Progress::none();
    let made = pipeline::remesh(Input::new(&mesh), &settings, &Solver::default(), &quiet);
    let Ok(made) = made else { return };
    assert!(made.mesh.positions().iter().all(|p| p.is_finite()));
    let found = measure::topology(&made.mesh, &quiet).expect("what came out is a mesh");
    let Ok(cleaned) = clean::clean(&mesh, &quiet) else {
        return;
    };
    let wanted = measure::topology_of_triangles(&cleaned.mesh);
    // Surfaces that touch, which cleaning has parted, touch again.
    if made.report.rejoined.is_some() {
        assert!(found.n_components <= wanted.n_components);
    } else if made.report.kept.is_empty() {
        let figures = |t: Topology| (t.n_components, t.n_borders, t.genus);
        assert_eq!(figures(found), figures(wanted));
    }
}

/// What once failed, by the bytes that drew it.
#[test]
fn damaged_meshes_that_failed_once_are_done() {
    let bytes = [
        109, 237, 0, 0, 26, 175, 24, 201, 67, 69, 1, 114, 80, 75, 89, 8, 26, 93, 32, 146, 6, 22,
        54, 205, 141, 89,
    ];
    check_damaged(&bytes, true);
}

/// Balls side by side, each with a material of its own.
fn row_of_parts(seed: u64, n_parts: usize) -> (PolygonMesh, Vec<i32>) {
    let (mut points, mut faces, mut materials) = (Vec::new(), Vec::new(), Vec::new());
    for part in 0..n_parts {
        let mesh = common::blob(seed.wrapping_add(part as u64), 5);
        let first = points.len() as u32;
        points.extend(
            mesh.positions()
                .iter()
                .map(|&p| p + DVec3::X * 10.0 * part as f64),
        );
        faces.extend(mesh.faces().iter().map(|face| face.map(|v| v.0 + first)));
        materials.resize(faces.len(), part as i32);
    }
    (
        PolygonMesh::from_faces(points, &faces).expect("the parts are meshes"),
        materials,
    )
}

#[test]
fn the_count_asked_for_is_met_within_two_percent() {
    let mesh = common::polygons(&common::limbs(5, 16));
    for kind in [Kind::Triangles, Kind::Quads] {
        for faces in [500, 1000, 1234, 2000] {
            let n_faces = remesh(&mesh, &quick(faces, kind)).mesh.n_faces();
            let is_near = n_faces.abs_diff(faces) * 50 <= faces;
            assert!(is_near, "{kind:?}: {n_faces} instead of {faces}");
        }
    }
}

#[test]
fn progress_never_runs_backwards() {
    let mesh = common::polygons(&common::limbs(1, 8));
    let heard = Mutex::new(Vec::new());
    let listener = |_: &str, share: f64| heard.lock().unwrap().push(share);
    let progress = Progress::new(CancelToken::new(), &listener);
    let settings = Settings {
        threads: 1,
        ..quick(400, Kind::Triangles)
    };
    pipeline::remesh(Input::new(&mesh), &settings, &Solver::default(), &progress).unwrap();
    let heard = heard.into_inner().unwrap();
    let backwards = heard.windows(2).find(|w| w[1] < w[0]);
    assert_eq!(backwards, None);
    assert!(heard.iter().all(|share| (0.0..=1.0).contains(share)));
    assert_eq!(heard.last(), Some(&1.0));
}
