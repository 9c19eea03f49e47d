//! Improves whole periods by small moves.

use super::moves::Moves;
use super::{Candidate, Problem};
use crate::progress::{Cancelled, Progress};
use crate::random::Random;

/// The shortest edge during moves: whole metrics lie apart, so that no way leads by a short edge.
const SHORT: f64 = 0.2;
/// After so many moves in vain some rings are given up to make room for others.
const PATIENCE: usize = 80;
/// The share of rings given up then.
const GIVEN_UP: f64 = 0.25;

/// Tries moves that keep the rings there are; keeps what lowers the cost.
pub(super) fn improve(
    problem: &Problem,
    mut best: Candidate,
    progress: &Progress,
) -> Result<Candidate, Cancelled> {
    let mut random = Random::new(problem.settings.seed);
    let n_trials = problem.settings.n_trials;
    let mut moves = Moves::new(problem, &best.state, &mut random, 0.0);
    let mut n_in_vain = 0;
    for trial in 0..n_trials {
        progress.at(trial as f64 / n_trials as f64)?;
        if n_in_vain == PATIENCE {
            moves = Moves::new(problem, &best.state, &mut random, GIVEN_UP);
            n_in_vain = 0;
        }
        n_in_vain += 1;
        let Some(candidate) = moves
            .next(&mut random)
            .and_then(|step| better(problem, &best, &step))
        else {
            continue;
        };
        best = candidate;
        moves = Moves::new(problem, &best.state, &mut random, 0.0);
        n_in_vain = 0;
    }
    Ok(best)
}

/// The metric moved by whole periods, if it can be reached and costs less.
fn better(problem: &Problem, best: &Candidate, step: &[f64]) -> Option<Candidate> {
    let moved = best.state.periods.iter().zip(step);
    let to: Vec<f64> = moved.map(|(x, step)| x + step).collect();
    let mut state = best.state.clone();
    if state.drag(&to, SHORT) < 1.0 {
        return None;
    }
    let least = problem.cost(&best.score);
    let score = problem.score(&state);
    if problem.cost(&score) >= least {
        return None;
    }
    let score = score.with_doubled(&state.complex);
    (problem.cost(&score) < least).then_some(Candidate { state, score })
}
