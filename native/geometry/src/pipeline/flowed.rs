//! Quads that flow, once they are fitted, and which of two are to be preferred.

use serde::Serialize;

use super::attempt::Attempt;
use super::crosses::Cross;
use super::laid::Instead;
use crate::deform::Deformed;
use crate::{embed, flow, sphere};

/// Marked edges are worth a smoother field that saves this share of the marked edges.
const WORTH: f64 = 0.05;

/// One in so many quads may be inverted before it is opened; of more, shape is lost.
const QUADS_PER_KNOT: usize = 50;
/// Where strips were taken out one in so many quads may be missed: else the quad sphere is nearer.
const QUADS_PER_MISS: usize = 20;
/// One pair of triangles in so many quads may cross when they have been moved apart.
const QUADS_PER_CROSSING: usize = 200;

/// Whether a part's quads flow.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Flowed {
    /// They do.
    Used {
        /// With which settings.
        attempt: Attempt,
        /// How many settings were tried, those of a symmetric surface too.
        n_attempts: usize,
        /// How many borders have rings of edges laid on them for want of lines, each side of a cut one.
        n_rings: usize,
        /// How they were found.
        flow: flow::Report,
        /// What had to be repaired to lay them on the sphere.
        cover: embed::CoverReport,
    },
    /// They are a grid, as the part was: with other counts.
    Grid,
    /// They are the part's own quads: as they were, cut into finer ones, or without some strips.
    Own {
        /// How many of the part's own quads went with strips that were taken out.
        n_taken: usize,
        /// How many strips of quads there are, each cut into a number of rows.
        n_strips: usize,
    },
    /// They do not.
    Refused {
        /// Why not.
        reason: String,
        /// What was used instead.
        instead: Instead,
    },
}

impl Flowed {
    /// How many borders have rings for want of lines.
    pub fn n_rings(&self) -> usize {
        match self {
            Self::Used { n_rings, .. } => *n_rings,
            Self::Grid | Self::Own { .. } | Self::Refused { .. } => 0,
        }
    }
}

/// A part whose quads flow.
pub struct FlowedPart {
    pub deformed: Deformed,
    /// How many quads the part of the surface that they miss would take, and how many are astray.
    pub n_missed: usize,
    /// How many lines along borders got rings in their stead.
    pub n_unmet: usize,
    /// The share of the marked edges that no edge of a quad lies along.
    pub lost: f64,
    pub sphere: sphere::Report,
    pub flowed: Flowed,
    /// As many crosses of the field as were asked for.
    pub crosses: Vec<Cross>,
    /// Whether it is its own image in the plane; an error says why not, none was asked.
    pub mirrored: Option<Result<(), String>>,
}

impl FlowedPart {
    /// How many quads fail the gate.
    pub fn n_failed(&self) -> usize {
        let report = &self.deformed.report;
        let n_quads = self.deformed.mesh.n_faces();
        let n_knotted = report.n_knotted.saturating_sub(n_quads / QUADS_PER_KNOT);
        let n_crossing = report
            .n_crossing_left
            .saturating_sub(n_quads / QUADS_PER_CROSSING);
        report.n_inverted + self.n_missed + self.n_unmet + n_knotted + n_crossing
    }

    /// An error where strips were taken out and too much of the surface went with them.
    pub fn not_cut_off(self) -> Result<Self, String> {
        let n_quads = self.deformed.mesh.n_faces();
        if self.is_last_resort() && self.n_missed * QUADS_PER_MISS > n_quads {
            return Err(format!("{} of {n_quads} quads are missed", self.n_missed));
        }
        Ok(self)
    }

    /// How many quads are inverted.
    pub fn n_inverted(&self) -> usize {
        self.deformed.report.n_inverted
    }

    /// Whether nothing fails and marked edges are met.
    pub fn is_sound(&self) -> bool {
        self.n_failed() == 0 && self.lost <= WORTH
    }

    /// The same with how many settings were tried.
    #[must_use]
    pub fn found_in(mut self, n: usize) -> Self {
        if let Flowed::Used { n_attempts, .. } = &mut self.flowed {
            *n_attempts = n;
        }
        self
    }

    /// How many of its borders have rings for want of lines.
    pub fn n_rings(&self) -> usize {
        self.flowed.n_rings()
    }

    pub fn is_last_resort(&self) -> bool {
        matches!(&self.flowed, Flowed::Used { attempt, .. } if attempt.is_last_resort())
    }

    /// Whether it is to be preferred: fewer quads fail, or as many and more marks are met.
    fn is_better_than(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(FlowedPart::n_failed);
        own < others || (own == others && self.lost + WORTH < other.lost)
    }
}

/// The better one, the first of equals; of two reasons the first.
pub fn better(
    best: Result<FlowedPart, String>,
    next: Result<FlowedPart, String>,
) -> Result<FlowedPart, String> {
    match (&best, &next) {
        (Ok(old), Ok(new)) if !new.is_better_than(old) => best,
        (Ok(_), Err(_)) => best,
        (Err(reason), Err(_)) if !reason.is_empty() => best,
        _ => next,
    }
}
