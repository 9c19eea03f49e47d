//! Whether the output is as symmetric as the input.

use glam::DVec3;

use super::near::distances;
use super::statistics::{mean, quantile};
use super::surface::Surface;
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

const N_SAMPLES: usize = 5000;
/// The input is symmetric if this share of samples, mirrored, lies no farther than the deviation.
const SHARE: f64 = 0.95;
/// In diagonals.
const DEVIATION: f64 = 0.005;

/// The mean distance of mirrored vertices to the nearest vertex / mean edge length, over the axes
/// in which the input is symmetric; none if there is none.
pub fn asymmetry(
    input: &Surface,
    output: &Surface,
    seed: u64,
    progress: &Progress,
) -> Result<Option<f64>, Cancelled> {
    let axes = mirror_axes(input, seed, progress)?;
    if axes.is_empty() {
        return Ok(None);
    }
    let tree = Bvh::build_of_points(&output.used, progress)?;
    let mut far = Vec::new();
    for axis in axes {
        let mirrored = output.used.iter().map(|&p| mirrored(input, p, axis));
        let mirrored: Vec<DVec3> = mirrored.collect();
        far.push(mean(&distances(&tree, &mirrored, progress)?));
    }
    Ok(Some(mean(&far) / mean(&output.edge_lengths).max(1e-300)))
}

/// The axes along which the surface, mirrored at the middle of its box, comes to lie on itself.
fn mirror_axes(surface: &Surface, seed: u64, progress: &Progress) -> Result<Vec<usize>, Cancelled> {
    let samples = surface.sample(N_SAMPLES, seed.wrapping_add(2));
    let mut axes = Vec::new();
    for axis in 0..3 {
        let points = samples.iter().map(|s| mirrored(surface, s.position, axis));
        let far = distances(&surface.tree, &points.collect::<Vec<_>>(), progress)?;
        if quantile(far, SHARE) < DEVIATION * surface.diagonal() {
            axes.push(axis);
        }
    }
    Ok(axes)
}

fn mirrored(surface: &Surface, mut p: DVec3, axis: usize) -> DVec3 {
    let [low, high] = surface.bounds;
    p[axis] = low[axis] + high[axis] - p[axis];
    p
}
