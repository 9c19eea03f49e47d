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
//! sphere still covers it. Across firm edges nothing is paired: triangles that are left over there
//! stay, three quads each once all are split. Surfaces with borders and handles are paired as they are
//! ([`pair_open`]): beside a border a triangle without a partner becomes a quad by a vertex more on
//! it. Not done here: laying the quads on the surface (`deform`).

mod grid;
mod improve;
mod layout;
mod matching;
mod open;
mod refine;
mod split;
mod tips;
mod worth;

use std::collections::BTreeSet;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{SphereMap, is_positive};
pub use grid::Grid;
pub use layout::{Cut, Layout};
pub use open::{OpenPairs, pair_open};
pub use refine::refine;
pub use split::split;
pub use worth::squareness;

/// Quads of pairs of triangles.
#[derive(Clone, PartialEq, Debug)]
pub struct Paired {
    /// The quads on the unit sphere; the diagonal from the first corner to the third lies inside of
    /// each. After them the triangles that firm edges left without a partner.
    pub quads: PolygonMesh,
    /// Their edges that were to stay, each once, smaller end first, in order.
    pub kept: Vec<[VertexId; 2]>,
    /// Their firm edges, likewise: all that there were.
    pub firm: Vec<[VertexId; 2]>,
}

impl Paired {
    /// How many quads there are once all are split.
    pub fn n_once_split(&self) -> usize {
        self.quads.faces().map(<[VertexId]>::len).sum()
    }
}

/// Edges that are to be edges of quads, on both sides of each.
#[derive(Clone, Copy, Debug)]
pub struct Stay<'a> {
    /// They become diagonals only where nothing else pairs all.
    pub kept: &'a HalfedgeMap<bool>,
    /// They never do.
    pub firm: Option<&'a HalfedgeMap<bool>>,
}

impl Stay<'_> {
    fn is_firm(&self, h: HalfedgeId) -> bool {
        self.firm.is_some_and(|firm| firm[h])
    }
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
/// vertices keep their order. Between firm edges as few triangles as can be are left over, one or
/// none as a rule. About O(n log n).
///
/// # Errors
/// [`enum@Error`].
pub fn pair(map: &SphereMap, stay: Stay<'_>, progress: &Progress) -> Result<Paired, Error> {
    let mesh = map.mesh();
    let mut arcs = worth::arcs(mesh, stay);
    let mut mate = matching::largest(&arcs, &progress.part("", 0.0, 0.6))?;
    if stay.firm.is_none() && mate.contains(&matching::NONE) {
        let n_faces = mesh.n_faces();
        return Err(Error::Bridges { n_faces });
    }
    for easing in 0..N_EASINGS {
        progress.at(0.6 + 0.3 * f64::from(easing) / f64::from(N_EASINGS))?;
        if !worth::ease(mesh, stay, &mut arcs, &mate) {
            break;
        }
        improve::improve(&arcs, &mut mate, &progress.part("", 0.9, 0.9))?;
    }
    let mut quads = worth::quads(mesh, stay, &mate);
    let alone = worth::triangles(mesh, &mate);
    let is_held = held(mesh, stay, &alone);
    let sphere = map.sphere().as_slice();
    let is_inside = |quad: [u32; 4]| {
        let [p, q, r, s] = quad.map(|u| sphere[u as usize]);
        is_positive(p, q, r) && is_positive(p, r, s)
    };
    let vertices = tips::without(&mut quads, &is_held, &is_inside);
    let quads = named((&quads, &alone), (&vertices, map));
    let firm = stay
        .firm
        .map(|firm| edges_of((mesh, firm), (&quads, &vertices)));
    Ok(Paired {
        kept: edges_of((mesh, stay.kept), (&quads, &vertices)),
        firm: firm.unwrap_or_default(),
        quads,
    })
}

/// The vertices that stay: ends of firm edges and corners of triangles.
fn held(mesh: &TriangleMesh, stay: Stay<'_>, alone: &[[u32; 3]]) -> Vec<bool> {
    let mut is_held = vec![false; mesh.n_vertices()];
    for h in mesh.halfedge_ids().filter(|&h| stay.is_firm(h)) {
        is_held[mesh.origin(h).index()] = true;
    }
    for &v in alone.iter().flatten() {
        is_held[v as usize] = true;
    }
    is_held
}

/// Quads and triangles between the vertices that are left, on the sphere.
fn named(
    (quads, alone): (&[[u32; 4]], &[[u32; 3]]),
    (vertices, map): (&[VertexId], &SphereMap),
) -> PolygonMesh {
    let mut number = vec![0; map.mesh().n_vertices()];
    for (i, v) in (0..).zip(vertices) {
        number[v.index()] = i;
    }
    let name = |&v: &u32| number[v as usize];
    let quads = quads.iter().map(|face| face.iter().map(name).collect());
    let alone = alone.iter().map(|face| face.iter().map(name).collect());
    let faces: Vec<Vec<u32>> = quads.chain(alone).collect();
    let sphere = vertices.iter().map(|&v| map.sphere()[v]).collect();
    faces_on(sphere, &faces)
}

/// The edges of faces that are marked edges of the mesh.
fn edges_of(
    (mesh, marked): (&TriangleMesh, &HalfedgeMap<bool>),
    (faces, vertices): (&PolygonMesh, &[VertexId]),
) -> Vec<[VertexId; 2]> {
    let marked = mesh.halfedge_ids().filter(|&h| marked[h]);
    let marked = marked.map(|h| [mesh.origin(h), mesh.target(h)]);
    let marked: BTreeSet<[VertexId; 2]> = marked.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    let mut edges = Vec::new();
    for face in faces.faces() {
        for i in 0..face.len() {
            let [a, b] = [face[i], face[(i + 1) % face.len()]];
            // Vertices keep their order.
            if a < b && marked.contains(&[a, b].map(|v| vertices[v.index()])) {
                edges.push([a, b]);
            }
        }
    }
    edges.sort_unstable();
    edges
}

/// A mesh on the sphere from the corners of its faces.
fn faces_on<F: AsRef<[u32]>>(sphere: Vec<DVec3>, faces: &[F]) -> PolygonMesh {
    PolygonMesh::from_faces(sphere, faces).expect("faces have corners that exist")
}

#[cfg(test)]
mod tests;
