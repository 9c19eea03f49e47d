//! Marked edges and sharp ones: the result has edges along them.

mod common;

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{PolygonMesh, VertexId};
use orbflow_geometry::pipeline::{Error, Input, Kind, Settings, remesh};
use orbflow_geometry::progress::Progress;

fn run(
    mesh: &PolygonMesh,
    marked: &[[VertexId; 2]],
    settings: &Settings,
) -> Result<PolygonMesh, Error> {
    let input = Input {
        marked,
        ..Input::new(mesh)
    };
    let remeshed = remesh(input, settings, &Solver::default(), &Progress::none())?;
    Ok(remeshed.mesh)
}

/// The edges of a mesh whose ends are both where a property holds.
fn edges(mesh: &PolygonMesh, holds: impl Fn(DVec3) -> bool) -> Vec<[VertexId; 2]> {
    let sides = mesh
        .faces()
        .flat_map(|face| (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]]));
    let inside = |ends: &[VertexId; 2]| ends.iter().all(|&v| holds(mesh.position(v)));
    sides
        .filter(|ends| ends[0] < ends[1])
        .filter(inside)
        .collect()
}

fn length(mesh: &PolygonMesh, edges: &[[VertexId; 2]]) -> f64 {
    let lengths = edges.iter().map(|e| e.map(|v| mesh.position(v)));
    lengths.map(|[a, b]| a.distance(b)).sum()
}

#[test]
fn a_marked_ring_of_a_ball_is_a_ring_of_the_result() {
    let ball = common::polygons(&common::sphere(24));
    let on_ring = |p: DVec3| p.z.abs() < 1e-6;
    let marked = edges(&ball, on_ring);
    let around = length(&ball, &marked);
    for kind in [Kind::Triangles, Kind::Quads] {
        let settings = Settings {
            faces: 800,
            kind,
            ..Settings::default()
        };
        let plain = run(&ball, &[], &settings).unwrap();
        let ringed = run(&ball, &marked, &settings).unwrap();
        let share = |mesh: &PolygonMesh| length(mesh, &edges(mesh, on_ring)) / around;
        assert!(share(&plain) < 0.5, "{kind:?}: {}", share(&plain));
        assert!(share(&ringed) > 0.98, "{kind:?}: {}", share(&ringed));
    }
}

#[test]
fn the_sharp_angle_says_which_edges_of_a_box_are_kept() {
    let cuboid = common::polygons(&common::cuboid(16));
    let on_edge = |p: DVec3| {
        let near = (DVec3::new(0.5, 0.4, 0.3) - p.abs()).abs();
        near.to_array().iter().filter(|&&d| d < 1e-6).count() >= 2
    };
    let all = 4.0 * (1.0 + 0.8 + 0.6);
    for kind in [Kind::Triangles, Kind::Quads] {
        let share = |sharp_angle| {
            let settings = Settings {
                faces: 800,
                kind,
                sharp_angle,
                ..Settings::default()
            };
            let mesh = run(&cuboid, &[], &settings).unwrap();
            length(&mesh, &edges(&mesh, on_edge)) / all
        };
        assert!(share(40.0) > 0.98, "{kind:?}: {}", share(40.0));
        assert!(share(120.0) < 0.5, "{kind:?}: {}", share(120.0));
    }
}

#[test]
fn a_marked_edge_must_name_vertices() {
    let ball = common::polygons(&common::sphere(4));
    let marked = [[VertexId(0), VertexId(5_000)]];
    let error = run(&ball, &marked, &Settings::default()).unwrap_err();
    let text = format!(
        "marked edge 0 names vertex 5000, but there are {} vertices",
        ball.n_vertices()
    );
    assert_eq!(error.to_string(), text);
}
