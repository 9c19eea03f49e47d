//! The learning rate of each step: one cycle, up in a straight line and down by a cosine.

use std::f64::consts::PI;

use orbflow_geometry::elementary::cos;

/// The share of the steps on which the rate rises.
const RISE: f64 = 0.1;
/// What the rate starts and ends with, as a share of the highest.
const LEAST: f64 = 0.01;

/// The rate of step `step` of `n_steps`, counted from 0.
pub fn one_cycle(step: usize, n_steps: usize, highest: f64) -> f64 {
    let share = step as f64 / n_steps.max(1) as f64;
    let height = if share < RISE {
        share / RISE
    } else {
        0.5 + 0.5 * cos(PI * (share - RISE) / (1.0 - RISE))
    };
    highest * (LEAST + (1.0 - LEAST) * height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_rises_falls_and_ends_low() {
        let rates: Vec<f64> = (0..=1000).map(|step| one_cycle(step, 1000, 2e-3)).collect();
        assert!(rates[..=100].is_sorted() && rates[100..].is_sorted_by(|a, b| a >= b));
        assert!((rates[100] - 2e-3).abs() < 1e-12);
        assert!((rates[1000] - 2e-5).abs() < 1e-12);
    }
}
