//! Arrays at the border: checked once on the way in, made once on the way out.

use glam::DVec3;
use numpy::{
    Element, PyArray1, PyArray2, PyArray3, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use orbflow_geometry::mesh::{FaceId, Id, PolygonMesh, PolygonMeshError, VertexId};
use orbflow_geometry::pipeline::{CarriedEdge, Cross};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::errors::InputError;

/// The three arrays that make a polygon mesh, as they came from Python.
#[derive(Clone, Copy)]
pub struct MeshArrays<'a, 'py> {
    /// `(V, 3) float32`
    pub positions: &'a Bound<'py, PyAny>,
    /// `(F,) int32`
    pub loop_start: &'a Bound<'py, PyAny>,
    /// `(L,) int32`
    pub corner_vert: &'a Bound<'py, PyAny>,
}

impl MeshArrays<'_, '_> {
    /// Checks the arrays and builds the mesh; positions are multiplied by `scale`.
    pub fn mesh(self, scale: DVec3) -> PyResult<PolygonMesh> {
        let positions = points(self.positions, "positions", scale)?;
        let loop_start = column(self.loop_start, "loop_start", "(F,)")?;
        let corner_vert = column(self.corner_vert, "corner_vert", "(L,)")?;
        mesh(positions, &loop_start, &corner_vert)
            .map_err(|error| InputError::new_err(error.to_string()))
    }
}

/// A triangle mesh `(points (V, 3) float32, triangles (T, 3) int32)` as a polygon mesh.
pub fn triangles(
    points_in: &Bound<'_, PyAny>,
    triangles: &Bound<'_, PyAny>,
    scale: DVec3,
) -> PyResult<PolygonMesh> {
    let corners = rows::<i32, 3>(triangles, "triangles", "(T, 3)")?;
    let starts: Vec<i32> = (0..corners.len() as i32 / 3).map(|f| 3 * f).collect();
    mesh(points(points_in, "points", scale)?, &starts, &corners)
        .map_err(|error| InputError::new_err(error.to_string()))
}

/// An array of one dimension.
pub fn column<T: Element + Copy>(
    array: &Bound<'_, PyAny>,
    name: &str,
    shape: &str,
) -> PyResult<Vec<T>> {
    let typed = array
        .cast::<PyArray1<T>>()
        .map_err(|_| wrong_type::<T>(array, name, shape))?;
    typed
        .readonly()
        .as_slice()
        .map(<[T]>::to_vec)
        .map_err(|_| not_contiguous(name))
}

/// The densities of a `(V,) float32` array.
pub fn densities(array: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let values = column::<f32>(array, "density", "(V,)")?;
    Ok(values.into_iter().map(f64::from).collect())
}

/// The points of a `(N, 3) float64` array.
pub fn places(array: &Bound<'_, PyAny>, name: &str, shape: &str) -> PyResult<Vec<DVec3>> {
    let flat = rows::<f64, 3>(array, name, shape)?;
    Ok(flat.chunks_exact(3).map(DVec3::from_slice).collect())
}

/// The points of a `(N, 3) float32` array, multiplied by `scale`.
fn points(array: &Bound<'_, PyAny>, name: &str, scale: DVec3) -> PyResult<Vec<DVec3>> {
    let flat = rows::<f32, 3>(array, name, "(V, 3)")?;
    let point = |p: &[f32]| DVec3::new(p[0].into(), p[1].into(), p[2].into()) * scale;
    Ok(flat.chunks_exact(3).map(point).collect())
}

/// The edges of a `(E, 2) int32` array, by their ends; `kind` says what edges they are.
pub fn vertex_pairs(array: &Bound<'_, PyAny>, kind: &str) -> PyResult<Vec<[VertexId; 2]>> {
    let flat = rows::<i32, 2>(array, &format!("{kind}_edges"), "(E, 2)")?;
    let pairs = flat.chunks_exact(2).enumerate();
    let vertex = |edge: usize, vertex: i32| {
        let id = u32::try_from(vertex).map(VertexId);
        id.map_err(|_| InputError::new_err(format!("{kind} edge {edge} names vertex {vertex}")))
    };
    pairs
        .map(|(edge, ends)| Ok([vertex(edge, ends[0])?, vertex(edge, ends[1])?]))
        .collect()
}

/// The values of a `(N, WIDTH)` array, row after row.
fn rows<T: Element + Copy, const WIDTH: usize>(
    array: &Bound<'_, PyAny>,
    name: &str,
    shape: &str,
) -> PyResult<Vec<T>> {
    let typed = array
        .cast::<PyArray2<T>>()
        .map_err(|_| wrong_type::<T>(array, name, shape))?;
    let [n, width] = [typed.shape()[0], typed.shape()[1]];
    if width != WIDTH {
        return Err(PyValueError::new_err(format!(
            "{name} must be of shape {shape}, not ({n}, {width})"
        )));
    }
    // `as_slice` takes column-major arrays too, in memory order.
    if !typed.is_c_contiguous() {
        return Err(not_contiguous(name));
    }
    let values = typed.readonly();
    values
        .as_slice()
        .map(<[T]>::to_vec)
        .map_err(|_| not_contiguous(name))
}

fn wrong_type<T: Element>(array: &Bound<'_, PyAny>, name: &str, shape: &str) -> PyErr {
    let wanted = numpy::dtype::<T>(array.py());
    let Ok(found) = array.cast::<PyUntypedArray>() else {
        let found = array.get_type();
        return PyTypeError::new_err(format!(
            "{name} must be a {shape} {wanted} array, not {found}"
        ));
    };
    let (dtype, sizes) = (found.dtype(), found.shape());
    let text = format!("{name} must be a {shape} {wanted} array, not {sizes:?} {dtype}");
    if dtype.is_equiv_to(&wanted) {
        PyValueError::new_err(text)
    } else {
        PyTypeError::new_err(text)
    }
}

fn not_contiguous(name: &str) -> PyErr {
    PyValueError::new_err(format!(
        "{name} must be C-contiguous; numpy.ascontiguousarray makes it so"
    ))
}

fn mesh(
    positions: Vec<DVec3>,
    loop_start: &[i32],
    corner_vert: &[i32],
) -> Result<PolygonMesh, PolygonMeshError> {
    let n_corners = corner_vert.len();
    if let Some(entry) = loop_start.iter().position(|&start| start < 0) {
        return Err(PolygonMeshError::BadStarts { entry, n_corners });
    }
    if let Some(corner) = corner_vert.iter().position(|&vertex| vertex < 0) {
        let face = loop_start.partition_point(|&start| start as usize <= corner);
        return Err(PolygonMeshError::IndexOutOfRange {
            face: FaceId::from_index(face.saturating_sub(1)),
            vertex: corner_vert[corner].into(),
            n_vertices: positions.len(),
        });
    }
    let end = (!loop_start.is_empty()).then_some(n_corners as u32);
    let starts = loop_start
        .iter()
        .map(|&start| start as u32)
        .chain(end)
        .collect();
    let corners = corner_vert
        .iter()
        .map(|&vertex| VertexId(vertex as u32))
        .collect();
    PolygonMesh::new(positions, starts, corners)
}

/// A `(N, 3) float32` array of points, multiplied by `scale`.
pub fn point_array(py: Python<'_>, points: &[DVec3], scale: DVec3) -> PyResult<Py<PyArray2<f32>>> {
    let flat: Vec<f32> = points
        .iter()
        .flat_map(|&p| (p * scale).as_vec3().to_array())
        .collect();
    Ok(PyArray1::from_vec(py, flat)
        .reshape([points.len(), 3])?
        .unbind())
}

/// The ends of carried edges, `(M, 2) int32`.
pub fn end_array(py: Python<'_>, edges: &[CarriedEdge]) -> PyResult<Py<PyArray2<i32>>> {
    let flat: Vec<i32> = edges
        .iter()
        .flat_map(|e| e.ends)
        .map(|v| v.0 as i32)
        .collect();
    Ok(PyArray1::from_vec(py, flat)
        .reshape([edges.len(), 2])?
        .unbind())
}

/// Which of the old edges each carried one lies on, `(M,) int32`.
pub fn from_array(py: Python<'_>, edges: &[CarriedEdge]) -> Py<PyArray1<i32>> {
    PyArray1::from_iter(py, edges.iter().map(|e| e.from as i32)).unbind()
}

/// Places and arms of crosses, `(N, 3, 3) float32`, multiplied by `scale`.
pub fn cross_array(py: Python<'_>, crosses: &[Cross], scale: DVec3) -> PyResult<Py<PyArray3<f32>>> {
    let points = crosses.iter().flat_map(|c| [c.place, c.arms[0], c.arms[1]]);
    let flat: Vec<f32> = points
        .flat_map(|p| (p * scale).as_vec3().to_array())
        .collect();
    Ok(PyArray1::from_vec(py, flat)
        .reshape([crosses.len(), 3, 3])?
        .unbind())
}

/// The `(N,) int32` array of faces.
pub fn face_array(py: Python<'_>, faces: &[FaceId]) -> Py<PyArray1<i32>> {
    PyArray1::from_iter(py, faces.iter().map(|face| face.0 as i32)).unbind()
}

/// The `(F,) int32` array of where each face's corners start.
pub fn start_array(py: Python<'_>, mesh: &PolygonMesh) -> Py<PyArray1<i32>> {
    let starts = mesh.starts().iter().take(mesh.n_faces());
    PyArray1::from_iter(py, starts.map(|&start| start as i32)).unbind()
}

/// The `(L,) int32` array of the corners of all faces.
pub fn corner_array(py: Python<'_>, mesh: &PolygonMesh) -> Py<PyArray1<i32>> {
    PyArray1::from_iter(py, mesh.corners().iter().map(|v| v.0 as i32)).unbind()
}

/// The scale of an object without its mirrorings; equal scales are none, so that the result does
/// not depend on the size of an object.
///
/// # Errors
/// `InputError` when an axis is flat.
pub fn scale((x, y, z): (f64, f64, f64)) -> PyResult<DVec3> {
    let scale = DVec3::new(x, y, z).abs();
    if !(scale.is_finite() && scale.min_element() > 0.0) {
        return Err(InputError::new_err(format!(
            "the object is scaled by ({x}, {y}, {z}); every axis needs a finite scale other than 0"
        )));
    }
    let is_uniform = scale.max_element() - scale.min_element() <= 1e-6 * scale.max_element();
    Ok(if is_uniform { DVec3::ONE } else { scale })
}
