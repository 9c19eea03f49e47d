//! `orbflow_native.decimate`.

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use orbflow_geometry::pipeline::{self, Input};
use pyo3::prelude::*;

use crate::arrays::{self, MeshArrays};
use crate::job::{CancelToken, Job};
use crate::report;

/// A mesh with fewer triangles.
#[pyclass(frozen, get_all, module = "orbflow_native")]
pub struct Decimated {
    /// `(V, 3) float32`: the positions of the vertices.
    positions: Py<PyArray2<f32>>,
    /// `(F,) int32`: where the corners of each face start.
    loop_start: Py<PyArray1<i32>>,
    /// `(L,) int32`: the vertex of each corner.
    corner_vert: Py<PyArray1<i32>>,
    /// `(F,) int32`: the material of each face; `None` when the input had none.
    material_index: Option<Py<PyArray1<i32>>>,
    /// What is told of the run.
    report: Py<PyAny>,
}

/// Lowers the number of triangles of a mesh; borders and handles are kept.
///
/// Raises `InputError` when the mesh cannot be done, `Cancelled` when the token was raised.
#[pyfunction]
#[pyo3(signature = (
    positions, loop_start, corner_vert, *, faces=2000, material_index=None, progress=None, cancel=None,
))]
#[expect(
    clippy::too_many_arguments,
    reason = "the keywords of a Python function"
)]
pub fn decimate<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    loop_start: &Bound<'py, PyAny>,
    corner_vert: &Bound<'py, PyAny>,
    faces: usize,
    material_index: Option<&Bound<'py, PyAny>>,
    progress: Option<Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Decimated> {
    let mesh = MeshArrays {
        positions,
        loop_start,
        corner_vert,
    }
    .mesh(DVec3::ONE)?;
    let materials = material_index
        .map(|array| arrays::column(array, "material_index", "(F,)"))
        .transpose()?;
    let input = Input {
        materials: materials.as_deref(),
        ..Input::new(&mesh)
    };
    let decimated = Job::new(progress, cancel)
        .run(py, |progress| pipeline::decimate(input, faces, progress))?;
    let materials = decimated.materials.as_deref();
    Ok(Decimated {
        positions: arrays::point_array(py, decimated.mesh.positions(), DVec3::ONE)?,
        loop_start: arrays::start_array(py, &decimated.mesh),
        corner_vert: arrays::corner_array(py, &decimated.mesh),
        material_index: materials.map(|values| PyArray1::from_slice(py, values).unbind()),
        report: report::dict(py, &decimated.report)?.unbind(),
    })
}
