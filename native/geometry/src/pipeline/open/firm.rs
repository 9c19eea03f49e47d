//! The edges along borders that quads have to meet.

use super::{Opening, SAME, is_same};
use crate::flow::FirmEdges;
use crate::groups::Groups;
use crate::measure::Polyline;
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexMap};

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
        let mut groups = Groups::new(mesh.n_vertices());
        let on = || mesh.halfedge_ids().filter(|&h| is_on[h]);
        for h in on() {
            groups.link(mesh.origin(h).index(), mesh.target(h).index());
        }
        let (group, n_groups) = groups.numbered();
        let mut loops = vec![Vec::new(); n_groups];
        for h in on() {
            loops[group[mesh.origin(h).index()] as usize].push(h);
        }
        let along = |cut: &Polyline| {
            let lies = |edges: &&Vec<HalfedgeId>| {
                let mut places = edges.iter().map(|&h| mesh.position(mesh.origin(h)));
                !edges.is_empty() && places.all(|p| cut.distance(p) < SAME)
            };
            loops.iter().filter(lies).cloned().collect::<Vec<_>>()
        };
        let twins = self.cuts.iter().map(along);
        twins.filter_map(|two| two.try_into().ok()).collect()
    }
}
