//! `orbflow_native.Origins`.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use orbflow_geometry::pipeline;
use pyo3::prelude::*;

/// What of the input every element of the result comes from: mix values by the weights.
#[pyclass(frozen, get_all, module = "orbflow_native")]
pub struct Origins {
    /// `(V, 3) int32`: of every vertex three corners of one face of the input.
    vertex_corners: Py<PyArray2<i32>>,
    /// `(V, 3) float32`: their weights, which sum to 1.
    vertex_weights: Py<PyArray2<f32>>,
    /// For each set of cuts `(L, 3) int32`: of every corner three corners of one face of the input.
    corner_corners: Vec<Py<PyArray2<i32>>>,
    /// For each set of cuts `(L, 3) float32`: their weights, which sum to 1.
    corner_weights: Vec<Py<PyArray2<f32>>>,
    /// `(F,) int32`: the face of the input under every face.
    faces: Py<PyArray1<i32>>,
}

impl Origins {
    /// The arrays of origins.
    pub fn new(py: Python<'_>, origins: &pipeline::Origins) -> PyResult<Self> {
        let (vertex_corners, vertex_weights) = arrays(py, &origins.vertices)?;
        let of_sets = origins.corners.iter().map(|set| arrays(py, set));
        let of_sets = of_sets.collect::<PyResult<Vec<_>>>()?;
        let (corner_corners, corner_weights) = of_sets.into_iter().unzip();
        let faces = origins.faces.iter().map(|face| face.0 as i32);
        Ok(Self {
            vertex_corners,
            vertex_weights,
            corner_corners,
            corner_weights,
            faces: PyArray1::from_iter(py, faces).unbind(),
        })
    }
}

type Arrays = (Py<PyArray2<i32>>, Py<PyArray2<f32>>);

fn arrays(py: Python<'_>, origins: &[pipeline::Origin]) -> PyResult<Arrays> {
    let corners: Vec<i32> = origins
        .iter()
        .flat_map(|o| o.corners)
        .map(|c| c as i32)
        .collect();
    let weights: Vec<f32> = origins
        .iter()
        .flat_map(|o| o.weights)
        .map(|w| w as f32)
        .collect();
    let shape = [origins.len(), 3];
    let corners = PyArray1::from_vec(py, corners).reshape(shape)?;
    let weights = PyArray1::from_vec(py, weights).reshape(shape)?;
    Ok((corners.unbind(), weights.unbind()))
}
