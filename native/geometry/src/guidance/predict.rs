//! The plug for guidance: who proposes lines and a density, beside what an artist draws.

use std::fmt::Debug;

use serde::Serialize;
use thiserror::Error;

use super::Stroke;
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// What is proposed for a mesh.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Guidance {
    /// Lines that edges follow.
    pub strokes: Vec<Stroke>,
    /// How small quads are to be at each vertex, from 0, as usual, to 1; none where all are alike.
    pub density: Option<VertexMap<f64>>,
    /// What the mesh was taken for; none where that is nothing.
    pub recognised: Option<Recognised>,
}

/// What a mesh was taken for.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Recognised {
    /// Of what kind it is, as "body".
    pub kind: String,
    /// How sure that is, from 0 to 1.
    pub confidence: f64,
}

/// Why there is no proposal.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum GuidanceError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The mesh is nothing for it.
    #[error("there is no guidance: {reason}")]
    Failed {
        /// Why.
        reason: String,
    },
}

/// Why a proposal is of no use.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum BadGuidance {
    /// A stroke has too few points for a line.
    #[error("stroke {stroke} has {n_points} points; {n_least} are needed")]
    TooShort {
        /// Which one.
        stroke: usize,
        /// How many it has.
        n_points: usize,
        /// How many make a line.
        n_least: usize,
    },
    /// A stroke is nowhere, or at one place alone.
    #[error("stroke {stroke} is {length} long")]
    NoLength {
        /// Which one.
        stroke: usize,
        /// How long it is.
        length: f64,
    },
    /// There is not one density for each vertex.
    #[error("there are {n_values} densities for {n_vertices} vertices")]
    DensityCount {
        /// How many densities there are.
        n_values: usize,
        /// How many vertices.
        n_vertices: usize,
    },
    /// A density is none.
    #[error("vertex {vertex} has the density {value}; it goes from 0 to 1")]
    DensityOutOfRange {
        /// Which vertex.
        vertex: VertexId,
        /// What it has.
        value: f64,
    },
    /// A confidence is none.
    #[error("the confidence is {value}; it goes from 0 to 1")]
    Confidence {
        /// What it is.
        value: f64,
    },
}

/// Proposes lines and a density for a mesh.
///
/// The pipeline asks for each part, an oriented manifold in the frame of work (the whole input has a
/// diagonal of 1 about the origin), and adds what it gets to what the artist drew. The same mesh must
/// get the same proposal, whatever the number of threads; `progress` is asked whether to go on.
pub trait GuidancePredictor: Debug + Sync {
    /// What reports call it.
    fn name(&self) -> &'static str;

    /// Whether it never proposes anything, so that it need not be asked.
    fn is_empty(&self) -> bool {
        false
    }

    /// The proposal for a mesh.
    ///
    /// # Errors
    /// [`GuidanceError`]; the mesh then gets what the artist drew alone, and the report says why.
    fn propose(
        &self,
        mesh: &TriangleMesh,
        progress: &Progress<'_>,
    ) -> Result<Guidance, GuidanceError>;
}

/// Proposes nothing.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct NoGuidance;

impl GuidancePredictor for NoGuidance {
    fn name(&self) -> &'static str {
        "none"
    }

    fn is_empty(&self) -> bool {
        true
    }

    fn propose(&self, _: &TriangleMesh, _: &Progress<'_>) -> Result<Guidance, GuidanceError> {
        Ok(Guidance::default())
    }
}

impl Guidance {
    /// Checks that a proposal can be used on a mesh.
    ///
    /// # Errors
    /// The first thing that is wrong with it.
    pub fn check(&self, mesh: &TriangleMesh) -> Result<(), BadGuidance> {
        for (stroke, line) in self.strokes.iter().enumerate() {
            let n_points = line.points.len();
            let n_least = if line.is_closed { 3 } else { 2 };
            if n_points < n_least {
                return Err(BadGuidance::TooShort {
                    stroke,
                    n_points,
                    n_least,
                });
            }
            let length = line.length();
            if !(length > 0.0 && length.is_finite()) {
                return Err(BadGuidance::NoLength { stroke, length });
            }
        }
        if let Some(values) = &self.density {
            let [n_values, n_vertices] = [values.len(), mesh.n_vertices()];
            if n_values != n_vertices {
                return Err(BadGuidance::DensityCount {
                    n_values,
                    n_vertices,
                });
            }
            let mut wrong = values.iter().enumerate();
            if let Some((i, &value)) = wrong.find(|(_, v)| !(0.0..=1.0).contains(*v)) {
                let vertex = VertexId::from_index(i);
                return Err(BadGuidance::DensityOutOfRange { vertex, value });
            }
        }
        match &self.recognised {
            Some(Recognised { confidence, .. }) if !(0.0..=1.0).contains(confidence) => {
                let value = *confidence;
                Err(BadGuidance::Confidence { value })
            }
            _ => Ok(()),
        }
    }
}
