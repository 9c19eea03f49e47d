//! Guidance: lines that somebody draws on a surface for edges to follow.
//!
//! A [`Stroke`] lies near a surface, not on it. [`draw()`] splits the triangles of a mesh where strokes
//! cross them, so that each becomes a chain of the mesh's own edges; vertices that are nearly on a
//! stroke are moved onto it instead, so that no thin triangles are left. What the quads make of such
//! edges is up to the flow: those of an *exact* stroke are lines that have to be met, those of one to
//! *follow* turn the field alone.
//!
//! Strokes that cross get a vertex there; borders are not crossed. Where the way from one point of a
//! stroke to the next is not found on the mesh, as round a fold, the stroke has a gap.
//!
//! A [`GuidancePredictor`] proposes strokes, and how dense quads are to be; [`NoGuidance`] proposes
//! nothing.

mod draw;
mod predict;
mod splitting;

use glam::DVec3;
use serde::{Deserialize, Serialize};

pub use draw::{Drawn, Pen, draw};
pub use predict::{
    BadGuidance, Guidance, GuidanceError, GuidancePredictor, NoGuidance, Recognised,
};

/// How strictly edges keep to a stroke.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strength {
    /// The field turns towards it near it.
    Follow,
    /// A line of edges lies on it.
    Exact,
}

impl Strength {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Follow => "follow",
            Self::Exact => "exact",
        }
    }
}

/// A line drawn near a surface.
#[derive(Clone, PartialEq, Debug)]
pub struct Stroke {
    /// Its points, in order.
    pub points: Vec<DVec3>,
    /// Whether the last is joined to the first.
    pub is_closed: bool,
    /// How strictly edges keep to it.
    pub strength: Strength,
}

impl Stroke {
    /// Its points, the first again at the end of a closed one.
    pub fn round(&self) -> impl Iterator<Item = DVec3> + '_ {
        let first = self.points.first().filter(|_| self.is_closed);
        self.points.iter().chain(first).copied()
    }

    /// How long it is.
    pub fn length(&self) -> f64 {
        let points: Vec<DVec3> = self.round().collect();
        points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum()
    }

    /// Points along it, evenly, about so far from each other; those of a closed one do not come
    /// back to the first.
    pub fn spaced(&self, step: f64) -> Vec<DVec3> {
        let points: Vec<DVec3> = self.round().collect();
        let whole = self.length();
        let fewest = if self.is_closed { FEWEST_ROUND } else { 1 };
        let n = ((whole / step).ceil() as usize).clamp(fewest, MOST_POINTS);
        let last = if self.is_closed { n - 1 } else { n };
        let mut spaced = Vec::with_capacity(last + 1);
        let mut done = 0.0;
        let mut i = 0;
        for k in 0..=last {
            let at = whole * k as f64 / n as f64;
            let mut length = points[i].distance(points[i + 1]);
            while done + length < at && i + 2 < points.len() {
                done += length;
                i += 1;
                length = points[i].distance(points[i + 1]);
            }
            let share = ((at - done) / length.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            spaced.push(points[i].lerp(points[i + 1], share));
        }
        spaced
    }
}

/// A closed stroke gets so many points at least: of fewer nothing would be left of a ring.
const FEWEST_ROUND: usize = 6;
/// No stroke gets more points than this.
const MOST_POINTS: usize = 100_000;

#[cfg(test)]
mod tests;
