//! Runs the core on a thread of its own, without the interpreter's lock.

use orbflow_geometry::progress;
use pyo3::prelude::*;

/// A flag that another thread raises to stop a running job.
#[pyclass(frozen, module = "orbflow_native")]
#[derive(Default)]
pub struct CancelToken(progress::CancelToken);

#[pymethods]
impl CancelToken {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Raises the flag; the job stops within a fraction of a second and raises `Cancelled`.
    fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether the flag is up.
    #[getter]
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}
