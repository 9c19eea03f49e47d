//! Primitives: meshes whose vertices lie on the unit sphere, to be deformed into a shape.
//!
//! Fixed ones ([`icosphere`], [`quad_sphere`]) are even on the sphere, which a map may stretch a
//! hundredfold; [`spread`] turns them to where they lie best, and [`adaptive`] places triangles so
//! that they are even on the surface. Every primitive covers the sphere exactly once, as
//! [`crate::sphere_map::check_cover`] proves.

mod adaptive;
mod icosphere;
mod net;
mod quad_sphere;
mod spread;
mod triangulation;

pub use adaptive::{Adaptive, AdaptiveError, Report, Settings, adaptive, sized};
pub use icosphere::{icosphere, icosphere_frequency};
pub use quad_sphere::{quad_sphere, quad_sphere_counts};
pub use spread::{SpreadSettings, spread};
