use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::measure::{Topology, topology};
use crate::mesh::{Id, PolygonMesh};
use crate::random::Random;
use crate::shapes;

/// A ball with tubes between random faces and some faces missing; no two of all these touch.
pub(super) fn bridged((n, seed): (u32, u64), n_bridges: usize, n_missing: usize) -> TriangleMesh {
    let ball = shapes::blob(seed, n);
    let mut random = Random::new(seed);
    let mut near = BTreeSet::new();
    let mut chosen = Vec::new();
    for _ in 0..2000 {
        let face = FaceId::from_index(random.below(ball.n_faces()));
        let corners = ball.face(face);
        if chosen.len() < 2 * n_bridges + n_missing && corners.iter().all(|v| !near.contains(v)) {
            near.extend(corners.iter().flat_map(|&v| ball.neighbours(v)));
            chosen.push(face);
        }
    }
    let kept = ball.face_ids().filter(|face| !chosen.contains(face));
    let mut faces: Vec<_> = kept.map(|face| ball.face(face)).collect();
    for pair in chosen[..2 * n_bridges].chunks(2) {
        let [[a, b, c], [p, q, r]] = [ball.face(pair[0]), ball.face(pair[1])];
        for [a, b, c, d] in [[a, b, r, p], [b, c, q, r], [c, a, p, q]] {
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleMesh::new(ball.positions().to_vec(), faces).unwrap()
}

fn shape(mesh: &TriangleMesh) -> Topology {
    topology_of_triangles(mesh)
}

fn length(mesh: &TriangleMesh, line: &[VertexId]) -> f64 {
    let next = line.iter().cycle().skip(1);
    let edges = line.iter().zip(next);
    edges
        .map(|(&a, &b)| mesh.position(a).distance(mesh.position(b)))
        .sum()
}

/// Checks all that is promised of a cut.
fn check(mesh: &TriangleMesh, cut: &Cut) {
    let [before, after] = [shape(mesh), shape(&cut.mesh)];
    let genus = before.genus.unwrap() as usize;
    assert_eq!((after.genus, after.n_components), (Some(0), 1));
    assert_eq!(after.n_borders, before.n_borders + 2 * genus);
    assert_eq!(cut.twins.len(), genus);
    let mut passed = BTreeSet::new();
    for [right, left] in &cut.twins {
        assert_eq!(right.len(), left.len());
        for (v, w) in right.iter().zip(left) {
            assert_eq!(cut.mesh.position(*v), cut.mesh.position(*w));
            assert!(passed.insert(*v) && passed.insert(*w));
            assert!(cut.mesh.is_border(*v) && cut.mesh.is_border(*w));
        }
    }
    // Pieces make up their faces.
    let mut areas = vec![DVec3::ZERO; mesh.n_faces()];
    for face in cut.mesh.face_ids() {
        areas[cut.source[face].index()] += crate::measure::area_vector(cut.mesh.triangle(face));
    }
    for face in mesh.face_ids() {
        assert_eq!(cut.source[face], face);
        let area = crate::measure::area_vector(mesh.triangle(face));
        assert!((areas[face.index()] - area).length() < 1e-9 * (1.0 + area.length()));
    }
    for h in cut.mesh.halfedge_ids() {
        assert!(cut.sides[h].is_none_or(|side| side.face() == cut.source[h.face()]));
    }
    let welded = weld(&PolygonMesh::from(&cut.mesh), &cut.twins).unwrap();
    let again = topology(&welded.mesh, &Progress::none()).unwrap();
    assert!(
        again.is_alike(&Topology {
            n_quads: 0,
            ..before
        }),
        "{again:?} {before:?}"
    );
}

fn cut_of(mesh: &TriangleMesh) -> Cut {
    cut(mesh, &Progress::none()).unwrap()
}

#[test]
fn a_torus_is_cut_round_its_tube() {
    for (n, m) in [(3, 3), (4, 3), (3, 7), (24, 12), (60, 24)] {
        let torus = shapes::torus(n, m);
        let cut = cut_of(&torus);
        check(&torus, &cut);
        let round = length(&cut.mesh, &cut.twins[0][0]);
        let tube = std::f64::consts::TAU * 0.4;
        assert!(round < 1.02 * tube, "{n} x {m}: {round} of {tube}");
    }
}

#[test]
fn a_torus_of_wavy_rings_is_cut_straight() {
    // Rings that wave: the edges round the tube go to and fro along it.
    let torus = shapes::torus(60, 20);
    let bent = torus.positions().iter().enumerate().map(|(i, _)| {
        let [ring, at] = [i / 20, i % 20].map(|k| k as f64);
        let turn = at / 20.0 * std::f64::consts::TAU;
        let along = (ring + 1.5 * crate::elementary::sin(3.0 * turn)) / 60.0;
        let (s, c) = crate::elementary::sin_cos(along * std::f64::consts::TAU);
        let (z, r) = crate::elementary::sin_cos(turn);
        DVec3::new(c * (1.0 + 0.4 * r), s * (1.0 + 0.4 * r), 0.4 * z)
    });
    let bent = torus.with_positions(bent.collect());
    let cut = cut_of(&bent);
    check(&bent, &cut);
    let round = length(&cut.mesh, &cut.twins[0][0]);
    assert!(round < 1.01 * std::f64::consts::TAU * 0.4, "{round}");
}

#[test]
fn a_mesh_without_handles_stays_as_it_is() {
    let ball = shapes::sphere(4);
    let some = ball.faces().iter().skip(9).copied();
    let (open, _) = TriangleMesh::of_faces(ball.positions(), some).unwrap();
    for mesh in [ball, open] {
        let cut = cut_of(&mesh);
        assert!(cut.twins.is_empty());
        assert_eq!(cut.mesh, mesh);
        assert_eq!(short_loop(&mesh), None);
    }
}

#[test]
fn two_components_are_refused() {
    let [a, b] = [shapes::torus(5, 4), shapes::torus(4, 5)];
    let shift = a.n_vertices() as u32;
    let moved = b.faces().iter().map(|f| f.map(|v| VertexId(v.0 + shift)));
    let faces = a.faces().iter().copied().chain(moved).collect();
    let both = TriangleMesh::new([a.positions(), b.positions()].concat(), faces).unwrap();
    let error = cut(&both, &Progress::none()).unwrap_err();
    assert_eq!(error.to_string(), "2 components; handles are cut of one");
}

#[test]
fn a_cancelled_cut_says_so() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let result = cut(&shapes::torus(6, 6), &Progress::silent(token));
    assert_eq!(result, Err(Error::Cancelled(Cancelled)));
}

#[test]
fn huge_and_tiny_coordinates_are_cut_too() {
    for scale in [1e-300, 1e-30, 1e30, 1e300] {
        let torus = shapes::torus(9, 6);
        let scaled = torus.positions().iter().map(|&p| p * scale).collect();
        let cut = cut_of(&torus.with_positions(scaled));
        assert_eq!(shape(&cut.mesh).genus, Some(0), "{scale}");
    }
    let flat = shapes::torus(5, 4).with_positions(vec![DVec3::ONE; 20]);
    assert_eq!(shape(&cut_of(&flat).mesh).genus, Some(0));
}

/// A torus of n × m quads, cut open between its last and its first ring.
fn open_torus(n: u32, m: u32) -> (PolygonMesh, [Vec<VertexId>; 2]) {
    let torus = shapes::torus(n, m);
    let ring = |i: u32| (i * m..(i + 1) * m).map(VertexId);
    let positions = torus.positions().iter().copied();
    let positions = positions.chain(ring(0).map(|v| torus.position(v) + 0.01 * DVec3::Y));
    let quads: Vec<[u32; 4]> = (0..n)
        .flat_map(|i| {
            let next = |j: u32| (j + 1) % m;
            (0..m).map(move |j| {
                [
                    i * m + j,
                    (i + 1) * m + j,
                    (i + 1) * m + next(j),
                    i * m + next(j),
                ]
            })
        })
        .collect();
    let open = PolygonMesh::from_faces(positions.collect(), &quads).unwrap();
    (open, [ring(0).collect(), ring(n).collect()])
}

#[test]
fn an_opened_torus_of_quads_is_welded_to_what_it_was() {
    let (open, [first, mut last]) = open_torus(12, 7);
    last.rotate_left(3);
    let chains = [first, last];
    let welded = weld(&open, std::slice::from_ref(&chains)).unwrap();
    let shape = topology(&welded.mesh, &Progress::none()).unwrap();
    assert_eq!(
        (shape.genus, shape.manifold, shape.closed),
        (Some(1), true, true)
    );
    assert_eq!((shape.n_vertices, shape.n_quads), (84, 84));
    let torus = shapes::torus(12, 7);
    for (i, v) in (0..84).map(VertexId).enumerate() {
        let moved = if i < 7 { 0.005 * DVec3::Y } else { DVec3::ZERO };
        assert!(welded.mesh.position(v).distance(torus.position(v) + moved) < 1e-12);
        assert_eq!(welded.vertices[v], v);
    }
    assert_eq!(welded.vertices[VertexId(84 + 3)], VertexId(3));
}

#[test]
fn borders_that_do_not_fit_are_not_welded() {
    let (open, [first, last]) = open_torus(12, 7);
    let message = |chains: [Vec<VertexId>; 2]| weld(&open, &[chains]).unwrap_err().to_string();
    let short = last[1..].to_vec();
    assert_eq!(
        message([first.clone(), short]),
        "the borders of cut 0 have 7 and 6 vertices"
    );
    let back = last.iter().rev().copied().collect();
    assert!(message([first.clone(), back]).contains("the borders of cut 0 do not fit"));
    let twice = first.clone();
    assert_eq!(
        message([first, twice]),
        "vertex 0 is passed twice by the borders of cuts"
    );
}

#[test]
fn a_sharp_rim_near_by_is_cut_rather_than_the_shortest_way() {
    // A ring of square section, 1 by 1, about a hole of radius 0.7: its inner rims are 4.4 long.
    let [n, m] = [96, 32];
    let corner = |j: u32| {
        let [side, along] = [j / 8, j % 8].map(f64::from);
        let along = along / 8.0;
        [
            [0.0, along],
            [along, 1.0],
            [1.0, 1.0 - along],
            [1.0 - along, 0.0],
        ][side as usize]
    };
    let points = (0..n * m).map(|i| {
        let [r, z] = corner(i % m);
        let turn = f64::from(i / m) / f64::from(n) * std::f64::consts::TAU;
        let (s, c) = crate::elementary::sin_cos(turn);
        DVec3::new(c * (0.7 + r), s * (0.7 + r), z)
    });
    let ring = shapes::torus(n, m).with_positions(points.collect());
    let cut = cut_of(&ring);
    check(&ring, &cut);
    assert_eq!(cut.mesh.n_faces(), ring.n_faces());
    let rim = length(&cut.mesh, &cut.twins[0][0]);
    assert!((rim - 0.7 * std::f64::consts::TAU).abs() < 0.01, "{rim}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn handles_are_cut_whatever_the_surface(
        n in 2_u32..9,
        seed in 0_u64..1000,
        n_bridges in 1_usize..5,
        n_missing in 0_usize..4,
    ) {
        let n = n.max(2 + n_bridges as u32);
        let mesh = bridged((n, seed), n_bridges, n_missing);
        prop_assert_eq!(shape(&mesh).genus, Some(n_bridges as i64));
        let cut = cut_of(&mesh);
        check(&mesh, &cut);
        prop_assert_eq!(cut_of(&mesh), cut);
    }
}
