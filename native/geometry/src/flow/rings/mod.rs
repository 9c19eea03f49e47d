//! Rings: closed loops round the limbs of a flat metric, as linear equations on its periods.
//!
//! A limb is a flat cylinder. If its period T lies on an axis, every grid line round it closes;
//! else it is one long spiral. "The imaginary part of T is 0" is a linear equation on the periods
//! with whole coefficients, so rings are imposed before rounding and kept by the moves after it.
//! On metrics whose vertices are all cones the share of edges on closed loops is the sum of
//! (w − 1) |T| / 2A over the cylinders along an axis, w their widths and A the area.

mod close;
mod cylinders;
mod impose;
mod lattice;
mod segments;
mod sight;

use glam::{DVec2, IVec2};

use super::periods::{Part, real_row};
use crate::mesh::HalfedgeId;

pub use cylinders::cylinders;
pub use impose::{Greed, impose, impose_row};
pub use lattice::Lattice;
pub use segments::{Segment, segments};

/// How far to look for cylinders.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Reach {
    /// The longest period.
    pub longest: f64,
    /// The least width.
    pub narrowest: f64,
    /// How far a period's direction may be from an axis, in radians.
    pub angle: f64,
    /// How far its end may be off the axis.
    pub aside: f64,
    /// The most edges that one line crosses.
    pub n_crossed: usize,
}

/// A maximal flat cylinder: what lies between parallel closed straight lines.
#[derive(Clone, PartialEq, Debug)]
pub struct Cylinder {
    /// Once round, in the frame of the face where it was found.
    pub period: DVec2,
    /// From border to border.
    pub width: f64,
    /// The period over the free periods.
    pub coefficients: Vec<IVec2>,
    /// The halfedges through which its lines enter one face after the other.
    pub entered: Vec<HalfedgeId>,
}

/// The part of a vector that has to vanish to put it on the nearer axis.
pub fn off_axis(vector: DVec2) -> Part {
    if vector.x.abs() < vector.y.abs() {
        Part::Real
    } else {
        Part::Imaginary
    }
}

impl Cylinder {
    /// How many edges of closed loops it has when it is along an axis and `scale` times as large.
    pub fn benefit(&self, scale: f64) -> f64 {
        (self.width * scale - 1.0) * self.period.length() * scale / 2.0
    }

    /// The equation that puts it along the axis off which `part` is.
    pub fn row(&self, part: Part) -> Vec<f64> {
        real_row(&self.coefficients, part)
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // Whole numbers, which are exact.
mod tests;
