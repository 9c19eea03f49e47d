//! How far points are from a surface or from other points.

use glam::DVec3;
use rayon::prelude::*;

use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Points between two looks at the progress.
const CHUNK: usize = 2048;

/// The distance of each point, in order.
pub fn distances(tree: &Bvh, points: &[DVec3], progress: &Progress) -> Result<Vec<f64>, Cancelled> {
    let search = |chunk: &[DVec3]| {
        progress.check()?;
        let far = chunk
            .iter()
            .map(|&p| tree.closest(p).distance_squared.sqrt());
        Ok(far.collect())
    };
    let found: Vec<Vec<f64>> = points
        .par_chunks(CHUNK)
        .map(search)
        .collect::<Result<_, _>>()?;
    Ok(found.concat())
}
