//! Primitives: meshes whose vertices lie on the unit sphere, to be deformed into a shape.
//!
//! Fixed ones ([`icosphere`], [`quad_sphere`]) are even on the sphere. Every primitive covers the
//! sphere exactly once, as [`crate::sphere_map::check_cover`] proves.

mod icosphere;
mod quad_sphere;

pub use icosphere::{icosphere, icosphere_frequency};
pub use quad_sphere::{quad_sphere, quad_sphere_counts};
