//! The one place that turns errors of the core into Python exceptions.

use glam::DVec3;
use orbflow_geometry::pipeline::{Kept, Warning};
use orbflow_geometry::{pipeline, score};
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::report;

create_exception!(
    orbflow_native,
    OrbflowError,
    PyException,
    "What every error of Orbflow derives from."
);
create_exception!(
    orbflow_native,
    InputError,
    OrbflowError,
    "This input or this setting cannot be done; the text says why, with numbers. `kept` lists the \
     parts that cannot be done and `warnings` what is wrong with a result that a strict run refuses, \
     as a report does."
);
create_exception!(
    orbflow_native,
    Cancelled,
    OrbflowError,
    "The job was stopped by its cancel token; nothing was changed."
);

/// Gives every `InputError` the lists of parts and warnings that an error may carry.
pub fn init(py: Python<'_>) -> PyResult<()> {
    let class = py.get_type::<InputError>();
    class.setattr("kept", PyList::empty(py))?;
    class.setattr("warnings", PyList::empty(py))
}

/// The error of a verb: the user stopped it, or the input cannot be done.
pub trait VerbError: std::error::Error + Send {
    /// Whether the user stopped it.
    fn is_cancelled(&self) -> bool;

    /// The parts that cannot be done, where these are why.
    fn kept(&self) -> &[Kept] {
        &[]
    }

    /// What is wrong with a result, where that is why.
    fn warnings(&self) -> &[Warning] {
        &[]
    }
}

impl VerbError for pipeline::Error {
    fn is_cancelled(&self) -> bool {
        self.is_cancelled()
    }

    fn kept(&self) -> &[Kept] {
        match self {
            Self::Refused { kept, .. } => kept,
            _ => &[],
        }
    }

    fn warnings(&self) -> &[Warning] {
        match self {
            Self::Unsound { warnings, .. } => warnings,
            _ => &[],
        }
    }
}

impl VerbError for score::Error {
    fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_))
    }
}

/// The exception for the error of a verb, in the coordinates of the caller.
pub fn exception(py: Python<'_>, error: &impl VerbError, scale: DVec3) -> PyErr {
    let text = error.to_string();
    if error.is_cancelled() {
        return Cancelled::new_err(text);
    }
    let exception = InputError::new_err(text);
    match tell(py, &exception, error, scale) {
        Ok(()) => exception,
        Err(told) => told,
    }
}

/// Gives an exception the lists that its error carries.
fn tell(py: Python<'_>, to: &PyErr, error: &impl VerbError, scale: DVec3) -> PyResult<()> {
    let value = to.value(py);
    if !error.kept().is_empty() {
        value.setattr("kept", report::dict(py, &unscaled(error.kept(), scale))?)?;
    }
    if !error.warnings().is_empty() {
        value.setattr("warnings", report::dict(py, &error.warnings())?)?;
    }
    Ok(())
}

/// Parts with their places in the coordinates of the caller.
pub fn unscaled(kept: &[Kept], scale: DVec3) -> Vec<Kept> {
    let mut kept = kept.to_vec();
    for reason in kept.iter_mut().flat_map(|kept| &mut kept.reasons) {
        reason.place = (DVec3::from_array(reason.place) / scale).to_array();
    }
    kept
}
