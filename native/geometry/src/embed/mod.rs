//! Spherical embedding: a closed mesh of genus 0 is laid on the unit sphere, one point per vertex,
//! without a fold.
//!
//! An [`OffsetPredictor`] reads the [`CollapseHierarchy`] and proposes sphere points sᵢ (offsets
//! xᵢ − sᵢ). [`embed`] checks the proposal, repairs its folds, relaxes it and proves the result, so
//! that a predictor can be wrong but never break a mesh. The [`Solver`] proposes by geometry alone
//! (Praun & Hoppe 2003, with the symmetric Dirichlet energy of Smith & Schaefer 2015); it is the
//! baseline, and what is done when a proposal cannot be repaired.

mod coarse;
mod cover;
mod energy;
mod fan;
mod finish;
mod growth;
mod layout;
mod level;
mod partial;
mod proposal;
mod repair;
mod rest;
mod room;
mod settle;
mod solver;
mod times;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::hierarchy::CollapseHierarchy;
use crate::mesh::{TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{NotABijection, SphereMap, folded_faces};
pub use cover::{CoverError, CoverReport, Covered, cover};
pub use energy::distortion;
use energy::try_distortion;
use finish::finish;
use proposal::unit_vectors;
pub use proposal::{ProposalReport, WeightsReport};
use rest::Stiffness;
pub use solver::Solver;
pub use times::Times;
use times::timed;

/// Proposes where on the sphere the vertices of a mesh go.
///
/// A proposal may be wrong in any way: not finite, too short, folded, of the wrong degree.
pub trait OffsetPredictor: Sync {
    /// The name that reports carry.
    fn name(&self) -> &str;

    /// Which learnt weights it has; none where it has learnt nothing.
    fn weights(&self) -> Option<&WeightsReport> {
        None
    }

    /// How its map of a mesh is finished, unless the caller wants it otherwise.
    fn finish(&self, _hierarchy: &CollapseHierarchy) -> Settings {
        Settings::default()
    }

    /// Who proposes for a mesh in its place; itself where there is none.
    fn deputy(&self, _hierarchy: &CollapseHierarchy) -> Option<&dyn OffsetPredictor> {
        None
    }

    /// Proposes a point for every vertex, or for those of a coarse level.
    ///
    /// # Errors
    /// [`PredictError`].
    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError>;
}

/// What a predictor proposes.
#[derive(Clone, PartialEq, Debug)]
pub struct Proposal {
    /// A direction for every proposed vertex; of any length, x − offset.
    pub sphere: VertexMap<DVec3>,
    /// How many vertices are proposed, counted from the coarsest
    /// ([`coarse_to_fine`](CollapseHierarchy::coarse_to_fine)). [`Solver::BRISK`] grows the others.
    pub n_proposed: usize,
    /// How many relaxations of single vertices the predictor did.
    pub n_relaxations: u64,
}

/// Why a predictor has no proposal.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum PredictError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It cannot do this mesh.
    #[error("the predictor has no proposal: {reason}")]
    Failed {
        /// Why.
        reason: String,
    },
}

/// How a map is finished.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Settings {
    /// Sweeps of relaxation over the whole map, at most.
    pub max_sweeps: u32,
    /// They end when one lowers the energy by less than this share.
    pub tolerance: f64,
}

impl Settings {
    /// Ends where a sweep is not worth its time any more: within a percent or two of the lowest
    /// energy, for a third of the sweeps.
    pub const BRISK: Self = Self {
        max_sweeps: 20,
        tolerance: 1e-2,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_sweeps: 20,
            tolerance: 1e-4,
        }
    }
}

/// What the repair of a proposal had to do.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
pub struct RepairReport {
    /// Whether the proposal was turned inside out first, being mostly folded.
    pub mirrored: bool,
    /// How many vertices were taken out and put back.
    pub n_moved: usize,
    /// Whether the proposal was given up for the solver's own map.
    pub fell_back_to_solver: bool,
}

/// What an embedding did and reached.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// How many vertices were embedded.
    pub n_vertices: usize,
    /// How many spherical triangles are folded: none.
    pub n_folds: usize,
    /// How often the sphere is covered: once.
    pub degree: i64,
    /// The [`distortion`] of the map.
    pub energy: f64,
    /// How many relaxations of single vertices were done, by the predictor and after it.
    pub n_relaxations: u64,
    /// How many sweeps finished the map.
    pub n_sweeps: u32,
    /// Whether they reached the tolerance; if not, more of [`Settings::max_sweeps`] lower the energy.
    pub complete: bool,
    /// Who proposed it.
    pub predictor: String,
    /// With which weights; none where nothing was learnt.
    pub weights: Option<WeightsReport>,
    /// What was proposed.
    pub proposal: ProposalReport,
    /// What had to be repaired.
    pub repair: RepairReport,
    /// How long that took.
    pub times: Times,
}

impl Report {
    /// What is told where nothing was embedded.
    pub fn none() -> Self {
        Self {
            n_vertices: 0,
            n_folds: 0,
            degree: 1,
            energy: 0.0,
            n_relaxations: 0,
            n_sweeps: 0,
            complete: true,
            predictor: "none".to_owned(),
            weights: None,
            proposal: ProposalReport {
                degree: 1,
                ..ProposalReport::default()
            },
            repair: RepairReport::default(),
            times: Times::default(),
        }
    }
}

/// An embedded mesh.
#[derive(Clone, Debug)]
pub struct Embedded {
    /// The proven map.
    pub map: SphereMap,
    /// How it was made.
    pub report: Report,
}

/// Why a mesh could not be embedded.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is no proposal.
    #[error(transparent)]
    Predict(PredictError),
    /// The map did not pass the proof.
    #[error("the map is not a bijection: {0}")]
    NotABijection(#[from] NotABijection),
}

impl From<PredictError> for Error {
    fn from(error: PredictError) -> Self {
        match error {
            PredictError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            failed @ PredictError::Failed { .. } => Self::Predict(failed),
        }
    }
}

/// Lays a mesh on the sphere: the predictor or its deputy proposes, the solver repairs and relaxes,
/// and the map is proven to be a bijection.
///
/// # Errors
/// [`enum@Error`]; for a predictor that returns, only when cancelled or when the coordinates of doubles
/// are too coarse for the mesh.
pub fn embed(
    hierarchy: &CollapseHierarchy,
    predictor: &dyn OffsetPredictor,
    settings: &Settings,
    progress: &Progress,
) -> Result<Embedded, Error> {
    // Loops of a few microseconds are worth sharing only from inside the thread pool.
    rayon::scope(|_| embed_in_pool(hierarchy, predictor, settings, progress))
}

fn embed_in_pool(
    hierarchy: &CollapseHierarchy,
    predictor: &dyn OffsetPredictor,
    settings: &Settings,
    progress: &Progress,
) -> Result<Embedded, Error> {
    let mesh = hierarchy.mesh();
    let predictor = predictor.deputy(hierarchy).unwrap_or(predictor);
    let mut times = Times::default();
    let proposing = progress.part("", 0.0, 0.7);
    let propose = || predictor.propose(hierarchy, &proposing);
    let proposed = timed(&mut times.propose_ms, propose)?;
    let mending = progress.part("", 0.7, 0.9);
    let (valid, proposal) = if proposed.n_proposed < mesh.n_vertices() {
        coarse::grown(hierarchy, &proposed, &mut times, &mending)?
    } else {
        mended(hierarchy, &proposed, &mut times, &mending)?
    };
    let finishing = progress.part("", 0.9, 1.0);
    let how = (settings, Stiffness::Shape);
    let finish = timed(&mut times.relax_ms, || {
        finish(mesh, valid.sphere, how, &finishing)
    })?;
    progress.check()?;
    let map = SphereMap::prove(mesh.clone(), finish.sphere)?;
    progress.check()?;
    let report = Report {
        n_vertices: mesh.n_vertices(),
        n_folds: 0,
        degree: 1,
        energy: try_distortion(mesh, map.sphere(), progress)?,
        n_relaxations: valid.n_relaxations + finish.n_relaxations,
        n_sweeps: finish.n_sweeps,
        complete: finish.complete,
        predictor: predictor.name().to_owned(),
        weights: predictor.weights().cloned(),
        proposal,
        repair: valid.report,
        times,
    };
    Ok(Embedded { map, report })
}

/// A proposal for all vertices, made valid.
fn mended(
    hierarchy: &CollapseHierarchy,
    proposed: &Proposal,
    times: &mut Times,
    progress: &Progress,
) -> Result<(Valid, ProposalReport), Error> {
    let mesh = hierarchy.mesh();
    let sphere = unit_vectors(proposed, mesh.n_vertices());
    let report = ProposalReport::new(mesh, &sphere, proposed.n_relaxations, progress)?;
    let mut valid = Valid::new(sphere, proposed.n_relaxations);
    let (mending, whole) = (progress.part("", 0.0, 0.5), progress.part("", 0.5, 1.0));
    timed(&mut times.repair_ms, || {
        if !report.is_valid() && !valid.mend(mesh, report.n_folds, &mending)? {
            valid.fall_back(hierarchy, Solver::default(), &whole)?;
        }
        Ok((valid, report))
    })
}

/// Lays a mesh on the sphere by the solver alone, so that areas are kept rather than angles.
///
/// A primitive of even faces then has even faces on the surface too, at the tips of limbs as well.
/// [`distortion`] is a few percent higher than that of [`embed`].
///
/// # Errors
/// [`enum@Error`]; without a cancellation only when the coordinates of doubles are too coarse.
pub fn even(hierarchy: &CollapseHierarchy, progress: &Progress) -> Result<SphereMap, Error> {
    rayon::scope(|_| {
        let growing = progress.part("", 0.0, 0.8);
        let Proposal { sphere, .. } =
            Solver::default().propose_as(Stiffness::Even, hierarchy, &growing)?;
        let finishing = progress.part("", 0.8, 1.0);
        let how = (&Settings::default(), Stiffness::Even);
        let mesh = hierarchy.mesh();
        let sphere = finish(mesh, sphere, how, &finishing)?.sphere;
        progress.check()?;
        Ok(SphereMap::prove(mesh.clone(), sphere)?)
    })
}

/// A proposal on its way to a valid map.
struct Valid {
    sphere: VertexMap<DVec3>,
    n_relaxations: u64,
    report: RepairReport,
}

impl Valid {
    fn new(sphere: VertexMap<DVec3>, n_relaxations: u64) -> Self {
        Self {
            sphere,
            n_relaxations,
            report: RepairReport::default(),
        }
    }

    /// Makes a map of a mesh valid: turned inside out where that helps, repaired where it can be.
    /// False where it cannot.
    fn mend(
        &mut self,
        mesh: &TriangleMesh,
        n_folds: usize,
        progress: &Progress,
    ) -> Result<bool, Cancelled> {
        let mut sphere = std::mem::replace(&mut self.sphere, VertexMap::from_vec(Vec::new()));
        // A mirrored map is folded everywhere, and right again after s → −s.
        let turned: VertexMap<DVec3> = sphere.iter().map(|&p| -p).collect();
        if folded_faces(mesh.faces(), &turned).len() < n_folds {
            self.report.mirrored = true;
            sphere = turned;
        }
        let Some(repaired) = repair::repair(mesh, sphere, repair::SMOOTHING, progress)? else {
            return Ok(false);
        };
        self.n_relaxations += repaired.n_relaxations;
        self.report.n_moved = repaired.n_moved;
        self.sphere = repaired.sphere;
        Ok(true)
    }

    /// Gives the proposal up for a solver's own map.
    fn fall_back(
        &mut self,
        hierarchy: &CollapseHierarchy,
        solver: Solver,
        progress: &Progress,
    ) -> Result<(), Error> {
        self.report = RepairReport {
            fell_back_to_solver: true,
            ..RepairReport::default()
        };
        let own = solver.propose(hierarchy, progress)?;
        self.n_relaxations += own.n_relaxations;
        self.sphere = own.sphere;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
