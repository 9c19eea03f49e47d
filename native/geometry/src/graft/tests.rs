use std::f64::consts::TAU;

use glam::DVec3;

use super::{Border, Grafted, Part, graft};
use crate::elementary::sin_cos;
use crate::measure::topology;
use crate::mesh::PolygonMesh;
use crate::progress::Progress;

fn on_circle(radius: f64, turn: f64) -> DVec3 {
    let (sin, cos) = sin_cos(turn * TAU);
    DVec3::new(radius * cos, radius * sin, 0.0)
}

/// A flat ring of n quads, between circles of radius 1 and 2.
fn ring(n: u32) -> PolygonMesh {
    let circle = |radius| (0..n).map(move |i| on_circle(radius, f64::from(i) / f64::from(n)));
    let quad = |i: u32| {
        let next = (i + 1) % n;
        [i, n + i, n + next, next]
    };
    let faces: Vec<[u32; 4]> = (0..n).map(quad).collect();
    PolygonMesh::from_faces(circle(1.0).chain(circle(2.0)).collect(), &faces).unwrap()
}

/// A circle of m points, the ring on its left.
fn border(radius: f64, m: u32, first: Option<usize>) -> Border {
    let way = if radius < 1.5 { -1.0 } else { 1.0 };
    let turn = |i: u32| way * (f64::from(i) + 0.3) / f64::from(m);
    let name = |i: u32| first.map(|first| first + i as usize);
    Border {
        points: (0..m).map(|i| on_circle(radius, turn(i))).collect(),
        is_held: vec![first.is_some(); m as usize],
        angles: vec![TAU / 2.0; m as usize],
        names: (0..m).map(name).collect(),
    }
}

fn grafted(n: u32, borders: Vec<Border>) -> Grafted {
    let mesh = ring(n);
    let part = Part {
        n_faces: n as usize,
        borders,
    };
    graft(&mesh, &[part], &Progress::none()).unwrap()
}

/// How many faces have how many corners, once the vertices of all borders are found.
fn sizes(found: &Grafted, borders: &[Border]) -> [usize; 2] {
    let held: Vec<_> = borders
        .iter()
        .flat_map(|border| border.names.iter().zip(&border.points))
        .filter_map(|(name, place)| Some(((*name)?, *place)))
        .collect();
    assert_eq!(found.at.len(), held.len());
    for (name, place) in held {
        assert_eq!(found.mesh.position(found.at[&name]), place);
    }
    let shape = topology(&found.mesh, &Progress::none()).unwrap();
    assert_eq!(
        (shape.n_borders, shape.genus, shape.n_components),
        (2, Some(0), 1)
    );
    [3, 4].map(|n| found.mesh.faces().filter(|face| face.len() == n).count())
}

#[test]
fn a_loop_of_as_many_edges_gets_the_vertices_and_no_other_face() {
    let borders = vec![border(1.0, 12, Some(0)), border(2.0, 40, None)];
    let found = grafted(12, borders.clone());
    assert_eq!(sizes(&found, &borders), [0, 12]);
    assert_eq!(found.told[0].as_ref().unwrap().n_met, 12);
}

#[test]
fn even_differences_are_met_by_quads() {
    for m in [4, 8, 10, 14, 20, 36, 60, 240] {
        let borders = vec![border(1.0, m, Some(0)), border(2.0, 40, None)];
        let found = grafted(12, borders.clone());
        assert_eq!(sizes(&found, &borders)[0], 0, "{m}");
        assert_eq!(found.told[0].as_ref().unwrap().n_edges, m as usize);
    }
}

#[test]
fn an_odd_edge_goes_by_a_strip_to_a_loop_that_may_have_any_number() {
    for m in [11, 13] {
        let borders = vec![border(1.0, m, Some(0)), border(2.0, 40, None)];
        let found = grafted(12, borders.clone());
        assert_eq!(sizes(&found, &borders)[0], 0, "{m}");
        let both = vec![border(1.0, m, Some(0)), border(2.0, m, Some(100))];
        assert_eq!(sizes(&grafted(12, both.clone()), &both)[0], 0, "{m}");
    }
}

#[test]
fn an_odd_edge_that_nothing_makes_up_for_costs_a_triangle() {
    let borders = vec![border(1.0, 13, Some(0)), border(2.0, 12, Some(100))];
    let found = grafted(12, borders.clone());
    assert_eq!(sizes(&found, &borders)[0], 1);
    assert_eq!(found.told[0].as_ref().unwrap().n_triangles, 1);
}

#[test]
fn what_would_need_too_many_edges_in_one_is_left_and_told_of() {
    let found = grafted(3, vec![border(1.0, 151, Some(0)), border(2.0, 9, None)]);
    let reason = found.told[0].as_ref().unwrap_err();
    assert_eq!(reason, "its border of 3 edges cannot take 151");
    assert_eq!(found.mesh.n_faces(), 3);
}
