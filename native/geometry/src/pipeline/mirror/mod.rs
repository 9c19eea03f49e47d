//! Mirror symmetry: which plane, and what is its own image in it.

mod data;
mod even_out;
mod face;
mod map;
mod plane;
mod roles;

pub use even_out::even_out;
pub use face::{Faced, doubled, face};
pub use map::symmetric;
pub use plane::{Mirror, Plane, Through, find};
pub use roles::{Role, image_of, roles};
