//! The wheel `orbflow_native`: arrays in, arrays out, nothing computed here.
//!
//! One file per verb of the core; [`arrays`] checks what comes in, [`job`] runs the core on a
//! thread without the interpreter's lock, [`errors`] is the one place that turns errors into
//! exceptions. The Python package around it is in `native/python/orbflow_native`.

mod arrays;
mod decimate;
mod embed;
mod errors;
mod guide;
mod job;
mod origins;
mod predictor;
mod remesh;
mod report;
mod score;

/// The compiled half of the package `orbflow_native`.
#[pyo3::pymodule]
mod _core {
    use orbflow_geometry::pipeline;
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::decimate::{Decimated, decimate};
    #[pymodule_export]
    use crate::embed::{Embedded, embed};
    #[pymodule_export]
    use crate::errors::{Cancelled, InputError, OrbflowError};
    #[pymodule_export]
    use crate::guide::Guide;
    #[pymodule_export]
    use crate::job::CancelToken;
    #[pymodule_export]
    use crate::origins::Origins;
    #[pymodule_export]
    use crate::remesh::{Remeshed, remesh};
    #[pymodule_export]
    use crate::score::score;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::errors::init(module.py())?;
        module.add("MIN_FACES", pipeline::MIN_FACES)?;
        module.add("MAX_FACES", pipeline::MAX_FACES)?;
        module.add(
            "DEFAULTS",
            crate::report::dict(module.py(), &pipeline::Settings::default())?,
        )?;
        module.add("__version__", pipeline::VERSION)
    }
}
