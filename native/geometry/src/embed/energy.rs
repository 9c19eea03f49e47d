//! The figure of merit of a map, and what is wrong with a proposed one.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use crate::elementary::ln_1p;
use crate::mesh::{TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::triple_product;

/// The smallest area ratio that the energy tells apart; folds count as this.
const LEAST_RATIO: f64 = 1e-3;

/// How many faces are summed up at once.
const CHUNK: usize = 512;

/// The distortion of a map: the area-weighted mean of log(1 + g (1 + 1/d²)) over all triangles.
///
/// With the surface scaled to the area 4π, d = det(s₁, s₂, s₃) / 2A is a triangle's area ratio (at
/// least 10⁻³: folds count as that) and g = Σ cot · |opposite edge|² / 2A its Dirichlet density, so
/// that an isometry has log 5 ≈ 1.609 everywhere, the least there is. Triangles without area are left out.
pub fn distortion(mesh: &TriangleMesh, sphere: &VertexMap<DVec3>) -> f64 {
    try_distortion(mesh, sphere, &Progress::none()).expect("nobody cancels")
}

/// The same for large meshes: it can be cancelled.
///
/// # Errors
/// When cancelled.
pub(super) fn try_distortion(
    mesh: &TriangleMesh,
    sphere: &VertexMap<DVec3>,
    progress: &Progress,
) -> Result<f64, Cancelled> {
    let size = mesh.positions().iter().map(|p| p.abs().max_element());
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let corners = |f: [VertexId; 3]| f.map(|v| mesh.position(v) / size);
    let total = sum_over_faces(mesh, |f| double_area(corners(f)), progress)?;
    let scale = 8.0 * PI / total;
    let weighted_log = |f: [VertexId; 3]| {
        let surface = corners(f);
        let log = log_distortion(surface, f.map(|v| sphere[v]), scale);
        if log.is_finite() {
            double_area(surface) * log
        } else {
            0.0
        }
    };
    Ok(sum_over_faces(mesh, weighted_log, progress)? / total)
}

/// log(1 + g (1 + 1/d²)) of one triangle, areas on the surface scaled; not finite without area.
fn log_distortion([a, b, c]: [DVec3; 3], [p, q, r]: [DVec3; 3], scale: f64) -> f64 {
    let unscaled = double_area([a, b, c]);
    let dot = |u: DVec3, v: DVec3, w: DVec3| (v - u).dot(w - u);
    let dirichlet = dot(a, b, c) * q.distance_squared(r)
        + dot(b, c, a) * r.distance_squared(p)
        + dot(c, a, b) * p.distance_squared(q);
    let density = dirichlet / unscaled / (unscaled * scale);
    let ratio = (triple_product(p, q, r) / (unscaled * scale)).max(LEAST_RATIO);
    // No map has g < 2 d; a triangle shrunk to a point has after the ratio was bounded.
    ln_1p(density.max(2.0 * ratio) * (1.0 + ratio.powi(-2)))
}

fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

/// A sum that is the same for any number of threads: over chunks, then over their sums.
fn sum_over_faces(
    mesh: &TriangleMesh,
    value: impl Fn([VertexId; 3]) -> f64 + Sync,
    progress: &Progress,
) -> Result<f64, Cancelled> {
    // After a cancellation nobody asks for the sum.
    let sum = |faces: &[[VertexId; 3]]| match progress.check() {
        Ok(()) => faces.iter().map(|&f| value(f)).sum(),
        Err(Cancelled) => 0.0,
    };
    let sums: Vec<f64> = mesh.faces().par_chunks(CHUNK).map(sum).collect();
    progress.check()?;
    Ok(sums.iter().sum())
}
