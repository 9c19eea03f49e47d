//! What a sphere is deformed into: the full-resolution surface, ready to be asked.

use glam::DVec3;

use crate::measure::{FeatureLine, face_normals, feature_lines, sharp_edges};
use crate::mesh::{FaceId, FaceMap, HalfedgeMap, TriangleMesh, VertexId};
use crate::nearest::{Bvh, Closest};
use crate::progress::{Cancelled, Progress};

/// The full-resolution surface with a tree over its faces and their normals.
#[derive(Clone, Debug)]
pub struct Target {
    mesh: TriangleMesh,
    bvh: Bvh,
    normals: FaceMap<DVec3>,
    features: Vec<FeatureLine>,
}

impl Target {
    /// Prepares a surface. It must lie in the same coordinates as the sphere map's. Edges at which
    /// it turns by more than 40° count as sharp.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(mesh: TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        progress.check()?;
        let sharp = sharp_edges(&mesh, 40f64.to_radians());
        Self::with_features(mesh, &sharp, progress)
    }

    /// The same with the edges, marked on one side or both, along which the result is to have
    /// edges too.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn with_features(
        mesh: TriangleMesh,
        marked: &HalfedgeMap<bool>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        progress.check()?;
        let normals = face_normals(&mesh);
        progress.check()?;
        let features = feature_lines(&mesh, marked);
        progress.check()?;
        let bvh = Bvh::build_of_mesh(&mesh, progress)?;
        Ok(Self {
            mesh,
            bvh,
            normals,
            features,
        })
    }

    /// The surface.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The tree over its faces.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The lines of sharp or marked edges, longest first.
    pub(super) fn features(&self) -> &[FeatureLine] {
        &self.features
    }

    /// The mean of the normals of the faces at a vertex.
    pub(super) fn vertex_normal(&self, vertex: VertexId) -> DVec3 {
        let normals = self.mesh.outgoing(vertex).map(|h| self.normals[h.face()]);
        normals.sum::<DVec3>().normalize_or_zero()
    }

    /// The normal of a face.
    pub(super) fn normal(&self, face: FaceId) -> DVec3 {
        self.normals[face]
    }

    /// Whether a face looks the way that a vector points.
    pub fn looks_along(&self, face: FaceId, way: DVec3) -> bool {
        self.normals[face].dot(way) > 0.0
    }

    /// The closest point whose face agrees with a normal, up to a distance.
    ///
    /// Faces that look another way belong to another sheet of the surface: the far side of a thin
    /// plate, the next finger.
    pub fn closest_agreeing(&self, p: DVec3, normal: DVec3, reach: f64) -> Option<Closest> {
        self.closest_agreeing_near(p, normal, reach, None)
    }

    /// The same, faster where `hint` is a face not far from it.
    pub fn closest_agreeing_near(
        &self,
        p: DVec3,
        normal: DVec3,
        reach: f64,
        hint: Option<FaceId>,
    ) -> Option<Closest> {
        // 75°: beyond, the walls of a sharp edge's other side would count as agreeing.
        let agrees = |face| self.normals[face].dot(normal) > 0.25;
        self.bvh.closest_where_near(p, reach * reach, hint, agrees)
    }
}
