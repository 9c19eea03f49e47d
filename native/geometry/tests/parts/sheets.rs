//! Surfaces that share edges: what goes on there is done, and what ends there is joined to it again.

use glam::DVec3;

use super::mixed::{Mixed, remesh, settings, walled_box};

#[test]
fn a_box_and_the_wall_in_it_are_done() {
    let mesh = walled_box(DVec3::ZERO).mesh();
    let report = remesh(&mesh, &settings(100)).unwrap().report;
    assert_eq!((report.parts.len(), report.kept.len()), (2, 0));
    assert_eq!((report.clean.n_shared_edges, report.clean.n_sheets), (4, 2));
    let told = "4 edges of three or more faces parted into 2 sheets";
    assert!(report.clean.sentences().contains(&told.to_owned()));
    let rejoined = report.rejoined.unwrap();
    assert_eq!(rejoined.n_joined + rejoined.n_left, rejoined.n_shared_lines);
}

/// A wall of 4 x 4 quads with a stem of so many columns of some width.
fn walls(n_stem: u32, width: f64) -> Mixed {
    let mut mixed = Mixed::default();
    let mut points: Vec<[f64; 3]> = Vec::new();
    for x in 0..5 {
        points.extend((0..5).map(|z| [f64::from(x) - 2.0, 0.0, f64::from(z)]));
    }
    for y in 1..=n_stem {
        points.extend((0..5).map(|z| [0.0, width * f64::from(y), f64::from(z)]));
    }
    let quad = |a: u32, b: u32, z: u32| [5 * a + z, 5 * b + z, 5 * b + z + 1, 5 * a + z + 1];
    let columns = (0..4).map(|x| (x, x + 1));
    let stem = (0..n_stem).map(|y| (if y == 0 { 2 } else { 4 + y }, 5 + y));
    let columns: Vec<(u32, u32)> = columns.chain(stem).collect();
    let quads = columns.iter();
    let quads = quads.flat_map(|&(a, b)| (0..4).map(move |z| quad(a, b, z)));
    let quads: Vec<[u32; 4]> = quads.collect();
    let quads: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
    mixed.add_faces(&points, &quads);
    mixed
}

#[test]
fn walls_that_meet_do_so_again() {
    for faces in [40, 60] {
        let result = remesh(&walls(3, 1.0).mesh(), &settings(faces)).unwrap();
        let report = &result.report;
        let rejoined = report.rejoined.unwrap();
        assert_eq!((rejoined.n_shared_lines, rejoined.n_joined), (1, 1));
        assert!(!report.output.manifold);
        assert_eq!(report.output.n_components, 1);
        let told = report.warnings.iter().map(|w| w.text.as_str());
        assert!(
            told.into_iter()
                .all(|text| !text.contains("no longer meet"))
        );
    }
}

#[test]
fn a_stem_that_stays_has_the_vertices_of_the_wall() {
    let mesh = walls(1, 0.05).mesh();
    let result = remesh(&mesh, &settings(60)).unwrap();
    let report = &result.report;
    assert_eq!((report.parts.len(), report.kept.len()), (1, 1));
    assert_eq!(report.rejoined.unwrap().n_left, 0);
    assert_eq!((result.kept_faces, report.output.n_components), (4, 1));
    let places: Vec<DVec3> = mesh.positions().to_vec();
    for face in result.mesh.faces().skip(result.mesh.n_faces() - 4) {
        let corners = face.iter().map(|&v| result.mesh.position(v));
        assert_eq!(corners.filter(|p| places.contains(p)).count(), 4);
    }
}

#[test]
fn boxes_at_an_edge_or_at_a_corner_stay_together() {
    for (at, n_lines) in [([1, 1, 0], 1), ([1, 1, 1], 0)] {
        let mut points: Vec<[u32; 3]> = Vec::new();
        let mut quads: Vec<[u32; 4]> = Vec::new();
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        for from in [[0, 0, 0], at] {
            let corner = |i: u32| [0, 1, 2].map(|k| from[k] + (i >> k & 1));
            let mut name = |i: u32| {
                let found = points.iter().position(|p| *p == corner(i));
                found.unwrap_or_else(|| {
                    points.push(corner(i));
                    points.len() - 1
                }) as u32
            };
            quads.extend(sides.map(|side| side.map(&mut name)));
        }
        let mut boxes = Mixed::default();
        let faces: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
        let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(f64::from)).collect();
        boxes.add_faces(&points, &faces);
        let report = remesh(&boxes.mesh(), &settings(48)).unwrap().report;
        assert_eq!(report.parts.len(), 2);
        let rejoined = report.rejoined.unwrap();
        assert_eq!((rejoined.n_shared_lines, rejoined.n_left), (n_lines, 0));
        assert_eq!(report.output.n_components, 1);
    }
}
