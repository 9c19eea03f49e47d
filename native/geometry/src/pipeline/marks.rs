//! Edges that the user marked, found again in a part of the cleaned mesh.

use std::collections::HashSet;

use glam::DVec3;

use super::frame::Frame;
use super::{Error, Input};
use crate::mesh::{HalfedgeMap, Id, TriangleMesh};

/// Edges known by the positions of their ends: cleaning welds, splits and renumbers vertices, but
/// moves none.
#[derive(Debug, Default)]
pub struct Marks(HashSet<[[u64; 3]; 2]>);

impl Marks {
    /// The marked edges of the input, in the frame of work.
    pub fn new(input: &Input<'_>, frame: &Frame) -> Result<Self, Error> {
        let n_vertices = input.mesh.n_vertices();
        let mut edges = HashSet::with_capacity(input.marked.len());
        for (edge, ends) in input.marked.iter().enumerate() {
            if let Some(&vertex) = ends.iter().find(|v| v.index() >= n_vertices) {
                return Err(Error::MarkedEdge {
                    edge,
                    vertex,
                    n_vertices,
                });
            }
            let ends = frame.enter(&ends.map(|v| input.mesh.position(v)));
            edges.insert(key(ends[0], ends[1]));
        }
        Ok(Self(edges))
    }

    /// The marked edges of a part, on both sides of each.
    pub fn on(&self, part: &TriangleMesh) -> HalfedgeMap<bool> {
        let is_marked = |h| {
            let [a, b] = [part.origin(h), part.target(h)].map(|v| part.position(v));
            !self.0.is_empty() && self.0.contains(&key(a, b))
        };
        part.halfedge_ids().map(is_marked).collect()
    }
}

/// Two ends as bits, in an order that does not depend on theirs.
fn key(a: DVec3, b: DVec3) -> [[u64; 3]; 2] {
    // Adding zero makes one zero of both.
    let [a, b] = [a, b].map(|p| (p + DVec3::ZERO).to_array().map(f64::to_bits));
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{PolygonMesh, VertexId, bounds};
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
        let input = Input {
            marked: &marked,
            ..Input::new(&mesh)
        };
        let prepared = Prepared::new(&mesh, &Progress::none()).unwrap();
        assert!(prepared.mesh.n_vertices() < mesh.n_vertices());
        let on = Marks::new(&input, &prepared.frame)
            .unwrap()
            .on(&prepared.mesh);
        assert_eq!(on.iter().filter(|&&is_marked| is_marked).count(), 4);
    }

    #[test]
    fn a_marked_edge_without_a_vertex_is_refused_with_its_number() {
        let mesh = soup();
        let input = Input {
            marked: &[[VertexId(0), VertexId(1)], [VertexId(2), VertexId(900)]],
            ..Input::new(&mesh)
        };
        let error = Marks::new(&input, &Frame::new(bounds(mesh.positions()))).unwrap_err();
        let text = format!(
            "marked edge 1 names vertex 900, but there are {} vertices",
            mesh.n_vertices()
        );
        assert_eq!(error.to_string(), text);
    }
}
