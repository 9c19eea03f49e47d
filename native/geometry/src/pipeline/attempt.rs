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

    /// Whether it is for parts that do not flow otherwise: where strips are taken out loops end.
    pub(super) fn is_last_resort(self) -> bool {
        matches!(self, Self::Thinned | Self::Denser | Self::Densest)
    }

    /// Whether its settings are not those of the usual attempt.
    pub(super) fn is_worth_trying(self, style: &flow::Settings) -> bool {
        self == Self::Usual || self.settings(style) != *style
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
