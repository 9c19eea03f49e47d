//! Rods of known shapes.

use super::*;
use crate::elementary::sin_cos;
use crate::measure::sharp_edges;
use crate::nearest::Bvh;
use crate::shapes::{self, swept};
use crate::sphere_map::check_cover;

fn straight(n: usize, length: f64) -> Vec<DVec3> {
    let step = length / (n - 1) as f64;
    (0..n).map(|i| DVec3::X * (step * i as f64)).collect()
}

fn spring(n_turns: f64, n: usize) -> Vec<DVec3> {
    let at = |i: usize| {
        let angle = std::f64::consts::TAU * n_turns * i as f64 / (n - 1) as f64;
        let (sin, cos) = sin_cos(angle);
        DVec3::new(5.0 * cos, 5.0 * sin, 0.5 * angle)
    };
    (0..n).map(at).collect()
}

fn rod_of(mesh: &TriangleMesh, n_quads: usize, mirror: Option<usize>) -> Rod {
    let settings = Settings {
        n_quads,
        adaptivity: 1.0,
        weight: &|_| 1.0,
        mirror,
    };
    let sharp = sharp_edges(mesh, 40f64.to_radians());
    let rod = rod(mesh, &sharp, &settings, &Progress::none()).unwrap();
    assert_eq!(check_cover(&rod.mesh, &rod.sphere), Ok(()));
    assert!(rod.mesh.n_faces().abs_diff(n_quads) <= rod.n_round / 2 + 1);
    rod
}

/// The share of a quad's worst corner that is left of a right angle.
fn worst(rod: &Rod) -> f64 {
    let quality = |face: &[VertexId]| {
        let p = [0, 1, 2, 3].map(|i| rod.mesh.position(face[i]));
        let normal = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
        let turn = |i: usize| {
            let [a, b] = [p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i]];
            a.normalize_or_zero()
                .cross(b.normalize_or_zero())
                .dot(normal)
        };
        (0..4).map(turn).fold(1.0, f64::min)
    };
    rod.mesh.faces().map(quality).fold(1.0, f64::min)
}

#[test]
fn a_pole_of_few_vertices_keeps_its_edges_straight() {
    for (n, n_quads) in [(8, 120), (4, 200)] {
        let mesh = swept(&straight(2, 80.0), 0.5, n);
        let rod = rod_of(&mesh, n_quads, None);
        assert_eq!(rod.n_round as u32 % n, 0, "{n}");
        assert!(worst(&rod) > 0.5, "{n} {}", worst(&rod));
        for p in rod
            .mesh
            .positions()
            .iter()
            .filter(|p| p.x > 1.0 && p.x < 79.0)
        {
            let near = mesh
                .positions()
                .iter()
                .map(|q| (q.y - p.y).abs() + (q.z - p.z).abs());
            let off = near.fold(f64::INFINITY, f64::min);
            assert!(off < 1e-9 || rod.n_round as u32 > n, "{p}");
        }
        // Rims and edges: two rings, and every step along each edge.
        let steps = (rod.mesh.n_faces()
            - 2 * (rod.n_round / 4) * (rod.n_round / 2 - rod.n_round / 4))
            / rod.n_round;
        assert_eq!(rod.on_lines.len(), 2 * rod.n_round + n as usize * steps);
    }
}

#[test]
fn a_spring_gets_rings_of_even_quads() {
    let mesh = swept(&spring(3.0, 90), 0.5, 12);
    let rod = rod_of(&mesh, 900, None);
    assert!(worst(&rod) > 0.6, "{}", worst(&rod));
    assert!(rod.strips.spiral < 0.02 && rod.strips.loops > 0.4);
    let tree = Bvh::of_mesh(&mesh);
    let far = rod.mesh.positions().iter();
    let far = far.map(|&p| tree.closest(p).distance_squared);
    let far = far.fold(0.0, f64::max).sqrt();
    // The wire is 0.5 thick from its middle.
    assert!(far < 0.06, "{far}");
}

#[test]
fn what_is_no_rod_is_refused() {
    let settings = Settings {
        n_quads: 300,
        adaptivity: 1.0,
        weight: &|_| 1.0,
        mirror: None,
    };
    let refused = |mesh: &TriangleMesh| {
        let sharp = sharp_edges(mesh, 0.7);
        rod(mesh, &sharp, &settings, &Progress::none()).unwrap_err()
    };
    assert!(matches!(
        refused(&shapes::sphere(8)),
        RodError::Short { .. }
    ));
    let plate = shapes::mapped_cube(6, |p| p * DVec3::new(1.0, 1.0, 0.01));
    assert_eq!(refused(&plate), RodError::NoLimb);
    let star = shapes::limbs(2, 12);
    let star = star.with_positions(
        star.positions()
            .iter()
            .map(|p| *p * DVec3::new(9.0, 9.0, 0.4))
            .collect(),
    );
    assert_eq!(refused(&star), RodError::NoLimb);
}
