//! What the network and what there is beside it reach on one shape.

use std::collections::BTreeMap;

use glam::DVec3;
use orbflow_geometry::decimate::{self, simplify};
use orbflow_geometry::embed::{OffsetPredictor, Solver};
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh};
use orbflow_geometry::pipeline;
use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_network::NetworkPredictor;
use orbflow_network::net::Network;
use orbflow_network::weights::{ReadWeightsError, Weights};
use serde::Serialize;
use thiserror::Error;

use super::rebuilt::Rebuilt;
use super::rotation::angles_between;
use crate::parts::refined;
use crate::prepare::WHOLE_FACES;
use crate::sample::{Sample, SampleError};
use crate::set::{Set, SetError, Shape, Which};
use crate::thesis::target::ThesisError;
use crate::thesis::{self, Example, Moved, Thesis};

/// What is evaluated.
pub struct Subject {
    pub(super) network: Network,
    predictor: NetworkPredictor,
    pub(super) levels: Vec<usize>,
    thesis: Option<Thesis>,
}

/// Who proposes a map.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Proposer {
    /// The directions from the centre.
    Radial,
    /// The network, before any repair.
    Network,
    /// The solver before any sweep.
    Unswept,
    /// The solver.
    Solver,
    /// The network of the thesis.
    Thesis,
    /// What the network of the thesis is to learn.
    ThesisTarget,
}

/// What was reached on one shape.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Outcome {
    /// Where the shape comes from.
    pub name: String,
    /// The folder that its file is in, or "made".
    pub category: String,
    /// How many vertices the level has that is proposed.
    pub n_vertices: usize,
    /// The maps of the level.
    pub proposals: BTreeMap<Proposer, Proposed>,
    /// Angles between the network's points and the solver's after the best rotation: the median and
    /// what 90 % stay below, in degrees.
    pub angles_deg: [f64; 2],
    /// The finished map of the whole mesh.
    pub whole: Option<Whole>,
}

/// How good a proposal for the level is.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Proposed {
    /// Its distortion, in the mean log form of the report.
    pub energy: f64,
    /// Folded triangles of a hundred.
    pub folds_pct: f64,
    /// The shape that a sphere of even points becomes by it.
    #[serde(flatten)]
    pub rebuilt: Rebuilt,
}

/// Finished maps of a whole mesh, from the solver alone and from the network's proposal.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Whole {
    /// How many vertices it has.
    pub n_vertices: usize,
    /// From the solver alone.
    pub solver: Cost,
    /// From the solver in a hurry, as it grows the network's proposals.
    pub brisk: Cost,
    /// From the network's proposal.
    pub network: Cost,
    /// Whether the proposal was given up for the solver's map.
    pub gave_up: bool,
}

/// What a finished map is worth and what it took.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Cost {
    /// Its distortion.
    pub energy: f64,
    /// Relaxations of single vertices.
    pub n_relaxations: u64,
    /// Processor time of the process, the collapse included; none where the system does not tell.
    pub cpu_ms: Option<f64>,
}

/// Why a shape cannot be evaluated.
#[derive(Debug, Error)]
pub enum OutcomeError {
    /// The level cannot be prepared or solved.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The whole mesh cannot be simplified.
    #[error(transparent)]
    Simplify(#[from] decimate::Error),
    /// The whole mesh cannot be embedded.
    #[error(transparent)]
    Embed(#[from] pipeline::Error),
    /// The thesis's network cannot read the shape.
    #[error(transparent)]
    Thesis(#[from] ThesisError),
    /// The set cannot be read.
    #[error(transparent)]
    Set(#[from] SetError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl OutcomeError {
    /// Whether the user asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Set(SetError::Cancelled(_))
                | Self::Thesis(ThesisError::Cancelled(_))
        )
    }
}

impl Subject {
    /// Makes trained weights ready.
    ///
    /// # Errors
    /// [`ReadWeightsError`] when the parameters are not those of the header.
    pub fn new(weights: &Weights) -> Result<Self, ReadWeightsError> {
        Ok(Self {
            network: weights.network()?,
            predictor: NetworkPredictor::new(weights)?,
            levels: weights.header.sizes.levels.clone(),
            thesis: None,
        })
    }

    /// Has the network of the thesis beside it, trained on these shapes of a set.
    ///
    /// # Errors
    /// [`OutcomeError`].
    pub fn with_thesis(
        self,
        (set, shapes): (&Set, &[Which<'_>]),
        settings: thesis::Settings,
        progress: &Progress,
    ) -> Result<Self, OutcomeError> {
        let make = |which: Which<'_>, shape: Shape| {
            let sample = Sample::of(which.name(), &shape.level, &self.levels)?;
            let example = Example::new(&sample, &shape.level)?;
            Ok::<_, OutcomeError>(example.with_target(shape.target))
        };
        let examples = set.read_all(shapes, make, &progress.part("load", 0.0, 0.1))?;
        let stage = progress.part("", 0.1, 1.0);
        let thesis = Some(Thesis::trained(&examples, settings, &stage)?);
        Ok(Self { thesis, ..self })
    }

    /// The levels of the network, fine to coarse.
    pub fn levels(&self) -> &[usize] {
        &self.levels
    }

    /// Measures one shape; `finish` asks for the finished maps of the whole mesh too.
    ///
    /// # Errors
    /// [`OutcomeError`].
    pub fn outcome(
        &self,
        which: Which<'_>,
        shape: &Shape,
        finish: bool,
    ) -> Result<Outcome, OutcomeError> {
        let whole = finish.then(|| self.whole(&shape.whole)).transpose()?;
        let sample = Sample::of(which.name(), &shape.level, &self.levels)?;
        let network = self.network.forward(&sample.prepared.pyramid);
        let (unswept, solver) = (sample.unswept_sphere()?, sample.solver_sphere()?);
        let angles = angles_between(&network, &solver);
        let proposals = [
            (Proposer::Radial, sample.mesh.positions()),
            (Proposer::Network, &network),
            (Proposer::Unswept, &unswept),
            (Proposer::Solver, &solver),
        ];
        let proposals = proposals.map(|(who, directions)| (who, proposed(&sample, directions)));
        let mut proposals = BTreeMap::from(proposals);
        if let Some(thesis) = &self.thesis {
            let example = Example::new(&sample, &shape.level)?;
            let example = example.with_target(shape.target.clone());
            let vertices = sample.mesh.positions();
            let both = [
                (Proposer::Thesis, thesis.predicted(&example, vertices)),
                (Proposer::ThesisTarget, thesis.target(&example, vertices)?),
            ];
            proposals.extend(both.map(|(who, moved)| (who, measured(&sample, &moved))));
        }
        Ok(Outcome {
            category: which.source.category.clone(),
            n_vertices: sample.mesh.n_vertices(),
            proposals,
            angles_deg: [0.5, 0.9]
                .map(|share| angles[(share * (angles.len() - 1) as f64) as usize]),
            whole,
            name: sample.name,
        })
    }

    fn whole(&self, mesh: &TriangleMesh) -> Result<Whole, OutcomeError> {
        let mesh = finest(mesh)?;
        let n_vertices = mesh.positions().len();
        let (solver, _) = finished(&mesh, &Solver::default())?;
        let (brisk, _) = finished(&mesh, &Solver::BRISK)?;
        let (network, gave_up) = finished(&mesh, &self.predictor)?;
        Ok(Whole {
            n_vertices,
            solver,
            brisk,
            network,
            gave_up,
        })
    }
}

/// The mesh that is finished, at its number of faces.
pub(super) fn finest(mesh: &TriangleMesh) -> Result<PolygonMesh, OutcomeError> {
    let settings = decimate::Settings {
        n_faces: WHOLE_FACES,
    };
    let mesh = refined(mesh.clone(), WHOLE_FACES);
    let simplified = simplify(&mesh, &settings, &Progress::none())?;
    Ok(PolygonMesh::from(&simplified.mesh))
}

/// How good directions of any length are.
fn proposed(sample: &Sample, directions: &[DVec3]) -> Proposed {
    let sphere: Vec<DVec3> = directions.iter().map(|d| d.normalize_or_zero()).collect();
    let quality = sample.quality(&sphere);
    Proposed {
        energy: quality.energy,
        folds_pct: quality.folds_pct,
        rebuilt: Rebuilt::new(&sample.mesh, &sphere),
    }
}

/// How good the sphere of the thesis is: itself as a surface, and what it says of where the vertices lie.
fn measured(sample: &Sample, moved: &Moved) -> Proposed {
    let quality = sample.quality(&moved.directions);
    Proposed {
        energy: quality.energy,
        folds_pct: quality.folds_pct,
        rebuilt: Rebuilt::of(&moved.surface, &sample.mesh),
    }
}

/// Embeds a mesh on one thread; also says whether the proposal was given up.
fn finished(
    mesh: &PolygonMesh,
    predictor: &dyn OffsetPredictor,
) -> Result<(Cost, bool), pipeline::Error> {
    let report = pipeline::embed(mesh, 1, predictor, &Progress::none())?.report;
    let step = report.steps.iter().find(|step| step.name == "embed");
    let cost = Cost {
        energy: report.embedding.energy,
        n_relaxations: report.embedding.n_relaxations,
        cpu_ms: step.and_then(|step| step.cpu_ms),
    };
    Ok((cost, report.embedding.repair.fell_back_to_solver))
}
