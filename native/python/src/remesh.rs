//! `orbflow_native.remesh`.

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use orbflow_geometry::pipeline::{self, Input, Settings, Style};
use orbflow_geometry::score;
use pyo3::prelude::*;

use crate::arrays::{self, MeshArrays};
use crate::job::{CancelToken, Job};
use crate::report;

/// A new mesh and how it came about.
#[pyclass(frozen, get_all, module = "orbflow_native")]
pub struct Remeshed {
    /// `(V, 3) float32`: the positions of the vertices.
    positions: Py<PyArray2<f32>>,
    /// `(F,) int32`: where the corners of each face start.
    loop_start: Py<PyArray1<i32>>,
    /// `(L,) int32`: the vertex of each corner.
    corner_vert: Py<PyArray1<i32>>,
    /// `(F,) int32`: the material of each face; `None` when the input had none.
    material_index: Option<Py<PyArray1<i32>>>,
    /// `(V, 3) float32`: where each vertex lies on the unit sphere of its part.
    sphere: Py<PyArray2<f32>>,
    /// What is told of the run.
    report: Py<PyAny>,
}

/// Rebuilds a mesh by deforming a sphere into each of its parts.
///
/// Keeps the topology, the direction of the faces and their materials. `scale` is the scale of the
/// object: faces are even in the scaled space, the result is in the space of the input.
/// How quads flow: `follow_shape` from 0 (smooth loops) to 1 (edges along the curvature), `adaptivity`
/// from 0 (quads of one size) to 1 (much smaller where the surface is bent).
/// Edges at which the surface turns by more than `sharp_angle` degrees, and the `marked_edges`
/// `(E, 2) int32`, get edges of the result along them. `mirror` makes flowing quads their own image
/// across "x", "y" or "z", or with "auto" across the first in which the mesh is symmetric.
/// `score_samples` is how many points of each surface the score looks at; 0 makes no score.
/// `progress` is called on the calling thread, at most 20 times a second, with the name of the step
/// and the share of the work that is done. The same input and settings give the same bytes.
///
/// Raises `InputError` when the mesh cannot be done, `Cancelled` when the token was raised.
#[pyfunction]
#[pyo3(signature = (
    positions, loop_start, corner_vert, *, faces=2000, kind="quads", primitive=None,
    follow_shape=0.5, adaptivity=0.5, sharp_angle=40.0, mirror="off", predictor="solver", threads=0,
    seed=0, scale=None, score_samples=10_000, material_index=None, marked_edges=None, reduced=None,
    progress=None, cancel=None,
))]
#[expect(
    clippy::too_many_arguments,
    reason = "the keywords of a Python function"
)]
pub fn remesh<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    loop_start: &Bound<'py, PyAny>,
    corner_vert: &Bound<'py, PyAny>,
    faces: usize,
    kind: &str,
    primitive: Option<&str>,
    follow_shape: f64,
    adaptivity: f64,
    sharp_angle: f64,
    mirror: &str,
    predictor: &str,
    threads: usize,
    seed: u64,
    scale: Option<(f64, f64, f64)>,
    score_samples: usize,
    material_index: Option<&Bound<'py, PyAny>>,
    marked_edges: Option<&Bound<'py, PyAny>>,
    reduced: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    progress: Option<Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Remeshed> {
    let scale = arrays::scale(scale.unwrap_or((1.0, 1.0, 1.0)))?;
    let mesh = MeshArrays {
        positions,
        loop_start,
        corner_vert,
    }
    .mesh(scale)?;
    let materials = material_index
        .map(|array| arrays::column(array, "material_index", "(F,)"))
        .transpose()?;
    let marked = marked_edges.map(arrays::vertex_pairs).transpose()?;
    let reduced = reduced
        .map(|(points, triangles)| arrays::triangles(&points, &triangles, scale))
        .transpose()?;
    let settings = Settings {
        faces,
        kind: report::choice("kind", kind)?,
        primitive: primitive
            .map(|word| report::choice("primitive", word))
            .transpose()?,
        style: Style {
            follow_shape,
            adaptivity,
        },
        sharp_angle,
        mirror: report::choice("mirror", mirror)?,
        seed,
        threads,
        score: (score_samples > 0).then(|| score::Settings {
            n_samples: score_samples,
            ..score::Settings::default()
        }),
    };
    let predictor = report::predictor(predictor)?;
    let input = Input {
        mesh: &mesh,
        materials: materials.as_deref(),
        reduced: reduced.as_ref(),
        marked: marked.as_deref().unwrap_or_default(),
    };
    let remeshed = Job::new(progress, cancel).run(py, |progress| {
        pipeline::remesh(input, &settings, &predictor, progress)
    })?;
    Remeshed::new(py, &remeshed, scale)
}

impl Remeshed {
    fn new(py: Python<'_>, remeshed: &pipeline::Remeshed, scale: DVec3) -> PyResult<Self> {
        let materials = remeshed.materials.as_deref();
        Ok(Self {
            positions: arrays::point_array(py, remeshed.mesh.positions(), scale.recip())?,
            loop_start: arrays::start_array(py, &remeshed.mesh),
            corner_vert: arrays::corner_array(py, &remeshed.mesh),
            material_index: materials.map(|values| PyArray1::from_slice(py, values).unbind()),
            sphere: arrays::point_array(py, &remeshed.sphere, DVec3::ONE)?,
            report: report::dict(py, &remeshed.report)?.unbind(),
        })
    }
}
