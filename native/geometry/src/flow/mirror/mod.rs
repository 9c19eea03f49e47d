//! Quads that are their own image in a plane.
//!
//! On a surface that is its own image the field is made so ([`field::mirror`]), and so are the
//! lines. In the flat metric the plane is then a straight line: it is put along an axis through
//! whole points, as sharp lines are, and the ways from it to the singularities of one side are tied
//! to their images ([`plan`]), so that whatever is rounded or moved on one side is on the other.
//! The grid of such a metric is its own image, which is checked quad by quad ([`images`]).
//!
//! [`field::mirror`]: super::field::mirror

mod images;
mod plan;
mod plane;

pub use images::images;
pub use plan::{Plan, plan, plane_edges};
pub use plane::straighten;
