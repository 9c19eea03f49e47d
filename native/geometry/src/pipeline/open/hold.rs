//! What holds primitives on borders while they are fitted.

use glam::DVec3;

use super::{Corner, Opening, SAME, is_same};
use crate::deform::Held;
use crate::mesh::VertexId;
use crate::pipeline::Error;
use crate::pipeline::even::Marked;
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;

/// The middle of an edge along a border is no farther from it than this share of the edge.
const BEND: f64 = 0.5;

impl Opening {
    /// Holds the edges of a primitive that were made along borders, on the target's: corners of the
    /// map's mesh on its corners.
    ///
    /// # Errors
    /// Where an edge is missing; when cancelled.
    pub fn held(
        &self,
        map: &SphereMap,
        made: &Adaptive,
        progress: &Progress<'_>,
    ) -> Result<Held, Error> {
        all_made(made)?;
        if self.edges.is_empty() {
            return Ok(Held::default());
        }
        let own = Marked::new(map.mesh(), &self.small).tree(progress)?;
        let at = |v: VertexId| map.surface_position(map.locate(made.primitive.position(v)));
        // Of a solid's lines not all are borders.
        let lies = |p: DVec3, within: f64| own.closest(p).distance_squared <= within * within;
        let is_border = |[a, b]: &&[VertexId; 2]| {
            let [a, b] = [*a, *b].map(at);
            let bend = BEND * a.distance(b);
            lies(a, SAME) && lies(b, SAME) && lies(a.midpoint(b), bend)
        };
        let edges: Vec<[VertexId; 2]> = made.on_lines.iter().filter(is_border).copied().collect();
        Ok(self.held_at(&edges, at, progress)?)
    }

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
        all_made(made)?;
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
            let lies = |corner: &&Corner| is_same(corner.on_map, p) || is_same(corner.goal, p);
            let corner = self.corners.iter().find(lies);
            corner.map_or_else(|| border.closest(p).position, |corner| corner.goal)
        };
        Ok(Held {
            goals: ends_of(edges).into_iter().map(|v| (v, place(v))).collect(),
            edges: edges.to_vec(),
        })
    }
}

/// Whether a primitive has all edges that its lines ask for.
fn all_made(made: &Adaptive) -> Result<(), Error> {
    if made.n_apart == 0 {
        return Ok(());
    }
    let reason = format!("{} edges along its borders could not be made", made.n_apart);
    Err(Error::Unopened { reason })
}

/// The vertices of some edges, each once and in order.
fn ends_of(edges: &[[VertexId; 2]]) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
