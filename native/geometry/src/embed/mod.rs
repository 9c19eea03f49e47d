//! Spherical embedding: a closed mesh of genus 0 is laid on the unit sphere, one point per vertex,
//! without a fold.
//!
//! An [`OffsetPredictor`] reads the [`CollapseHierarchy`] and proposes sphere points sᵢ (offsets
//! xᵢ − sᵢ). [`embed`] checks the proposal, repairs its folds, relaxes it and proves the result, so
//! that a predictor can be wrong but never break a mesh. The [`Solver`] proposes by geometry alone
//! (Praun & Hoppe 2003, with the symmetric Dirichlet energy of Smith & Schaefer 2015); it is the
//! baseline, and what is done when a proposal cannot be repaired.

mod energy;
mod fan;
mod growth;
mod level;
mod partial;
mod rest;
mod room;
mod solver;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::hierarchy::CollapseHierarchy;
use crate::mesh::VertexMap;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{NotABijection, SphereMap, degree, folded_faces};
pub use energy::distortion;
use level::Level;
use partial::Partial;
pub use solver::Solver;

/// Proposes where on the sphere the vertices of a mesh go.
///
/// A proposal may be wrong in any way: not finite, too short, folded, of the wrong degree.
pub trait OffsetPredictor: Sync {
    /// The name that reports carry.
    fn name(&self) -> &str;

    /// Proposes a point for every vertex of the finest mesh.
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
    /// A direction for every vertex of the finest mesh; of any length, x − offset.
    pub sphere: VertexMap<DVec3>,
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

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_sweeps: 20,
            tolerance: 1e-4,
        }
    }
}

/// What was proposed, before any repair.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct ProposalReport {
    /// Its [`distortion`], points that are not usable counted as (0, 0, 1).
    pub energy: f64,
    /// How many triangles were folded.
    pub n_folds: usize,
    /// The same in percent.
    pub folds_pct: f64,
    /// How often it covered the sphere.
    pub degree: i64,
    /// How many vertices had no usable point.
    pub n_unusable: usize,
    /// How many relaxations of single vertices the predictor did.
    pub n_relaxations: u64,
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
    /// What was proposed.
    pub proposal: ProposalReport,
    /// What had to be repaired.
    pub repair: RepairReport,
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

/// Lays a mesh on the sphere: the predictor proposes, the solver repairs and relaxes, and the map
/// is proven to be a bijection.
///
/// # Errors
/// [`Error`]; for a predictor that returns, only when cancelled or when the coordinates of doubles
/// are too coarse for the mesh.
pub fn embed(
    hierarchy: &CollapseHierarchy,
    predictor: &dyn OffsetPredictor,
    settings: &Settings,
    progress: &Progress,
) -> Result<Embedded, Error> {
    let mesh = hierarchy.mesh();
    let proposed = predictor.propose(hierarchy, &progress.part("", 0.0, 0.7))?;
    let mut n_relaxations = proposed.n_relaxations;
    let (mut sphere, n_unusable) = usable(&proposed.sphere, mesh.n_vertices());
    let proposal = assess(hierarchy, &sphere, n_unusable, proposed.n_relaxations);
    let mut repair = RepairReport::default();
    if proposal.n_folds > 0 || proposal.degree != 1 || n_unusable > 0 {
        repair.fell_back_to_solver = true;
        let own = Solver::default().propose(hierarchy, &progress.part("", 0.7, 0.9))?;
        sphere = own.sphere;
        n_relaxations += own.n_relaxations;
    }
    let finish = finish(hierarchy, sphere, settings, &progress.part("", 0.9, 1.0))?;
    let map = SphereMap::prove(mesh.clone(), finish.sphere)?;
    let report = Report {
        n_vertices: mesh.n_vertices(),
        n_folds: 0,
        degree: 1,
        energy: distortion(mesh, map.sphere()),
        n_relaxations: n_relaxations + finish.n_relaxations,
        n_sweeps: finish.n_sweeps,
        complete: finish.complete,
        predictor: predictor.name().to_owned(),
        proposal,
        repair,
    };
    Ok(Embedded { map, report })
}

/// One unit vector per vertex, and how many vertices had none.
fn usable(sphere: &VertexMap<DVec3>, n_vertices: usize) -> (VertexMap<DVec3>, usize) {
    let given = sphere.iter().map(|p| p.try_normalize());
    let given: Vec<_> = given
        .chain(std::iter::repeat(None))
        .take(n_vertices)
        .collect();
    let n_unusable = given.iter().filter(|p| p.is_none()).count();
    let points = given.into_iter().map(|p| p.unwrap_or(DVec3::Z));
    (points.collect(), n_unusable)
}

fn assess(
    hierarchy: &CollapseHierarchy,
    sphere: &VertexMap<DVec3>,
    n_unusable: usize,
    n_relaxations: u64,
) -> ProposalReport {
    let mesh = hierarchy.mesh();
    let n_folds = folded_faces(mesh.faces(), sphere).len();
    ProposalReport {
        energy: distortion(mesh, sphere),
        n_folds,
        folds_pct: 100.0 * n_folds as f64 / mesh.n_faces() as f64,
        degree: degree(mesh.faces(), sphere),
        n_unusable,
        n_relaxations,
    }
}

/// A finished map.
struct Finish {
    sphere: VertexMap<DVec3>,
    n_relaxations: u64,
    n_sweeps: u32,
    complete: bool,
}

/// Sweeps over a valid map until its energy is settled.
fn finish(
    hierarchy: &CollapseHierarchy,
    sphere: VertexMap<DVec3>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Finish, Cancelled> {
    let mut partial = Partial::whole(hierarchy.mesh(), sphere);
    let positions = rest::to_size_one(hierarchy.mesh().positions());
    let mut level = Level::new(&partial, &positions, rest::Metric::FINISH);
    let (mut n_relaxations, mut n_sweeps, mut complete) = (0, 0, false);
    while n_sweeps < settings.max_sweeps && !complete {
        progress.at(f64::from(n_sweeps) / f64::from(settings.max_sweeps))?;
        let sweep = level.sweep(growth::STILL, progress)?;
        n_relaxations += sweep.n_relaxations;
        n_sweeps += 1;
        complete = sweep.decrease <= settings.tolerance * sweep.energy;
    }
    level.store(&mut partial);
    Ok(Finish {
        sphere: partial.sphere,
        n_relaxations,
        n_sweeps,
        complete,
    })
}

#[cfg(test)]
mod tests;
