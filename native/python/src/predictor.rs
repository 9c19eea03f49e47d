//! Predictors by their names, and the weights of the network.

use std::fs;
use std::path::PathBuf;

use orbflow_geometry::embed::{OffsetPredictor, Solver};
use orbflow_network::weights::Weights;
use orbflow_network::{AutoPredictor, NetworkPredictor};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::InputError;

/// The predictor of a name, with its weights: the bytes of a file or its path, or those of the wheel.
///
/// Weights are numbers; nothing in them is executed.
///
/// # Errors
/// `ValueError` with the names there are, and for weights that nothing would read; `InputError` when
/// weights cannot be read or are not such a file.
pub fn predictor(
    name: &str,
    weights: Option<&Bound<'_, PyAny>>,
) -> PyResult<Box<dyn OffsetPredictor + Send>> {
    match (name, weights) {
        ("solver", None) => Ok(Box::new(Solver::default())),
        ("solver", Some(_)) => Err(PyValueError::new_err(
            "weights: they are not for the predictor `solver`",
        )),
        ("network", Some(weights)) => Ok(Box::new(network(weights)?)),
        ("network", None) => Ok(Box::<NetworkPredictor>::default()),
        ("auto", Some(weights)) => Ok(Box::new(AutoPredictor::new(network(weights)?))),
        ("auto", None) => Ok(Box::<AutoPredictor>::default()),
        _ => Err(PyValueError::new_err(format!(
            "predictor: unknown name `{name}`, expected `auto`, `network` or `solver`"
        ))),
    }
}

fn network(weights: &Bound<'_, PyAny>) -> PyResult<NetworkPredictor> {
    let (bytes, named) = if let Ok(bytes) = weights.cast::<PyBytes>() {
        (bytes.as_bytes().to_vec(), String::new())
    } else {
        let path: PathBuf = weights.extract()?;
        let bytes = fs::read(&path).map_err(|cause| {
            InputError::new_err(format!("cannot read {}: {cause}", path.display()))
        })?;
        (bytes, format!("{}: ", path.display()))
    };
    let weights = Weights::from_bytes(&bytes);
    let network = weights.and_then(|weights| NetworkPredictor::new(&weights));
    network.map_err(|cause| InputError::new_err(format!("{named}{cause}")))
}
