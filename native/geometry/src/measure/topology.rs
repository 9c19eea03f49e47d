//! How a polygon mesh hangs together, whatever its faces are.

use serde::Serialize;

use super::PolygonEdges;
use crate::groups::Groups;
use crate::mesh::{Id, PolygonMesh, TriangleMesh};
use crate::progress::{Cancelled, Progress};

/// Counts that do not depend on positions.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Topology {
    /// Vertices that a face uses.
    pub n_vertices: usize,
    /// Faces.
    pub n_faces: usize,
    /// Faces with four corners.
    pub n_quads: usize,
    /// Pieces that share no vertex.
    pub n_components: usize,
    /// The number of handles, (2 components − borders − Euler number) / 2; none unless manifold.
    pub genus: Option<i64>,
    /// Whether no edge has only one face.
    pub closed: bool,
    /// Whether every edge has at most two faces that run through it in opposite directions, and
    /// the faces at every vertex form one fan.
    pub manifold: bool,
    /// Groups of connected edges with only one face.
    pub n_borders: usize,
}

/// Counts vertices, faces, pieces, handles and borders.
///
/// # Errors
/// When cancelled.
pub fn topology(mesh: &PolygonMesh, progress: &Progress) -> Result<Topology, Cancelled> {
    topology_of(mesh, &PolygonEdges::new(mesh, progress)?, progress)
}

/// The same for a mesh whose edges are at hand.
///
/// # Errors
/// When cancelled.
pub fn topology_of(
    mesh: &PolygonMesh,
    edges: &PolygonEdges,
    progress: &Progress,
) -> Result<Topology, Cancelled> {
    let mut is_used = vec![false; mesh.n_vertices()];
    mesh.corners()
        .iter()
        .for_each(|v| is_used[v.index()] = true);
    let n_vertices = is_used.iter().filter(|&&used| used).count();
    let n_unused = mesh.n_vertices() - n_vertices;
    let n_components = n_groups(mesh, edges, |_| true, progress)? - n_unused;
    let n_border_vertices = border_ends(mesh, edges);
    let n_borders = n_groups(mesh, edges, |n_sides| n_sides == 1, progress)?
        - (mesh.n_vertices() - n_border_vertices);
    let is_paired =
        |c: usize| edges.n_sides[edges.of_corner[c] as usize] == 1 || edges.twin(c).is_some();
    let manifold = (0..edges.n_corners()).all(is_paired) && n_fans(edges, progress)? == n_vertices;
    let euler = n_vertices as i64 - edges.len() as i64 + mesh.n_faces() as i64;
    let genus = (2 * n_components as i64 - n_borders as i64 - euler).div_euclid(2);
    Ok(Topology {
        n_vertices,
        n_faces: mesh.n_faces(),
        n_quads: mesh.n_quads(),
        n_components,
        genus: manifold.then_some(genus),
        closed: !edges.n_sides.contains(&1),
        manifold,
        n_borders,
    })
}

/// The same for triangles that are a manifold mesh already, each of whose vertices has a face.
pub fn topology_of_triangles(mesh: &TriangleMesh) -> Topology {
    let [n_components, n_borders] = [mesh.face_components().1, mesh.border_loops().len()];
    let genus = (2 * n_components as i64 - n_borders as i64 - mesh.euler_number()).div_euclid(2);
    Topology {
        n_vertices: mesh.n_vertices(),
        n_faces: mesh.n_faces(),
        n_quads: 0,
        n_components,
        genus: Some(genus),
        closed: n_borders == 0,
        manifold: true,
        n_borders,
    }
}

impl Topology {
    /// Whether another mesh hangs together alike, whatever its counts of vertices and faces.
    pub fn is_alike(&self, other: &Self) -> bool {
        let figures = |t: &Self| (t.closed, t.manifold, t.n_components, t.n_borders, t.genus);
        figures(self) == figures(other)
    }
}

/// How many groups of vertices the edges with a wanted number of sides make.
fn n_groups(
    mesh: &PolygonMesh,
    edges: &PolygonEdges,
    is_wanted: impl Fn(u32) -> bool,
    progress: &Progress,
) -> Result<usize, Cancelled> {
    let mut groups = Groups::new(mesh.n_vertices());
    for (&[a, b], &n_sides) in edges.ends.iter().zip(&edges.n_sides) {
        progress.check()?;
        if is_wanted(n_sides) {
            groups.link(a.index(), b.index());
        }
    }
    Ok(groups.numbered().1)
}

/// How many vertices lie on an edge with one side.
fn border_ends(mesh: &PolygonMesh, edges: &PolygonEdges) -> usize {
    let mut is_end = vec![false; mesh.n_vertices()];
    for (ends, _) in edges
        .ends
        .iter()
        .zip(&edges.n_sides)
        .filter(|(_, n)| **n == 1)
    {
        for v in ends {
            is_end[v.index()] = true;
        }
    }
    is_end.iter().filter(|&&end| end).count()
}

/// How many fans of faces there are around all vertices: one each in a manifold mesh.
fn n_fans(edges: &PolygonEdges, progress: &Progress) -> Result<usize, Cancelled> {
    let mut groups = Groups::new(edges.n_corners());
    for corner in 0..edges.n_corners() {
        progress.check()?;
        if let Some(twin) = edges.twin(corner) {
            groups.link(corner, edges.next(twin));
        }
    }
    Ok(groups.numbered().1)
}
