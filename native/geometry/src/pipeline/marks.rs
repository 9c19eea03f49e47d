//! Edges that the user marked, found again in a part of the cleaned mesh.

use std::collections::HashSet;

use glam::DVec3;

use super::frame::{Frame, bits};
use super::{Error, Input};
use crate::mesh::{HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};

/// Edges known by the places of their ends.
#[derive(Clone, Debug, Default)]
pub struct Marks(HashSet<[[u64; 3]; 2]>);

impl Marks {
    /// Edges of the input, in the frame of work.
    pub fn new((mesh, edges): (&PolygonMesh, &[[VertexId; 2]]), frame: &Frame) -> Self {
        let key = |ends: &[VertexId; 2]| {
            let ends = frame.enter(&ends.map(|v| mesh.position(v)));
            key(ends[0], ends[1])
        };
        Self(edges.iter().map(key).collect())
    }

    /// Edges in the frame of work, by the places of their ends.
    pub fn at(ends: impl Iterator<Item = [DVec3; 2]>) -> Self {
        Self(ends.map(|[a, b]| key(a, b)).collect())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The marked edges of a part, on both sides of each.
    pub fn on(&self, part: &TriangleMesh) -> HalfedgeMap<bool> {
        let is_marked = |h| {
            let [a, b] = [part.origin(h), part.target(h)].map(|v| part.position(v));
            !self.is_empty() && self.0.contains(&key(a, b))
        };
        part.halfedge_ids().map(is_marked).collect()
    }
}

impl Input<'_> {
    /// Whether all edges have their ends.
    pub(super) fn check_edges(&self) -> Result<(), Error> {
        let n_vertices = self.mesh.n_vertices();
        let cuts = self.cuts.unwrap_or_default().iter();
        let cuts = cuts.map(|set| ("cut", set.as_slice()));
        let all = [("marked", self.marked), ("carried", self.carried)];
        for (kind, edges) in all.into_iter().chain(cuts) {
            for (edge, ends) in edges.iter().enumerate() {
                if let Some(&vertex) = ends.iter().find(|v| v.index() >= n_vertices) {
                    return Err(Error::EdgeOutOfRange {
                        kind,
                        edge,
                        vertex,
                        n_vertices,
                    });
                }
            }
        }
        Ok(())
    }
}

/// Two ends as bits, in an order that does not depend on theirs.
pub(super) fn key(a: DVec3, b: DVec3) -> [[u64; 3]; 2] {
    let [a, b] = [a, b].map(bits);
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::frame::Prepared;
    use crate::progress::Progress;
    use crate::shapes;

    /// A box of separate triangles, so that cleaning welds and renumbers all vertices.
    fn soup() -> PolygonMesh {
        let mesh = shapes::cuboid(2);
        let positions = mesh.face_ids().flat_map(|f| mesh.triangle(f)).collect();
        let faces: Vec<_> = (0..mesh.n_faces() as u32)
            .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
            .collect();
        PolygonMesh::from_faces(positions, &faces).unwrap()
    }

    #[test]
    fn marked_edges_are_found_after_welding() {
        let mesh = soup();
        let marked = [[VertexId(0), VertexId(1)], [VertexId(8), VertexId(6)]];
        let prepared = Prepared::new(&mesh, &Progress::none()).unwrap();
        assert!(prepared.mesh.n_vertices() < mesh.n_vertices());
        let on = Marks::new((&mesh, &marked), &prepared.frame).on(&prepared.mesh);
        assert_eq!(on.iter().filter(|&&is_marked| is_marked).count(), 4);
    }

    #[test]
    fn a_marked_edge_without_a_vertex_is_refused_with_its_number() {
        let mesh = soup();
        let input = Input {
            marked: &[[VertexId(0), VertexId(1)], [VertexId(2), VertexId(900)]],
            ..Input::new(&mesh)
        };
        let error = input.check_edges().unwrap_err();
        let text = format!(
            "marked edge 1 names vertex 900, but there are {} vertices",
            mesh.n_vertices()
        );
        assert_eq!(error.to_string(), text);
    }
}
