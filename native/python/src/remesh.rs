//! `orbflow_native.remesh`.

use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArray3};
use orbflow_geometry::guidance::NoGuidance;
use orbflow_geometry::guidance::Stroke;
use orbflow_geometry::mesh::VertexId;
use orbflow_geometry::pipeline::{self, Borders, Handles, Input, Settings, Style};
use orbflow_geometry::score;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{self, MeshArrays};
use crate::errors;
use crate::guide::Guide;
use crate::job::{CancelToken, Job};
use crate::origins::Origins;
use crate::predictor::predictor;
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
    /// `(M, 2) int32`: the edges, by their ends, that lie on edges to be carried.
    carried_edges: Py<PyArray2<i32>>,
    /// `(M,) int32`: on which of the edges to be carried each of them lies.
    carried_from: Py<PyArray1<i32>>,
    /// What of the input every element comes from; `None` without `cut_edges`.
    origins: Option<Py<Origins>>,
    /// `(N,) int32`: the faces that lie on what filled borders and sealed handles.
    filled_faces: Py<PyArray1<i32>>,
    /// `(N, 3, 3) float32`: of crosses of the field the place and two arms, half as long as edges.
    crosses: Py<PyArray3<f32>>,
    /// What is told of the run.
    report: Py<PyAny>,
    /// How many faces at the end are the input's own, of parts that were kept as they were.
    kept_faces: usize,
}

/// Rebuilds a mesh by deforming a sphere into each of its parts.
///
/// Keeps the topology, the direction of the faces and their materials. `scale` is the scale of the
/// object: faces are even in the scaled space, the result is in the space of the input.
/// How quads flow: `follow_shape` from 0 (smooth loops) to 1 (edges along the curvature), `adaptivity`
/// from 0 (quads of one size) to 1 (much smaller where the surface is bent). A part
/// keeps its own quads, cut into finer ones or without some strips, where good ones come of it: `own_quads`.
/// Edges at which the surface turns by more than `sharp_angle` degrees, and the `marked_edges`
/// `(E, 2) int32`, get edges of the result along them. `density` `(V,) float32` goes from 0 to 1:
/// where it is 1, edges of flowing quads are about half as long as where it is 0. `mirror` makes flowing quads their own image
/// across "x", "y" or "z", or with "auto" across the first in which every vertex, with its density and
/// marks, is the image of another; with "off" across none.
/// Edges of the result that lie on `carried_edges` `(E, 2) int32` are told, so that marks on these can
/// be carried over. `cut_edges` are edges `(E, 2) int32` along which data on corners is cut as texture
/// coordinates are along seams, a list with a set of them for each way in which data is cut; with
/// it, the result tells where each of its elements comes from.
/// Parts that cannot be done stay as they were: their faces come last and are `kept_faces`, and the
/// report's `kept` says why; a `strict` run raises instead. Parts too small for their share of the
/// faces, or smaller than `small_size` percent of the diagonal, stay or go: `small_parts` is "keep" or
/// "drop". Borders that lie on each other are welded up to a gap of `weld` times the diagonal; `None`
/// welds equal points alone. The others stay or are filled: `borders` is "keep" or "fill"; with
/// `fill_size` those alone are that are no longer than so many percent of the diagonal. `handles` is
/// "keep" or "seal": those are closed for good round which a tight loop is no longer than `seal_size`
/// percent of the diagonal.
/// With `solid` everything becomes one closed surface first, by a grid whose cells measure
/// `solid_detail` percent of the diagonal, 0.02 to 5. Closed parts that lie wholly inside another are
/// parts like others or go: `inner` is "keep" or "drop".
/// `predictor` is "auto", "network" or "solver": auto takes the network for maps of 20,000 vertices or
/// more, else the solver. The network has the wheel's weights, or `weights`: the bytes of a file that
/// `orbflow train` wrote, or its path. `n_crosses` is how many crosses of the field to tell at most.
/// `guides` are lines near the surface that edges of flowing quads follow; what became of each is in
/// the report's `guides`, and a lost exact one is among its `warnings`.
/// `keep_faces` `(F,) bool` are faces that are kept as they are: they come last, in order, bit for bit,
/// and the new ones join them without a gap; `faces` counts them too. The report's `kept_faces` says how
/// they were joined.
/// `score_samples` is how many points of each surface the score looks at; 0 makes no score.
/// `progress` is called on the calling thread, at most 20 times a second, with the name of the step
/// and the share of the work that is done. The same input and settings give the same bytes.
///
/// Raises `InputError` when the mesh cannot be done, `Cancelled` when the token was raised.
#[pyfunction]
#[pyo3(signature = (
    positions, loop_start, corner_vert, *, faces=2000, kind="quads", primitive=None,
    follow_shape=0.5, adaptivity=0.5, own_quads=true, sharp_angle=40.0, mirror="auto",
    small_parts="keep",
    small_size=0.0, borders="keep", fill_size=None, handles="keep", seal_size=1.0, solid=false,
    solid_detail=0.4, inner="keep", weld=1e-5, strict=false, predictor="auto", weights=None,
    threads=0, seed=0, scale=None, score_samples=10_000, n_crosses=0,
    material_index=None, marked_edges=None, carried_edges=None, cut_edges=None, density=None,
    reduced=None, guides=None, keep_faces=None, progress=None, cancel=None,
))]
#[expect(
    clippy::too_many_arguments,
    clippy::too_many_lines,
    clippy::fn_params_excessive_bools,
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
    own_quads: bool,
    sharp_angle: f64,
    mirror: &str,
    small_parts: &str,
    small_size: f64,
    borders: &str,
    fill_size: Option<f64>,
    handles: &str,
    seal_size: f64,
    solid: bool,
    solid_detail: f64,
    inner: &str,
    weld: Option<f64>,
    strict: bool,
    predictor: &str,
    weights: Option<&Bound<'py, PyAny>>,
    threads: usize,
    seed: u64,
    scale: Option<(f64, f64, f64)>,
    score_samples: usize,
    n_crosses: usize,
    material_index: Option<&Bound<'py, PyAny>>,
    marked_edges: Option<&Bound<'py, PyAny>>,
    carried_edges: Option<&Bound<'py, PyAny>>,
    cut_edges: Option<Vec<Bound<'py, PyAny>>>,
    density: Option<&Bound<'py, PyAny>>,
    reduced: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    guides: Option<Vec<PyRef<'py, Guide>>>,
    keep_faces: Option<&Bound<'py, PyAny>>,
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
    let materials = material_index.map(materials).transpose()?;
    let pairs = |array: Option<_>, kind| array.map(|a| arrays::vertex_pairs(a, kind)).transpose();
    let marked = pairs(marked_edges, "marked")?;
    let carried = pairs(carried_edges, "carried")?;
    let cuts = cut_edges.map(cuts).transpose()?;
    let density = density.map(arrays::densities).transpose()?;
    let reduced = reduced
        .map(|(points, triangles)| arrays::triangles(&points, &triangles, scale))
        .transpose()?;
    let guides = strokes(&guides.unwrap_or_default(), scale);
    let keep = keep_faces.map(flags).transpose()?;
    let settings = Settings {
        faces,
        kind: report::choice("kind", kind)?,
        primitive: self::primitive(primitive)?,
        style: Style {
            follow_shape,
            adaptivity,
        },
        own_quads,
        sharp_angle,
        mirror: report::choice("mirror", mirror)?,
        small_parts: report::choice("small_parts", small_parts)?,
        small_size,
        borders: self::borders(borders, fill_size)?,
        handles: self::handles(handles, seal_size)?,
        solid,
        solid_detail,
        inner: report::choice("inner", inner)?,
        weld,
        strict,
        seed,
        threads,
        n_crosses,
        score: scored(score_samples),
    };
    let predictor = self::predictor(predictor, weights)?;
    let input = Input {
        mesh: &mesh,
        materials: materials.as_deref(),
        reduced: reduced.as_ref(),
        marked: marked.as_deref().unwrap_or_default(),
        density: density.as_deref(),
        carried: carried.as_deref().unwrap_or_default(),
        cuts: cuts.as_deref(),
        guides: &guides,
        keep_faces: keep.as_deref(),
        guidance: &NoGuidance,
    };
    let job = Job::new(progress, cancel).scaled(scale);
    let mut remeshed = job.run(py, |progress| {
        pipeline::remesh(input, &settings, predictor.as_ref(), progress)
    })?;
    remeshed.report.kept = errors::unscaled(&remeshed.report.kept, scale);
    Remeshed::new(py, &remeshed, scale)
}

fn materials(array: &Bound<'_, PyAny>) -> PyResult<Vec<i32>> {
    arrays::column(array, "material_index", "(F,)")
}

fn flags(array: &Bound<'_, PyAny>) -> PyResult<Vec<bool>> {
    arrays::column(array, "keep_faces", "(F,)")
}

fn primitive(word: Option<&str>) -> PyResult<Option<pipeline::Primitive>> {
    word.map(|word| report::choice("primitive", word))
        .transpose()
}

fn strokes(guides: &[PyRef<'_, Guide>], scale: DVec3) -> Vec<Stroke> {
    guides.iter().map(|guide| guide.stroke(scale)).collect()
}

/// How a result is scored: not at all by no samples.
fn scored(n_samples: usize) -> Option<score::Settings> {
    (n_samples > 0).then(|| score::Settings {
        n_samples,
        ..score::Settings::default()
    })
}

/// The sets of edges along which data is cut.
fn cuts(sets: Vec<Bound<'_, PyAny>>) -> PyResult<Vec<Vec<[VertexId; 2]>>> {
    let cut = |set| arrays::vertex_pairs(&set, "cut");
    sets.into_iter().map(cut).collect()
}

/// What becomes of borders, by a word and a size.
fn borders(word: &str, fill_size: Option<f64>) -> PyResult<Borders> {
    match (word, fill_size) {
        ("keep", _) => Ok(Borders::Keep),
        ("fill", None) => Ok(Borders::Fill),
        ("fill", Some(size_pct)) => Ok(Borders::FillUpTo(size_pct)),
        _ => Err(PyValueError::new_err(format!(
            "borders: unknown variant `{word}`, expected `keep` or `fill`"
        ))),
    }
}

/// What becomes of handles, by a word and a size.
fn handles(word: &str, seal_size: f64) -> PyResult<Handles> {
    match word {
        "keep" => Ok(Handles::Keep),
        "seal" => Ok(Handles::SealUpTo(seal_size)),
        _ => Err(PyValueError::new_err(format!(
            "handles: unknown variant `{word}`, expected `keep` or `seal`"
        ))),
    }
}

impl Remeshed {
    fn new(py: Python<'_>, remeshed: &pipeline::Remeshed, scale: DVec3) -> PyResult<Self> {
        let materials = remeshed.materials.as_deref();
        let origins = remeshed.origins.as_ref();
        let origins = origins.map(|origins| Py::new(py, Origins::new(py, origins)?));
        Ok(Self {
            positions: arrays::point_array(py, remeshed.mesh.positions(), scale.recip())?,
            loop_start: arrays::start_array(py, &remeshed.mesh),
            corner_vert: arrays::corner_array(py, &remeshed.mesh),
            material_index: materials.map(|values| PyArray1::from_slice(py, values).unbind()),
            sphere: arrays::point_array(py, &remeshed.sphere, DVec3::ONE)?,
            carried_edges: arrays::end_array(py, &remeshed.carried)?,
            carried_from: arrays::from_array(py, &remeshed.carried),
            origins: origins.transpose()?,
            filled_faces: arrays::face_array(py, &remeshed.filled),
            crosses: arrays::cross_array(py, &remeshed.crosses, scale.recip())?,
            report: report::dict(py, &remeshed.report)?.unbind(),
            kept_faces: remeshed.kept_faces,
        })
    }
}
