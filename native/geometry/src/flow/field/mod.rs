//! The orientation field: one cross per face, smooth and along the shape.
//!
//! A cross is four unit vectors at right angles; one of them is the face's *direction*, which with
//! normal × direction makes the face's *frame*. Vectors in a frame are complex numbers.
//!
//! ```text
//! halfedge h has the vector w in its face's frame, and w' = −i^r w in its twin's   (r = turns[h])
//! any vector w carried over h becomes i^r w
//! around a vertex, counter-clockwise, a vector is turned by Σ r ≡ k  (mod 4)       (k = indices[v])
//! k > 0: cone angle (4 − k) · 90°, valence 4 − k in the result;  Σ k = 8
//! ```

mod charts;
mod mirror;
mod settle;
mod shape;
mod smooth;
mod turns;

use std::f64::consts::TAU;

use glam::DVec3;
use thiserror::Error;

use crate::elementary::{argument, cos, sin};
use crate::measure::total_area;
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sparse::NotPositiveDefinite;

pub use charts::{Charts, halfedges};
pub use mirror::mirror;
pub use settle::{settle, settle_along};
pub use shape::{Axes, axes, in_chart};

/// How the field follows the shape.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Settings {
    /// How strongly crosses follow the principal directions; 0 gives the smoothest field. Below 1.5
    /// quads lie more aslant to the shape; above they are less even and less square.
    pub alignment: f64,
    /// Edges whose faces' normals differ by more than this angle are followed.
    pub sharp_angle: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            alignment: 1.5,
            sharp_angle: TAU / 9.0,
        }
    }
}

/// One cross per face of a closed mesh, with what it takes to compare neighbours.
#[derive(Clone, PartialEq, Debug)]
pub struct OrientationField {
    /// One arm of the cross: a unit vector in the plane of the face.
    pub directions: FaceMap<DVec3>,
    /// r of each halfedge: a vector w of the halfedge becomes −i^r w as its twin's. r + r' = 0
    /// modulo 4 for twins.
    pub turns: HalfedgeMap<u8>,
    /// k of each vertex: its cone angle is (4 − k) · 90°. The sum is 8.
    pub indices: VertexMap<i32>,
    /// How many quarters the twin's cross is ahead of the halfedge's, beyond −r: how unsmooth the
    /// field is there, opposite for twins. Around a vertex, counter-clockwise over what is crossed,
    /// the sum of them less the angles of the corners is k − 4 quarters.
    pub residuals: HalfedgeMap<f64>,
}

/// Why there is no field.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum FieldError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The linear system has no factor: numbers overflow.
    #[error(transparent)]
    Unsolvable(#[from] NotPositiveDefinite),
    /// Squares of areas overflow or vanish.
    #[error("an area of {area:e} is too large or too small to compute with")]
    Size {
        /// The area of the mesh.
        area: f64,
    },
    /// Only closed meshes of genus 0 have the singularities that the next steps count on.
    #[error("the mesh has {n_borders} borders and the Euler number {euler}, not 2")]
    NotASphere {
        /// How many border loops it has.
        n_borders: usize,
        /// Vertices − edges + faces.
        euler: i64,
    },
}

/// Finds the orientation field of a closed mesh of genus 0.
///
/// Smooth where the surface is about equally bent both ways, along the principal directions where
/// it is not, along sharp edges always. Numbers of faces and their sizes are those of the wanted
/// detail: curvature is averaged over a few faces. Degenerate faces are tolerated. Five sparse
/// factorisations, O(n^1.5).
///
/// # Errors
/// When the mesh is not a topological sphere, when its sizes overflow, or on cancellation.
pub fn orient(
    mesh: &TriangleMesh,
    settings: &Settings,
    progress: &Progress,
) -> Result<OrientationField, FieldError> {
    let none = HalfedgeMap::filled(3 * mesh.n_faces(), false);
    orient_along(mesh, (settings, &none), progress)
}

/// As [`orient`], with some edges that are followed as sharp ones are, whatever their angle.
///
/// # Errors
/// As those of [`orient`].
pub fn orient_along(
    mesh: &TriangleMesh,
    (settings, along): (&Settings, &HalfedgeMap<bool>),
    progress: &Progress,
) -> Result<OrientationField, FieldError> {
    if !mesh.is_closed() || mesh.euler_number() != 2 {
        return Err(FieldError::NotASphere {
            n_borders: mesh.border_loops().len(),
            euler: mesh.euler_number(),
        });
    }
    let area = total_area(mesh);
    if !(1e-120..1e120).contains(&area) {
        return Err(FieldError::Size { area });
    }
    let charts = Charts::new(mesh);
    let axes = shape::axes(mesh);
    progress.at(0.0)?;
    let pulls = shape::pulls(mesh, (&charts, &axes), settings, along);
    let crosses = smooth::smooth(mesh, &charts, &pulls, progress)?;
    let angles: FaceMap<f64> = crosses.iter().map(|&z| argument(z) / 4.0).collect();
    let (turns, residuals) = turns::match_crosses(mesh, &charts, &angles);
    let indices = turns::indices(mesh, &charts, &residuals);
    let directions = axes
        .iter()
        .zip(&angles)
        .map(|(axes, &angle)| axes.u * cos(angle) + axes.v * sin(angle))
        .collect();
    let field = OrientationField {
        directions,
        turns,
        indices,
        residuals,
    };
    debug_assert_eq!(field.check(mesh), Ok(()));
    Ok(field)
}

/// What is wrong with a field.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum FieldFlaw {
    /// The turns of two twins do not cancel.
    #[error("the turns across the edges of vertex {vertex} do not cancel")]
    Turns {
        /// An end of the edge.
        vertex: VertexId,
    },
    /// Turns and index of a vertex disagree.
    #[error("the turns around vertex {vertex} sum up to {turns}, its index is {index}")]
    Index {
        /// The vertex.
        vertex: VertexId,
        /// The sum of the turns.
        turns: i32,
        /// The index.
        index: i32,
    },
    /// The indices do not sum up to 8.
    #[error("the indices sum up to {sum}, not 8")]
    Sum {
        /// Their sum.
        sum: i32,
    },
}

impl OrientationField {
    /// Checks that turns and indices agree everywhere; for tests and debug assertions after edits.
    ///
    /// # Errors
    /// The first flaw.
    pub fn check(&self, mesh: &TriangleMesh) -> Result<(), FieldFlaw> {
        for h in mesh.halfedge_ids() {
            let cancels = |twin| (self.turns[h] + self.turns[twin]).is_multiple_of(4);
            if !mesh.twin(h).is_some_and(cancels) {
                let vertex = mesh.origin(h);
                return Err(FieldFlaw::Turns { vertex });
            }
        }
        for (vertex, &index) in self.indices.iter_ids() {
            let turns = self.turns_around(mesh, vertex);
            if (turns - index) % 4 != 0 {
                return Err(FieldFlaw::Index {
                    vertex,
                    turns,
                    index,
                });
            }
        }
        match self.indices.iter().sum() {
            8 => Ok(()),
            sum => Err(FieldFlaw::Sum { sum }),
        }
    }

    /// How many quarters a vector turns that is carried once around a vertex, counter-clockwise.
    fn turns_around(&self, mesh: &TriangleMesh, vertex: VertexId) -> i32 {
        let crossed = mesh.outgoing(vertex).map(HalfedgeId::prev);
        crossed.map(|h| i32::from(self.turns[h])).sum()
    }
}

#[cfg(test)]
mod tests;
