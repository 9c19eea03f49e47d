//! What becomes of borders, and what is told of it.

use serde::{Deserialize, Serialize};

use super::Error;
use super::settings::{Primitive, Settings};
use crate::close;

/// The longest border that a size can name, in percent of the diagonal: round a circle it is 222 %.
pub const MAX_FILL: f64 = 1000.0;

/// What becomes of borders.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Borders {
    /// They stay: lines of edges of the result lie on them.
    #[default]
    Keep,
    /// All are closed for good.
    Fill,
    /// Those are whose loops are no longer than so many percent of the whole mesh's diagonal, from
    /// 0 to 1000.
    FillUpTo(f64),
}

impl Borders {
    /// The size up to which borders are filled, where one is named.
    pub(super) fn size_pct(self) -> Option<f64> {
        match self {
            Self::Keep | Self::Fill => None,
            Self::FillUpTo(size_pct) => Some(size_pct),
        }
    }
}

/// What became of the borders of a part.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Opened {
    /// How many it had.
    pub n_borders: usize,
    /// How many of them were filled for good.
    pub n_filled: usize,
    /// How the others were closed while quads were made; none where there are no others.
    pub way: Option<Closure>,
}

/// How borders are closed that are opened again.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Closure {
    /// Each has a cap.
    Capped,
    /// The part is glued to its image at the longest; the others have caps.
    Doubled,
}

impl Opened {
    /// What is told of a part that was closed.
    pub(super) fn of(closed: &close::Closed) -> Self {
        let n_open = closed.n_capped + closed.n_doubled;
        let way = match closed.n_doubled {
            0 => Closure::Capped,
            _ => Closure::Doubled,
        };
        Self {
            n_borders: n_open + closed.n_filled,
            n_filled: closed.n_filled,
            way: (n_open > 0).then_some(way),
        }
    }
}

impl Settings {
    /// How borders are closed, where the diagonal measures 1.
    pub(super) fn close(&self) -> close::Settings {
        let fill = match self.borders {
            Borders::Keep => close::Fill::None,
            Borders::Fill => close::Fill::All,
            Borders::FillUpTo(size_pct) => close::Fill::UpTo(size_pct / 100.0),
        };
        close::Settings {
            fill,
            ..close::Settings::default()
        }
    }

    /// Why no part with borders can be done, if so: primitives that are the same for all shapes have
    /// none, and borders are to stay.
    pub(super) fn closed_alone(&self) -> Option<String> {
        let primitive = self.primitive();
        let other = match primitive {
            Primitive::QuadSphere => Primitive::Flow,
            Primitive::Icosphere => Primitive::Adaptive,
            Primitive::Flow | Primitive::Adaptive => return None,
        };
        if self.borders == Borders::Fill {
            return None;
        }
        let [name, other] = [primitive, other].map(Primitive::name);
        Some(format!(
            "the {name} primitive has no borders; choose {other}, or fill all borders"
        ))
    }

    /// Whether the size is in its range.
    pub(super) fn check_borders(&self) -> Result<(), Error> {
        match self.borders.size_pct() {
            Some(value) if !(0.0..=MAX_FILL).contains(&value) => Err(Error::SizeOutOfRange {
                name: "fill size",
                value,
                most: MAX_FILL,
            }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(borders: Borders) -> Settings {
        Settings {
            borders,
            ..Settings::default()
        }
    }

    #[test]
    fn sizes_of_borders_to_fill_go_from_0_to_10_diagonals() {
        for size in [-1.0, 1000.5, f64::NAN, f64::INFINITY] {
            let message = with(Borders::FillUpTo(size))
                .check()
                .unwrap_err()
                .to_string();
            let wanted = format!("the fill size is {size}; it goes from 0 to 1000");
            assert_eq!(message, wanted);
        }
        for size in [0.0, 3.5, MAX_FILL] {
            assert!(with(Borders::FillUpTo(size)).check().is_ok(), "{size}");
        }
    }

    #[test]
    fn a_size_is_a_share_of_the_diagonal() {
        assert_eq!(with(Borders::Keep).close().fill, close::Fill::None);
        assert_eq!(with(Borders::Fill).close().fill, close::Fill::All);
        assert_eq!(
            with(Borders::FillUpTo(25.0)).close().fill,
            close::Fill::UpTo(0.25)
        );
    }

    #[test]
    fn primitives_without_borders_name_the_one_that_has_them() {
        let asked = |primitive| Settings {
            primitive: Some(primitive),
            ..Settings::default()
        };
        for (primitive, words) in [
            (
                Primitive::QuadSphere,
                "the quad-sphere primitive has no borders; choose flow, ",
            ),
            (
                Primitive::Icosphere,
                "the icosphere primitive has no borders; choose adaptive, ",
            ),
        ] {
            let why = asked(primitive).closed_alone().unwrap();
            assert!(why.starts_with(words), "{why}");
            let filled = Settings {
                borders: Borders::Fill,
                ..asked(primitive)
            };
            assert_eq!(filled.closed_alone(), None);
        }
        for primitive in [Primitive::Flow, Primitive::Adaptive] {
            assert_eq!(asked(primitive).closed_alone(), None);
        }
    }
}
