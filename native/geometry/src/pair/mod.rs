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
mod refine;
mod split;
mod tips;
mod worth;

use std::collections::BTreeSet;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;
pub use refine::refine;
pub use split::split;

/// Quads of pairs of triangles.
#[derive(Clone, PartialEq, Debug)]
pub struct Paired {
    /// The quads on the unit sphere; the diagonal from the first corner to the third lies inside of each.
    pub quads: PolygonMesh,
    /// Their edges that were to stay, each once, smaller end first, in order.
    pub kept: Vec<[VertexId; 2]>,
}

/// How often pairs that leave two quads at a vertex are made dearer; most such vertices go at once.
const N_EASINGS: u32 = 6;

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
) -> Result<Paired, Error> {
    let mesh = map.mesh();
    let mut arcs = worth::arcs(mesh, kept);
    let mate = matching::perfect(&arcs, &progress.part("", 0.0, 0.6))?;
    let mut mate = mate.ok_or(Error::Bridges {
        n_faces: mesh.n_faces(),
    })?;
    for easing in 0..N_EASINGS {
        progress.at(0.6 + 0.3 * f64::from(easing) / f64::from(N_EASINGS))?;
        if !worth::ease(mesh, &mut arcs, &mate) {
            break;
        }
        matching::improve(&arcs, &mut mate, &progress.part("", 0.9, 0.9))?;
    }
    let mut quads = worth::quads(mesh, &mate);
    let vertices = tips::without(&mut quads, map.sphere().as_slice());
    let sphere = vertices.iter().map(|&v| map.sphere()[v]).collect();
    let quads = quads_on(sphere, &quads);
    let kept = kept_edges((mesh, kept), (&quads, &vertices));
    Ok(Paired { quads, kept })
}

/// The edges of quads that are edges of the mesh which were to stay.
fn kept_edges(
    (mesh, kept): (&TriangleMesh, &HalfedgeMap<bool>),
    (quads, vertices): (&PolygonMesh, &[VertexId]),
) -> Vec<[VertexId; 2]> {
    let marked = mesh.halfedge_ids().filter(|&h| kept[h]);
    let marked = marked.map(|h| [mesh.origin(h), mesh.target(h)]);
    let marked: BTreeSet<[VertexId; 2]> = marked.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    let mut edges = Vec::new();
    for face in quads.faces() {
        for i in 0..4 {
            let [a, b] = [face[i], face[(i + 1) % 4]];
            // Vertices keep their order.
            if a < b && marked.contains(&[a, b].map(|v| vertices[v.index()])) {
                edges.push([a, b]);
            }
        }
    }
    edges.sort_unstable();
    edges
}

/// A mesh of quads from their corners.
fn quads_on(sphere: Vec<DVec3>, quads: &[[u32; 4]]) -> PolygonMesh {
    PolygonMesh::from_faces(sphere, quads).expect("quads have four corners that exist")
}

#[cfg(test)]
mod tests;
