//! Quads that do not flow, and which of two are to be preferred.

use serde::Serialize;

use super::probe::farthest;
use crate::deform::{Deformed, Target};
use crate::sphere;

/// A surface that is nowhere farther than this many edges is met well enough by regular quads.
const NEAR: f64 = 0.5;
/// And beyond that what is nearer by this factor is worth less regular ones.
const WORTH: f64 = 2.0;

/// What is used where quads do not flow.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Instead {
    /// Triangles of the part in pairs.
    PairedTriangles,
    /// The quad sphere, where that has fewer inverted quads or few are wanted.
    QuadSphere,
}

/// Quads that do not flow, laid on a part.
pub struct Laid {
    pub deformed: Deformed,
    pub sphere: Option<sphere::Report>,
    /// How far the surface is from them at most, in edges.
    pub off: f64,
}

impl Laid {
    pub fn new(deformed: Deformed, sphere: Option<sphere::Report>, target: &Target) -> Self {
        Self {
            off: farthest(&deformed.mesh, target),
            deformed,
            sphere,
        }
    }

    pub fn is_good(&self) -> bool {
        self.n_inverted() == 0 && self.off <= NEAR
    }

    pub fn n_inverted(&self) -> usize {
        self.deformed.report.n_inverted
    }

    /// These quads, or those of the quad sphere where these are worse.
    pub fn or_sphere(self, sphere: Self) -> (Self, Instead) {
        if self.is_worse_than(&sphere) {
            (sphere, Instead::QuadSphere)
        } else {
            (self, Instead::PairedTriangles)
        }
    }

    /// Whether more quads are inverted, or as many and the surface is missed by much more.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        let [own, others] = [self.n_inverted(), other.n_inverted()];
        let is_far = self.off > NEAR && self.off > WORTH * other.off;
        others < own || (others == own && is_far)
    }
}
