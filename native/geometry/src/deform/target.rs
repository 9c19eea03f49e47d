//! What a sphere is deformed into: the full-resolution surface, ready to be asked.

use glam::DVec3;

use crate::measure::face_normals;
use crate::mesh::{FaceMap, TriangleMesh};
use crate::nearest::{Bvh, Closest};

/// The full-resolution surface with a tree over its faces and their normals.
#[derive(Clone, Debug)]
pub struct Target {
    mesh: TriangleMesh,
    bvh: Bvh,
    normals: FaceMap<DVec3>,
}

impl Target {
    /// Prepares a surface. It must lie in the same coordinates as the sphere map's.
    pub fn new(mesh: TriangleMesh) -> Self {
        let bvh = Bvh::of_mesh(&mesh);
        let normals = face_normals(&mesh);
        Self { mesh, bvh, normals }
    }

    /// The surface.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The tree over its faces.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The closest point whose face agrees with a normal, up to a distance.
    ///
    /// Faces that look another way belong to another sheet of the surface: the far side of a thin
    /// plate, the next finger.
    pub fn closest_agreeing(&self, p: DVec3, normal: DVec3, reach: f64) -> Option<Closest> {
        // 75°: beyond, the walls of a sharp edge's other side would count as agreeing.
        let agrees = |face| self.normals[face].dot(normal) > 0.25;
        self.bvh.closest_where(p, reach * reach, agrees)
    }
}
