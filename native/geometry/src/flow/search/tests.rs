//! The search on boxes, of which the best grid is known, and its promises.

use super::*;
use crate::flow::complex::tests::{box_complex, box_mesh};
use crate::flow::strips::strips;
use crate::mesh::{HalfedgeId, TriangleMesh, VertexId};
use crate::progress::CancelToken;

fn settings(n_trials: usize) -> Settings {
    Settings {
        n_trials,
        ..Settings::default()
    }
}

#[test]
fn a_box_of_its_own_size_is_kept() {
    // Nothing is better than no spiral, every section a loop, exactly the wish.
    let whole = quantise(box_complex(1), 376, &settings(20), &Progress::none()).unwrap();
    let score = whole.report.score;
    assert_eq!(score.n_quads, 376);
    assert!(score.energy < 1e-12);
    assert!((score.loops - 656.0 / 752.0).abs() < 1e-12);
    assert_eq!((score.n_doubled, whole.grid.quads.len()), (0, 376));
}

#[test]
fn other_counts_are_met_and_told_truly() {
    for n_quads in [60, 500, 1100] {
        let whole = quantise(box_complex(1), n_quads, &settings(60), &Progress::none()).unwrap();
        let score = whole.report.score;
        assert_eq!(score.n_quads, whole.grid.quads.len());
        assert!(score.count_error < 0.06, "{score:?}");
        assert_eq!(whole.grid.n_vertices, score.n_quads + 2);
        let read = strips(&whole.grid.quads, whole.grid.n_vertices).unwrap();
        assert!((read.spiral - score.spiral).abs() < 1e-12);
        assert!((read.loops - score.loops).abs() < 1e-12);
        assert_eq!(whole.complex.check(), Ok(()));
    }
}

/// The edges round the sides of a box at the end of an axis, each a line of its own.
fn rim(mesh: &TriangleMesh, axis: usize) -> Vec<HalfedgeId> {
    let end = mesh.positions().iter().map(|p| p[axis]).fold(0.0, f64::max);
    let is_at = |v: VertexId| mesh.position(v)[axis] > end - 1e-9;
    let is_rim = |h: &HalfedgeId| {
        let ends = [mesh.origin(*h), mesh.target(*h)];
        let apex = mesh.origin(h.prev());
        let is_straight = (mesh.position(ends[0]) - mesh.position(ends[1])).abs();
        let n_axes = (0..3).filter(|&k| is_straight[k] > 1e-9).count();
        ends.into_iter().all(is_at) && is_at(apex) && n_axes == 1
    };
    mesh.halfedge_ids().filter(is_rim).collect()
}

#[test]
fn loops_that_are_twins_get_equally_long() {
    let mesh = box_mesh(1);
    let rims = [rim(&mesh, 0), rim(&mesh, 2)];
    for are_twins in [false, true] {
        let mut complex = box_complex(1);
        let lines: Vec<_> = rims.iter().flatten().map(|&h| vec![h]).collect();
        complex.follow_lines(&lines);
        let loops = [(0..4).collect(), (4..8).collect()];
        complex.chains.twins = if are_twins { vec![loops] } else { Vec::new() };
        let whole = quantise(complex, 376, &settings(20), &Progress::none()).unwrap();
        let lengths = (0..8).map(|line| whole.complex.sum_along(line, &whole.complex.start));
        let lengths: Vec<f64> = lengths.map(|sum| sum.abs().max_element()).collect();
        let [x, z]: [f64; 2] = [lengths[..4].iter().sum(), lengths[4..].iter().sum()];
        // 8 by 6 round the end of the long axis, 10 by 8 round that of the short one.
        let wanted = if are_twins { x } else { 36.0 };
        assert!(
            (z - wanted).abs() < 1e-9 && (are_twins || x < 29.0),
            "{x} {z}"
        );
        assert!(
            whole.report.score.count_error < 0.06,
            "{:?}",
            whole.report.score
        );
    }
}

#[test]
fn the_same_search_finds_the_same_grid() {
    let run = || quantise(box_complex(1), 300, &settings(40), &Progress::none()).unwrap();
    let [one, other] = [run(), run()];
    assert_eq!(one.grid, other.grid);
    assert_eq!(one.report, other.report);
}

#[test]
fn a_cancelled_search_says_so() {
    let token = CancelToken::new();
    token.cancel();
    let found = quantise(box_complex(1), 300, &settings(5), &Progress::silent(token));
    assert!(matches!(found, Err(QuantiseError::Cancelled(_))));
}
