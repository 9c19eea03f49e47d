//! Makes manifold triangle meshes of what comes in, changing as little as it can.
//!
//! In order: equal points are welded; polygons lose corners that repeat, and go when fewer than
//! three are left or the same polygon came before; polygons become triangles; triangles without
//! area go where that opens no hole; the faces of each component are turned to agree with its
//! majority; a vertex where several fans meet becomes one vertex for each.
//!
//! Welding can bring together what only touches, such as the edges of two boxes side by side.
//! Where an edge has more than two faces after welding, what hangs together there is welded anew,
//! only at vertices on the border of the mesh as given: enough to close a soup of triangles, too
//! little to glue closed parts. Solids that share an edge even so part at it (`pairs`). At any other
//! edge of more than two faces surfaces are parted into sheets with borders (`sheets`); [`take_apart`]
//! says along which lines they meet, [`clean`] refuses the mesh. A part with one side only is a
//! tangle, set apart or refused. Borders that lie on each other within a distance are welded too
//! (`seam`).
//!
//! Not done: holes stay open, parts that cross stay crossed, an inside-out part stays so.

mod apart;
mod edges;
mod fans;
mod mend;
mod orient;
mod pairs;
mod polygons;
mod report;
mod scale;
mod seam;
mod sheets;
mod triangulate;
mod weld;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{
    FaceId, FaceMap, HalfedgeId, Id, PolygonMesh, TriangleMesh, TriangleMeshError, VertexId,
    VertexMap,
};
use crate::progress::{Cancelled, Progress};
pub use apart::{Apart, Tangle};
use mend::Soup;
use polygons::Polygons;
pub use report::Report;
pub use seam::{WELD, distance};
pub use sheets::{Fan, SharedLine, SharedPoint, Strand};
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

impl Cleaned {
    /// Some of the triangles, none of them without all that hangs together with it.
    ///
    /// # Panics
    /// When a component is wanted in part.
    #[must_use]
    pub fn only(&self, is_wanted: &[bool]) -> Self {
        let faces = self.mesh.faces().iter().zip(is_wanted);
        let faces = faces.filter(|(_, wanted)| **wanted).map(|(face, _)| *face);
        let mesh = TriangleMesh::of_faces(self.mesh.positions(), faces);
        let source = self.source.iter().zip(is_wanted);
        let source = source.filter(|(_, wanted)| **wanted).map(|(face, _)| *face);
        Self {
            mesh: mesh.expect("components of a mesh are a mesh").0,
            source: source.collect(),
            report: self.report,
        }
    }
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
/// most of its faces, be it outward or inward. Triangles back to back enclose nothing and go.
///
/// # Errors
/// When there is nothing to work with, when more than two faces meet at an edge, when a component
/// cannot be oriented, when the user cancels.
pub fn clean(input: &PolygonMesh, progress: &Progress) -> Result<Cleaned, Error> {
    let Apart {
        mesh,
        source,
        shared,
        tangles,
        mut report,
        ..
    } = take_apart(input, None, progress)?;
    refuse(&shared, &tangles)?;
    let is_left = not_doubled(&mesh);
    report.n_doubled = is_left.iter().filter(|&&is_left| !is_left).count();
    if report.n_doubled == is_left.len() || mesh.n_vertices() < 4 {
        let n_points = mesh.n_vertices().min(3);
        return Err(Error::TooFewPoints { n_points });
    }
    let cleaned = Cleaned {
        mesh,
        source,
        report,
    };
    Ok(match report.n_doubled {
        0 => cleaned,
        _ => cleaned.only(&is_left),
    })
}

/// Takes a mesh apart into its parts; see the module for what is done.
///
/// Works for coordinates of any size. Costs O(n log n). Each surface keeps the orientation of most
/// of its faces. Borders that lie on each other are welded up to a gap of `weld` times the diagonal.
///
/// # Errors
/// When there is nothing to work with, when the user cancels.
pub fn take_apart(
    input: &PolygonMesh,
    weld: Option<f64>,
    progress: &Progress,
) -> Result<Apart, Error> {
    let apart = exactly(input, &progress.part("", 0.0, 0.6))?;
    let Some(share) = weld.filter(|_| apart.is_open()) else {
        return Ok(apart);
    };
    let distance = seam::distance(input, share);
    let Some(closed) = seam::close(input, &apart, distance, progress)? else {
        return Ok(apart);
    };
    let moved = input.with_positions(closed.positions);
    let mut apart = exactly(&moved, &progress.part("", 0.6, 1.0))?;
    let report = &mut apart.report;
    report.n_welded = report.n_welded.saturating_sub(closed.n_welded);
    report.n_seam_welded = closed.n_welded;
    report.weld_distance = closed.gap;
    apart.moved = Some(moved.positions().to_vec());
    Ok(apart)
}

/// The same where equal points alone are welded.
fn exactly(input: &PolygonMesh, progress: &Progress) -> Result<Apart, Error> {
    let [n_vertices, n_faces] = [input.n_vertices(), input.n_faces()];
    if n_faces == 0 {
        return Err(Error::NoFaces { n_vertices });
    }
    let mut report = Report::default();
    let all = weld::first_equal(input, Reach::All);
    progress.at(0.2)?;
    let polygons = polygons::simplify(input, |_, v| all[v.index()], &mut report);
    progress.at(0.4)?;
    let triangulated = Triangulated::new(input, &polygons);
    progress.at(0.6)?;
    check_area(&triangulated, input)?;
    count_vertices(&all, &polygons, &mut report);
    progress.at(0.65)?;
    if let Some(apart) = already_solid(&triangulated, report, progress)? {
        return Ok(apart);
    }
    progress.at(0.7)?;
    let soup = Soup::new(polygons, triangulated, &mut report, progress)?;
    let soup = match soup.crowded(n_faces, n_vertices) {
        Some(crowded) => loosened(input, &all, crowded, &mut report)?,
        None => soup,
    };
    apart::sort(soup, report, progress)
}

/// Welds anew what hangs together with edges of more than two faces: vertices on borders alone.
fn loosened(
    input: &PolygonMesh,
    all: &[VertexId],
    (mut faces, vertices): (FaceMap<bool>, VertexMap<bool>),
    report: &mut Report,
) -> Result<Soup, Error> {
    let border = weld::first_equal(input, Reach::Border);
    let polygons = polygons::simplify(input, |_, v| all[v.index()], &mut Report::default());
    let mut is_left: FaceMap<bool> = FaceMap::filled(input.n_faces(), false);
    (0..polygons.len()).for_each(|i| is_left[polygons.source(i)] = true);
    // What all welding makes degenerate may be a wall between others.
    let touches = |face| input.face(face).iter().any(|v| vertices[all[v.index()]]);
    for face in input.face_ids().filter(|&face| !is_left[face]) {
        faces[face] = touches(face);
    }
    let mut names = all.to_vec();
    for face in input.face_ids().filter(|&face| faces[face]) {
        for v in input.face(face) {
            names[v.index()] = border[v.index()];
        }
    }
    let name = |face, v: VertexId| {
        if faces[face] {
            border[v.index()]
        } else {
            all[v.index()]
        }
    };
    let polygons = polygons::simplify(input, name, report);
    [report.n_welded, report.n_isolated] = [0; 2];
    count_vertices(&names, &polygons, report);
    let triangulated = Triangulated::new(input, &polygons);
    Soup::new(polygons, triangulated, report, &Progress::none())
}

/// The mesh if it has nothing to mend and no border, which is told fastest by trying.
fn already_solid(
    triangulated: &Triangulated,
    report: Report,
    progress: &Progress,
) -> Result<Option<Apart>, Cancelled> {
    let compacted = compact(&triangulated.positions, triangulated.faces.clone());
    progress.check()?;
    let Ok(mesh) = TriangleMesh::build(compacted.positions, compacted.faces, progress)? else {
        return Ok(None);
    };
    if !mesh.is_closed() {
        return Ok(None);
    }
    let origin = compacted.was.iter();
    let origin = origin.map(|v| triangulated.origins[v.index()]).collect();
    Ok(Some(Apart {
        mesh,
        source: FaceMap::from_vec(triangulated.source.clone()),
        origin,
        shared: Vec::new(),
        touching: Vec::new(),
        points: Vec::new(),
        tangles: Vec::new(),
        moved: None,
        report,
    }))
}

/// Which triangles do not lie back to back with another, all three edges in common.
fn not_doubled(mesh: &TriangleMesh) -> Vec<bool> {
    let is_left = |face| {
        let h = mesh.halfedge(face);
        let neighbour = |h| mesh.twin(h).map(HalfedgeId::face);
        let first = neighbour(h);
        first.is_none() || first != neighbour(h.next()) || first != neighbour(h.prev())
    };
    mesh.face_ids().map(is_left).collect()
}

/// Refuses meshes whose faces are all points or lines.
fn check_area(triangulated: &Triangulated, input: &PolygonMesh) -> Result<(), Error> {
    let faces = &triangulated.faces;
    if faces.iter().all(|&face| triangulated.is_flat(face)) {
        let n_faces = input.n_faces();
        return Err(Error::NoArea { n_faces });
    }
    Ok(())
}

/// Faces over the vertices that they use.
struct Compacted {
    positions: Vec<DVec3>,
    faces: Vec<[VertexId; 3]>,
    /// What each vertex was called before.
    was: Vec<VertexId>,
}

/// Drops vertices that no face uses.
fn compact(positions: &[DVec3], mut faces: Vec<[VertexId; 3]>) -> Compacted {
    const UNUSED: VertexId = VertexId(u32::MAX);
    let mut renamed = vec![UNUSED; positions.len()];
    for vertex in faces.iter().flatten() {
        renamed[vertex.index()] = *vertex;
    }
    let mut was = Vec::with_capacity(positions.len());
    for name in renamed.iter_mut().filter(|name| **name != UNUSED) {
        was.push(std::mem::replace(name, VertexId::from_index(was.len())));
    }
    for vertex in faces.iter_mut().flatten() {
        *vertex = renamed[vertex.index()];
    }
    Compacted {
        positions: was.iter().map(|v| positions[v.index()]).collect(),
        faces,
        was,
    }
}

/// Counts the vertices welded, and those that no face of the input used.
fn count_vertices(names: &[VertexId], polygons: &Polygons, report: &mut Report) {
    let mut used = vec![false; names.len()];
    for vertex in polygons.corners() {
        used[vertex.index()] = true;
    }
    for (i, vertex) in names.iter().enumerate() {
        report.n_welded += usize::from(vertex.index() != i);
        report.n_isolated += usize::from(vertex.index() == i && !used[i]);
    }
}

/// Refuses sheets that meet, which as one mesh would come apart, and tangles.
fn refuse(shared: &[SharedLine], tangles: &[Tangle]) -> Result<(), Error> {
    let edges = shared
        .iter()
        .flat_map(|line| line.edges().map(|ends| (ends, line.n_faces)));
    if let Some(([a, b], n_faces)) = edges.min() {
        return Err(Error::NonManifoldEdge { n_faces, a, b });
    }
    match tangles {
        [] => Ok(()),
        [first, ..] => {
            let [a, b] = first.one_sided;
            Err(Error::NotOrientable { a, b })
        }
    }
}

#[cfg(test)]
mod tests;
