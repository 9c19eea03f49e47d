//! Mirror symmetry: which plane, and what is its own image in it.

mod data;
mod even_out;
mod face;
mod joined;
mod map;
mod plane;
mod roles;
mod seam;

pub use even_out::even_out;
pub use face::{Faced, doubled, face};
pub use joined::joined;
pub use map::symmetric;
pub use plane::{Mirror, Plane, Through, find};
pub use roles::{Role, image_of, roles};
pub use seam::{Halved, Seam, halved};
