//! The network as a predictor of `embed`.

use glam::DVec3;
use orbflow_geometry::embed::{OffsetPredictor, PredictError, Proposal, Settings, WeightsReport};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::VertexMap;
use orbflow_geometry::progress::Progress;

use crate::net::{Network, Sizes};
use crate::pyramid::Prepared;
use crate::weights::{ReadWeightsError, Weights};

/// Proposes the coarse levels of a hierarchy by a graph network; `embed` grows the finer ones.
#[derive(Clone, Debug)]
pub struct NetworkPredictor {
    network: Network,
    sizes: Sizes,
    weights: WeightsReport,
}

impl NetworkPredictor {
    /// A predictor with trained weights.
    ///
    /// # Errors
    /// [`ReadWeightsError`] when the parameters are not those of the header.
    pub fn new(weights: &Weights) -> Result<Self, ReadWeightsError> {
        let sum = weights.sum();
        Ok(Self {
            network: weights.network()?,
            sizes: weights.header.sizes.clone(),
            weights: WeightsReport {
                sum: format!("{sum:016x}"),
                shipped: sum == Weights::shipped_sum(),
                provenance: weights.header.provenance.clone(),
            },
        })
    }
}

impl Default for NetworkPredictor {
    /// A predictor with the weights that every build carries.
    fn default() -> Self {
        Self::new(&Weights::shipped()).expect("the tests read the same weights")
    }
}

impl OffsetPredictor for NetworkPredictor {
    fn name(&self) -> &'static str {
        "network"
    }

    fn weights(&self) -> Option<&WeightsReport> {
        Some(&self.weights)
    }

    fn finish(&self, _hierarchy: &CollapseHierarchy) -> Settings {
        Settings::BRISK
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        progress.at(0.0)?;
        let prepared = Prepared::new(hierarchy, &self.sizes.levels).map_err(|error| {
            let reason = error.to_string();
            PredictError::Failed { reason }
        })?;
        progress.at(0.3)?;
        let directions = self.network.forward(&prepared.pyramid);
        let mut sphere = VertexMap::filled(hierarchy.n_vertices(), DVec3::ZERO);
        for (&v, own) in prepared.order.iter().zip(directions) {
            sphere[v] = (prepared.frame * own).normalize_or_zero();
        }
        progress.at(1.0)?;
        Ok(Proposal {
            sphere,
            n_proposed: prepared.n_vertices(),
            n_relaxations: 0,
        })
    }
}
