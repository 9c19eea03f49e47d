//! Whole moves of periods that keep the rings there are.

use crate::flow::covariance::Dense;
use crate::flow::periods::{Equations, Periods, common_divisor, dot, is_unit};
use crate::flow::rounding::shift;

/// A variance below this is 0: the row follows from those that are kept.
const FOLLOWS: f64 = 1e-7;

/// The whole moves that keep a set of equations.
#[derive(Clone, Debug)]
pub struct Lattice {
    covariance: Dense,
    equations: Equations,
}

impl Lattice {
    /// The moves that keep the given rows, as far as these are independent.
    pub fn keeping(covariance: &Dense, rows: &[Vec<f64>]) -> Self {
        let mut lattice = Self {
            covariance: covariance.clone(),
            equations: Equations::default(),
        };
        for row in rows {
            let row = lattice.equations.reduced(row);
            let moved = lattice.covariance.times(&row);
            let variance = dot(&row, &moved);
            if variance < FOLLOWS {
                continue;
            }
            if lattice.equations.add(&row, |k| covariance.at(k, k)) {
                lattice.covariance.decide(&moved, variance);
            }
        }
        lattice
    }

    /// The move nearest to `mean` in energy with row · move = `value`; none if there is none or
    /// it is 0.
    ///
    /// Components are made whole one after the other, the most certain first, and the others
    /// follow; the pivots of the equations come last and are exact.
    pub fn move_by(&self, row: &[f64], value: f64, mean: &[f64]) -> Option<Periods> {
        let row = self.equations.reduced(row);
        let divisor = common_divisor(&row)?;
        let row: Vec<f64> = row.iter().map(|x| (x / divisor).round()).collect();
        let value = value / divisor;
        let moved = self.covariance.times(&row);
        let variance = dot(&row, &moved);
        if variance < FOLLOWS || (value - value.round()).abs() > 1e-9 {
            return None;
        }
        let n = row.len();
        let units = (0..n).filter(|&k| is_unit(row[k]) && !self.equations.is_pivot(k));
        let pivot = units.max_by(|&a, &b| {
            self.covariance
                .at(a, a)
                .total_cmp(&self.covariance.at(b, b))
                .then(b.cmp(&a))
        })?;
        let mut step = mean.to_vec();
        let miss = value - dot(&row, &step);
        shift(&mut step, &moved, miss / variance);
        let mut covariance = self.covariance.clone();
        covariance.decide(&moved, variance);
        let free = (0..n).filter(|&k| k != pivot && !self.equations.is_pivot(k));
        make_whole(&mut step, covariance, free.collect());
        step[pivot] = 0.0;
        step[pivot] = (value - dot(&row, &step)) * row[pivot];
        self.equations.solve(&mut step);
        step.iter().any(|&x| x != 0.0).then_some(step)
    }
}

/// Rounds the free components, the most certain first; the rest is rounded where it stands.
fn make_whole(step: &mut [f64], mut covariance: Dense, mut free: Vec<usize>) {
    let doubt = |step: &[f64], covariance: &Dense, k: usize| {
        let off = step[k] - step[k].round();
        off * off / covariance.at(k, k).max(1e-12)
    };
    while !free.is_empty() {
        let mut best = 0;
        let mut least = f64::INFINITY;
        for (i, &k) in free.iter().enumerate() {
            let doubt = doubt(step, &covariance, k);
            if doubt < least {
                (best, least) = (i, doubt);
            }
        }
        let k = free.remove(best);
        let variance = covariance.at(k, k);
        if variance > 1e-9 {
            let moved = covariance.column(k).to_vec();
            let off = step[k].round() - step[k];
            if off != 0.0 {
                shift(step, &moved, off / variance);
            }
            covariance.decide(&moved, variance);
        }
        step[k] = step[k].round();
    }
    for x in step {
        *x = x.round();
    }
}
