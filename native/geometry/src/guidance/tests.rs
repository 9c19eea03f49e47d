use glam::DVec3;

use super::{Drawn, Pen, Strength, Stroke, draw};
use crate::elementary::sin_cos;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};
use crate::nearest::Bvh;
use crate::shapes;

fn circle(radius: f64, height: f64, n: usize) -> Stroke {
    let point = |i: usize| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * i as f64 / n as f64);
        DVec3::new(radius * cos, radius * sin, height)
    };
    Stroke {
        points: (0..n).map(point).collect(),
        is_closed: true,
        strength: Strength::Exact,
    }
}

fn drawn(mesh: &TriangleMesh, strokes: &[Stroke], step: f64) -> Drawn {
    let tree = Bvh::of_mesh(mesh);
    let locate = |p: DVec3| {
        let closest = tree.closest(p);
        Some((closest.face, closest.position))
    };
    let pen = Pen {
        step,
        locate: &locate,
        settle: &|p| p,
        is_fixed: &VertexMap::filled(mesh.n_vertices(), false),
        is_barrier: &HalfedgeMap::filled(3 * mesh.n_faces(), false),
    };
    draw(mesh, strokes, &pen).unwrap()
}

fn edges(drawn: &Drawn, strength: Strength) -> Vec<HalfedgeId> {
    let on = drawn.along(strength);
    let mesh = &drawn.mesh;
    let first = |h: &HalfedgeId| mesh.twin(*h).is_some_and(|twin| *h < twin);
    mesh.halfedge_ids()
        .filter(|&h| on[h])
        .filter(first)
        .collect()
}

fn valence(drawn: &Drawn, strength: Strength) -> Vec<usize> {
    let on = drawn.along(strength);
    let mesh = &drawn.mesh;
    mesh.vertex_ids()
        .map(|v| mesh.outgoing(v).filter(|&h| on[h]).count())
        .collect()
}

#[test]
fn a_ring_on_a_ball_becomes_one_closed_chain_of_edges() {
    let mesh = shapes::sphere(12);
    for (height, step) in [(0.0, 0.1), (0.31, 0.05), (0.8, 0.2)] {
        let radius = f64::sqrt(1.0 - height * height);
        let drawn = drawn(&mesh, &[circle(radius, height, 40)], step);
        assert_eq!(drawn.gaps, [0]);
        assert_eq!(drawn.mesh.check(), Ok(()));
        assert_eq!(drawn.mesh.euler_number(), 2);
        let ends = valence(&drawn, Strength::Exact);
        assert!(ends.iter().all(|&n| n == 0 || n == 2));
        let length: f64 = edges(&drawn, Strength::Exact)
            .iter()
            .map(|&h| {
                let ends = [drawn.mesh.origin(h), drawn.mesh.target(h)];
                let [a, b] = ends.map(|v| drawn.mesh.position(v));
                for p in [a, b] {
                    assert!((p.z - height).abs() < 0.03, "{p}");
                }
                a.distance(b)
            })
            .sum();
        let round = std::f64::consts::TAU * radius;
        assert!((length / round - 1.0).abs() < 0.05, "{length} {round}");
    }
}

#[test]
fn strokes_that_cross_share_a_vertex_and_the_stronger_one_counts() {
    let mesh = shapes::sphere(10);
    let ring = circle(1.0, 0.0, 30);
    let turned = Stroke {
        points: ring
            .points
            .iter()
            .map(|p| DVec3::new(p.x, 0.0, p.y))
            .collect(),
        strength: Strength::Follow,
        is_closed: true,
    };
    let drawn = drawn(&mesh, &[ring, turned], 0.1);
    let [exact, follow] =
        [Strength::Exact, Strength::Follow].map(|strength| valence(&drawn, strength));
    let n_shared = exact
        .iter()
        .zip(&follow)
        .filter(|(a, b)| **a == 2 && **b == 2);
    assert_eq!(n_shared.count(), 2);
    assert_eq!(drawn.mesh.check(), Ok(()));
}

#[test]
fn no_triangle_folds_or_gets_thin_and_halfedges_know_where_they_come_from() {
    let mesh = shapes::sphere(12);
    let drawn = drawn(&mesh, &[circle(0.9, 0.4, 33), circle(0.3, 0.95, 9)], 0.1);
    for face in drawn.mesh.face_ids() {
        let [a, b, c] = drawn.mesh.triangle(face);
        let normal = (b - a).cross(c - a);
        assert!(normal.dot(a + b + c) > 0.0);
        let longest = (b - a).length_squared().max((c - a).length_squared());
        assert!(normal.length() > 0.02 * longest, "{face:?}");
    }
    for (h, side) in drawn.sides.iter_ids() {
        let Some(side) = *side else { continue };
        let [a, b] = [drawn.mesh.origin(h), drawn.mesh.target(h)];
        let old = [mesh.origin(side), mesh.target(side)];
        // An end that is an old vertex is that of the old halfedge.
        let is_old = |v: crate::mesh::VertexId| (v.0 as usize) < mesh.n_vertices();
        assert!(!is_old(a) || a == old[0]);
        assert!(!is_old(b) || b == old[1]);
    }
    assert_eq!(
        drawn.parents.len(),
        drawn.mesh.n_vertices() - mesh.n_vertices()
    );
}

#[test]
fn points_are_spread_evenly_along_a_stroke() {
    let stroke = Stroke {
        points: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)],
        is_closed: false,
        strength: Strength::Follow,
    };
    let spaced = stroke.spaced(0.5);
    let wanted = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0]];
    assert_eq!(spaced, wanted.map(|[x, y]| DVec3::new(x, y, 0.0)));
    let closed = Stroke {
        is_closed: true,
        ..stroke
    };
    assert_eq!(closed.spaced(10.0).len(), 6);
}
