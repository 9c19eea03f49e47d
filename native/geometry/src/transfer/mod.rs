//! The artist's data, carried from the old mesh to the new one.
//!
//! Every kind of data has a file of its own, and all ask the same question: which place of the old
//! surface belongs to this place of the new one? A [`Source`] answers it, so that materials,
//! and later texture coordinates, weights and creases, agree about where they come from.

mod edges;
mod materials;
mod places;
mod seams;

use glam::DVec3;

use crate::nearest::{Bvh, Closest};

pub use edges::{CarriedEdge, edges};
pub use materials::materials;
pub use places::{Places, places};
pub use seams::Seams;

/// The old surface, asked for the place that belongs to a place of the new one.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    tree: &'a Bvh,
}

impl<'a> Source<'a> {
    /// Wraps the triangles of the old surface; none without triangles.
    pub fn new(tree: &'a Bvh) -> Option<Self> {
        (tree.n_faces() > 0).then_some(Self { tree })
    }

    /// The closest place, but of a thin wall the side that faces like `normal`, if that is no
    /// farther than `reach`.
    pub fn at(self, p: DVec3, normal: DVec3, reach: f64) -> Closest {
        let faces_alike = |face| {
            let [a, b, c] = self.tree.triangle(face);
            (b - a).cross(c - a).dot(normal) >= 0.0
        };
        let closest = self.tree.closest(p);
        if faces_alike(closest.face) {
            return closest;
        }
        let alike = self.tree.closest_where(p, reach * reach, faces_alike);
        alike.unwrap_or(closest)
    }
}
