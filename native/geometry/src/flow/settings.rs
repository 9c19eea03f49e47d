//! What is asked of the flow.

use super::{field, search, sizes};

/// What to make.
#[derive(Clone, PartialEq, Debug)]
pub struct Settings {
    /// How many quads; the count that is reached differs by less than a percent.
    pub n_quads: usize,
    /// How the field follows the shape.
    pub field: field::Settings,
    /// How long edges are wanted where.
    pub sizes: sizes::Settings,
    /// Edges sharper than this, in radians, get edges of quads along them; none: no edge does.
    pub sharp_angle: Option<f64>,
    /// Which of those edges are followed.
    pub creases: Creases,
    /// How long whole periods are searched, and what makes them good.
    pub search: search::Settings,
    /// Whether more quads will do, because strips of them are to be taken out: see [`Flow::thinned`](super::Flow::thinned).
    pub may_exceed: bool,
}

/// Which sharp edges get edges of quads along them.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Creases {
    /// Lines of some length, if most of what is sharp lies on them.
    Long,
    /// All of a solid's, however short: corners are vertices with as many quads as fit there. The
    /// number of quads may be an eighth off for it.
    All,
}

impl Settings {
    /// The usual settings for a number of quads.
    pub fn new(n_quads: usize) -> Self {
        Self {
            n_quads,
            field: field::Settings::default(),
            sizes: sizes::Settings::default(),
            sharp_angle: Some(40f64.to_radians()),
            creases: Creases::Long,
            search: search::Settings::default(),
            may_exceed: false,
        }
    }
}
