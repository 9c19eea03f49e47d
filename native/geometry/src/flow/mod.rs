//! Flow: quads whose edges follow the shape, read off a flat metric with integer periods.
//!
//! A smooth [`field`] of crosses says how the quads should lie; where it turns by a quarter too
//! much or too little around a vertex, the result has an irregular vertex ([`singularities`]). The
//! [`wish`] is the flat map that follows the field best, in units of a quad's edge.

pub mod complex;
pub mod cones;
pub mod conformal;
pub mod creases;
pub mod field;
pub mod place;
pub mod singularities;
pub mod wish;
