//! The rest metric: what shape the triangles of a level want to have.

use std::f64::consts::PI;

use glam::DVec3;

use super::fan::Rest;
use crate::mesh::bounds;

/// What is added to every squared edge, relative to the squared size of the mesh: an edge shorter
/// than a three-millionth of it is a point.
const LEAST_EDGE_SQUARED: f64 = 1e-13;
/// The same for triangles of equal size: longer than any edge.
const EQUAL_EDGE_SQUARED: f64 = 100.0;

/// The weight of areas in an even map. At 1 the areas of a fixed primitive's faces still vary half
/// as much as without; far beyond 30 its quads are sheared.
const EVENNESS: f64 = 30.0;

/// How the metric of the surface is made regular and scaled.
///
/// The squared length of every edge of a triangle grows by δ times their mean, plus a constant.
/// Without it flat parts of technical models have triangles without area, whose energy is infinite.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Metric {
    /// The share δ of the mean squared edge of the triangle.
    pub delta: f64,
    /// The squared length that is added everywhere.
    pub floor: f64,
    /// What twice an area is multiplied by, so that the level has the area of the sphere.
    pub scale: f64,
    /// The weight of keeping areas, see [`Fan`](super::fan::Fan).
    pub evenness: f64,
}

/// Which shape the rest metric has.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stiffness {
    /// That of the surface, smoothed while there are few vertices.
    Shape,
    /// The same, and areas are kept rather than angles.
    Even,
    /// Equilateral triangles of one size, whatever the surface.
    Equal,
}

impl Stiffness {
    /// The metric for a level of `n_vertices` of a mesh of size 1; not yet scaled.
    pub fn metric(self, n_vertices: usize) -> Metric {
        let delta = match n_vertices {
            ..1_000 => 0.05,
            1_000..5_000 => 0.01,
            _ => 1e-3,
        };
        match self {
            Self::Equal => Metric {
                delta: 0.0,
                floor: EQUAL_EDGE_SQUARED,
                ..Metric::FINISH
            },
            _ => Metric {
                delta,
                ..self.finish()
            },
        }
    }

    /// The metric in which a map is finished: hardly smoothed.
    pub fn finish(self) -> Metric {
        match self {
            Self::Even => Metric {
                evenness: EVENNESS,
                ..Metric::FINISH
            },
            _ => Metric::FINISH,
        }
    }
}

/// The positions of a mesh, moved and scaled so that the longest side of its box is 1.
pub fn to_size_one(positions: &[DVec3]) -> Vec<DVec3> {
    let [low, high] = bounds(positions);
    // Halves do not overflow.
    let centre = 0.5 * low + 0.5 * high;
    let half = (0.5 * high - 0.5 * low)
        .max_element()
        .max(f64::MIN_POSITIVE);
    let scaled = positions.iter().map(|&p| (p - centre) / half * 0.5);
    scaled.collect()
}

impl Metric {
    /// The metric in which a map is finished.
    const FINISH: Self = Self {
        delta: 1e-4,
        floor: LEAST_EDGE_SQUARED,
        scale: 1.0,
        evenness: 0.0,
    };

    /// The rest shape of the triangle with these corners, seen from the first.
    pub fn rest(&self, p: DVec3, b: DVec3, c: DVec3) -> Rest {
        let [u, w] = [b - p, c - p];
        let [uu, ww, uw] = [u.length_squared(), w.length_squared(), u.dot(w)];
        let more = self.delta * (uu + ww + (w - u).length_squared()) / 3.0 + self.floor;
        let [uu, ww, uw] = [uu + more, ww + more, uw + 0.5 * more];
        let double_area = (uu * ww - uw * uw).max(f64::MIN_POSITIVE).sqrt();
        Rest {
            cot_c: (ww - uw) / double_area,
            cot_b: (uu - uw) / double_area,
            cot_p: uw / double_area,
            square: (double_area * self.scale).powi(2),
        }
    }

    /// The same metric, scaled so that `double_area`, the sum over all faces measured with a scale
    /// of 1, becomes that of the unit sphere.
    pub fn scaled_to_sphere(self, double_area: f64) -> Self {
        Self {
            scale: 8.0 * PI / double_area,
            ..self
        }
    }
}
