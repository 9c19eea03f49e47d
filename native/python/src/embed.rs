//! `orbflow_native.embed`.

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use orbflow_geometry::pipeline;
use pyo3::prelude::*;

use crate::arrays::{self, MeshArrays};
use crate::job::{CancelToken, Job};
use crate::predictor::predictor;
use crate::report;

/// A mesh of triangles and its map to the sphere.
#[pyclass(frozen, get_all, module = "orbflow_native")]
pub struct Embedded {
    /// `(V, 3) float32`: the positions of the vertices.
    positions: Py<PyArray2<f32>>,
    /// `(F,) int32`: where the corners of each face start.
    loop_start: Py<PyArray1<i32>>,
    /// `(L,) int32`: the vertex of each corner.
    corner_vert: Py<PyArray1<i32>>,
    /// `(V, 3) float32`: where each vertex lies on the unit sphere of its part.
    sphere: Py<PyArray2<f32>>,
    /// What is told of the run.
    report: Py<PyAny>,
}

/// Maps every vertex of a mesh to the unit sphere, at full resolution.
///
/// Raises `InputError` when the mesh cannot be done, `Cancelled` when the token was raised.
#[pyfunction]
#[pyo3(signature = (
    positions, loop_start, corner_vert, *, predictor="auto", weights=None, threads=0, progress=None,
    cancel=None,
))]
#[expect(
    clippy::too_many_arguments,
    reason = "the keywords of a Python function"
)]
pub fn embed<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    loop_start: &Bound<'py, PyAny>,
    corner_vert: &Bound<'py, PyAny>,
    predictor: &str,
    weights: Option<&Bound<'py, PyAny>>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Embedded> {
    let mesh = MeshArrays {
        positions,
        loop_start,
        corner_vert,
    }
    .mesh(DVec3::ONE)?;
    let predictor = self::predictor(predictor, weights)?;
    let embedded = Job::new(progress, cancel).run(py, |progress| {
        pipeline::embed(&mesh, threads, predictor.as_ref(), progress)
    })?;
    Ok(Embedded {
        positions: arrays::point_array(py, embedded.mesh.positions(), DVec3::ONE)?,
        loop_start: arrays::start_array(py, &embedded.mesh),
        corner_vert: arrays::corner_array(py, &embedded.mesh),
        sphere: arrays::point_array(py, &embedded.sphere, DVec3::ONE)?,
        report: report::dict(py, &embedded.report)?.unbind(),
    })
}
