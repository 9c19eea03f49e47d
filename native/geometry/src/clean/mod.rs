//! Makes a manifold triangle mesh of what comes in, changing as little as it can.
//!
//! In order: equal points are welded; polygons lose corners that repeat, and go when fewer than
//! three are left or the same polygon came before; polygons become triangles; triangles without
//! area go where that opens no hole; the faces of each component are turned to agree with its
//! majority; a vertex where several fans meet becomes one vertex for each.
//!
//! Welding can bring together what only touches, such as the edges of two boxes side by side.
//! When an edge has more than two faces after welding, only vertices on the border of the mesh
//! as given are welded: enough to close a soup of triangles, too little to glue closed parts.
//!
//! Not done: holes stay open, parts that cross stay crossed, an inside-out part stays so.

mod edges;
mod fans;
mod mend;
mod orient;
mod polygons;
mod report;
mod scale;
mod triangulate;
mod weld;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{
    FaceId, FaceMap, HalfedgeId, Id, PolygonMesh, TriangleMesh, TriangleMeshError, VertexId,
};
use crate::progress::{Cancelled, Progress};
use polygons::Polygons;
pub use report::Report;
use triangulate::Triangulated;
use weld::Reach;

/// A manifold mesh and how it came about.
#[derive(Clone, PartialEq, Debug)]
pub struct Cleaned {
    /// The mesh; components, holes and handles are as they came.
    pub mesh: TriangleMesh,
    /// The input polygon of each triangle.
    pub source: FaceMap<FaceId>,
    /// What had to be done.
    pub report: Report,
}

/// Why no manifold mesh can be made. Vertices are the input's, counted from 0.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// There are no faces.
    #[error("the mesh has no faces ({n_vertices} vertices)")]
    NoFaces {
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// There are too few points for a solid.
    #[error("the faces use {n_points} different points; at least 4 are needed")]
    TooFewPoints {
        /// How many different points there are.
        n_points: usize,
    },
    /// All faces are points or lines.
    #[error("the mesh has no area: each of its {n_faces} faces is a point or a line")]
    NoArea {
        /// How many faces there are.
        n_faces: usize,
    },
    /// More than two faces at an edge.
    #[error("{n_faces} faces meet at the edge between vertices {a} and {b}; at most 2 can")]
    NonManifoldEdge {
        /// How many faces meet.
        n_faces: usize,
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// The surface has one side only.
    #[error(
        "the surface cannot be oriented (it has one side, like a moebius strip): faces disagree \
         along the edge between vertices {a} and {b} whichever way they are turned"
    )]
    NotOrientable {
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// The triangles are too many.
    #[error(transparent)]
    Mesh(#[from] TriangleMeshError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Makes a manifold triangle mesh of polygons; see the module for what is done.
///
/// Works for coordinates of any size. Costs O(n log n). Each component keeps the orientation of
/// most of its faces, be it outward or inward.
///
/// # Errors
/// When there is nothing to work with, when more than two faces meet at an edge, when a component
/// cannot be oriented, when the user cancels.
pub fn clean(input: &PolygonMesh, progress: &Progress) -> Result<Cleaned, Error> {
    let [n_vertices, n_faces] = [input.n_vertices(), input.n_faces()];
    if n_faces == 0 {
        return Err(Error::NoFaces { n_vertices });
    }
    match attempt(input, Reach::All, progress) {
        Err(edge @ Error::NonManifoldEdge { .. }) => attempt(input, Reach::Border, progress)
            .map_err(|error| match error {
                Error::Cancelled(_) => error,
                _ => edge,
            }),
        result => result,
    }
}

fn attempt(input: &PolygonMesh, reach: Reach, progress: &Progress) -> Result<Cleaned, Error> {
    let mut report = Report::default();
    let first = weld::first_equal(input, reach);
    progress.at(0.2)?;
    let polygons = polygons::simplify(input, &first, &mut report);
    progress.at(0.4)?;
    let triangulated = Triangulated::new(input, &polygons);
    progress.at(0.6)?;
    check_area(&triangulated, input)?;
    count_vertices(&first, &polygons, &mut report);
    progress.at(0.65)?;
    if let Some(cleaned) = already_solid(&triangulated, report, progress)? {
        return Ok(cleaned);
    }
    progress.at(0.7)?;
    let mended = mend::mend(polygons, triangulated, &mut report, progress)?;
    let (positions, faces) = compact(&mended.positions, mended.faces);
    Ok(Cleaned {
        mesh: TriangleMesh::build(positions, faces, progress)??,
        source: FaceMap::from_vec(mended.source),
        report,
    })
}

/// The mesh if it has nothing to mend and no border, which is told fastest by trying.
fn already_solid(
    triangulated: &Triangulated,
    report: Report,
    progress: &Progress,
) -> Result<Option<Cleaned>, Cancelled> {
    let (positions, faces) = compact(&triangulated.positions, triangulated.faces.clone());
    progress.check()?;
    let Ok(mesh) = TriangleMesh::build(positions, faces, progress)? else {
        return Ok(None);
    };
    let source = FaceMap::from_vec(triangulated.source.clone());
    let cleaned = Cleaned {
        mesh,
        source,
        report,
    };
    let is_solid = cleaned.mesh.is_closed() && !has_doubled(&cleaned.mesh);
    Ok(is_solid.then_some(cleaned))
}

/// Whether two triangles lie back to back, with all three edges in common.
fn has_doubled(mesh: &TriangleMesh) -> bool {
    mesh.face_ids().any(|face| {
        let h = mesh.halfedge(face);
        let neighbour = |h| mesh.twin(h).map(HalfedgeId::face);
        let first = neighbour(h);
        first.is_some() && first == neighbour(h.next()) && first == neighbour(h.prev())
    })
}

/// Refuses meshes whose faces are all points or lines, and those of fewer than four points.
fn check_area(triangulated: &Triangulated, input: &PolygonMesh) -> Result<(), Error> {
    let faces = &triangulated.faces;
    if faces.iter().all(|&face| triangulated.is_flat(face)) {
        let n_faces = input.n_faces();
        return Err(Error::NoArea { n_faces });
    }
    let mut points: Vec<VertexId> = faces.iter().take(4).flatten().copied().collect();
    points.sort_unstable();
    points.dedup();
    if points.len() < 4 {
        let n_points = points.len();
        return Err(Error::TooFewPoints { n_points });
    }
    Ok(())
}

/// Drops vertices that no face uses.
fn compact(positions: &[DVec3], mut faces: Vec<[VertexId; 3]>) -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    const UNUSED: VertexId = VertexId(u32::MAX);
    let mut renamed = vec![UNUSED; positions.len()];
    for vertex in faces.iter().flatten() {
        renamed[vertex.index()] = *vertex;
    }
    let mut kept = Vec::with_capacity(positions.len());
    for (name, &position) in renamed.iter_mut().zip(positions) {
        if *name != UNUSED {
            *name = VertexId::from_index(kept.len());
            kept.push(position);
        }
    }
    for vertex in faces.iter_mut().flatten() {
        *vertex = renamed[vertex.index()];
    }
    (kept, faces)
}

/// Counts the vertices welded, and those that no face of the input used.
fn count_vertices(first: &[VertexId], polygons: &Polygons, report: &mut Report) {
    let mut used = vec![false; first.len()];
    for vertex in polygons.corners() {
        used[vertex.index()] = true;
    }
    for (i, vertex) in first.iter().enumerate() {
        report.n_welded += usize::from(vertex.index() != i);
        report.n_isolated += usize::from(vertex.index() == i && !used[i]);
    }
}

#[cfg(test)]
mod tests;
