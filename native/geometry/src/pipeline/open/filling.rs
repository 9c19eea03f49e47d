//! What of a closed part is real.

use super::Closing;
use crate::mesh::TriangleMesh;

impl Closing {
    /// What of the closed part is real: the part itself and what fills short borders for now.
    pub fn real(&self) -> TriangleMesh {
        let closed = &self.closed;
        let faces = closed.mesh.face_ids().filter(|&f| closed.is_real[f]);
        let faces = faces.map(|f| closed.mesh.face(f));
        let real = TriangleMesh::of_faces(closed.mesh.positions(), faces);
        real.expect("the real faces of a closed part are a mesh").0
    }
}
