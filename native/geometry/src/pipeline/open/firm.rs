//! The edges along borders that quads have to meet.

use super::loops::chains;
use super::{Opening, SAME, is_same};
use crate::deform::Target;
use crate::flow::{FirmEdges, Real};
use crate::groups::Groups;
use crate::measure::Polyline;
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexMap};

/// About how many faces of a patch say whether it is real.
const VOTES: usize = 50;

impl Opening {
    /// Some edges of a surface that was made along the borders, with the borders' corners.
    pub fn firm(
        &self,
        mesh: &TriangleMesh,
        is_on: HalfedgeMap<bool>,
        target: &Target,
    ) -> FirmEdges {
        let mut is_corner = VertexMap::filled(mesh.n_vertices(), false);
        for h in mesh.halfedge_ids().filter(|&h| is_on[h]) {
            let v = mesh.origin(h);
            let p = mesh.position(v);
            is_corner[v] = self.corners.iter().any(|corner| is_same(corner.goal, p));
        }
        FirmEdges {
            twins: self.twins(mesh, &is_on),
            real: Some(Real {
                is_real: self.real_side(mesh, &is_on, target),
                n_quads: self.n_asked,
            }),
            is_on,
            is_corner,
            may_end: false,
        }
    }

    /// Which faces of a surface lie on what is real, those between some edges together.
    fn real_side(
        &self,
        mesh: &TriangleMesh,
        is_on: &HalfedgeMap<bool>,
        target: &Target,
    ) -> FaceMap<bool> {
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids().filter(|&h| !is_on[h]) {
            if let Some(twin) = mesh.twin(h) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (patches, n_patches) = groups.numbered();
        let mut sizes = vec![0; n_patches];
        for &patch in &patches {
            sizes[patch as usize] += 1;
        }
        let mut votes = vec![0.0; n_patches];
        let mut n_seen = vec![0; n_patches];
        for (face, &patch) in mesh.face_ids().zip(&patches) {
            let patch = patch as usize;
            if n_seen[patch] % (sizes[patch] / VOTES + 1) == 0 {
                votes[patch] += self.vote(&mesh.triangle(face), target);
            }
            n_seen[patch] += 1;
        }
        patches
            .iter()
            .map(|&patch| votes[patch as usize] > 0.0)
            .collect()
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
