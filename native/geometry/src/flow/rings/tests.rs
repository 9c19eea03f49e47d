//! The bands of a box, whose periods and widths are known.

use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::flow::complex::tests::box_complex;
use crate::flow::covariance::Dense;
use crate::flow::drag::State;
use crate::flow::lines::trace;
use crate::flow::periods::{choose, dot};
use crate::flow::rounding::Rounding;
use crate::random::Random;

const REACH: Reach = Reach {
    longest: 40.0,
    narrowest: 1.0,
    angle: 0.05,
    aside: f64::INFINITY,
    n_crossed: 40,
};

/// The box of 10 × 8 × 6 with its periods chosen.
fn boxed() -> State {
    let mut complex = box_complex(1);
    let basis = choose(&mut complex).unwrap();
    State::new(&complex, basis.start)
}

/// The box with every period moved by up to half of `range`.
fn shaken(seed: u64, range: f64) -> State {
    let mut state = boxed();
    let mut random = Random::new(seed);
    let moved: Vec<f64> = (state.periods.iter())
        .map(|x| x + range * (random.unit() - 0.5))
        .collect();
    assert_eq!(state.drag(&moved, 0.1), 1.0);
    state
}

/// The vector that coefficients make of periods.
fn evaluate(coefficients: &[IVec2], periods: &[f64]) -> DVec2 {
    let parts = [Part::Real, Part::Imaginary].map(|part| real_row(coefficients, part));
    parts.map(|row| dot(&row, periods)).into()
}

#[test]
fn a_box_has_three_bands() {
    let state = boxed();
    let found = cylinders(&state.complex, &REACH);
    let mut figures: Vec<[i64; 2]> = found
        .iter()
        .map(|c| [c.period.length().round() as i64, c.width.round() as i64])
        .collect();
    figures.sort_unstable();
    assert_eq!(figures, [[28, 10], [32, 8], [36, 6]]);
    for c in &found {
        assert!(evaluate(&c.coefficients, &state.periods).distance(c.period) < 1e-9);
    }
}

#[test]
fn the_bands_of_a_box_add_up_to_its_loops() {
    let state = boxed();
    let bands = cylinders(&state.complex, &REACH);
    let share: f64 = bands.iter().map(|c| c.benefit(1.0)).sum::<f64>() / state.complex.area();
    assert!((trace(&state.complex).loops - share).abs() < 1e-12);
}

#[test]
fn periods_found_in_a_shaken_box_are_sums_of_its_periods() {
    for seed in 0..5 {
        let state = shaken(seed, 0.8);
        let reach = Reach {
            angle: FRAC_PI_2,
            n_crossed: 20,
            ..REACH
        };
        let found = cylinders(&state.complex, &reach);
        assert!(!found.is_empty());
        for c in found {
            assert!(evaluate(&c.coefficients, &state.periods).distance(c.period) < 1e-9);
        }
    }
}

#[test]
fn imposed_rings_close_after_rounding() {
    for seed in 0..5 {
        let state = shaken(seed, 0.8);
        let reach = Reach {
            angle: 0.2,
            ..REACH
        };
        let pool = cylinders(&state.complex, &reach);
        let covariance = Dense::energy(&state.complex).inverse();
        let wish = state.periods.clone();
        let mut rounding = Rounding::new(state, wish, covariance);
        let greed = Greed {
            worth: 1.0,
            n_most: 10,
        };
        assert!(impose(&mut rounding, &pool, 1.0, greed) > 0);
        let rows = rounding.equations.clone();
        let rounded = rounding.round().unwrap();
        let mut solved = rounded.periods.clone();
        rows.solve(&mut solved);
        assert_eq!(solved, rounded.periods);
        assert!(rounded.complex.start.iter().all(|v| *v == v.round()));
        assert_eq!(rounded.complex.check(), Ok(()));
    }
}

#[test]
fn moves_of_the_lattice_keep_its_rings() {
    let state = boxed();
    let bands = cylinders(&state.complex, &REACH);
    let rows: Vec<Vec<f64>> = bands.iter().map(|c| c.row(off_axis(c.period))).collect();
    let energy = Dense::energy(&state.complex);
    let lattice = Lattice::keeping(&energy, &energy.inverse(), &rows);
    let n = state.periods.len();
    let mut n_found = 0;
    for k in 0..n {
        let mut row = vec![0.0; n];
        row[k] = 1.0;
        let Some(step) = lattice.move_by(&row, 1.0) else {
            continue;
        };
        n_found += 1;
        assert_eq!(step[k], 1.0);
        assert!(step.iter().all(|x| x.fract() == 0.0));
        assert!(rows.iter().all(|row| dot(row, &step) == 0.0));
    }
    assert!(n_found > 0);
}

#[test]
fn segments_lead_from_cone_to_cone() {
    for seed in 0..5 {
        let state = shaken(seed, 0.8);
        for segment in segments(&state.complex, 20.0, 2.0) {
            let vector = evaluate(&segment.coefficients, &state.periods);
            assert!(vector.distance(segment.vector) < 1e-9);
        }
    }
}
