//! The solver's maps: valid for every closed shape, whatever its size, place, noise or threads.

mod common;

use glam::{DMat3, DVec3};
use orbflow_geometry::decimate::collapse_to_tetrahedron;
use orbflow_geometry::elementary::ln;
use orbflow_geometry::embed::{
    Embedded, Error, OffsetPredictor, Report, Settings, Solver, Times, distortion, embed, even,
};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::{TriangleMesh, VertexId};
use orbflow_geometry::progress::{CancelToken, Cancelled, Progress};
use orbflow_geometry::random::Random;

fn hierarchy(mesh: TriangleMesh) -> CollapseHierarchy {
    collapse_to_tetrahedron(mesh, &Progress::none()).expect("the mesh is closed and of genus 0")
}

/// Embeds, which proves that the map is valid.
fn solved(mesh: TriangleMesh) -> Embedded {
    let settings = Settings::default();
    let found = embed(
        &hierarchy(mesh),
        &Solver::default(),
        &settings,
        &Progress::none(),
    );
    found.expect("a closed mesh of genus 0 is embedded")
}

fn moved(mesh: &TriangleMesh, map: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    mesh.with_positions(mesh.positions().iter().map(|&p| map(p)).collect())
}

#[test]
fn random_blobs_and_limbs_are_embedded_with_low_energy() {
    for seed in 0..12 {
        let blob = solved(common::blob(seed, 9)).report;
        assert!(blob.energy < 1.75 && blob.complete, "{seed}: {blob:?}");
        let limbs = solved(common::limbs(seed, 9)).report;
        assert!(limbs.energy < 2.5, "{seed}: {limbs:?}");
    }
}

#[test]
fn a_solver_in_a_hurry_comes_close_with_half_the_work() {
    for seed in [2, 4] {
        // Some 2,400 vertices: most levels are beyond those that it sweeps.
        let hierarchy = hierarchy(common::limbs(seed, 20));
        let [thorough, brisk] = [Solver::default(), Solver::BRISK].map(|solver| {
            let found = embed(
                &hierarchy,
                &solver,
                &solver.finish(&hierarchy),
                &Progress::none(),
            );
            found.expect("limbs are closed").report
        });
        assert!(
            2 * brisk.n_relaxations < thorough.n_relaxations
                && brisk.energy < 1.02 * thorough.energy,
            "{seed}: {brisk:?} {thorough:?}"
        );
    }
}

#[test]
fn a_scaled_mesh_has_the_same_map_to_the_last_bit() {
    let mesh = common::limbs(4, 7);
    let reference = solved(mesh.clone());
    for exponent in [-90, -3, 50, 99] {
        let scaled = moved(&mesh, |p| p * 2.0_f64.powi(exponent));
        let found = solved(scaled);
        assert_eq!(found.map.sphere(), reference.map.sphere(), "2^{exponent}");
        assert!((found.report.energy - reference.report.energy).abs() < 1e-12);
    }
}

#[test]
fn turned_mirrored_and_renumbered_meshes_have_the_same_energy() {
    let mesh = common::limbs(5, 9);
    let n = mesh.n_vertices() as u32;
    let reference = solved(mesh.clone()).report.energy;
    let turn = DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(0.7);
    let mirrored_faces = mesh.faces().iter().map(|&[a, b, c]| [c, b, a]).collect();
    let mirrored = mesh.positions().iter().map(|p| p.with_y(-p.y)).collect();
    // 7 has no divisor in common with the number of vertices, so that this is a permutation.
    assert_ne!(n % 7, 0);
    let number = |v: VertexId| VertexId((v.0 * 7 + 3) % n);
    let mut positions = vec![DVec3::ZERO; n as usize];
    for v in mesh.vertex_ids() {
        positions[number(v).0 as usize] = mesh.position(v);
    }
    let renumbered = mesh.faces().iter().map(|f| f.map(number)).collect();
    let variants = [
        moved(&mesh, |p| turn * p + DVec3::new(3.0, -2.0, 5.0)),
        TriangleMesh::new(mirrored, mirrored_faces).unwrap(),
        TriangleMesh::new(positions, renumbered).unwrap(),
    ];
    for variant in variants {
        let energy = solved(variant).report.energy;
        assert!((energy - reference).abs() < 0.02, "{energy} {reference}");
    }
}

#[test]
fn the_same_bytes_come_out_for_any_number_of_threads() {
    let hierarchy = hierarchy(common::limbs(6, 20));
    let run = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        let (settings, progress) = (Settings::default(), Progress::none());
        pool.install(|| {
            let found = embed(&hierarchy, &Solver::default(), &settings, &progress).unwrap();
            let times = Times::default();
            let report = Report {
                times,
                ..found.report
            };
            (found.map.sphere().clone(), report)
        })
    };
    let [one, two, five] = [1, 2, 5].map(run);
    assert!(one == two && one == five);
}

#[test]
fn degenerate_shapes_are_embedded_too() {
    let mesh = common::cuboid(6);
    let mut random = Random::new(9);
    let mut noise = || DVec3::new(random.unit(), random.unit(), random.unit());
    let chaos = mesh.positions().iter().map(|_| noise()).collect();
    let shapes = [
        ("needle", moved(&mesh, |p| p * DVec3::new(1e6, 1.0, 1.0))),
        ("sheet", moved(&mesh, |p| p * DVec3::new(1.0, 1.0, 1e-9))),
        ("flat", moved(&mesh, |p| p.with_z(0.0))),
        ("line", moved(&mesh, |p| DVec3::X * p.x)),
        ("point", moved(&mesh, |_| DVec3::ONE)),
        ("far away", moved(&mesh, |p| p + 1e12)),
        (
            "cluster",
            moved(&mesh, |p| if p.x > 0.4 { p } else { p * 1e-9 }),
        ),
        ("large", moved(&mesh, |p| p * 1e140)),
        ("small", moved(&mesh, |p| p * 1e-140)),
        ("chaos", mesh.with_positions(chaos)),
    ];
    for (name, shape) in shapes {
        let hierarchy = hierarchy(shape);
        let (settings, progress) = (Settings::default(), Progress::none());
        let found = embed(&hierarchy, &Solver::default(), &settings, &progress);
        let report = found
            .unwrap_or_else(|error| panic!("{name}: {error}"))
            .report;
        assert_eq!((report.n_folds, report.degree), (0, 1), "{name}");
        let even = even(&hierarchy, &progress).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(even.sphere().len(), hierarchy.n_vertices());
    }
}

#[test]
fn an_isometry_has_the_least_distortion_there_is() {
    let mesh = common::sphere(24);
    let sphere = mesh.positions().iter().copied().collect();
    let found = distortion(&mesh, &sphere);
    // The mesh is a polyhedron in the sphere: areas differ a little from the sphere's.
    assert!((found - ln(5.0_f64)).abs() < 0.01, "{found}");
}

#[test]
fn a_raised_flag_stops_the_embedding() {
    let hierarchy = hierarchy(common::blob(3, 6));
    let token = CancelToken::new();
    token.cancel();
    let progress = Progress::silent(token);
    let found = embed(
        &hierarchy,
        &Solver::default(),
        &Settings::default(),
        &progress,
    );
    assert_eq!(found.unwrap_err(), Error::Cancelled(Cancelled));
}
