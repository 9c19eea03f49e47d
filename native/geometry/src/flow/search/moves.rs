//! Whole moves that keep rings: one unit, one more ring, two cones onto one line.

use super::Problem;
use crate::flow::drag::State;
use crate::flow::periods::{Part, Periods, dot, real_row};
use crate::flow::rings::{Cylinder, Lattice, Reach, Segment, cylinders, off_axis, segments};
use crate::random::Random;

/// A ring is tried where a period is off an axis by no more than this.
const MOST_OFF: f64 = 4.0;
/// Two cones are put onto one line where they are off it by no more than this.
const MOST_ASIDE: f64 = 2.0;
/// The least share of edges that a new ring must bring.
const WORTHWHILE: f64 = 0.002;
/// How many new rings are tried.
const MOST_RINGS: usize = 16;
/// Of all moves the share of new rings, and of these with lines.
const SHARES: [f64; 2] = [0.2, 0.55];

/// The moves from one metric.
pub(super) struct Moves {
    lattice: Lattice,
    n: usize,
    /// Moves that close one more ring, the best last.
    rings: Vec<Periods>,
    segments: Vec<Segment>,
}

impl Moves {
    /// Finds the rings of a metric, to be kept but for a share `given_up`, and those it misses.
    pub fn new(problem: &Problem, state: &State, random: &mut Random, given_up: f64) -> Self {
        let reach = Reach {
            longest: 2.0 * problem.n_quads.sqrt(),
            narrowest: 1.5,
            angle: 0.35,
            aside: MOST_OFF,
            n_crossed: 100,
        };
        let found = cylinders(&state.complex, &reach);
        let (mut kept, missed): (Vec<Cylinder>, Vec<Cylinder>) =
            found.into_iter().partition(|c| off(c).abs() < 0.5);
        kept.retain(|_| random.unit() >= given_up);
        let weight = |c: &Cylinder| c.width * c.period.length();
        kept.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
        let rings = kept.iter().map(|c| c.row(off_axis(c.period)));
        let rows: Vec<Vec<f64>> = problem.lines.iter().cloned().chain(rings).collect();
        let lattice = Lattice::keeping(&problem.energy, &problem.covariance, &rows);
        Self {
            rings: ring_moves(problem, state, &lattice, missed),
            lattice,
            n: state.periods.len(),
            segments: segments(&state.complex, 0.56 * problem.n_quads.sqrt(), MOST_ASIDE),
        }
    }

    /// The next move to try; none when the one chosen does not exist.
    pub fn next(&mut self, random: &mut Random) -> Option<Periods> {
        let kind = random.unit();
        if kind < SHARES[0]
            && let Some(step) = self.rings.pop()
        {
            return Some(step);
        }
        if kind < SHARES[1] && !self.segments.is_empty() {
            let [a, b] = [0; 2].map(|_| &self.segments[random.below(self.segments.len())]);
            let shorter = if b.vector.length() < a.vector.length() {
                b
            } else {
                a
            };
            let part = off_axis(shorter.vector);
            let row = real_row(&shorter.coefficients, part);
            return self.lattice.move_by(&row, -part.of(shorter.vector).round());
        }
        if self.n == 0 {
            return None;
        }
        let mut row = vec![0.0; self.n];
        row[random.below(self.n)] = 1.0;
        let unit = if random.below(2) == 0 { 1.0 } else { -1.0 };
        self.lattice.move_by(&row, unit)
    }
}

/// How far the period of a cylinder is off the nearer axis.
fn off(cylinder: &Cylinder) -> f64 {
    off_axis(cylinder.period).of(cylinder.period)
}

/// The moves that close cylinders which are nearly along an axis, the best last.
fn ring_moves(
    problem: &Problem,
    state: &State,
    lattice: &Lattice,
    missed: Vec<Cylinder>,
) -> Vec<Periods> {
    let area = state.complex.area();
    let from_wish: Vec<f64> = (state.periods.iter().zip(&problem.wish))
        .map(|(x, wish)| x - wish)
        .collect();
    let pull = problem.energy.times(&from_wish);
    let benefit = |c: &Cylinder| c.benefit(1.0) / area;
    let mut worth: Vec<Cylinder> = missed
        .into_iter()
        .filter(|c| off(c).abs() <= MOST_OFF && off(c).abs() < 0.5 * c.period.length())
        .filter(|c| benefit(c) > WORTHWHILE)
        .collect();
    worth.sort_by(|a, b| benefit(b).total_cmp(&benefit(a)));
    worth.truncate(MOST_RINGS);
    let mut moves: Vec<(f64, Periods)> = Vec::new();
    for cylinder in &worth {
        let part: Part = off_axis(cylinder.period);
        let value = -part.of(cylinder.period).round();
        if let Some(step) = lattice.move_by(&cylinder.row(part), value) {
            let energy = 2.0 * dot(&pull, &step) + problem.energy.between(&step, &step);
            let gain = benefit(cylinder) * problem.settings.weights.loops - energy / area;
            moves.push((gain, step));
        }
    }
    moves.sort_by(|a, b| a.0.total_cmp(&b.0));
    moves.into_iter().map(|(_, step)| step).collect()
}
