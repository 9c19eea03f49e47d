//! Pairing: triangles become quads, two and two, and quads four smaller ones.
//!
//! ```text
//! triangles ─ matching of neighbours ─▶ quads ─ tips of two quads go ─▶ quads ─ split, at will ─▶ four times as many
//! ```
//!
//! The faces of a closed surface of triangles are nodes with three neighbours each and no bridge, so
//! that all can be paired (Petersen 1891); which pairs are worth most says their shape: squareness,
//! a fold between them, edges that are to stay, how many faces their ends have (Remacle et al. 2012).
//! Every quad is two positive triangles of the sphere or lies in one such quad, so what covered the
//! sphere still covers it. Not done here: laying the quads on the surface (`deform`).

mod matching;
mod split;
mod tips;
mod worth;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{HalfedgeMap, PolygonMesh};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;
pub use split::split;

/// Quads on the unit sphere; the diagonal from the first corner to the third lies inside of each.
pub type Quads = PolygonMesh;

/// Why triangles cannot be paired.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum Error {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A bridge between faces: an edge whose sides are one face.
    #[error("{n_faces} triangles cannot be paired")]
    Bridges {
        /// How many triangles there are.
        n_faces: usize,
    },
}

/// Pairs the triangles of a surface into quads, whose positions are the points of the sphere.
///
/// There are half as many quads as triangles, or fewer where a vertex of two quads was taken out;
/// vertices keep their order. `kept` edges, on both sides of each, become diagonals only where
/// nothing else pairs all. About O(n log n).
///
/// # Errors
/// [`enum@Error`].
pub fn pair(
    map: &SphereMap,
    kept: &HalfedgeMap<bool>,
    progress: &Progress,
) -> Result<Quads, Error> {
    let mesh = map.mesh();
    let arcs = worth::arcs(mesh, kept);
    let mate = matching::perfect(&arcs, &progress.part("", 0.0, 0.9))?;
    let mate = mate.ok_or(Error::Bridges {
        n_faces: mesh.n_faces(),
    })?;
    progress.at(0.9)?;
    let quads = worth::quads(mesh, &mate);
    Ok(tips::without(quads, map.sphere().as_slice()))
}

/// A mesh of quads from their corners.
fn quads_on(sphere: Vec<DVec3>, quads: &[[u32; 4]]) -> Quads {
    PolygonMesh::from_faces(sphere, quads).expect("quads have four corners that exist")
}

#[cfg(test)]
mod tests;
