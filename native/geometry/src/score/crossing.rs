//! Triangles that cross each other.

use glam::DVec3;
use rayon::prelude::*;

use super::surface::Surface;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// Triangles between two looks at the progress.
const CHUNK: usize = 1024;
/// Volumes below this share of a cube of the same size count as touching: rounding alone makes a
/// millionth of it.
const TOUCH: f64 = 1e-9;

/// The pairs of triangles of which an edge of one passes through the inside of the other. Pairs
/// that share an edge are not tested.
pub fn pairs(surface: &Surface, progress: &Progress) -> Result<Vec<[u32; 2]>, Cancelled> {
    progress.at(0.0)?;
    let all: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    let search = |chunk: &[u32]| {
        progress.check()?;
        let mut found = Vec::new();
        for &i in chunk {
            add_crossing(surface, i, &mut found);
        }
        Ok(found)
    };
    let found: Vec<Vec<_>> = all
        .par_chunks(CHUNK)
        .map(search)
        .collect::<Result<_, _>>()?;
    Ok(found.concat())
}

/// The share of triangles that are in a pair.
pub fn involved_pct(pairs: &[[u32; 2]], n_triangles: usize) -> f64 {
    let mut involved: Vec<u32> = pairs.iter().flatten().copied().collect();
    involved.sort_unstable();
    involved.dedup();
    100.0 * involved.len() as f64 / n_triangles as f64
}

/// Adds the pairs of triangle `i` with later ones.
fn add_crossing(surface: &Surface, i: u32, found: &mut Vec<[u32; 2]>) {
    let triangle = surface.triangles[i as usize];
    let [a, b, c] = triangle.map(|v| surface.mesh.position(v));
    surface
        .tree
        .visit_overlaps(a.min(b).min(c), a.max(b).max(c), |face| {
            let j = face.index() as u32;
            if j > i && is_crossing(surface, triangle, surface.triangles[j as usize]) {
                found.push([i, j]);
            }
        });
}

fn is_crossing(surface: &Surface, a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    let n_shared: usize = a.iter().map(|v| b.iter().filter(|w| v == *w).count()).sum();
    let passes = |[a, b]: [&[VertexId; 3]; 2]| {
        (0..3).any(|k| {
            let ends = [a[k], a[(k + 1) % 3]];
            let is_apart = !ends.iter().any(|v| b.contains(v));
            is_apart
                && is_through(
                    ends.map(|v| surface.mesh.position(v)),
                    b.map(|v| surface.mesh.position(v)),
                )
        })
    };
    n_shared < 2 && (passes([&a, &b]) || passes([&b, &a]))
}

/// Whether the open segment pq passes through the open triangle.
fn is_through([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let side = [a - b, b - c, c - a].map(|e| e.abs().max_element());
    let size = side.into_iter().fold(p.distance(q), f64::max);
    let touch = TOUCH * size * size * size;
    let [above, below] = [volume(a, b, c, p), volume(a, b, c, q)];
    if above.min(below) >= -touch || above.max(below) <= touch {
        return false;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    around.iter().all(|&v| v > touch) || around.iter().all(|&v| v < -touch)
}

fn volume(u: DVec3, v: DVec3, w: DVec3, x: DVec3) -> f64 {
    (v - u).cross(w - u).dot(x - u)
}
