//! Strokes that edges are to follow.

use glam::DVec3;
use numpy::{PyArray2, PyArrayMethods, ToPyArray};
use orbflow_geometry::guidance::{Strength, Stroke};
use pyo3::prelude::*;

use crate::arrays;

/// A line near the surface that edges of flowing quads follow; with `is_exact` a line of edges lies
/// on it, else they turn along it. A closed one goes on from its last point to its first.
///
/// `points` is a `(N, 3) float64` array in the mesh's coordinates, of 2 points or more, closed of 3.
#[pyclass(frozen, module = "orbflow_native")]
pub struct Guide(Stroke);

#[pymethods]
impl Guide {
    #[new]
    #[pyo3(signature = (points, *, is_closed=false, is_exact=false))]
    #[expect(
        clippy::fn_params_excessive_bools,
        reason = "the keywords of a Python function"
    )]
    fn new(points: &Bound<'_, PyAny>, is_closed: bool, is_exact: bool) -> PyResult<Self> {
        let strength = if is_exact {
            Strength::Exact
        } else {
            Strength::Follow
        };
        Ok(Self(Stroke {
            points: arrays::places(points, "points", "(N, 3)")?,
            is_closed,
            strength,
        }))
    }

    /// `(N, 3) float64`
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let flat: Vec<f64> = self.0.points.iter().flat_map(DVec3::to_array).collect();
        let n = self.0.points.len();
        flat.to_pyarray(py).reshape([n, 3])
    }

    /// Whether the last point is joined to the first.
    #[getter]
    fn is_closed(&self) -> bool {
        self.0.is_closed
    }

    /// Whether a line of edges is to lie on it.
    #[getter]
    fn is_exact(&self) -> bool {
        self.0.strength == Strength::Exact
    }
}

impl Guide {
    /// It with its points multiplied by `scale`.
    pub fn stroke(&self, scale: DVec3) -> Stroke {
        Stroke {
            points: self.0.points.iter().map(|&p| p * scale).collect(),
            ..self.0
        }
    }
}
