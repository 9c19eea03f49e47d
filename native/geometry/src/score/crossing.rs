//! Triangles that cross each other.

use super::surface::Surface;
use crate::nearest::crossing_pairs;
use crate::progress::{Cancelled, Progress};

/// The pairs of triangles of which an edge of one passes through the inside of the other. Pairs
/// that share an edge are not tested.
pub fn pairs(surface: &Surface, progress: &Progress) -> Result<Vec<[u32; 2]>, Cancelled> {
    progress.at(0.0)?;
    let at = |v| surface.mesh.position(v);
    crossing_pairs(&surface.tree, &surface.triangles, at, progress)
}

/// The share of triangles that are in a pair.
pub fn involved_pct(pairs: &[[u32; 2]], n_triangles: usize) -> f64 {
    let mut involved: Vec<u32> = pairs.iter().flatten().copied().collect();
    involved.sort_unstable();
    involved.dedup();
    100.0 * involved.len() as f64 / n_triangles as f64
}
