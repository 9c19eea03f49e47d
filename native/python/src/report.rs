//! Reports of the core as dictionaries, and words of Python as settings of the core.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::{DeserializeOwned, IntoDeserializer, value};

/// A report as Python's dictionaries, lists, numbers and strings.
pub fn dict<'py>(py: Python<'py>, report: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(report).map_err(|error| {
        PyRuntimeError::new_err(format!("the report cannot be written: {error}"))
    })?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The choice that a word names, such as `"quads"`.
///
/// # Errors
/// `ValueError` with the words there are.
pub fn choice<T: DeserializeOwned>(name: &str, word: &str) -> PyResult<T> {
    T::deserialize(word.into_deserializer())
        .map_err(|error: value::Error| PyValueError::new_err(format!("{name}: {error}")))
}
