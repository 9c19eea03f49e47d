//! Roundings of the wish at several scales, with few rings and with many.

use super::{Candidate, Problem, Weights};
use crate::flow::drag::SHORT;
use crate::flow::rings::{Cylinder, Greed, Reach, cylinders, impose};
use crate::progress::{Cancelled, Progress};

/// How much energy a whole mesh of loops is worth when rings are chosen.
const WORTHS: [f64; 3] = [0.0, 1.0, 3.0];
/// Scales tried for each of these; each corrects the count of the one before.
const N_SCALES: usize = 9;
/// By how much the scales are spread around the one that should give the count.
const SPREAD: f64 = 0.004;
/// The scale grows so when a rounding got stuck.
const ROOM: f64 = 1.03;
/// And so where lines that must be met were not: below, a shape that needs three times the quads asked
/// for is never found.
const ROOM_OF_SOLIDS: f64 = 1.08;
/// The weight of the count among roundings: moves mend the count and keep the loops.
const COUNT_WEIGHT: f64 = 5.0;
/// The most rings imposed.
const MOST_RINGS: usize = 30;
/// How often, in all, a rounding that got stuck is tried again with fewer rings.
const MOST_RETRIES: usize = 14;

/// What the roundings gave.
#[derive(Default)]
pub(super) struct Found {
    /// The best one.
    pub best: Option<Candidate>,
    pub n_tried: usize,
    pub n_stuck: usize,
    n_retries: usize,
}

/// One way to round.
#[derive(Clone, Copy)]
struct Attempt {
    scale: f64,
    worth: f64,
}

pub(super) fn round_at_scales(problem: &Problem, progress: &Progress) -> Result<Found, Cancelled> {
    let pool = pool(problem);
    let mut found = Found::default();
    let n = (WORTHS.len() * N_SCALES) as f64;
    for worth in WORTHS {
        let mut scale = 1.0;
        let n_reached = found.n_tried - found.n_stuck;
        for i in 0..N_SCALES {
            progress.at(found.n_tried as f64 / n)?;
            let spread = 1.0 + SPREAD * (i as f64 - 2.0);
            scale *= match found.take(problem, &pool, Attempt { scale, worth }) {
                Some(growth) => growth.sqrt() * spread,
                None if problem.firm.is_empty() => ROOM,
                None => ROOM_OF_SOLIDS,
            };
        }
        if found.n_tried - found.n_stuck == n_reached {
            // More rings leave less room yet.
            break;
        }
    }
    if let Some(best) = &mut found.best {
        problem.complete(best);
    }
    Ok(found)
}

/// The cylinders of the wish, as near to it as the metric gets.
fn pool(problem: &Problem) -> Vec<Cylinder> {
    let mut wished = problem.start.state.clone();
    wished.drag(&problem.wish, SHORT);
    let reach = Reach {
        longest: 1.6 * problem.n_quads.sqrt(),
        narrowest: 1.2,
        angle: 0.6,
        aside: f64::INFINITY,
        n_crossed: 80,
    };
    cylinders(&wished.complex, &reach)
}

impl Found {
    /// Rounds and keeps the result if it is the best; returns how many times its quads are wanted
    /// if all lines that must be are met.
    fn take(&mut self, problem: &Problem, pool: &[Cylinder], attempt: Attempt) -> Option<f64> {
        self.n_tried += 1;
        let Some(candidate) = self.round(problem, pool, attempt) else {
            self.n_stuck += 1;
            return None;
        };
        let is_met = candidate.score.n_unmet == 0;
        let growth = candidate.n_wanted / candidate.score.n_quads as f64;
        let weights = Weights {
            count: COUNT_WEIGHT,
            ..problem.settings.weights
        };
        let cost = |c: &Candidate| c.score.cost(&weights);
        if (self.best.as_ref()).is_none_or(|best| cost(&candidate) < cost(best)) {
            self.best = Some(candidate);
        }
        is_met.then_some(growth)
    }

    fn round(
        &mut self,
        problem: &Problem,
        pool: &[Cylinder],
        attempt: Attempt,
    ) -> Option<Candidate> {
        let start = problem.start.scaled(attempt.scale);
        let mut n_most = MOST_RINGS;
        loop {
            let mut rounding = start.clone();
            let greed = Greed {
                worth: attempt.worth,
                n_most,
            };
            let n_rings = impose(&mut rounding, pool, attempt.scale, greed);
            if let Some(state) = rounding.round() {
                let mut candidate = problem.candidate(state, problem.n_quads);
                if !problem.firm.is_empty() {
                    problem.complete(&mut candidate);
                }
                return Some(candidate);
            }
            if n_rings < 2 || self.n_retries == MOST_RETRIES {
                return None;
            }
            self.n_retries += 1;
            n_most = n_rings * 2 / 3;
        }
    }
}
