//! Joins the two borders of every cut again.

use super::{Opening, SAME};
use crate::close::handles;
use crate::deform::Deformed;
use crate::measure::{PolygonEdges, Polyline};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

impl Opening {
    /// Quads whose handles are whole again; or why two borders cannot be joined.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn welded(
        &self,
        opened: Deformed,
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        if self.cuts.is_empty() {
            return Ok(Ok(opened));
        }
        let opened = self.leveled(opened, progress)?;
        let loops = loops(&opened.mesh, progress)?;
        let twins: Option<Vec<_>> = self
            .cuts
            .iter()
            .map(|cut| two_along(&opened.mesh, &loops, cut))
            .collect();
        let Some(twins) = twins else {
            return Ok(Err("a cut has not two borders of quads".to_owned()));
        };
        Ok(match handles::weld(&opened.mesh, &twins) {
            Ok(welded) => Ok(opened.renamed(welded.mesh, &welded.vertices, progress)?),
            Err(error) => Err(error.to_string()),
        })
    }
}

/// The two loops along a cut, side by side: the faces are on the left of the first.
pub(super) fn two_along(
    mesh: &PolygonMesh,
    loops: &[Vec<VertexId>],
    cut: &Polyline,
) -> Option<[Vec<VertexId>; 2]> {
    let lies =
        |edges: &&Vec<VertexId>| edges.iter().all(|&v| cut.distance(mesh.position(v)) < SAME);
    let along: Vec<_> = loops.iter().filter(lies).cloned().collect();
    let [one, mut other] = <[Vec<VertexId>; 2]>::try_from(along).ok()?;
    other.reverse();
    Some([one, other])
}

/// The loops of a mesh's borders, the faces on the left.
pub(super) fn loops(
    mesh: &PolygonMesh,
    progress: &Progress<'_>,
) -> Result<Vec<Vec<VertexId>>, Cancelled> {
    let edges = PolygonEdges::new(mesh, progress)?;
    let corners = mesh.corners();
    let mut ahead: Vec<Option<VertexId>> = vec![None; mesh.n_vertices()];
    for c in (0..edges.n_corners()).filter(|&c| edges.n_sides[edges.of_corner[c] as usize] == 1) {
        ahead[corners[c].index()] = Some(corners[edges.next(c)]);
    }
    let mut loops = Vec::new();
    for start in 0..mesh.n_vertices() {
        let mut border = Vec::new();
        let mut at = VertexId::from_index(start);
        while let Some(next) = ahead[at.index()].take() {
            border.push(at);
            at = next;
        }
        if !border.is_empty() {
            loops.push(border);
        }
    }
    Ok(loops)
}
