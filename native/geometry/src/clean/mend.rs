//! What has to be done when polygons over welded vertices are not a solid already.

use glam::DVec3;

use super::edges::Edges;
use super::polygons::Polygons;
use super::triangulate::Triangulated;
use super::{Error, Report, fans, orient};
use crate::mesh::{FaceId, Id, VertexId};
use crate::progress::Progress;

/// Triangles that make a manifold mesh but for vertices without a face.
pub(super) struct Mended {
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[VertexId; 3]>,
    pub(super) source: Vec<FaceId>,
}

/// Drops repeated polygons and hanging flat triangles, turns faces, splits vertices.
pub(super) fn mend(
    mut polygons: Polygons,
    mut triangulated: Triangulated,
    report: &mut Report,
    progress: &Progress,
) -> Result<Mended, Error> {
    report.n_duplicates = polygons.drop_repeated();
    if report.n_duplicates > 0 {
        triangulated.cut_all(&polygons);
    }
    let mut edges = Edges::new(&triangulated.faces);
    progress.at(0.8)?;
    while triangulated.resolve_conflicts(&edges, &polygons) {
        edges = Edges::new(&triangulated.faces);
        progress.check()?;
    }
    report.n_flat_dropped = drop_flat_fins(&mut triangulated, &mut edges);
    check_edges(&edges, &triangulated)?;
    report.n_doubled = drop_doubled(&mut triangulated, &mut edges)?;
    let mut twins = edges.into_twins();
    let mut faces = triangulated.faces;
    progress.at(0.85)?;
    report.n_reoriented = orient::agree(&mut faces, &mut twins)
        .map_err(|[a, b]| [a, b].map(|v| triangulated.origins[v.index()]))
        .map_err(|[a, b]| Error::NotOrientable { a, b })?;
    progress.at(0.9)?;
    let mut positions = triangulated.positions;
    report.n_split = fans::split(&mut faces, &twins, &mut positions);
    progress.at(0.95)?;
    Ok(Mended {
        positions,
        faces,
        source: triangulated.source,
    })
}

/// Drops triangles without area that hang on the surface: those with an edge that no other face
/// has, again and again. A triangle without area whose edges all have two faces closes a crack.
fn drop_flat_fins(triangulated: &mut Triangulated, edges: &mut Edges) -> usize {
    let lonely = edges.lonely_faces().into_iter();
    let mut stack: Vec<FaceId> = lonely.filter(|&f| triangulated.is_face_flat(f)).collect();
    let mut is_kept = vec![true; triangulated.faces.len()];
    let mut n_dropped = 0;
    while let Some(face) = stack.pop() {
        if !std::mem::replace(&mut is_kept[face.index()], false) {
            continue;
        }
        n_dropped += 1;
        let lonely = edges.drop_face(face).into_iter();
        stack.extend(lonely.filter(|&f| triangulated.is_face_flat(f)));
    }
    if n_dropped > 0 {
        triangulated.keep(&is_kept);
        *edges = Edges::new(&triangulated.faces);
    }
    n_dropped
}

/// Drops pairs of triangles that have all three edges in common.
fn drop_doubled(triangulated: &mut Triangulated, edges: &mut Edges) -> Result<usize, Error> {
    let is_kept: Vec<bool> = edges
        .neighbours()
        .map(|[a, b, c]| a.is_none() || a != b || b != c)
        .collect();
    let n_dropped = is_kept.iter().filter(|is_kept| !**is_kept).count();
    if n_dropped == is_kept.len() {
        return Err(Error::TooFewPoints { n_points: 3 });
    }
    if n_dropped > 0 {
        triangulated.keep(&is_kept);
        *edges = Edges::new(&triangulated.faces);
    }
    Ok(n_dropped)
}

fn check_edges(edges: &Edges, triangulated: &Triangulated) -> Result<(), Error> {
    let Some(run) = edges.runs().find(|run| run.len() > 2) else {
        return Ok(());
    };
    let face = triangulated.faces[run[0].face().index()];
    let ends = [face[run[0].corner()], face[run[0].next().corner()]];
    let [a, b] = ends.map(|v| triangulated.origins[v.index()]);
    Err(Error::NonManifoldEdge {
        n_faces: run.len(),
        a: a.min(b),
        b: a.max(b),
    })
}
