//! Lines as linear equations on the periods.

use crate::flow::complex::Complex;
use crate::flow::periods::{Part, real_row};
use crate::flow::rings::off_axis;

/// A line is not put onto an axis from which its wish is farther than this share of its length.
const OBLIQUE: f64 = 0.5;

/// The equations that put the lines of a complex with chosen periods along the axes they are
/// wished to be near; none for lines that are wished to be oblique.
pub fn rows(complex: &Complex) -> Vec<Vec<f64>> {
    let lines = 0..complex.chains.n_lines();
    lines.filter_map(|line| row(complex, line)).collect()
}

fn row(complex: &Complex, line: usize) -> Option<Vec<f64>> {
    let wished = complex.sum_along(line, &complex.wish);
    let part: Part = off_axis(wished);
    if part.of(wished).abs() > OBLIQUE * wished.length() {
        return None;
    }
    Some(real_row(&complex.coefficients_along(line), part))
}
