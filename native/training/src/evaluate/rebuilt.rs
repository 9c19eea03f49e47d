//! The shape that a proposal gives back: a sphere of even points, each carried to the surface.

use glam::{DMat3, DVec3};
use orbflow_geometry::measure::area_vector;
use orbflow_geometry::mesh::{Id, PolygonMesh, TriangleMesh, bounds};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::random::Random;
use orbflow_geometry::sphere::icosphere;
use serde::Serialize;

/// Of the sphere: four points for each vertex of a level of 500.
const FREQUENCY: u32 = 14;
/// Points on each of two surfaces that are compared: shares err by half a percent.
const N_SAMPLES: usize = 10_000;
/// How far a point may be from the other surface, in shares of the diagonal.
const REACHES: [f64; 2] = [0.005, 0.01];

/// How much of a rebuilt shape is right, and how much of the shape was rebuilt: in percent, within
/// half a percent of the diagonal and within one.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Rebuilt {
    /// Of the rebuilt surface, what is on the shape.
    pub precision_pct: [f64; 2],
    /// Of the shape, what is on the rebuilt surface.
    pub recall_pct: [f64; 2],
    /// Their harmonic mean.
    pub f1_pct: [f64; 2],
}

impl Rebuilt {
    /// Rebuilds a mesh from points of the sphere for its vertices, and compares.
    pub fn new(mesh: &TriangleMesh, sphere: &[DVec3]) -> Self {
        let carried = carried(mesh, sphere);
        let points = carried.positions();
        let rebuilt: Vec<[DVec3; 3]> = carried
            .faces()
            .map(|f| [f[0], f[1], f[2]].map(|v| points[v.index()]))
            .collect();
        Self::of(&rebuilt, mesh)
    }

    /// Compares what was made of a mesh with it.
    pub fn of(rebuilt: &[[DVec3; 3]], mesh: &TriangleMesh) -> Self {
        let shape: Vec<[DVec3; 3]> = mesh.face_ids().map(|f| mesh.triangle(f)).collect();
        let [low, high] = bounds(mesh.positions());
        let reaches = REACHES.map(|share| share * low.distance(high));
        let (precision_pct, recall_pct) = (
            near_pct(rebuilt, &shape, reaches),
            near_pct(&shape, rebuilt, reaches),
        );
        let f1 = |i: usize| {
            let (p, r): (f64, f64) = (precision_pct[i], recall_pct[i]);
            2.0 * p * r / (p + r).max(f64::MIN_POSITIVE)
        };
        Self {
            precision_pct,
            recall_pct,
            f1_pct: [f1(0), f1(1)],
        }
    }
}

/// The sphere of even points that shapes are rebuilt from.
pub fn ball() -> PolygonMesh {
    icosphere(FREQUENCY)
}

/// This sphere carried to a mesh, whose vertices have these points of the sphere.
pub fn carried(mesh: &TriangleMesh, sphere: &[DVec3]) -> PolygonMesh {
    let (ball, weights) = (ball(), weights_of_faces(mesh, sphere));
    let points = ball.positions().iter();
    let carried = points.map(|&p| carry(p, mesh, &weights)).collect();
    ball.with_positions(carried)
}

/// For each face the weights of its corners, as a map from points of the sphere; none where the face
/// is seen edge-on from the centre.
fn weights_of_faces(mesh: &TriangleMesh, sphere: &[DVec3]) -> Vec<Option<DMat3>> {
    let weights = mesh.faces().iter().map(|face| {
        let corners = DMat3::from_cols_array_2d(&face.map(|v| sphere[v.index()].to_array()));
        (corners.determinant().abs() > 1e-12).then(|| corners.inverse())
    });
    weights.collect()
}

/// The point of the surface under a point of the sphere. Where folds lay several triangles over it,
/// the one whose middle it is nearest to counts; where none does, the border of the nearest one.
fn carry(p: DVec3, mesh: &TriangleMesh, weights_of_faces: &[Option<DMat3>]) -> DVec3 {
    let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
    for (face, to_weights) in mesh.faces().iter().zip(weights_of_faces) {
        let Some(to_weights) = to_weights else {
            continue;
        };
        // All positive inside, whichever way the triangle lies; all negative behind the centre.
        let weights = *to_weights * p;
        let least = weights.min_element() / weights.abs().element_sum();
        if least > best.0 {
            let kept = weights.max(DVec3::ZERO);
            let kept = kept / kept.element_sum().max(f64::MIN_POSITIVE);
            let [a, b, c] = face.map(|v| mesh.position(v));
            best = (least, a * kept.x + b * kept.y + c * kept.z);
        }
    }
    best.1
}

/// What share of one surface is within each reach of another, in percent.
fn near_pct(of: &[[DVec3; 3]], other: &[[DVec3; 3]], reaches: [f64; 2]) -> [f64; 2] {
    let tree = Bvh::new(other);
    let distances: Vec<f64> = samples(of, N_SAMPLES)
        .into_iter()
        .map(|p| tree.closest(p).position.distance(p))
        .collect();
    reaches.map(|reach| {
        let n_near = distances.iter().filter(|&&d| d <= reach).count();
        100.0 * n_near as f64 / distances.len().max(1) as f64
    })
}

/// Points even by area, the same every time.
pub fn samples(triangles: &[[DVec3; 3]], n_samples: usize) -> Vec<DVec3> {
    let mut random = Random::new(7);
    let mut sum = 0.0;
    let ends = triangles.iter().map(|&t| {
        sum += area_vector(t).length();
        sum
    });
    let ends: Vec<f64> = ends.collect();
    let total = ends.last().copied().unwrap_or(0.0);
    let point = |i: usize| {
        let at = (i as f64 + random.unit()) / n_samples as f64 * total;
        let [a, b, c] = triangles[ends.partition_point(|&end| end <= at).min(ends.len() - 1)];
        let (u, v) = (random.unit().sqrt(), random.unit());
        a * (1.0 - u) + (b * (1.0 - v) + c * v) * u
    };
    (0..n_samples).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::march;

    fn shape() -> TriangleMesh {
        let ball = march(|p| p.length() - 0.8, 1.0, 16);
        TriangleMesh::new(ball.positions, ball.faces).expect("a ball is closed")
    }

    #[test]
    fn a_ball_comes_back_from_its_own_directions() {
        let mesh = shape();
        let sphere: Vec<DVec3> = mesh
            .positions()
            .iter()
            .map(|p| p.normalize_or_zero())
            .collect();
        let rebuilt = Rebuilt::new(&mesh, &sphere);
        for figures in [rebuilt.precision_pct, rebuilt.recall_pct, rebuilt.f1_pct] {
            assert!(figures.iter().all(|&f| f > 99.0), "{rebuilt:?}");
        }
    }

    #[test]
    fn half_a_ball_is_precise_but_misses_the_other_half() {
        let mesh = shape();
        let above = |p: &DVec3| p.with_z(p.z.max(0.01)).normalize_or_zero();
        let sphere: Vec<DVec3> = mesh.positions().iter().map(above).collect();
        let rebuilt = Rebuilt::new(&mesh, &sphere);
        assert!(rebuilt.recall_pct[1] < 80.0, "{rebuilt:?}");
    }
}
