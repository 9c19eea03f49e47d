//! The search on boxes, of which the best grid is known, and its promises.

use super::*;
use crate::flow::complex::tests::box_complex;
use crate::flow::strips::strips;
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
