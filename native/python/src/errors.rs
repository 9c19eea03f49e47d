//! The one place that turns errors of the core into Python exceptions.

use pyo3::create_exception;
use pyo3::exceptions::PyException;

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
