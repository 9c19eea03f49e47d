//! What holds primitives on borders where quads do not flow.

use glam::DVec3;

use super::{Opening, SAME};
use crate::deform::Held;
use crate::mesh::VertexId;
use crate::pipeline::Error;
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;

impl Opening {
    /// Holds a primitive whose lines are borders, all of them.
    ///
    /// # Errors
    /// Where an edge is missing; when cancelled.
    pub fn held_all(
        &self,
        map: &SphereMap,
        made: &Adaptive,
        progress: &Progress<'_>,
    ) -> Result<Held, Error> {
        if made.n_apart > 0 {
            let reason = format!("{} edges along its borders could not be made", made.n_apart);
            return Err(Error::Unopened { reason });
        }
        let at = |v: VertexId| map.surface_position(map.locate(made.primitive.position(v)));
        Ok(self.held_at(&made.on_lines, at, progress)?)
    }

    /// Holds edges along borders at the nearest places of these, corners on corners.
    ///
    /// # Errors
    /// When cancelled.
    pub fn held_at(
        &self,
        edges: &[[VertexId; 2]],
        at: impl Fn(VertexId) -> DVec3,
        progress: &Progress<'_>,
    ) -> Result<Held, Cancelled> {
        let border = self.edges.tree(progress)?;
        let place = |v: VertexId| {
            let p = at(v);
            let mut ends = self.ends.iter();
            let is_near = |q: &DVec3| q.distance_squared(p) < SAME * SAME;
            let end = ends.find(|(own, corner)| is_near(own) || is_near(corner));
            end.map_or_else(|| border.closest(p).position, |(_, corner)| *corner)
        };
        let mut vertices: Vec<VertexId> = edges.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        Ok(Held {
            goals: vertices.into_iter().map(|v| (v, place(v))).collect(),
            edges: edges.to_vec(),
        })
    }
}
