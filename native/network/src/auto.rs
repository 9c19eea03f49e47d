//! The default of the program: the network where it saves time, else the solver.

use std::sync::OnceLock;

use orbflow_geometry::embed::{OffsetPredictor, PredictError, Proposal, Settings, Solver};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::progress::Progress;

use crate::predictor::NetworkPredictor;

/// The network for meshes of many vertices, the solver for others.
///
/// Both lead to maps of the same distortion, within a percent. With the network a map of 16,000
/// vertices takes two thirds of the solver's time, but below 20,000 vertices less than a tenth of a
/// second is saved, too little for a map that hangs on weights.
#[derive(Clone, Debug)]
pub struct AutoPredictor {
    /// That of the shipped weights is not made before it is asked.
    network: OnceLock<NetworkPredictor>,
    solver: Solver,
    least_vertices: usize,
}

impl AutoPredictor {
    /// Chooses between the solver and a network of one's own.
    pub fn new(network: NetworkPredictor) -> Self {
        Self {
            network: network.into(),
            ..Self::default()
        }
    }

    /// The same, but the network proposes from so many vertices on.
    #[must_use]
    pub fn from_vertices(self, least_vertices: usize) -> Self {
        Self {
            least_vertices,
            ..self
        }
    }

    fn choice(&self, hierarchy: &CollapseHierarchy) -> &dyn OffsetPredictor {
        if hierarchy.n_vertices() < self.least_vertices {
            &self.solver
        } else {
            self.network.get_or_init(NetworkPredictor::default)
        }
    }
}

impl Default for AutoPredictor {
    /// With the weights that every build carries.
    fn default() -> Self {
        Self {
            network: OnceLock::new(),
            solver: Solver::default(),
            least_vertices: 20_000,
        }
    }
}

impl OffsetPredictor for AutoPredictor {
    fn name(&self) -> &'static str {
        "auto"
    }

    fn finish(&self, hierarchy: &CollapseHierarchy) -> Settings {
        self.choice(hierarchy).finish(hierarchy)
    }

    fn deputy(&self, hierarchy: &CollapseHierarchy) -> Option<&dyn OffsetPredictor> {
        Some(self.choice(hierarchy))
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        self.choice(hierarchy).propose(hierarchy, progress)
    }
}
