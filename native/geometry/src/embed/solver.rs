//! The geometric solver: progressive spherical embedding (Praun & Hoppe 2003).

use super::growth::{GrowError, Growth, Limits};
use super::rest::Stiffness;
use super::{OffsetPredictor, PredictError, Proposal, Settings};
use crate::hierarchy::CollapseHierarchy;
use crate::progress::Progress;

/// From so many vertices on a level is fine.
const FINE: usize = 1_000;

/// The predictor that needs no training: it undoes the collapses on the sphere, coarse to fine,
/// and relaxes in between, so that low frequencies are settled while there are few vertices.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Solver {
    /// Sweeps at each level below 1,000 vertices, at most.
    pub max_coarse_sweeps: u32,
    /// Sweeps at each level from 1,000 vertices on, at most.
    pub max_fine_sweeps: u32,
    /// The sweeps of a level end when one lowers the energy by less than this share.
    pub tolerance: f64,
    /// Levels of more vertices have no sweeps: those that finish the map must do.
    pub finest_swept: usize,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            max_coarse_sweeps: 30,
            max_fine_sweeps: 10,
            tolerance: 5e-4,
            finest_swept: usize::MAX,
        }
    }
}

impl OffsetPredictor for Solver {
    fn name(&self) -> &'static str {
        "solver"
    }

    fn finish(&self, _hierarchy: &CollapseHierarchy) -> Settings {
        if self.finest_swept == usize::MAX {
            Settings::default()
        } else {
            Settings::BRISK
        }
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        self.propose_as(Stiffness::Shape, hierarchy, progress)
    }
}

impl Solver {
    /// A solver in a hurry: it settles the low frequencies on the levels that are cheap, and leaves
    /// the high ones to the sweeps that finish the map.
    ///
    /// Far fewer swept levels leave low frequencies to the finest one, where a sweep costs twenty
    /// times as much; more of them take longer than they save.
    pub const BRISK: Self = Self {
        max_coarse_sweeps: 30,
        max_fine_sweeps: 10,
        tolerance: 5e-4,
        finest_swept: 500,
    };

    /// How the level of so many vertices is relaxed.
    pub(super) fn limits(self, n_vertices: usize) -> Limits {
        let max_sweeps = if n_vertices < FINE {
            self.max_coarse_sweeps
        } else {
            self.max_fine_sweeps
        };
        Limits {
            max_sweeps,
            tolerance: self.tolerance,
        }
    }

    /// Proposes a map in a metric of choice.
    pub(super) fn propose_as(
        self,
        wanted: Stiffness,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        let mut growth = Growth::tetrahedron(hierarchy, wanted, progress)?;
        let mut n_relaxations = 0;
        let mut grown = self.grow(hierarchy, &mut growth, progress);
        if let Err(GrowError::NoRoom { .. }) = grown {
            n_relaxations += growth.n_relaxations;
            // Triangles of equal size have the most room; relaxation brings the shape back later.
            growth = Growth::tetrahedron(hierarchy, Stiffness::Equal, progress)?;
            grown = self.grow(hierarchy, &mut growth, progress);
        }
        match grown {
            Err(GrowError::Cancelled(cancelled)) => Err(cancelled.into()),
            Err(error @ GrowError::NoRoom { .. }) => Err(PredictError::Failed {
                reason: error.to_string(),
            }),
            Ok(()) => Ok(Proposal {
                n_relaxations: n_relaxations + growth.n_relaxations,
                n_proposed: hierarchy.n_vertices(),
                sphere: growth.partial.sphere,
            }),
        }
    }

    /// Undoes what is left to undo, with sweeps each time the number of vertices has grown enough.
    pub(super) fn grow(
        self,
        hierarchy: &CollapseHierarchy,
        growth: &mut Growth,
        progress: &Progress,
    ) -> Result<(), GrowError> {
        let n_vertices = hierarchy.n_vertices();
        let mut n_relaxed = 4;
        let n_left = n_vertices - growth.partial.n_there();
        for round in (0..hierarchy.n_rounds()).rev() {
            let left = hierarchy.round(round).filter(|&i| i < n_left);
            let collapses: Vec<_> = left.map(|i| hierarchy.collapse(i)).collect();
            if collapses.is_empty() {
                continue;
            }
            growth.insert_all(&collapses, progress)?;
            let n_there = growth.partial.n_there();
            let factor = if n_there < FINE { 1.15 } else { 1.3 };
            let has_grown = n_there as f64 >= factor * n_relaxed as f64;
            if has_grown && n_there < n_vertices && n_there <= self.finest_swept {
                growth.sweeps(self.limits(n_there), progress)?;
                n_relaxed = n_there;
            }
            progress.at(n_there as f64 / n_vertices as f64)?;
        }
        Ok(())
    }
}
