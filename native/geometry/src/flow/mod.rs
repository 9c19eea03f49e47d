//! Flow: quads whose edges follow the shape, read off a flat metric with integer periods.
//!
//! A smooth [`field`] of crosses says how the quads should lie; where it turns by a quarter too
//! much or too little around a vertex, the result has an irregular vertex ([`singularities`]).
//! [`sizes`] say how long edges should be where. The [`wish`] is the flat map that follows the field
//! best, in units of a quad's edge.
//!
//! That metric is decided by free Gaussian integers, its [`periods`]. [`drag`] moves it through
//! valid metrics only, [`rounding`] to whole periods, with rings round the limbs imposed
//! first; a [`search`] of counted trials picks and improves. Its unit [`grid`] is the quads; where no
//! grid of the count is valid, strips are taken out of a finer one.

pub mod complex;
pub mod cones;
pub mod conformal;
pub mod covariance;
pub mod creases;
pub mod drag;
mod dress;
mod error;
pub mod field;
pub mod grid;
mod guides;
mod laid;
mod lines;
mod mirror;
pub mod periods;
pub mod place;
mod quads;
mod rings;
pub mod rod;
pub mod rounding;
pub mod search;
mod settings;
pub mod singularities;
pub mod sizes;
mod stars;
pub mod strips;
mod thin;
pub mod wish;

pub use creases::CORNER_ANGLE;
pub use error::Error;
pub use guides::{FirmEdges, Guides, Real};
pub use quads::{Flow, Report, flow};
pub use settings::{Creases, Settings};
