//! Chooses whole periods: the count of quads exact, spirals few, loops many, near the wish.
//!
//! Low-energy roundings are not the ones with good loops, and a trial is cheap because no
//! geometry is involved: the area of the metric is the number of quads. So many roundings at
//! slightly different scales are scored, and the best is improved by small moves. Trials are
//! counted, never timed: the result is the same on every machine.

mod local;
mod moves;
mod score;
mod starts;

use thiserror::Error;

use super::complex::Complex;
use super::covariance::Dense;
use super::creases::{self, Firm, Row};
use super::drag::{SHORT, State};
use super::grid::{self, Grid, NotReadable};
use super::periods::{self, NotASphere, Periods, dot};
use super::rings::impose_row;
use super::rounding::Rounding;
use super::strips::doubled_edges;
use crate::progress::{Cancelled, Progress};

use score::relative_error;
pub use score::{Score, Weights};

/// What the search may do and what it looks for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Settings {
    /// How many small moves are tried after the roundings.
    pub n_trials: usize,
    /// What makes a grid good.
    pub weights: Weights,
    /// Starts the random choice of moves.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            n_trials: 800,
            weights: Weights::default(),
            seed: 1,
        }
    }
}

/// What was reached.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Report {
    /// How good the grid is.
    pub score: Score,
    /// How many roundings and moves were scored.
    pub n_trials: usize,
    /// How many roundings got stuck.
    pub n_stuck: usize,
}

/// A flat metric with whole periods, and its unit grid.
#[derive(Clone, Debug)]
pub struct Quantised {
    /// The metric: `start` is whole, `wish` in units of one edge of the grid.
    pub complex: Complex,
    /// Its grid, all of it quads.
    pub grid: Grid,
    /// How many quads it should have, so that those that count are as many as wanted.
    pub n_wanted: usize,
    /// What was reached.
    pub report: Report,
}

/// Why a metric got no whole periods.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum QuantiseError {
    /// The complex is not one sphere.
    #[error(transparent)]
    NotASphere(#[from] NotASphere),
    /// Every rounding met cones that would have to coincide.
    #[error("none of {n_tried} roundings of {n_periods} periods could be reached")]
    Stuck {
        /// How many were tried.
        n_tried: usize,
        /// How many Gaussian integers were to be found.
        n_periods: usize,
    },
    /// The grid of whole periods could not be read.
    #[error(transparent)]
    Unreadable(#[from] NotReadable),
    /// The user stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Gives a flat cone metric whole periods near its wish, so that its grid has `n_quads` quads.
///
/// The complex must be compact, as [`super::cones::keep_cones`] leaves it. Keeps its topology
/// and cone angles; located points follow. Costs a few hundred roundings and drags of the reduced
/// complex, about a second for a hundred cones.
///
/// # Errors
/// See [`QuantiseError`].
pub fn quantise(
    mut complex: Complex,
    n_quads: usize,
    settings: &Settings,
    progress: &Progress,
) -> Result<Quantised, QuantiseError> {
    let n_periods = complex.n_vertices().saturating_sub(2);
    if n_periods > FEW_PERIODS && n_periods * QUADS_PER_PERIOD > n_quads {
        let n_tried = 0;
        return Err(QuantiseError::Stuck { n_tried, n_periods });
    }
    let problem = Problem::new(&mut complex, n_quads, settings)?;
    let found = starts::round_at_scales(&problem, &progress.part("", 0.0, 0.4))?;
    let mut n_trials = found.n_tried - found.n_stuck;
    let best = found.best.ok_or(QuantiseError::Stuck {
        n_tried: found.n_tried,
        n_periods: problem.wish.len() / 2,
    })?;
    let best = local::improve(&problem, best, &progress.part("", 0.4, 1.0))?;
    n_trials += settings.n_trials;
    best.state.replay(&mut complex);
    for h in complex.halfedge_ids() {
        complex.wish[h] = complex.coefficients.value(h, &problem.wish);
    }
    Ok(Quantised {
        grid: grid::read(&complex)?,
        complex,
        n_wanted: best.n_wanted.round() as usize,
        report: Report {
            score: best.score,
            n_trials,
            n_stuck: found.n_stuck,
        },
    })
}

/// So many periods are always tried.
const FEW_PERIODS: usize = 200;
/// And of more one for so many quads: with less room every rounding gets stuck.
const QUADS_PER_PERIOD: usize = 4;

/// A line is given up if to put it along an axis costs more energy than this.
const DEAREST: f64 = 0.01;

/// What all trials share.
struct Problem<'a> {
    /// The metric at its start, dragged to where the equations of the lines hold.
    start: Rounding,
    /// The wanted periods, scaled so that the wish has the wanted area.
    wish: Periods,
    /// The equations of the ties, twins and lines that are kept.
    lines: Vec<Vec<f64>>,
    /// The energy as a square form of periods.
    energy: Dense,
    /// Its inverse.
    covariance: Dense,
    n_quads: f64,
    /// Lines that must be straight ways.
    firm: Firm,
    settings: &'a Settings,
}

/// A metric with whole periods and how good it is.
#[derive(Clone)]
struct Candidate {
    state: State,
    score: Score,
    /// How many quads it should have, so that those that count are as many as wanted.
    n_wanted: f64,
}

impl<'a> Problem<'a> {
    fn new(
        complex: &mut Complex,
        n_quads: usize,
        settings: &'a Settings,
    ) -> Result<Self, NotASphere> {
        let basis = periods::choose(complex)?;
        let start = State::new(complex, basis.start);
        let mut dragged = start.clone();
        dragged.drag(&basis.wish, SHORT);
        let n_quads = n_quads as f64;
        let scale = (n_quads / dragged.complex.area()).sqrt();
        let energy = Dense::energy(&dragged.complex);
        let covariance = energy.inverse();
        let wish = basis.wish.iter().map(|x| x * scale).collect();
        let mut start = Rounding::new(start, wish, covariance.clone());
        let mut kept = creases::tie_rows(complex);
        kept.append(&mut creases::twin_rows(complex));
        kept.retain(|row| impose_row(&mut start, row));
        let dear = |start: &Rounding, row: &[f64]| {
            let off = dot(row, &start.wish);
            let variance = start.covariance.between(row, row);
            off * off > DEAREST * n_quads * variance.max(1e-9)
        };
        for Row { row, is_firm } in creases::rows(complex) {
            if (is_firm || !dear(&start, &row)) && impose_row(&mut start, &row) {
                kept.push(row);
            }
        }
        Ok(Self {
            wish: start.wish.clone(),
            start,
            lines: kept,
            covariance,
            energy,
            n_quads,
            firm: Firm::of(complex),
            settings,
        })
    }

    /// A metric of which so many quads are wanted.
    fn candidate(&self, state: State, n_wanted: f64) -> Candidate {
        Candidate {
            score: Score::of_lines(&state.complex, &self.wish, n_wanted),
            state,
            n_wanted,
        }
    }

    /// Counts what only the grid tells, which costs most of a trial.
    fn complete(&self, candidate: &mut Candidate) {
        let Candidate { state, score, .. } = candidate;
        let Ok((quads, n_vertices)) = grid::read_quads(&state.complex) else {
            score.n_doubled = 1;
            return;
        };
        let told = self.firm.told((&quads, n_vertices), &state.periods);
        score.n_doubled = doubled_edges(&quads, n_vertices);
        score.n_unmet = told.n_unmet;
        if let Some(growth) = told.growth {
            let area = state.complex.area();
            candidate.n_wanted = area * growth;
            score.count_error = relative_error(area, candidate.n_wanted);
        }
    }

    fn cost(&self, score: &Score) -> f64 {
        score.cost(&self.settings.weights)
    }
}

#[cfg(test)]
mod tests;
