//! The predictor that was asked for.

use std::fs;
use std::path::Path;

use orbflow_geometry::embed::{OffsetPredictor, Solver};
use orbflow_network::weights::{ReadWeightsError, Weights};
use orbflow_network::{AutoPredictor, NetworkPredictor};

use crate::arguments::{Predictor, Run};
use crate::error::Error;

impl Run {
    /// The predictor itself, with its weights.
    pub fn build(&self) -> Result<Box<dyn OffsetPredictor>, Error> {
        match (self.predictor, &self.weights) {
            (Predictor::Auto, None) => Ok(Box::<AutoPredictor>::default()),
            (Predictor::Auto, path) => Ok(Box::new(AutoPredictor::new(network(path.as_deref())?))),
            (Predictor::Network, path) => Ok(Box::new(network(path.as_deref())?)),
            // The arguments see to it that a solver has none.
            (Predictor::Solver, _) => Ok(Box::new(Solver::default())),
        }
    }
}

/// A network with the weights of a file, or with those that the program carries.
pub fn network(path: Option<&Path>) -> Result<NetworkPredictor, Error> {
    let Some(path) = path else {
        return Ok(NetworkPredictor::default());
    };
    let wrong = |cause: ReadWeightsError| Error::Weights {
        path: path.to_owned(),
        cause,
    };
    NetworkPredictor::new(&read_weights(path)?).map_err(wrong)
}

/// Reads a file of weights.
pub fn read_weights(path: &Path) -> Result<Weights, Error> {
    let path = path.to_owned();
    match fs::read(&path) {
        Err(cause) => Err(Error::OpenWeights { path, cause }),
        Ok(bytes) => Weights::from_bytes(&bytes).map_err(|cause| Error::Weights { path, cause }),
    }
}
