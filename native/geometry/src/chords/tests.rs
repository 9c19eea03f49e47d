use std::collections::BTreeSet;

use glam::DVec3;

use super::*;
use crate::measure;
use crate::shapes::{CUBE_QUADS, open_tube as tube};

/// A rectangle of `n` by `m` unit squares, its vertices row by row.
fn grid([n, m]: [u32; 2]) -> PolygonMesh {
    let point = |i: u32| DVec3::new(f64::from(i % (n + 1)), f64::from(i / (n + 1)), 0.0);
    let quad = |i: u32| {
        let first = i / n * (n + 1) + i % n;
        [first, first + 1, first + n + 2, first + n + 1]
    };
    let points = (0..(n + 1) * (m + 1)).map(point).collect();
    let quads: Vec<[u32; 4]> = (0..n * m).map(quad).collect();
    PolygonMesh::from_faces(points, &quads).unwrap()
}

fn made(quads: &PolygonMesh, rules: Rules<'_>, most: usize) -> Option<Fewer> {
    fewer(quads, rules, 0..=most, &Progress::none()).unwrap()
}

fn shape(mesh: &PolygonMesh) -> (Option<i64>, usize, usize) {
    let topology = measure::topology(mesh, &Progress::none()).unwrap();
    (topology.genus, topology.n_borders, topology.n_components)
}

#[test]
fn a_rectangle_loses_rows_and_keeps_its_border_and_corners() {
    let mesh = grid([8, 4]);
    for most in [31, 20, 9, 1] {
        let fewer = made(&mesh, Rules::default(), most).unwrap();
        assert!(fewer.quads.n_faces() <= most);
        assert_eq!(shape(&fewer.quads), (Some(0), 1, 1));
        for corner in [0, 8, 36, 44].map(VertexId) {
            let at = fewer.vertex_of[corner.index()];
            assert_eq!(fewer.quads.position(at), mesh.position(corner));
        }
        for p in fewer.quads.positions() {
            assert!((0.0..=8.0).contains(&p.x) && (0.0..=4.0).contains(&p.y));
        }
    }
    assert_eq!(made(&mesh, Rules::default(), 0), None);
}

#[test]
fn no_more_quads_go_than_shall_where_that_can_be() {
    // The shortest way to 25 of 4 × 8 quads is a long row; a column leaves enough.
    let flat = grid([8, 4]);
    let squeezed = flat
        .positions()
        .iter()
        .map(|p| DVec3::new(p.x, 0.5 * p.y, 0.0));
    let mesh = flat.with_positions(squeezed.collect());
    let n = |counts| {
        let made = fewer(&mesh, Rules::default(), counts, &Progress::none());
        made.unwrap().unwrap().quads.n_faces()
    };
    assert_eq!(n(0..=31), 24);
    assert_eq!(n(27..=31), 28);
}

#[test]
fn a_tube_keeps_its_ends_and_a_ring_that_is_a_line() {
    let mesh = tube([12, 6]);
    let ring = |first: u32| -> Vec<[VertexId; 2]> {
        let edge = |i: u32| sorted([first + i, first + (i + 1) % 12]);
        (0..12).map(|i| ids(edge(i))).collect()
    };
    let lines = ring(24);
    let rules = Rules {
        lines: &lines,
        ..Rules::default()
    };
    let fewer = made(&mesh, rules, 20).unwrap();
    assert_eq!(shape(&fewer.quads), (Some(0), 2, 1));
    // The line is still one ring, where it was.
    let on: BTreeSet<VertexId> = fewer.lines.iter().flatten().copied().collect();
    assert_eq!(on.len(), fewer.lines.len());
    assert!(on.len() >= 3);
    for v in on {
        assert!((fewer.quads.position(v).z - 2.0).abs() < 1e-12);
    }
    let heights = fewer.quads.positions().iter().map(|p| p.z);
    let [low, high] = heights.fold([9.0, -9.0], |[a, b], z| [f64::min(a, z), f64::max(b, z)]);
    assert_eq!([low, high].map(f64::to_bits), [0.0, 6.0].map(f64::to_bits));
}

#[test]
fn quads_that_are_their_own_image_stay_so() {
    let mesh = grid([8, 2]);
    let images: Vec<VertexId> = (0..27).map(|i| VertexId(i / 9 * 9 + 8 - i % 9)).collect();
    let rules = Rules {
        images: Some(&images),
        ..Rules::default()
    };
    let fewer = made(&mesh, rules, 9).unwrap();
    let after = fewer.images.unwrap();
    for (v, &image) in after.iter().enumerate() {
        assert_eq!(after[image.index()].index(), v);
        let [p, q] = [fewer.quads.positions()[v], fewer.quads.position(image)];
        assert!((p.x + q.x - 8.0).abs() < 1e-12 && (p.y - q.y).abs() < 1e-12);
    }
}

#[test]
fn the_middle_of_a_lid_stays_where_it_is() {
    // Eight quads round a pole, their outer sides in a ring of sixteen; two rings of quads round them.
    let at = |radius: f64, i: u32| {
        let (sin, cos) = crate::elementary::sin_cos(std::f64::consts::TAU * f64::from(i) / 16.0);
        DVec3::new(radius * cos, radius * sin, 0.0)
    };
    let rings = [1.0, 1.3, 1.6].into_iter();
    let rings = rings.flat_map(|radius| (0..16).map(move |i| at(radius, i)));
    let points: Vec<DVec3> = [DVec3::ZERO].into_iter().chain(rings).collect();
    let lid = (0..8).map(|i| [0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % 16]);
    let ring = |first: u32| {
        (0..16).map(move |i| {
            let next = (i + 1) % 16;
            [first + i, first + 16 + i, first + 16 + next, first + next]
        })
    };
    let quads: Vec<[u32; 4]> = lid.chain(ring(1)).chain(ring(17)).collect();
    let mesh = PolygonMesh::from_faces(points, &quads).unwrap();
    let fewer = made(&mesh, Rules::default(), 20).unwrap();
    assert!(fewer.quads.n_faces() <= 20);
    let pole = fewer.vertex_of[0];
    assert_eq!(fewer.quads.position(pole), DVec3::ZERO);
    assert_eq!(shape(&fewer.quads), (Some(0), 1, 1));
}

#[test]
fn a_cube_of_six_quads_and_what_is_no_quads_cannot_get_fewer() {
    let corner = |i: u32| {
        let bit = |bit: u32| f64::from(i >> bit & 1);
        DVec3::new(bit(0), bit(1), bit(2))
    };
    let cube = PolygonMesh::from_faces((0..8).map(corner).collect(), &CUBE_QUADS).unwrap();
    assert_eq!(made(&cube, Rules::default(), 5), None);
    assert_eq!(made(&cube, Rules::default(), 6).unwrap().quads, cube);
    let triangle = PolygonMesh::from_faces((0..3).map(corner).collect(), &[[0, 1, 2]]).unwrap();
    assert_eq!(made(&triangle, Rules::default(), 1), None);
}
