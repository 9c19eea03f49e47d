//! The closest point of one triangle.

use glam::DVec3;

use super::Closest;
use crate::mesh::FaceId;

/// The squared sine below which a triangle counts as a needle, whose normal is mostly rounding.
/// Above 1e-6 healthy thin triangles would pay for tests that they do not need; below 1e-18 the
/// weights of a needle are noise.
const NEEDLE: f64 = 1e-12;

/// Where on a triangle the closest point is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct OnTriangle {
    /// The weights of the corners, which are not negative and sum to 1.
    pub weights: [f64; 3],
    /// The closest point.
    pub position: DVec3,
    /// The squared distance to it.
    pub distance_squared: f64,
}

impl OnTriangle {
    /// Names the triangle.
    pub fn of(self, face: FaceId) -> Closest {
        let Self {
            weights,
            position,
            distance_squared,
        } = self;
        Closest {
            face,
            weights,
            position,
            distance_squared,
        }
    }
}

/// The point of a triangle that is closest to `p`; the triangle may be a segment or a point.
///
/// Where the foot of the perpendicular lies outside, the closest point is on an edge that it lies
/// beyond. Needles test all edges, because their weights are not to be trusted.
pub fn closest_on_triangle(p: DVec3, triangle: [DVec3; 3]) -> OnTriangle {
    let [a, b, c] = triangle;
    let [ab, ac, ap] = [b - a, c - a, p - a];
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    let beta = ap.cross(ac).dot(normal);
    let gamma = ab.cross(ap).dot(normal);
    let alpha = area - beta - gamma;
    let is_needle = area <= NEEDLE * ab.length_squared() * ac.length_squared();
    let is_inside = alpha >= 0.0 && beta >= 0.0 && gamma >= 0.0 && area > 0.0;
    if is_inside && !is_needle {
        return inside(p, triangle, [beta / area, gamma / area]);
    }
    let mut best = None;
    for (corner, weight) in [alpha, beta, gamma].into_iter().enumerate() {
        if weight < 0.0 || is_needle {
            keep_closer(&mut best, on_edge(p, triangle, (corner + 1) % 3));
        }
    }
    if is_inside {
        keep_closer(&mut best, inside(p, triangle, [beta / area, gamma / area]));
    }
    best.unwrap_or_else(|| on_edge(p, triangle, 0))
}

fn keep_closer(best: &mut Option<OnTriangle>, found: OnTriangle) {
    if best.is_none_or(|best| found.distance_squared < best.distance_squared) {
        *best = Some(found);
    }
}

fn inside(p: DVec3, [a, b, c]: [DVec3; 3], [v, w]: [f64; 2]) -> OnTriangle {
    let v = v.min(1.0);
    let w = w.min(1.0 - v);
    let position = a + (b - a) * v + (c - a) * w;
    let weights = [1.0 - v - w, v, w];
    OnTriangle {
        weights,
        position,
        distance_squared: p.distance_squared(position),
    }
}

fn on_edge(p: DVec3, triangle: [DVec3; 3], from: usize) -> OnTriangle {
    let to = (from + 1) % 3;
    let [a, b] = [triangle[from], triangle[to]];
    let along = b - a;
    let length = along.length_squared();
    let t = if length > 0.0 {
        ((p - a).dot(along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    // Exactly b at its end, so that the two edges of a corner agree on its distance.
    let position = if t < 1.0 { a + along * t } else { b };
    let mut weights = [0.0; 3];
    weights[from] = 1.0 - t;
    weights[to] = t;
    OnTriangle {
        weights,
        position,
        distance_squared: p.distance_squared(position),
    }
}
