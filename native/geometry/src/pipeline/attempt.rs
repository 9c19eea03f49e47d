//! The settings of the flow that are tried one after the other.

use serde::Serialize;

use crate::flow;

/// Settings of the flow, in the order in which they are tried while quads come out inverted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Attempt {
    /// None: rings round a part that is one limb from end to end.
    Rings,
    /// The usual ones.
    Usual,
    /// A field that follows the shape less.
    Smoother,
    /// A field that follows it more, and other random moves.
    Closer,
    /// The same with sizes that differ less, or more where they hardly did.
    Evener,
    /// A field that follows it most, with such sizes.
    Closest,
    /// The usual field and one size.
    Even,
    /// The usual ones and no exact count: strips of the quads are taken out.
    Thinned,
    /// The same of twice as many quads.
    Denser,
    /// The same of four times as many.
    Densest,
}

impl Attempt {
    pub(super) const ALL: [Self; 9] = [
        Self::Usual,
        Self::Smoother,
        Self::Closer,
        Self::Evener,
        Self::Closest,
        Self::Even,
        Self::Thinned,
        Self::Denser,
        Self::Densest,
    ];

    pub(super) fn settings(self, style: &flow::Settings) -> flow::Settings {
        let mut settings = style.clone();
        match self {
            Self::Rings | Self::Usual => {}
            Self::Smoother => settings.field.alignment /= 3.0,
            Self::Closer => {
                settings.field.alignment *= 4.0 / 3.0;
                settings.search.seed += 1;
            }
            Self::Evener => {
                settings = Self::Closer.settings(style);
                settings.sizes.adaptivity = share_of(style, 0.6);
            }
            Self::Closest => {
                settings.field.alignment *= 2.0;
                settings.sizes.adaptivity = share_of(style, 0.5);
            }
            Self::Even => settings.sizes.adaptivity = 0.0,
            Self::Thinned => settings.may_exceed = true,
            Self::Denser => {
                settings = Self::Thinned.settings(style);
                settings.n_quads *= 2;
            }
            Self::Densest => {
                settings = Self::Thinned.settings(style);
                settings.n_quads *= 4;
            }
        }
        settings
    }

    /// What it costs, where the usual one costs 1: time grows with the quads.
    fn cost(self) -> usize {
        match self {
            Self::Denser => 2,
            Self::Densest => 4,
            _ => 1,
        }
    }

    /// Whether it is for parts that do not flow otherwise: where strips are taken out loops end.
    pub(super) fn is_last_resort(self) -> bool {
        matches!(self, Self::Thinned | Self::Denser | Self::Densest)
    }

    /// Whether its settings are not those of the usual attempt.
    pub(super) fn is_worth_trying(self, style: &flow::Settings) -> bool {
        self == Self::Usual || self.settings(style) != *style
    }
}

/// What all attempts at a part may cost, where the first costs 1.
const MOST_COST: usize = 3;
/// Fewer quads than these take little time: more attempts may be made, as if there were so many.
const FEW_QUADS: usize = 1_000;

/// What is left of what all attempts at a part may cost, symmetric ones and others.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Budget {
    total: usize,
    left: usize,
    pub n_attempts: usize,
    /// Whether an attempt had too many quads: then strips of them can be taken out.
    pub is_over: bool,
}

impl Budget {
    pub fn new(n_quads: usize) -> Self {
        let total = MOST_COST * FEW_QUADS.max(n_quads) / n_quads.max(1);
        Self {
            total,
            left: total,
            n_attempts: 0,
            is_over: false,
        }
    }

    /// The same once another way has failed at some cost, after so many attempts; the usual attempt
    /// is left in any case, with a plane of symmetry and without.
    pub fn after(self, cost: usize, n_attempts: usize) -> Self {
        Self {
            left: self.left.saturating_sub(cost).max(2),
            n_attempts: self.n_attempts + n_attempts,
            ..self
        }
    }

    /// The same with nothing spent, once so many attempts have been made.
    pub fn again(self, n_attempts: usize) -> Self {
        Self {
            left: self.total,
            n_attempts,
            is_over: false,
            ..self
        }
    }

    /// Takes the cost of an attempt if that leaves as much as is to be kept back.
    pub fn take(&mut self, attempt: Attempt, kept_back: usize) -> bool {
        let fits = attempt.cost() + kept_back <= self.left;
        if fits {
            self.left -= attempt.cost();
            self.n_attempts += 1;
        }
        fits
    }

    /// What is kept back while nothing flows: for the usual surface where this one is symmetric, else
    /// for the attempts that take strips out, as many as there is room for.
    pub fn kept_back(self, is_symmetric: bool) -> usize {
        if is_symmetric {
            return self.total.div_ceil(2);
        }
        let thinned = self.is_over.then_some(Attempt::Thinned);
        let resorts = thinned
            .into_iter()
            .chain([Attempt::Denser, Attempt::Densest]);
        let sums = resorts.scan(0, |sum, resort| {
            *sum += resort.cost();
            Some(*sum)
        });
        sums.take_while(|&sum| sum <= self.left).last().unwrap_or(0)
    }
}

/// A share of the adaptivity of a style, no less than of the usual one: where quads of one size fail,
/// as on legs that are thinner than they are, smaller ones may not.
fn share_of(style: &flow::Settings, share: f64) -> f64 {
    share * style.sizes.adaptivity.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_attempts_are_alike_and_the_first_is_what_was_asked_for() {
        let style = flow::Settings::new(700);
        let all: Vec<_> = Attempt::ALL.iter().map(|a| a.settings(&style)).collect();
        assert_eq!(all[0], style);
        for (i, one) in all.iter().enumerate() {
            assert!(!all[i + 1..].contains(one), "{i}");
        }
    }

    /// What is tried where nothing flows.
    fn tried(n_quads: usize, is_over: bool) -> (Vec<Attempt>, usize) {
        let mut budget = Budget::new(n_quads);
        budget.is_over = is_over;
        let is_tried = |attempt: &Attempt| {
            let is_spare = *attempt == Attempt::Usual || attempt.is_last_resort();
            let kept_back = if is_spare { 0 } else { budget.kept_back(false) };
            (is_over || *attempt != Attempt::Thinned) && budget.take(*attempt, kept_back)
        };
        let tried: Vec<_> = Attempt::ALL.into_iter().filter(is_tried).collect();
        let cost = tried.iter().map(|attempt| attempt.cost()).sum();
        (tried, cost)
    }

    #[test]
    fn all_attempts_cost_three_times_the_first_or_those_of_few_quads() {
        use Attempt::{Closer, Denser, Smoother, Thinned, Usual};
        for n_quads in [1_000, 2_000, 20_000] {
            assert_eq!(tried(n_quads, false), (vec![Usual, Denser], 3));
            assert_eq!(tried(n_quads, true), (vec![Usual, Smoother, Thinned], 3));
        }
        let few = vec![Usual, Smoother, Closer, Thinned, Denser];
        assert_eq!(tried(500, true), (few, 6));
        let (all, cost) = tried(50, true);
        assert_eq!((all, cost), (Attempt::ALL.to_vec(), 13));
    }

    #[test]
    fn a_symmetric_surface_leaves_half_for_the_usual_one() {
        let mut budget = Budget::new(2_000);
        assert!(budget.take(Attempt::Usual, 0));
        assert!(!budget.take(Attempt::Smoother, budget.kept_back(true)));
        assert!(budget.take(Attempt::Usual, 0) && budget.take(Attempt::Thinned, 0));
        assert_eq!(budget.n_attempts, 3);
        assert!(!budget.take(Attempt::Usual, 0));
    }

    #[test]
    fn where_one_size_is_asked_for_others_are_tried_and_nothing_is_tried_twice() {
        let mut style = flow::Settings::new(700);
        style.sizes.adaptivity = 0.0;
        let worth = Attempt::ALL.iter().filter(|a| a.is_worth_trying(&style));
        let all: Vec<_> = worth.map(|a| a.settings(&style)).collect();
        assert_eq!(all.len(), Attempt::ALL.len() - 1);
        assert!(all.iter().any(|one| one.sizes.adaptivity > 0.4));
        for (i, one) in all.iter().enumerate() {
            assert!(!all[i + 1..].contains(one), "{i}");
        }
    }
}
