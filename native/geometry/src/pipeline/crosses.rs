//! Crosses of the field that quads follow, to be shown.

use glam::DVec3;

use super::frame::Frame;
use crate::flow::Flow;
use crate::measure::face_normal;
use crate::mesh::TriangleMesh;
use crate::mirror::mirrored;

/// A cross of the field.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cross {
    /// Where it is, on the surface.
    pub place: DVec3,
    /// Two arms along the surface, at right angles, half as long as edges are wanted there; the other
    /// two are their opposites.
    pub arms: [DVec3; 2],
}

impl Cross {
    /// Its image in the plane where a coordinate is 0.
    #[must_use]
    pub fn mirrored(self, axis: usize) -> Self {
        Self {
            place: mirrored(self.place, axis),
            arms: self.arms.map(|arm| mirrored(arm, axis)),
        }
    }
}

/// At most so many crosses of a field, from all over the surface.
pub fn some(even: &TriangleMesh, flow: &Flow, n: usize) -> Vec<Cross> {
    if n == 0 {
        return Vec::new();
    }
    let cross = |face| {
        let [a, b, c] = even.triangle(face);
        let arm = flow.crosses[face] * (flow.sizes[face] / 2.0);
        Cross {
            place: (a + b + c) / 3.0,
            arms: [arm, face_normal(even, face).cross(arm)],
        }
    };
    let step = even.n_faces().div_ceil(n);
    even.face_ids().step_by(step).map(cross).collect()
}

/// Crosses back from the frame of work.
pub fn leave(crosses: Vec<Cross>, frame: &Frame) -> Vec<Cross> {
    let leave = |Cross { place, arms }| Cross {
        place: frame.leave(&[place])[0],
        arms: arms.map(|arm| frame.grow(arm)),
    };
    crosses.into_iter().map(leave).collect()
}
