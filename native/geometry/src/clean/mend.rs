//! What has to be done when polygons over welded vertices are not a solid already.

use super::edges::Edges;
use super::polygons::Polygons;
use super::triangulate::Triangulated;
use super::{Error, Report};
use crate::groups::Groups;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, Id, VertexId, VertexMap};
use crate::progress::Progress;

/// Triangles over welded vertices, however they meet.
pub(super) struct Soup {
    pub(super) triangulated: Triangulated,
    pub(super) edges: Edges,
}

impl Soup {
    /// Drops repeated polygons and hanging flat triangles, and cuts polygons so that none of their
    /// diagonals meets other faces.
    pub(super) fn new(
        mut polygons: Polygons,
        mut triangulated: Triangulated,
        report: &mut Report,
        progress: &Progress,
    ) -> Result<Self, Error> {
        report.n_duplicates = polygons.drop_repeated();
        if report.n_duplicates > 0 {
            triangulated.cut_all(&polygons);
        }
        let mut edges = Edges::new(&triangulated.faces);
        progress.check()?;
        while triangulated.resolve_conflicts(&edges, &polygons) {
            edges = Edges::new(&triangulated.faces);
            progress.check()?;
        }
        report.n_flat_dropped = drop_flat_fins(&mut triangulated, &mut edges);
        Ok(Self {
            triangulated,
            edges,
        })
    }

    /// The input's faces that hang together with an edge of more than two, and which of the
    /// input's vertices they use; none where there is no such edge.
    pub(super) fn crowded(
        &self,
        n_faces: usize,
        n_vertices: usize,
    ) -> Option<(FaceMap<bool>, VertexMap<bool>)> {
        let is_crowded = |run: &&[HalfedgeId]| run.len() > 2;
        self.edges.runs().find(is_crowded)?;
        let mut groups = Groups::new(self.triangulated.faces.len());
        for run in self.edges.runs() {
            for pair in run.windows(2) {
                groups.link(pair[0].face().index(), pair[1].face().index());
            }
        }
        let (group, n) = groups.numbered();
        let mut is_hit = vec![false; n];
        for run in self.edges.runs().filter(is_crowded) {
            is_hit[group[run[0].face().index()] as usize] = true;
        }
        let mut faces = FaceMap::filled(n_faces, false);
        let mut vertices = VertexMap::filled(n_vertices, false);
        for (i, corners) in self.triangulated.faces.iter().enumerate() {
            if is_hit[group[i] as usize] {
                faces[self.triangulated.source[i]] = true;
                for v in corners.iter().filter(|v| v.index() < n_vertices) {
                    vertices[*v] = true;
                }
            }
        }
        Some((faces, vertices))
    }

    /// The ends of an edge, as the input names them, the smaller first.
    pub(super) fn ends(&self, h: HalfedgeId) -> [VertexId; 2] {
        let ends = self.triangulated.ends(h);
        let [a, b] = ends.map(|v| self.triangulated.origins[v.index()]);
        [a.min(b), a.max(b)]
    }
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
