//! Closest points on triangles, and triangles that cross, by a tree of boxes.
//!
//! [`Bvh`] holds its own copy of the triangles in the order of its leaves, so that it outlives the
//! mesh and a leaf is read in one piece. Boxes are four to a node and kept in `f32`, rounded
//! outwards in a frame in which the whole has size 1: half the memory, four boxes an instruction.
//! Triangles and distances are `f64`, so answers equal those of testing every triangle, bit for
//! bit, and of several equally close triangles the one with the smallest id is returned.

mod build;
mod crossing;
mod search;
mod triangle;

use glam::DVec3;

use crate::mesh::{FaceId, Id, TriangleMesh};
use crate::progress::{Cancelled, Progress};
use build::Node;

pub use crossing::{crossing_pairs, depths};
pub use triangle::closest_on_triangle;

/// A tree of boxes over triangles, to find the closest of them.
///
/// Degenerate triangles are allowed: a point or a segment is a triangle too. Coordinates must be
/// finite, and between 1e-70 and 1e70 in size, so that squared areas neither vanish nor overflow.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// In the order of leaves.
    triangles: Vec<[DVec3; 3]>,
    /// The face of each triangle in the order of leaves.
    faces: Vec<FaceId>,
    /// The place of each face in the order of leaves.
    slots: Vec<u32>,
    frame: Frame,
}

/// The triangle closest to a point, and where on it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Closest {
    /// The triangle.
    pub face: FaceId,
    /// The weights of its corners, which are not negative and sum to 1.
    pub weights: [f64; 3],
    /// The closest point.
    pub position: DVec3,
    /// The squared distance to it.
    pub distance_squared: f64,
}

/// The frame of the boxes: the middle of everything at zero, its largest half side of length 1.
#[derive(Clone, Copy, Debug)]
struct Frame {
    centre: DVec3,
    per_length: f64,
}

impl Frame {
    fn of(triangles: &[[DVec3; 3]]) -> Self {
        let Some(&[first, ..]) = triangles.first() else {
            return Self {
                centre: DVec3::ZERO,
                per_length: 1.0,
            };
        };
        let corners = triangles.iter().flatten();
        let (low, high) = corners.fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        let half = (high * 0.5 - low * 0.5).max_element();
        let per_length = if half > 0.0 { half.recip() } else { 1.0 };
        Self {
            centre: low * 0.5 + high * 0.5,
            per_length,
        }
    }

    fn local(self, p: DVec3) -> DVec3 {
        (p - self.centre) * self.per_length
    }
}

impl Bvh {
    /// Builds the tree over triangles; face i is the i-th of them. O(n log n).
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        Self::build(triangles, &Progress::none()).expect("nobody cancels")
    }

    /// The same for large meshes: it can be cancelled.
    ///
    /// # Errors
    /// When cancelled.
    pub fn build(triangles: &[[DVec3; 3]], progress: &Progress) -> Result<Self, Cancelled> {
        let frame = Frame::of(triangles);
        let (nodes, order) = build::build(triangles, frame, progress)?;
        progress.check()?;
        let mut slots = vec![0; triangles.len()];
        for (slot, &face) in order.iter().enumerate() {
            slots[face as usize] = slot as u32;
        }
        progress.check()?;
        let mut sorted = Vec::with_capacity(order.len());
        for &face in &order {
            progress.check()?;
            sorted.push(triangles[face as usize]);
        }
        let faces = order.into_iter().map(FaceId).collect();
        Ok(Self {
            nodes,
            triangles: sorted,
            faces,
            slots,
            frame,
        })
    }

    /// Builds the tree over the faces of a mesh.
    pub fn of_mesh(mesh: &TriangleMesh) -> Self {
        Self::build_of_mesh(mesh, &Progress::none()).expect("nobody cancels")
    }

    /// The same for large meshes: it can be cancelled.
    ///
    /// # Errors
    /// When cancelled.
    pub fn build_of_mesh(mesh: &TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        let triangles: Vec<_> = mesh.face_ids().map(|face| mesh.triangle(face)).collect();
        progress.check()?;
        Self::build(&triangles, progress)
    }

    /// Builds the tree over points, as triangles without size: face i is the i-th point.
    pub fn of_points(points: &[DVec3]) -> Self {
        Self::build_of_points(points, &Progress::none()).expect("nobody cancels")
    }

    /// The same for many points: it can be cancelled.
    ///
    /// # Errors
    /// When cancelled.
    pub fn build_of_points(points: &[DVec3], progress: &Progress) -> Result<Self, Cancelled> {
        let triangles: Vec<_> = points.iter().map(|&p| [p; 3]).collect();
        Self::build(&triangles, progress)
    }

    /// How many triangles there are.
    pub fn n_faces(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of a triangle.
    pub fn triangle(&self, face: FaceId) -> [DVec3; 3] {
        self.triangles[self.slots[face.index()] as usize]
    }

    /// The point of all triangles that is closest to `p`.
    ///
    /// # Panics
    /// When there is no triangle, or `p` is not finite.
    pub fn closest(&self, p: DVec3) -> Closest {
        self.closest_where(p, f64::INFINITY, |_| true)
            .expect("a tree with triangles, a finite point")
    }

    /// The same as [`Bvh::closest`], faster where `hint` is a face not far from the closest one.
    ///
    /// # Panics
    /// When there is no face `hint`, or `p` is not finite.
    pub fn closest_near(&self, p: DVec3, hint: FaceId) -> Closest {
        self.closest_where_near(p, f64::INFINITY, Some(hint), |_| true)
            .expect("a tree with triangles, a finite point")
    }

    /// The closest point among the accepted faces no farther than the given squared distance.
    ///
    /// `accept` is asked only about faces that are closer than the best so far.
    pub fn closest_where(
        &self,
        p: DVec3,
        max_distance_squared: f64,
        accept: impl Fn(FaceId) -> bool,
    ) -> Option<Closest> {
        self.closest_where_near(p, max_distance_squared, None, accept)
    }

    /// The same as [`Bvh::closest_where`], faster where `hint` is a face not far from the closest
    /// one.
    ///
    /// # Panics
    /// When there is no face `hint`.
    pub fn closest_where_near(
        &self,
        p: DVec3,
        max_distance_squared: f64,
        hint: Option<FaceId>,
        accept: impl Fn(FaceId) -> bool,
    ) -> Option<Closest> {
        let none = Closest {
            face: FaceId(u32::MAX),
            weights: [0.0; 3],
            position: p,
            distance_squared: max_distance_squared,
        };
        let hinted = hint.filter(|&face| accept(face)).map(|face| {
            let found = closest_on_triangle(p, self.triangle(face));
            found.of(face)
        });
        let near = hinted.filter(|found| found.distance_squared <= max_distance_squared);
        let start = near.unwrap_or(none);
        Some(search::closest(self, p, start, &accept)).filter(|found| found.face != none.face)
    }

    /// Calls `visit` with every face whose bounding box touches the box from `low` to `high`.
    pub fn visit_overlaps(&self, low: DVec3, high: DVec3, visit: impl FnMut(FaceId)) {
        search::overlaps(self, [low, high], visit);
    }
}

#[cfg(test)]
mod tests;
