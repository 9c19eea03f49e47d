//! Imposes rings on a metric before its periods are rounded.

use super::{Cylinder, off_axis};
use crate::flow::covariance::DECIDED;
use crate::flow::periods::{Equations, Part, dot};
use crate::flow::rounding::{Rounding, shift};

/// A period is not turned onto an axis from which it is farther than this share of its length.
const OBLIQUE: f64 = 0.6;

/// More rings than this that cannot be reached are a metric that has no room for any.
const MOST_REFUSED: usize = 30;

/// Which rings to impose.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Greed {
    /// How much energy a whole mesh of loops is worth.
    pub worth: f64,
    /// The most rings.
    pub n_most: usize,
}

/// An equation and what it brings.
struct Offer {
    row: Vec<f64>,
    gain: f64,
}

/// Puts cylinders along axes, the one that brings most first; returns how many.
///
/// `scale` is how much larger the rounding's metric is than the one the cylinders were found in.
/// What cannot be reached without a fold is left out.
pub fn impose(rounding: &mut Rounding, pool: &[Cylinder], scale: f64, greed: Greed) -> usize {
    let mut refused: Vec<Vec<f64>> = Vec::new();
    let mut n_set = 0;
    while n_set < greed.n_most && refused.len() < MOST_REFUSED {
        let Some(offer) = best_offer(rounding, pool, [scale, greed.worth], &refused) else {
            break;
        };
        if impose_row(rounding, &offer.row) {
            n_set += 1;
        } else {
            refused.push(offer.row);
        }
    }
    n_set
}

fn best_offer(
    rounding: &Rounding,
    pool: &[Cylinder],
    [scale, worth]: [f64; 2],
    refused: &[Vec<f64>],
) -> Option<Offer> {
    let area = rounding.state.complex.area();
    let offer = |cylinder: &Cylinder| {
        let part: Part = off_axis(cylinder.period);
        if part.of(cylinder.period).abs() > OBLIQUE * cylinder.period.length() {
            return None;
        }
        let row = rounding.equations.reduced(&cylinder.row(part));
        if row.iter().all(|&x| x == 0.0) || refused.contains(&row) {
            return None;
        }
        let variance = rounding.covariance.between(&row, &row);
        let off = dot(&row, &rounding.wish);
        let gain = (worth * cylinder.benefit(scale) - off * off / variance) / area;
        (variance > DECIDED && gain > 0.0).then_some(Offer { row, gain })
    };
    let best = |a: Offer, b: Offer| if b.gain > a.gain { b } else { a };
    pool.iter().filter_map(offer).reduce(best)
}

/// Drags the metric until the equation holds, at least cost; false and unchanged if it cannot be.
pub fn impose_row(rounding: &mut Rounding, row: &[f64]) -> bool {
    let moved = rounding.covariance.times(row);
    let variance = dot(row, &moved);
    let mut equations: Equations = rounding.equations.clone();
    let wish = &rounding.wish;
    let length = |k: usize| wish[k & !1].abs().max(wish[k | 1].abs());
    if !equations.add(row, length) {
        return false;
    }
    let freed = |periods: &[f64]| {
        let mut periods = periods.to_vec();
        let off = dot(row, &periods);
        shift(&mut periods, &moved, -off / variance);
        periods
    };
    let [wish, own] = [freed(&rounding.wish), freed(&rounding.state.periods)];
    if !rounding.take(wish, &own) {
        return false;
    }
    rounding.covariance.decide(&moved, variance);
    rounding.equations = equations;
    true
}
