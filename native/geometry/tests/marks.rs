//! Marked edges and sharp ones: the result has edges along them.

mod common;

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use orbflow_geometry::elementary::direction;
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

/// A ball of rows and columns, its radius a function of the direction.
fn globe(radius: impl Fn(DVec3) -> f64) -> PolygonMesh {
    let (rows, columns) = (20u32, 40u32);
    let place = |row: u32, column: u32| {
        let down = direction(PI * f64::from(row) / f64::from(rows));
        let round = direction(2.0 * PI * f64::from(column) / f64::from(columns));
        let way = (down.y * round).extend(down.x);
        way * radius(way)
    };
    let inner = (1..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let mut positions: Vec<DVec3> = inner.map(|(row, column)| place(row, column)).collect();
    positions.extend([place(0, 0), place(rows, 0)]);
    let [top, bottom] = [2, 1].map(|n| positions.len() as u32 - n);
    let at = |row: u32, column: u32| (row - 1) * columns + column % columns;
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for column in 0..columns {
        faces.push(vec![top, at(1, column), at(1, column + 1)]);
        faces.push(vec![bottom, at(rows - 1, column + 1), at(rows - 1, column)]);
        for row in 1..rows - 1 {
            let [a, b] = [row, row + 1].map(|row| [at(row, column), at(row, column + 1)]);
            faces.push(vec![a[0], b[0], b[1], a[1]]);
        }
    }
    PolygonMesh::from_faces(positions, &faces).expect("its faces have vertices")
}

fn share_met(mesh: &PolygonMesh, marked: &[[VertexId; 2]], settings: &Settings) -> f64 {
    let input = Input {
        marked,
        carried: marked,
        ..Input::new(mesh)
    };
    let remeshed = remesh(input, settings, &Solver::default(), &Progress::none());
    let remeshed = remeshed.expect("a closed ball can be remeshed");
    let met: Vec<_> = remeshed.carried.iter().map(|edge| edge.ends).collect();
    length(&remeshed.mesh, &met) / length(mesh, marked)
}

#[test]
fn marks_arrive_however_the_surface_is_turned_in_its_last_digits() {
    let lumpy = globe(|way| 1.0 + 0.6 * (way.x.powi(2) - way.y.powi(2)) * (way.z.powi(2) + 0.3));
    let marked = edges(&lumpy, |p| p.z.abs() < 1e-6);
    for turn in 0..4 {
        let by = DMat3::from_rotation_x(3e-7 * f64::from(turn));
        let turned = lumpy.positions().iter().map(|&p| by * p).collect();
        let turned = lumpy.with_positions(turned);
        for faces in [400, 800] {
            let settings = Settings {
                faces,
                ..Settings::default()
            };
            let share = share_met(&turned, &marked, &settings);
            assert!(share > 0.98, "{turn} {faces}: {share}");
        }
    }
}

#[test]
fn marks_arrive_beside_sharp_edges_that_are_not_clear() {
    // Facets all over but round the ring.
    let rough = globe(|way| {
        let is_rough = way.z.abs() > 0.3;
        1.0 + if is_rough {
            0.06 * direction(40.0 * way.x).y * direction(37.0 * way.y).y
        } else {
            0.0
        }
    });
    let marked = edges(&rough, |p| p.z.abs() < 1e-6);
    let settings = Settings {
        faces: 800,
        ..Settings::default()
    };
    let share = share_met(&rough, &marked, &settings);
    assert!(share > 0.9, "{share}");
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
