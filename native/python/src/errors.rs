//! The one place that turns errors of the core into Python exceptions.

use orbflow_geometry::{pipeline, score};
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

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
    "This input or this setting cannot be done; the text says why, with numbers."
);
create_exception!(
    orbflow_native,
    Cancelled,
    OrbflowError,
    "The job was stopped by its cancel token; nothing was changed."
);

/// The error of a verb: the user stopped it, or the input cannot be done.
pub trait VerbError: std::error::Error + Send {
    /// Whether the user stopped it.
    fn is_cancelled(&self) -> bool;
}

impl VerbError for pipeline::Error {
    fn is_cancelled(&self) -> bool {
        self.is_cancelled()
    }
}

impl VerbError for score::Error {
    fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_))
    }
}

/// The exception for the error of a verb.
pub fn exception(error: &impl VerbError) -> PyErr {
    let text = error.to_string();
    if error.is_cancelled() {
        Cancelled::new_err(text)
    } else {
        InputError::new_err(text)
    }
}
