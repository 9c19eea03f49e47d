//! `orbflow_native.score`.

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::pipeline;
use orbflow_geometry::score::Settings;
use pyo3::prelude::*;

use crate::arrays::MeshArrays;
use crate::job::{CancelToken, Job};
use crate::report;

/// The arrays of a mesh: positions, `loop_start`, `corner_vert`.
type Arrays<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// Says in numbers how good `output` is as a new mesh of `input`.
///
/// `target` is the number of quads that was asked for, a triangle being half a quad; `n_samples` is
/// how many points of each surface the distances are measured at, starting at `seed`. Whether the
/// topology is the same is told of the input once it is cleaned as `remesh` does it.
/// Raises `InputError` when a mesh cannot be scored, `Cancelled` when the token was raised.
#[pyfunction]
#[pyo3(signature = (input, output, *, target=None, n_samples=100_000, seed=0, progress=None, cancel=None))]
#[expect(
    clippy::too_many_arguments,
    reason = "the keywords of a Python function"
)]
pub fn score<'py>(
    py: Python<'py>,
    input: Arrays<'py>,
    output: Arrays<'py>,
    target: Option<usize>,
    n_samples: usize,
    seed: u64,
    progress: Option<Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Py<PyAny>> {
    let [input, output] = [mesh(input)?, mesh(output)?];
    let settings = Settings {
        target,
        n_samples,
        seed,
    };
    let score = Job::new(progress, cancel).run(py, |progress| {
        pipeline::score(&input, &output, &settings, progress)
    })?;
    Ok(report::dict(py, &score)?.unbind())
}

fn mesh((positions, loop_start, corner_vert): Arrays<'_>) -> PyResult<PolygonMesh> {
    let [positions, loop_start, corner_vert] = [&positions, &loop_start, &corner_vert];
    MeshArrays {
        positions,
        loop_start,
        corner_vert,
    }
    .mesh(DVec3::ONE)
}
