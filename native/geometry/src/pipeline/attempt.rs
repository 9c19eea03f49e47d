//! The settings of the flow that are tried one after the other.

use serde::Serialize;

use crate::flow;

/// Settings of the flow, in the order in which they are tried while quads come out inverted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Attempt {
    /// The usual ones.
    Usual,
    /// A field that follows the shape less.
    Smoother,
    /// A field that follows it more, and other random moves.
    Closer,
    /// The same with sizes that differ less.
    Evener,
    /// A field that follows it most, with sizes that differ less.
    Closest,
    /// The usual field and one size.
    Even,
}

impl Attempt {
    pub(super) const ALL: [Self; 6] = [
        Self::Usual,
        Self::Smoother,
        Self::Closer,
        Self::Evener,
        Self::Closest,
        Self::Even,
    ];

    pub(super) fn settings(self, style: &flow::Settings) -> flow::Settings {
        let mut settings = style.clone();
        match self {
            Self::Usual => {}
            Self::Smoother => settings.field.alignment /= 3.0,
            Self::Closer => {
                settings.field.alignment *= 4.0 / 3.0;
                settings.search.seed += 1;
            }
            Self::Evener => {
                settings = Self::Closer.settings(style);
                settings.sizes.adaptivity *= 0.6;
            }
            Self::Closest => {
                settings.field.alignment *= 2.0;
                settings.sizes.adaptivity *= 0.5;
            }
            Self::Even => settings.sizes.adaptivity = 0.0,
        }
        settings
    }
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
}
