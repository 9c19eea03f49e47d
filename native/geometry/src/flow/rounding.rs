//! Makes all periods whole, one after the other, each where it costs least.
//!
//! Two vectors live: the *state*, a valid metric whose fixed periods are whole, and the *wish*,
//! the cheapest periods given those fixed, which may be no valid metric at all. Each period gets
//! the nearest whole value that the state can be dragged to; the covariance then says how all
//! others follow (Teunissen 1995, bootstrapping).

use glam::DVec2;

use super::covariance::{DECIDED, Dense};
use super::drag::{SHORT, State, has_angles};
use super::periods::{Equations, Periods};

/// Edges that the wish makes shorter than this go first: their choices are few.
const FEW_CHOICES: f64 = 1.8;
/// How many whole values of a period are tried before giving up.
const MOST_CANDIDATES: usize = 16;
/// How far candidates lie from the wanted value.
const REACH: i32 = 3;

/// A metric on its way to whole periods.
#[derive(Clone, Debug)]
pub struct Rounding {
    /// The valid metric.
    pub state: State,
    /// The cheapest periods given what is fixed.
    pub wish: Periods,
    /// Whether the state is at the wish.
    pub is_reached: bool,
    /// How periods not yet fixed move together.
    pub covariance: Dense,
    /// What has to hold; the pivots are never rounded.
    pub equations: Equations,
}

/// A column of the covariance to move a component along.
struct Pull {
    component: usize,
    moved: Vec<f64>,
    variance: f64,
}

impl Rounding {
    /// Starts from a metric that is dragged as far as it goes towards the wish.
    pub fn new(mut state: State, wish: Periods, covariance: Dense) -> Self {
        let is_reached = state.drag(&wish, SHORT) >= 1.0;
        Self {
            state,
            wish,
            is_reached,
            covariance,
            equations: Equations::default(),
        }
    }

    /// The same with a wish so many times as large, dragged there as far as it goes.
    #[must_use]
    pub fn scaled(&self, scale: f64) -> Self {
        let mut scaled = self.clone();
        for x in &mut scaled.wish {
            *x *= scale;
        }
        scaled.is_reached = scaled.state.drag(&scaled.wish, SHORT) >= 1.0;
        scaled
    }

    /// Makes all periods whole.
    ///
    /// None when a period has no whole value that can be reached.
    pub fn round(mut self) -> Option<State> {
        let n = self.wish.len() / 2;
        let mut is_fixed: Vec<bool> = (0..n)
            .map(|j| self.free_components(j).next().is_none())
            .collect();
        while let Some(j) = self.next_period(&is_fixed) {
            let pulls = self.pulls(j);
            let found = self
                .candidates(j)
                .into_iter()
                .any(|value| self.try_value(&pulls, value));
            if !found {
                return None;
            }
            for pull in &pulls {
                self.covariance.decide(&pull.moved, pull.variance);
            }
            is_fixed[j] = true;
            self.settle(&is_fixed);
        }
        self.finish()
    }

    fn period(periods: &[f64], j: usize) -> DVec2 {
        DVec2::new(periods[2 * j], periods[2 * j + 1])
    }

    fn free_components(&self, j: usize) -> impl Iterator<Item = usize> + '_ {
        [2 * j, 2 * j + 1]
            .into_iter()
            .filter(|&k| !self.equations.is_pivot(k))
    }

    /// Short ones first, short to long; then the one whose nearest whole value is the most certain.
    fn next_period(&self, is_fixed: &[bool]) -> Option<usize> {
        let cost = |j: usize| {
            let wished = Self::period(&self.wish, j);
            let own = Self::period(&self.state.periods, j).length();
            let mut length = wished.length();
            if !self.is_reached {
                length = length.min(own);
            }
            if length < FEW_CHOICES {
                return length - 100.0;
            }
            let mean =
                0.5 * (self.covariance.at(2 * j, 2 * j) + self.covariance.at(2 * j + 1, 2 * j + 1));
            let variance = mean.max(1e-12);
            wished.distance_squared(wished.round()) / variance.min(1.0) + 0.05 * variance.sqrt()
        };
        (0..is_fixed.len())
            .filter(|&j| !is_fixed[j])
            .map(|j| (cost(j), j))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, j)| j)
    }

    /// The columns of a period's free components, the second free of the first.
    fn pulls(&self, j: usize) -> Vec<Pull> {
        let mut pulls: Vec<Pull> = Vec::new();
        for component in self.free_components(j) {
            let mut moved = self.covariance.column(component).to_vec();
            if let Some(first) = pulls.first() {
                let factor = first.moved[component] / first.variance;
                for (value, other) in moved.iter_mut().zip(&first.moved) {
                    *value -= factor * other;
                }
            }
            let variance = moved[component];
            if variance > DECIDED {
                pulls.push(Pull {
                    component,
                    moved,
                    variance,
                });
            }
        }
        pulls
    }

    /// Whole values of a period, the most wanted first.
    fn candidates(&self, j: usize) -> Vec<DVec2> {
        let wished = Self::period(&self.wish, j);
        let own = Self::period(&self.state.periods, j);
        let mut wanted = wished;
        if !self.is_reached && own.length() < 1.0 {
            // The wish has collapsed here: the direction that is there says more.
            wanted = own.normalize_or(DVec2::X) * wished.length().clamp(1.0, 2.0);
        }
        let is_pivot = [2 * j, 2 * j + 1].map(|k| self.equations.is_pivot(k));
        let reach = is_pivot.map(|is| if is { 0 } else { REACH });
        let mut candidates = Vec::new();
        for x in -reach[0]..=reach[0] {
            for y in -reach[1]..=reach[1] {
                let mut value = wanted.round() + glam::IVec2::new(x, y).as_dvec2();
                for (k, is) in is_pivot.into_iter().enumerate() {
                    if is {
                        value[k] = wanted[k];
                    }
                }
                if value.length_squared() > 0.5 || is_pivot.contains(&true) {
                    candidates.push(value);
                }
            }
        }
        let miss = |v: &DVec2| v.distance_squared(wanted);
        candidates.sort_by(|a, b| miss(a).total_cmp(&miss(b)));
        candidates.truncate(MOST_CANDIDATES);
        candidates
    }

    fn try_value(&mut self, pulls: &[Pull], value: DVec2) -> bool {
        let moved = |periods: &[f64]| {
            let mut periods = periods.to_vec();
            for pull in pulls {
                let miss = value[pull.component % 2] - periods[pull.component];
                shift(&mut periods, &pull.moved, miss / pull.variance);
            }
            periods
        };
        let [wish, own] = [moved(&self.wish), moved(&self.state.periods)];
        self.take(wish, &own)
    }

    /// Drags to a new wish, or, if that is out of reach, the state by its own least move and from
    /// there as far towards the wish as it goes. Changes nothing when neither works.
    pub fn take(&mut self, wish: Periods, own: &[f64]) -> bool {
        if self.is_reached {
            let mut state = self.state.clone();
            if state.drag(&wish, SHORT) >= 1.0 {
                self.state = state;
                self.wish = wish;
                return true;
            }
        }
        let mut state = self.state.clone();
        if state.drag(own, SHORT) < 1.0 {
            return false;
        }
        self.is_reached = state.drag(&wish, SHORT) >= 1.0;
        self.state = state;
        self.wish = wish;
        true
    }

    /// Takes the rounding errors off the periods that are fixed.
    fn settle(&mut self, is_fixed: &[bool]) {
        for j in (0..is_fixed.len()).filter(|&j| is_fixed[j]) {
            let free: Vec<usize> = self.free_components(j).collect();
            for k in free {
                self.wish[k] = self.wish[k].round();
                self.state.periods[k] = self.state.periods[k].round();
            }
        }
    }

    /// Drags to the exact whole periods, of which all are next to the state's.
    fn finish(mut self) -> Option<State> {
        let mut whole: Periods = self.state.periods.iter().map(|x| x.round()).collect();
        self.equations.solve(&mut whole);
        let is_there = self.state.drag(&whole, SHORT) >= 1.0;
        let is_open = |f| self.state.complex.double_area(f) > 0.5;
        (is_there && self.state.complex.face_ids().all(is_open) && has_angles(&self.state.complex))
            .then_some(self.state)
    }
}

/// Adds a multiple of a direction.
pub(super) fn shift(periods: &mut [f64], direction: &[f64], factor: f64) {
    for (value, step) in periods.iter_mut().zip(direction) {
        *value += factor * step;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::flow::complex::tests::box_complex;
    use crate::flow::periods::choose;
    use crate::random::Random;

    proptest! {
        #[test]
        fn rounded_boxes_are_whole_and_valid(
            scale in 0.2..1.5f64,
            seed: u64,
        ) {
            let mut complex = box_complex(1);
            let basis = choose(&mut complex).unwrap();
            let state = State::new(&complex, basis.start);
            let mut random = Random::new(seed);
            let wish: Vec<f64> =
                basis.wish.iter().map(|x| x * scale + random.unit() - 0.5).collect();
            let covariance = Dense::energy(&complex).inverse();
            let whole = Rounding::new(state, wish, covariance).round().unwrap();
            prop_assert_eq!(whole.complex.check(), Ok(()));
            prop_assert!(whole.complex.start.iter().all(|v| *v == v.round()));
            prop_assert!(whole.periods.iter().all(|x| x.fract() == 0.0));
        }
    }

    #[test]
    fn a_whole_wish_is_kept() {
        let mut complex = box_complex(1);
        let basis = choose(&mut complex).unwrap();
        let state = State::new(&complex, basis.start.clone());
        let covariance = Dense::energy(&complex).inverse();
        let whole = Rounding::new(state, basis.wish, covariance)
            .round()
            .unwrap();
        for (own, start) in whole.periods.iter().zip(basis.start) {
            assert!((own - start).abs() < 1e-9);
        }
    }
}
