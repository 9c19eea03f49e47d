//! What a change of the input that changes nothing must not change.

mod common;

use glam::{DMat3, DVec3};
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh, VertexId};
use orbflow_geometry::pipeline::{self, Input, Kind, Remeshed, Settings};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;
use orbflow_geometry::{measure, score};

fn settings(kind: Kind) -> Settings {
    Settings {
        faces: 600,
        kind,
        score: None,
        ..Settings::default()
    }
}

fn remesh(mesh: &TriangleMesh, settings: &Settings) -> Remeshed {
    let mesh = common::polygons(mesh);
    pipeline::remesh(
        Input::new(&mesh),
        settings,
        &Solver::default(),
        &Progress::none(),
    )
    .expect("a closed mesh of genus 0 can be done")
}

fn mapped(mesh: &TriangleMesh, map: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    let points = mesh.positions().iter().map(|&p| map(p)).collect();
    TriangleMesh::new(points, mesh.faces().to_vec()).expect("the same faces")
}

/// The mean distance in percent of the diagonal, and how the embedding came out.
fn figures(mesh: &TriangleMesh) -> [f64; 2] {
    let made = remesh(mesh, &settings(Kind::Triangles));
    let wanted = score::Settings {
        n_samples: 20_000,
        ..score::Settings::default()
    };
    let input = common::polygons(mesh);
    let score = score::score(&input, &made.mesh, &wanted, &Progress::none()).expect("two meshes");
    [score.distance.chamfer_pct, made.report.embedding.energy]
}

/// Two figures that differ only by the luck of ties and samples.
fn assert_alike(a: [f64; 2], b: [f64; 2]) {
    assert!(
        (a[0] / b[0] - 1.0).abs() < 0.15,
        "distance {} and {}",
        a[0],
        b[0]
    );
    assert!(
        (a[1] - b[1]).abs() < 0.03 * (a[1] + b[1]),
        "energy {} and {}",
        a[1],
        b[1]
    );
}

#[test]
fn the_same_run_twice_gives_the_same_bits() {
    for (name, mesh) in common::closed(8) {
        for kind in [Kind::Triangles, Kind::Quads] {
            let [a, b] = [0, 1].map(|_| remesh(&mesh, &settings(kind)));
            assert_eq!(bits(&a.mesh), bits(&b.mesh), "{name}");
            assert_eq!(a.sphere, b.sphere, "{name}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    for (name, mesh) in common::closed(12) {
        for kind in [Kind::Triangles, Kind::Quads] {
            let of = |threads| {
                remesh(
                    &mesh,
                    &Settings {
                        threads,
                        ..settings(kind)
                    },
                )
            };
            let one = of(1);
            for n_threads in [2, 3, 7] {
                let many = of(n_threads);
                assert_eq!(
                    bits(&one.mesh),
                    bits(&many.mesh),
                    "{name}, {n_threads} threads"
                );
                assert_eq!(one.sphere, many.sphere, "{name}, {n_threads} threads");
            }
        }
    }
}

#[test]
fn doubling_the_size_doubles_the_result_exactly() {
    let mesh = common::limbs(4, 8);
    let made = remesh(&mesh, &settings(Kind::Quads));
    for factor in [2.0, 0.125, 2_f64.powi(90), 2_f64.powi(-90)] {
        let scaled = remesh(&mapped(&mesh, |p| p * factor), &settings(Kind::Quads));
        let back = scaled
            .mesh
            .positions()
            .iter()
            .map(|&p| p / factor)
            .collect();
        assert_eq!(
            bits(&made.mesh),
            bits(&made.mesh.with_positions(back)),
            "{factor}"
        );
        assert_eq!(made.sphere, scaled.sphere, "{factor}");
    }
}

#[test]
fn a_mesh_turned_or_mirrored_is_done_as_well() {
    let mesh = common::limbs(6, 10);
    let before = figures(&mesh);
    let turn = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(1.1);
    assert_alike(before, figures(&mapped(&mesh, |p| turn * p)));
    // A mirrored mesh keeps its outside outside when its faces turn round.
    let mirrored = mapped(&mesh, |p| p * DVec3::new(-1.0, 1.0, 1.0));
    let faces = mirrored
        .faces()
        .iter()
        .map(|&[a, b, c]| [a, c, b])
        .collect();
    let mirrored = TriangleMesh::new(mirrored.positions().to_vec(), faces).unwrap();
    assert_alike(before, figures(&mirrored));
}

#[test]
fn a_mesh_with_shuffled_vertices_and_faces_is_done_as_well() {
    let mesh = common::limbs(6, 10);
    assert_alike(figures(&mesh), figures(&shuffled(&mesh, 11)));
}

#[test]
fn an_inside_out_mesh_stays_inside_out() {
    let mesh = common::blob(2, 8);
    let faces = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = TriangleMesh::new(mesh.positions().to_vec(), faces).unwrap();
    let volume = |mesh: &TriangleMesh| {
        let made = remesh(mesh, &settings(Kind::Triangles)).mesh;
        let faces = made.faces().map(|f| [f[0], f[1], f[2]]).collect();
        measure::volume(&TriangleMesh::new(made.positions().to_vec(), faces).unwrap())
    };
    assert!(volume(&mesh) > 0.0);
    assert!(volume(&turned) < 0.0);
}

/// The same surface under other numbers.
fn shuffled(mesh: &TriangleMesh, seed: u64) -> TriangleMesh {
    let mut random = Random::new(seed);
    let mut order: Vec<u32> = (0..mesh.n_vertices() as u32).collect();
    shuffle(&mut order, &mut random);
    let mut points = vec![DVec3::ZERO; order.len()];
    for (&new, &p) in order.iter().zip(mesh.positions()) {
        points[new as usize] = p;
    }
    let renamed = |f: &[VertexId; 3]| [1, 2, 0].map(|i| VertexId(order[f[i].0 as usize]));
    let mut faces: Vec<_> = mesh.faces().iter().map(renamed).collect();
    shuffle(&mut faces, &mut random);
    TriangleMesh::new(points, faces).expect("the same surface")
}

fn shuffle<T>(items: &mut [T], random: &mut Random) {
    for i in (1..items.len()).rev() {
        items.swap(i, (random.next_u64() % (i as u64 + 1)) as usize);
    }
}

fn bits(mesh: &PolygonMesh) -> (Vec<[u64; 3]>, Vec<u32>) {
    let positions = mesh
        .positions()
        .iter()
        .map(|p| p.to_array().map(f64::to_bits));
    (
        positions.collect(),
        mesh.corners().iter().map(|v| v.0).collect(),
    )
}
