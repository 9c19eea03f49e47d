//! Whole moves of periods that keep the rings there are.

use crate::flow::covariance::Dense;
use crate::flow::periods::{Equations, Periods, common_divisor, dot, is_unit};
use crate::flow::rounding::shift;

/// A variance below this is 0: the row follows from those that are kept.
const FOLLOWS: f64 = 1e-7;

/// How many components of a move are weighed; the others, which would hardly move, stay. 48 give
/// no better moves, only slower ones.
const MOST_MOVED: usize = 12;

/// The whole moves that keep a set of equations.
#[derive(Clone, Debug)]
pub struct Lattice {
    covariance: Dense,
    /// The energy of the components that are no pivots, which these follow.
    energy: Dense,
    equations: Equations,
}

impl Lattice {
    /// The moves that keep the given rows, as far as these are independent.
    pub fn keeping(energy: &Dense, covariance: &Dense, rows: &[Vec<f64>]) -> Self {
        let mut own = covariance.clone();
        let mut equations = Equations::default();
        for row in rows {
            let row = equations.reduced(row);
            let moved = own.times(&row);
            let variance = dot(&row, &moved);
            if variance < FOLLOWS {
                continue;
            }
            if equations.add(&row, |k| covariance.at(k, k)) {
                own.decide(&moved, variance);
            }
        }
        let mut energy = energy.clone();
        for (row, pivot) in equations.rows() {
            energy.follow(row, pivot);
        }
        Self {
            covariance: own,
            energy,
            equations,
        }
    }

    /// The move of least energy with row · move = `value`; none if there is none or it is 0.
    ///
    /// Of the move over the reals the larger components are made whole one after the other, the
    /// most certain first, and the others of these follow; the rest is 0. The pivots of the
    /// equations come last and are exact.
    pub fn move_by(&self, row: &[f64], value: f64) -> Option<Periods> {
        let row = self.equations.reduced(row);
        let divisor = common_divisor(&row)?;
        let row: Vec<f64> = row.iter().map(|x| (x / divisor).round()).collect();
        let value = value / divisor;
        let moved = self.covariance.times(&row);
        if dot(&row, &moved) < FOLLOWS || (value - value.round()).abs() > 1e-9 {
            return None;
        }
        let is_free = |&k: &usize| !self.equations.is_pivot(k);
        let free: Vec<usize> = (0..row.len()).filter(is_free).collect();
        let units = free.iter().copied().filter(|&k| is_unit(row[k]));
        let variance = |k: usize| self.covariance.at(k, k);
        let pivot = units.max_by(|&a, &b| variance(a).total_cmp(&variance(b)).then(b.cmp(&a)))?;
        let mut largest: Vec<usize> = free.into_iter().filter(|&k| k != pivot).collect();
        largest.sort_by(|&a, &b| moved[b].abs().total_cmp(&moved[a].abs()).then(a.cmp(&b)));
        largest.truncate(MOST_MOVED);
        let mut step = vec![0.0; row.len()];
        let whole = self.whole(&row, pivot, value, &largest);
        for (k, whole) in largest.iter().zip(whole) {
            step[*k] = whole;
        }
        step[pivot] = (value - dot(&row, &step)) * row[pivot];
        self.equations.solve(&mut step);
        step.iter().any(|&x| x != 0.0).then_some(step)
    }

    /// Whole values of some components at little energy, where `pivot` sees to row · move = `value`.
    fn whole(&self, row: &[f64], pivot: usize, value: f64, some: &[usize]) -> Vec<f64> {
        let at = |i: usize, j: usize| self.energy.at(i, j);
        let follow: Vec<f64> = some.iter().map(|&k| -row[pivot] * row[k]).collect();
        let with_pivot = |i: usize| at(some[i], pivot) + follow[i] * at(pivot, pivot);
        let energy = Dense::from_fn(some.len(), |i, j| {
            let own = at(some[i], some[j]) + follow[i] * at(pivot, some[j]);
            own + follow[j] * with_pivot(i)
        });
        let pull: Vec<f64> = (0..some.len())
            .map(|i| -value * row[pivot] * with_pivot(i))
            .collect();
        let covariance = energy.inverse();
        let mut step = covariance.times(&pull);
        make_whole(&mut step, covariance, (0..some.len()).collect());
        step
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
