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

/// Why a part cannot be done that has borders, or handles; none where it can.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct SphereAlone {
    pub borders: Option<String>,
    pub handles: Option<String>,
}

/// What became of the borders of a part.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Opened {
    /// How many it had.
    pub n_borders: usize,
    /// How many of them were filled for good.
    pub n_filled: usize,
    /// How the others were closed while quads were made; none where there are no others, or nothing had
    /// to be closed.
    pub way: Option<Closure>,
    /// How many of its handles were sealed for good.
    pub n_sealed: usize,
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
    /// What is told of a part; nothing where it had no borders and no handle was sealed.
    pub(super) fn new([n_borders, n_filled]: [usize; 2], n_sealed: usize) -> Option<Self> {
        (n_borders + n_sealed > 0).then_some(Self {
            n_borders,
            n_filled,
            way: None,
            n_sealed,
        })
    }

    /// The same once it was closed.
    pub(super) fn closed(self, is_doubled: bool) -> Self {
        let way = if is_doubled {
            Closure::Doubled
        } else {
            Closure::Capped
        };
        Self {
            way: (self.n_filled < self.n_borders).then_some(way),
            ..self
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

    /// Why parts with borders and with handles cannot be done, if so: primitives that are the same
    /// for all shapes have neither.
    pub(super) fn sphere_alone(&self) -> SphereAlone {
        let primitive = self.primitive();
        let other = match primitive {
            Primitive::QuadSphere => Primitive::Flow,
            Primitive::Icosphere => Primitive::Adaptive,
            Primitive::Flow | Primitive::Adaptive => return SphereAlone::default(),
        };
        let [name, other] = [primitive, other].map(Primitive::name);
        let borders =
            format!("the {name} primitive has no borders; choose {other}, or fill all borders");
        SphereAlone {
            borders: (self.borders != Borders::Fill).then_some(borders),
            handles: Some(format!(
                "the {name} primitive has no handles; choose {other}"
            )),
        }
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
            let why = asked(primitive).sphere_alone();
            let (borders, handles) = (why.borders.unwrap(), why.handles.unwrap());
            assert!(borders.starts_with(words), "{borders}");
            assert!(handles.contains("has no handles; choose "), "{handles}");
            let filled = Settings {
                borders: Borders::Fill,
                ..asked(primitive)
            };
            assert_eq!(filled.sphere_alone().borders, None);
        }
        for primitive in [Primitive::Flow, Primitive::Adaptive] {
            assert_eq!(asked(primitive).sphere_alone(), SphereAlone::default());
        }
    }
}
