//! The default of the program: the network where it saves time, else the solver.

use orbflow_geometry::embed::{OffsetPredictor, PredictError, Proposal, Solver};
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
    network: NetworkPredictor,
    solver: Solver,
    least_vertices: usize,
}

impl AutoPredictor {
    /// From so many vertices on the network proposes.
    pub const LEAST_VERTICES: usize = 20_000;

    /// Chooses between the solver and a network, from so many vertices on.
    pub fn new(network: NetworkPredictor, least_vertices: usize) -> Self {
        Self {
            network,
            solver: Solver::default(),
            least_vertices,
        }
    }

    fn choice(&self, hierarchy: &CollapseHierarchy) -> &dyn OffsetPredictor {
        if hierarchy.n_vertices() < self.least_vertices {
            &self.solver
        } else {
            &self.network
        }
    }
}

impl Default for AutoPredictor {
    /// With the weights that every build carries.
    fn default() -> Self {
        Self::new(NetworkPredictor::default(), Self::LEAST_VERTICES)
    }
}

impl OffsetPredictor for AutoPredictor {
    fn name(&self) -> &'static str {
        "auto"
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
