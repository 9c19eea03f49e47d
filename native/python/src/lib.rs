//! The wheel `orbflow_native`: arrays in, arrays out, nothing computed here.
//!
//! One file per verb of the core; [`arrays`] checks what comes in, [`job`] runs the core on a
//! thread without the interpreter's lock, [`errors`] is the one place that turns errors into
//! exceptions. The Python package around it is in `native/python/orbflow_native`.

mod errors;
mod job;

/// The compiled half of the package `orbflow_native`.
#[pyo3::pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::errors::{Cancelled, InputError, OrbflowError};
    #[pymodule_export]
    use crate::job::CancelToken;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
