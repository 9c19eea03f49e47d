//! Whole runs: what comes out is what was asked for, and what cannot be done is said.

mod common;

use std::sync::Mutex;

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::topology;
use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::pipeline::{
    Error, Flowed, Input, Kind, Primitive, Remeshed, Settings, remesh,
};
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_geometry::sphere_map::check_cover;

fn settings(faces: usize, kind: Kind) -> Settings {
    Settings {
        faces,
        kind,
        ..Settings::default()
    }
}

fn run(mesh: &PolygonMesh, settings: &Settings) -> Result<Remeshed, Error> {
    remesh(
        Input::new(mesh),
        settings,
        &Solver::default(),
        &Progress::none(),
    )
}

/// Two meshes side by side in one.
fn beside(a: &PolygonMesh, b: &PolygonMesh) -> PolygonMesh {
    let shift = DVec3::X * 20.0;
    let positions = a
        .positions()
        .iter()
        .copied()
        .chain(b.positions().iter().map(|&p| p + shift));
    let of_a = a.faces().map(|f| f.iter().map(|v| v.0).collect::<Vec<_>>());
    let first = a.n_vertices() as u32;
    let of_b = b
        .faces()
        .map(|f| f.iter().map(|v| v.0 + first).collect::<Vec<_>>());
    let faces: Vec<_> = of_a.chain(of_b).collect();
    PolygonMesh::from_faces(positions.collect(), &faces).expect("two meshes make one")
}

#[test]
fn every_closed_shape_gives_a_closed_mesh_of_the_asked_size() {
    for (name, mesh) in common::closed(16) {
        for kind in [Kind::Triangles, Kind::Quads] {
            let result = run(&common::polygons(&mesh), &settings(600, kind)).unwrap();
            let found = topology(&result.mesh, &Progress::none()).unwrap();
            assert!(found.closed && found.manifold, "{name} {kind:?}: {found:?}");
            assert_eq!(
                (found.n_components, found.genus),
                (1, Some(0)),
                "{name} {kind:?}"
            );
            let off = (found.n_faces as f64 / 600.0 - 1.0).abs();
            assert!(off <= 0.02, "{name} {kind:?}: {} faces", found.n_faces);
            let quads = if kind == Kind::Quads {
                found.n_faces
            } else {
                0
            };
            assert_eq!(found.n_quads, quads, "{name}");
            assert_eq!(
                check_cover(&result.mesh, &result.sphere),
                Ok(()),
                "{name} {kind:?}"
            );
        }
    }
}

#[test]
fn few_faces_are_possible() {
    let mesh = common::polygons(&common::blob(5, 8));
    for (faces, kind) in [
        (4, Kind::Triangles),
        (6, Kind::Quads),
        (20, Kind::Triangles),
    ] {
        let result = run(&mesh, &settings(faces, kind)).unwrap();
        assert_eq!(result.mesh.n_faces(), faces);
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let mesh = common::polygons(&common::limbs(4, 14));
    for kind in [Kind::Triangles, Kind::Quads] {
        let with = |threads| {
            run(
                &mesh,
                &Settings {
                    threads,
                    ..settings(500, kind)
                },
            )
            .unwrap()
        };
        let [one, two, again] = [with(1), with(2), with(2)];
        assert_eq!(one.mesh, two.mesh, "{kind:?}");
        assert_eq!(one.sphere, two.sphere, "{kind:?}");
        assert_eq!(two.mesh, again.mesh, "{kind:?}");
    }
}

#[test]
fn parts_share_the_faces_by_area() {
    let both = beside(
        &common::polygons(&common::sphere(10)),
        &common::polygons(&common::capsule(8.0, 10)),
    );
    let result = run(&both, &settings(1200, Kind::Quads)).unwrap();
    assert_eq!(
        topology(&result.mesh, &Progress::none())
            .unwrap()
            .n_components,
        2
    );
    let shares: Vec<_> = result
        .report
        .parts
        .iter()
        .map(|part| part.n_faces as f64)
        .collect();
    // The capsule has 1 + 8 / 2 times the area of the sphere.
    assert!((shares[1] / shares[0] - 5.0).abs() < 0.5, "{shares:?}");
    assert_eq!(result.report.embedding.degree, 1);
}

#[test]
fn materials_follow_the_surface() {
    let mesh = common::polygons(&common::cuboid(12));
    let middle = |mesh: &PolygonMesh, face: &[_]| {
        face.iter().map(|&v| mesh.position(v).x).sum::<f64>() / face.len() as f64
    };
    let materials: Vec<i32> = mesh
        .faces()
        .map(|face| i32::from(middle(&mesh, face) > 0.0) * 3)
        .collect();
    let input = Input {
        materials: Some(&materials),
        ..Input::new(&mesh)
    };
    let result = remesh(
        input,
        &settings(400, Kind::Quads),
        &Solver::default(),
        &Progress::none(),
    )
    .unwrap();
    let new = result.materials.unwrap();
    assert_eq!(new.len(), result.mesh.n_faces());
    for (face, material) in result.mesh.faces().zip(new) {
        let x = middle(&result.mesh, face);
        assert!(
            x.abs() < 0.05 || material == i32::from(x > 0.0) * 3,
            "{x} {material}"
        );
    }
}

#[test]
fn what_cannot_be_done_is_said_with_numbers() {
    let closed = common::sphere(4);
    let message = |mesh: &PolygonMesh, settings: &Settings| {
        run(mesh, settings).map(|_| ()).unwrap_err().to_string()
    };
    let quads = settings(100, Kind::Quads);
    let mut faces: Vec<_> = closed.faces().iter().map(|f| f.map(|v| v.0)).collect();
    faces.truncate(faces.len() - 2);
    let open = PolygonMesh::from_faces(closed.positions().to_vec(), &faces).unwrap();
    let sphere = Settings {
        primitive: Some(Primitive::QuadSphere),
        ..quads.clone()
    };
    let found = message(&open, &sphere);
    assert!(
        found.starts_with("1 border loop, 4 border edges: "),
        "{found}"
    );
    let found = message(&common::polygons(&common::torus(8, 6)), &sphere);
    assert!(found.starts_with("genus 1: "), "{found}");
    let wrong = Settings {
        primitive: Some(Primitive::Icosphere),
        ..quads
    };
    let found = message(&common::polygons(&closed), &wrong);
    assert_eq!(
        found,
        "the icosphere primitive makes triangles, but quads were asked for"
    );
}

#[test]
fn a_reduced_mesh_is_used_only_where_it_can_stand_for_the_part() {
    let mesh = common::polygons(&common::blob(9, 20));
    let good = common::polygons(&common::blob(9, 12));
    let torus = common::polygons(&common::torus(8, 6));
    for (reduced, status) in [(&good, "used"), (&torus, "refused")] {
        let input = Input {
            reduced: Some(reduced),
            ..Input::new(&mesh)
        };
        let predictor = Solver::default();
        let result = remesh(
            input,
            &settings(300, Kind::Quads),
            &predictor,
            &Progress::none(),
        );
        let report = serde_json::to_value(&result.unwrap().report).unwrap();
        assert_eq!(report["parts"][0]["reduced"]["status"], status);
    }
}

#[test]
fn progress_rises_to_the_end_and_a_cancelled_run_says_so() {
    let mesh = common::polygons(&common::blob(2, 14));
    let heard = Mutex::new(Vec::new());
    let listener = |_: &str, share: f64| heard.lock().unwrap().push(share);
    let progress = Progress::new(CancelToken::new(), &listener);
    remesh(
        Input::new(&mesh),
        &settings(300, Kind::Quads),
        &Solver::default(),
        &progress,
    )
    .unwrap();
    let shares = heard.into_inner().unwrap();
    let fall = shares.windows(2).find(|w| w[0] > w[1] + 1e-9);
    assert_eq!(fall, None);
    assert!(shares.last().is_some_and(|&last| (last - 1.0).abs() < 1e-9));

    let token = CancelToken::new();
    token.cancel();
    let stopped = remesh(
        Input::new(&mesh),
        &settings(300, Kind::Quads),
        &Solver::default(),
        &Progress::silent(token),
    );
    assert!(stopped.is_err_and(|error| error.is_cancelled()));
}

#[test]
fn meshes_of_any_size_and_place_give_the_same_shape() {
    let mesh = common::polygons(&common::blob(7, 10));
    let settings = settings(300, Kind::Triangles);
    let plain = run(&mesh, &settings).unwrap().mesh;
    for scale in [2f64.powi(100), 2f64.powi(-100)] {
        let scaled = mesh.with_positions(mesh.positions().iter().map(|&p| p * scale).collect());
        let result = run(&scaled, &settings).unwrap().mesh;
        assert_eq!(result.corners(), plain.corners());
        for (p, q) in result.positions().iter().zip(plain.positions()) {
            assert!((*p / scale).distance(*q) < 1e-9, "{p} {q}");
        }
    }
}

#[test]
fn flowing_quads_cover_the_sphere_once_and_are_as_many_as_asked_for() {
    for (name, mesh) in common::closed(16) {
        let wanted = Settings {
            primitive: Some(Primitive::Flow),
            ..settings(500, Kind::Quads)
        };
        let result = run(&common::polygons(&mesh), &wanted).unwrap();
        let flow = result.report.parts[0].flow.clone();
        assert!(
            matches!(flow, Some(Flowed::Used { .. })),
            "{name}: {flow:?}"
        );
        let [n_faces, n_vertices] = [result.mesh.n_faces(), result.mesh.n_vertices()];
        assert_eq!((result.mesh.n_quads(), n_vertices), (n_faces, n_faces + 2));
        assert!(n_faces.abs_diff(500) <= 10, "{name}: {n_faces}");
        assert_eq!(check_cover(&result.mesh, &result.sphere), Ok(()), "{name}");
    }
}

#[test]
fn flowing_quads_on_limbs_are_not_inverted() {
    for seed in 0..3 {
        let wanted = Settings {
            primitive: Some(Primitive::Flow),
            ..settings(400, Kind::Quads)
        };
        let mesh = common::polygons(&common::limbs(seed, 16));
        let result = run(&mesh, &wanted).unwrap();
        let part = &result.report.parts[0];
        assert!(matches!(part.flow, Some(Flowed::Used { .. })), "{seed}");
        assert_eq!(part.deform.n_inverted, 0, "{seed}");
        assert_eq!(check_cover(&result.mesh, &result.sphere), Ok(()), "{seed}");
    }
}

#[test]
fn too_few_quads_to_flow_fall_back_to_the_quad_sphere_and_say_so() {
    let wanted = Settings {
        primitive: Some(Primitive::Flow),
        ..settings(7, Kind::Quads)
    };
    let mesh = common::polygons(&common::limbs(2, 8));
    let result = run(&mesh, &wanted).unwrap();
    assert_eq!(check_cover(&result.mesh, &result.sphere), Ok(()));
    match &result.report.parts[0].flow {
        Some(Flowed::Refused { reason, .. }) => assert!(!reason.is_empty()),
        other => assert!(matches!(other, Some(Flowed::Used { .. })), "{other:?}"),
    }
}
