//! What borders are filled with for good.

use glam::DVec3;

use super::{Closing, SAME};
use crate::groups::Groups;
use crate::mesh::{FaceId, Id, TriangleMesh};

impl Closing {
    /// The triangles that fill borders for good.
    pub fn filling(&self) -> Vec<[DVec3; 3]> {
        let mesh = &self.closed.mesh;
        let first = self.open.n_faces();
        let is_more = |face: FaceId| face.index() >= first && self.closed.is_real[face];
        if self.told.is_none_or(|told| told.n_filled == 0) {
            return Vec::new();
        }
        let more = || mesh.face_ids().skip(first).filter(|&face| is_more(face));
        let mut groups = Groups::new(mesh.n_faces());
        let sides = |face| {
            let h = mesh.halfedge(face);
            [h, h.next(), h.prev()]
        };
        for h in more().flat_map(sides) {
            if let Some(twin) = mesh.twin(h).filter(|twin| is_more(twin.face())) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (group, n_groups) = groups.numbered();
        let mut round = vec![0.0; n_groups];
        for h in more().flat_map(sides) {
            if !mesh.twin(h).is_some_and(|twin| is_more(twin.face())) {
                let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
                round[group[h.face().index()] as usize] += a.distance(b);
            }
        }
        // Longer ones are opened again.
        let longest = self.asked * (1.0 + SAME);
        let stays = |face: &FaceId| round[group[face.index()] as usize] <= longest;
        more()
            .filter(stays)
            .map(|face| mesh.triangle(face))
            .collect()
    }

    /// What of the closed part is real: the part itself and what fills borders.
    pub fn real(&self) -> TriangleMesh {
        let closed = &self.closed;
        let faces = closed.mesh.face_ids().filter(|&f| closed.is_real[f]);
        let faces = faces.map(|f| closed.mesh.face(f));
        let real = TriangleMesh::of_faces(closed.mesh.positions(), faces);
        real.expect("the real faces of a closed part are a mesh").0
    }
}
