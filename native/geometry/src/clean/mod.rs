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

mod ears;
mod edges;
mod fans;
mod orient;
mod polygons;
mod report;
mod scale;
mod triangulate;
mod weld;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{FaceId, FaceMap, Id, PolygonMesh, TriangleMesh, TriangleMeshError, VertexId};
use crate::progress::{Cancelled, Progress};
use edges::Edges;
pub use report::Report;
use scale::Scale;
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
    progress.at(0.15)?;
    let polygons = polygons::simplify(input, &first, &mut report);
    progress.at(0.25)?;
    let mut triangulated = Triangulated::new(input, &polygons);
    progress.at(0.4)?;
    let mut edges = Edges::new(&triangulated.faces);
    while triangulated.resolve_conflicts(&edges, &polygons) {
        edges = Edges::new(&triangulated.faces);
        progress.check()?;
    }
    progress.at(0.6)?;
    let mut faces = triangulated.faces;
    check_area(&faces, &triangulated.positions, input)?;
    report.n_flat_dropped = drop_flat_fins(&faces, &triangulated.positions, &mut edges);
    check_edges(&edges, &faces, &triangulated.origins)?;
    progress.at(0.7)?;
    report.n_reoriented =
        orient::agree(&mut faces, &mut edges).map_err(|[a, b]| Error::NotOrientable { a, b })?;
    progress.at(0.75)?;
    let n_before = triangulated.positions.len();
    fans::split(&mut faces, &edges, &mut triangulated.positions);
    report.n_split = triangulated.positions.len() - n_before;
    progress.at(0.8)?;
    let source = edges.kept(&triangulated.source);
    let faces = edges.kept(&faces);
    let (positions, faces) = compact(&triangulated.positions, faces);
    count_vertices(input, &first, &polygons, &mut report);
    let mesh = TriangleMesh::new(positions, faces)?;
    progress.at(1.0)?;
    let source = FaceMap::from_vec(source);
    Ok(Cleaned {
        mesh,
        source,
        report,
    })
}

/// Refuses meshes whose faces are all points or lines, and those of fewer than four points.
fn check_area(
    faces: &[[VertexId; 3]],
    positions: &[DVec3],
    input: &PolygonMesh,
) -> Result<(), Error> {
    let scale = Scale::of(positions);
    let solid = |f: &[VertexId; 3]| !scale.is_flat(f.map(|v| positions[v.index()]));
    if !faces.iter().any(solid) {
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

/// Drops triangles without area that hang on the surface: those with an edge that no other face
/// has, again and again. A triangle without area whose edges all have two faces closes a crack.
fn drop_flat_fins(faces: &[[VertexId; 3]], positions: &[DVec3], edges: &mut Edges) -> usize {
    let scale = Scale::of(positions);
    let is_flat = |f: FaceId| scale.is_flat(faces[f.index()].map(|v| positions[v.index()]));
    let mut stack: Vec<FaceId> = edges.lonely_faces().filter(|&f| is_flat(f)).collect();
    let mut n_dropped = 0;
    while let Some(face) = stack.pop() {
        if !edges.is_kept(face) {
            continue;
        }
        n_dropped += 1;
        for lonely in edges.drop_face(face) {
            if is_flat(lonely) {
                stack.push(lonely);
            }
        }
    }
    n_dropped
}

fn check_edges(edges: &Edges, faces: &[[VertexId; 3]], origins: &[VertexId]) -> Result<(), Error> {
    let Some(h) = edges.crowded() else {
        return Ok(());
    };
    let face = faces[h.face().index()];
    let [a, b] = [face[h.corner()], face[h.next().corner()]].map(|v| origins[v.index()]);
    Err(Error::NonManifoldEdge {
        n_faces: edges.n_faces(h),
        a: a.min(b),
        b: a.max(b),
    })
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
fn count_vertices(
    input: &PolygonMesh,
    first: &[VertexId],
    polygons: &polygons::Polygons,
    report: &mut Report,
) {
    let mut used = vec![false; input.n_vertices()];
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
