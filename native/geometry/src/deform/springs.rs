//! Springs: the edges of quads that are to be even wish for one length while they are fitted.
//!
//! An edge from u to v along the unit vector d, of length l, asks that its ends' steps make it as
//! long as all are in the mean, L: k (d · (step(v) − step(u)) − (L − l))². It asks along the surface
//! alone, so that no limb swells or shrinks for it, and says nothing about turning.

use glam::DVec3;

use super::follow::Stars;
use super::sheet::Sheet;
use crate::mesh::{VertexId, VertexMap};

/// No edge asks for more than this share of the mean at once: at 0.5 the many short edges across a
/// thin hull turn quads over.
const MOST_ASKED: f64 = 0.3;

/// By how much a length is asked to grow towards the mean at once, or to shrink.
pub(super) fn asked(mean: f64, length: f64) -> f64 {
    let most = MOST_ASKED * mean;
    (mean - length).clamp(-most, most)
}

/// The edges of a sheet as springs.
pub(super) struct Springs {
    stars: Stars,
    mean: f64,
    /// Of each edge, relative to a sample's pull.
    weight: f64,
}

impl Springs {
    /// All edges of a sheet.
    pub fn new(sheet: &Sheet, weight: f64) -> Self {
        Self {
            stars: Stars::new(sheet),
            mean: sheet.mean_edge(),
            weight,
        }
    }

    /// Of each edge at a vertex how it wants the vertex to step: along which way, how far if the
    /// others take their steps, and how much it weighs.
    pub fn at(
        &self,
        sheet: &Sheet,
        v: VertexId,
        steps: &VertexMap<DVec3>,
    ) -> impl Iterator<Item = (DVec3, f64, f64)> {
        let here = *sheet.point(v);
        self.stars.of(v).iter().map(move |&u| {
            let edge = here.position - sheet.position(u);
            let length = edge.length();
            let way = edge / length.max(f64::MIN_POSITIVE);
            let way = way - here.normal * here.normal.dot(way);
            let gap = asked(self.mean, length) + way.dot(steps[u]);
            (way, gap, self.weight)
        })
    }
}
