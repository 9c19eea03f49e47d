//! Whether the output is as symmetric as the input.

use glam::DVec3;

use super::statistics::{mean, quantile};
use super::surface::Surface;
use crate::nearest::Bvh;

const N_SAMPLES: usize = 5000;
/// The input is symmetric if this share of samples, mirrored, lies no farther than the deviation.
const SHARE: f64 = 0.95;
/// In diagonals.
const DEVIATION: f64 = 0.005;

/// The mean distance of mirrored vertices to the nearest vertex / mean edge length, over the axes
/// in which the input is symmetric; none if there is none.
pub fn asymmetry(input: &Surface, output: &Surface, seed: u64) -> Option<f64> {
    let axes = mirror_axes(input, seed);
    if axes.is_empty() {
        return None;
    }
    let tree = Bvh::of_points(&output.used);
    let far = |&axis: &usize| {
        let far = |&p: &DVec3| {
            tree.closest(mirrored(input, p, axis))
                .distance_squared
                .sqrt()
        };
        mean(&output.used.iter().map(far).collect::<Vec<_>>())
    };
    let far: Vec<f64> = axes.iter().map(far).collect();
    Some(mean(&far) / mean(&output.edge_lengths).max(1e-300))
}

/// The axes along which the surface, mirrored at the middle of its box, comes to lie on itself.
fn mirror_axes(surface: &Surface, seed: u64) -> Vec<usize> {
    let samples = surface.sample(N_SAMPLES, seed.wrapping_add(2));
    let is_mirror = |&axis: &usize| {
        let far = samples.iter().map(|sample| {
            let p = mirrored(surface, sample.position, axis);
            surface.tree.closest(p).distance_squared.sqrt()
        });
        quantile(far.collect(), SHARE) < DEVIATION * surface.diagonal()
    };
    (0..3).filter(is_mirror).collect()
}

fn mirrored(surface: &Surface, mut p: DVec3, axis: usize) -> DVec3 {
    let [low, high] = surface.bounds;
    p[axis] = low[axis] + high[axis] - p[axis];
    p
}
