//! Improves whole periods by small moves.

use std::collections::BTreeSet;

use glam::DVec2;

use super::moves::Moves;
use super::{Candidate, Problem, Score};
use crate::flow::covariance::energy_weight;
use crate::flow::periods::Periods;
use crate::progress::{Cancelled, Progress};
use crate::random::Random;

/// The shortest edge during moves: whole metrics lie apart, so that no way leads by a short edge.
const SHORT: f64 = 0.2;
/// After so many moves in vain some rings are given up to make room for others.
const PATIENCE: usize = 80;
/// The share of rings given up then.
const GIVEN_UP: f64 = 0.25;
/// What a move may lose by count and distance, hoping for loops: hardly any that was kept lost more.
const HOPE: f64 = 0.02;

/// About how many rings a metric has.
const N_RINGS: usize = 30;
/// The products that may be spent on finding moves anew: a metric of 100 periods never gets there, one
/// of 360 with 200 lines after a second.
const MOST_WORK: f64 = 3e9;

/// Tries moves that keep the rings there are; keeps what lowers the cost.
pub(super) fn improve(
    problem: &Problem,
    best: Candidate,
    progress: &Progress,
) -> Result<Candidate, Cancelled> {
    let mut random = Random::new(problem.settings.seed);
    let n_trials = problem.settings.n_trials;
    let mut place = Place::new(problem, best, &mut random);
    let n_rows = problem.lines.len() + N_RINGS;
    let each = n_rows as f64 * (problem.wish.len() as f64).powi(2);
    let mut work = 0.0;
    for trial in 0..n_trials {
        progress.at(trial as f64 / n_trials as f64)?;
        if let Some(better) = place.try_next(&mut random) {
            place = Place::new(problem, better, &mut random);
            work += each;
            if work > MOST_WORK {
                break;
            }
        }
    }
    Ok(place.best)
}

/// The best metric so far, the moves from it, and what helps to judge them.
struct Place<'a> {
    problem: &'a Problem<'a>,
    best: Candidate,
    moves: Moves,
    n_in_vain: usize,
    /// The moves tried.
    tried: BTreeSet<Vec<i64>>,
    /// What a halfedge's distance from the wish weighs, and its wish.
    wishes: Vec<(f64, DVec2)>,
}

impl<'a> Place<'a> {
    fn new(problem: &'a Problem<'a>, best: Candidate, random: &mut Random) -> Self {
        let complex = &best.state.complex;
        let wish = |h| {
            let wished = complex.coefficients.value(h, &problem.wish);
            (energy_weight(complex, h), wished)
        };
        Self {
            problem,
            wishes: complex.halfedge_ids().map(wish).collect(),
            moves: Moves::new(problem, &best.state, random, 0.0),
            best,
            n_in_vain: 0,
            tried: BTreeSet::new(),
        }
    }

    /// Tries one more move; the metric that it leads to if that is better.
    fn try_next(&mut self, random: &mut Random) -> Option<Candidate> {
        if self.n_in_vain == PATIENCE {
            self.moves = Moves::new(self.problem, &self.best.state, random, GIVEN_UP);
            self.n_in_vain = 0;
        }
        self.n_in_vain += 1;
        let step = self.moves.next(random)?;
        let own = self.best.state.periods.iter();
        let to: Periods = own.zip(&step).map(|(x, step)| x + step).collect();
        let is_new = self.tried.insert(step.iter().map(|&x| x as i64).collect());
        if !is_new || self.loses(&to) > HOPE {
            return None;
        }
        self.take(&to)
    }

    /// How much worse the count and the distance from the wish would be, without going there. The
    /// area is exact; the distance is that of the triangles here, which may flip on the way.
    fn loses(&self, to: &[f64]) -> f64 {
        let Candidate {
            state,
            score,
            n_wanted,
        } = &self.best;
        let complex = &state.complex;
        let vectors: Vec<DVec2> = (complex.halfedge_ids())
            .map(|h| complex.coefficients.value(h, to))
            .collect();
        let faces = vectors.as_chunks::<3>().0.iter();
        let area: f64 = faces.map(|v| 0.5 * v[0].perp_dot(v[1])).sum();
        let miss = vectors.iter().zip(&self.wishes);
        let energy: f64 = miss
            .map(|(v, (weight, wish))| weight * v.distance_squared(*wish))
            .sum();
        let weights = &self.problem.settings.weights;
        let cost = |energy: f64, area: f64| {
            weights.energy * energy + weights.count * Score::excess_error(area, *n_wanted)
        };
        cost(energy / area, area) - cost(score.energy, complex.area())
    }

    /// The metric of the given periods, if it can be reached and costs less.
    fn take(&self, to: &[f64]) -> Option<Candidate> {
        let problem = self.problem;
        let mut state = self.best.state.clone();
        if state.drag(to, SHORT) < 1.0 {
            return None;
        }
        let least = problem.cost(&self.best.score);
        let mut found = problem.candidate(state, self.best.n_wanted);
        if problem.cost(&found.score) >= least {
            return None;
        }
        problem.complete(&mut found);
        (problem.cost(&found.score) < least).then_some(found)
    }
}
