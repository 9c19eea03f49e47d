//! The edges along borders that quads have to meet.

use super::loops::chains;
use super::{Opening, SAME, is_same};
use crate::flow::FirmEdges;
use crate::measure::Polyline;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};

impl Opening {
    /// Some edges of a surface that was made along the borders, with the borders' corners.
    pub fn firm(&self, mesh: &TriangleMesh, is_on: HalfedgeMap<bool>) -> FirmEdges {
        let mut is_corner = VertexMap::filled(mesh.n_vertices(), false);
        for h in mesh.halfedge_ids().filter(|&h| is_on[h]) {
            let v = mesh.origin(h);
            let p = mesh.position(v);
            is_corner[v] = self.corners.iter().any(|corner| is_same(corner.goal, p));
        }
        FirmEdges {
            twins: self.twins(mesh, &is_on),
            is_on,
            is_corner,
        }
    }

    /// The two loops of edges along each cut, where there are two.
    fn twins(&self, mesh: &TriangleMesh, is_on: &HalfedgeMap<bool>) -> Vec<[Vec<HalfedgeId>; 2]> {
        if self.cuts.is_empty() {
            return Vec::new();
        }
        let loops = chains(mesh, is_on);
        let along = |cut: &Polyline| {
            let lies = |edges: &&Vec<HalfedgeId>| {
                let mut places = edges.iter().map(|&h| mesh.position(mesh.origin(h)));
                places.all(|p| cut.distance(p) < SAME)
            };
            loops.iter().filter(lies).cloned().collect::<Vec<_>>()
        };
        let twins = self.cuts.iter().map(along);
        twins.filter_map(|two| two.try_into().ok()).collect()
    }
}
