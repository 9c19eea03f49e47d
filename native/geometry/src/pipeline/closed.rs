//! Which faces of a result lie on what filled borders and sealed handles.

use super::frame::Prepared;
use super::join::Joined;
use crate::mesh::{FaceId, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

impl Joined {
    /// The faces whose middles are nearer to what was filled or sealed than to the part itself.
    ///
    /// # Errors
    /// When cancelled.
    pub fn on_filling(
        &self,
        prepared: &Prepared,
        progress: &Progress<'_>,
    ) -> Result<Vec<FaceId>, Cancelled> {
        if self.filling.is_empty() {
            return Ok(Vec::new());
        }
        let filling = Bvh::build(&self.filling, progress)?;
        let part = Bvh::build_of_mesh(&prepared.mesh, progress)?;
        let middle = |corners: &[VertexId]| {
            let sum: glam::DVec3 = corners.iter().map(|&v| self.mesh.position(v)).sum();
            sum / corners.len() as f64
        };
        let is_on = |face: &FaceId| {
            let middle = middle(self.mesh.face(*face));
            let far = |tree: &Bvh| tree.closest(middle).distance_squared;
            far(&filling) < far(&part)
        };
        Ok(self.mesh.face_ids().filter(is_on).collect())
    }
}
