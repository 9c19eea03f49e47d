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

/// A wall of 4 x 4 quads with a stem of so many columns.
fn walls(n_stem: u32) -> Mixed {
    let mut mixed = Mixed::default();
    let mut points: Vec<[f64; 3]> = Vec::new();
    for x in 0..5 {
        points.extend((0..5).map(|z| [f64::from(x) - 2.0, 0.0, f64::from(z)]));
    }
    for y in 1..=n_stem {
        points.extend((0..5).map(|z| [0.0, f64::from(y), f64::from(z)]));
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
fn walls_that_meet_do_so_again_or_are_told() {
    for faces in [40, 60] {
        let result = remesh(&walls(3).mesh(), &settings(faces)).unwrap();
        let report = &result.report;
        let rejoined = report.rejoined.unwrap();
        assert_eq!(rejoined.n_shared_lines, 1);
        assert_eq!(rejoined.n_joined + rejoined.n_left, 1);
        let is_told = report
            .warnings
            .iter()
            .any(|w| w.text.contains("no longer meet"));
        assert_eq!(is_told, rejoined.n_left == 1);
        assert_eq!(report.output.n_components, 1 + rejoined.n_left);
        assert_eq!(report.output.manifold, rejoined.n_joined == 0);
    }
}
