//! Triangles that cross each other.

use glam::DVec3;
use rayon::prelude::*;

use super::Bvh;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// Triangles between two looks at the progress.
const CHUNK: usize = 1024;
/// Volumes below this share of a cube of the same size count as touching: rounding alone makes a
/// millionth of it.
const TOUCH: f64 = 1e-9;

/// The pairs of triangles of which an edge of one passes through the inside of the other, each
/// once, in order. Pairs that share an edge are not tested.
///
/// The tree is over the same triangles.
///
/// # Errors
/// When cancelled.
pub fn crossing_pairs(
    tree: &Bvh,
    triangles: &[[VertexId; 3]],
    at: impl Fn(VertexId) -> DVec3 + Copy + Sync,
    progress: &Progress,
) -> Result<Vec<[u32; 2]>, Cancelled> {
    let all: Vec<u32> = (0..triangles.len() as u32).collect();
    let search = |chunk: &[u32]| {
        progress.check()?;
        let mut found = Vec::new();
        for &i in chunk {
            let triangle = triangles[i as usize];
            let [a, b, c] = triangle.map(at);
            tree.visit_overlaps(a.min(b).min(c), a.max(b).max(c), |face| {
                let j = face.index() as u32;
                let is_crossing = || {
                    depths([triangle, triangles[j as usize]], at)
                        .next()
                        .is_some()
                };
                if j > i && is_crossing() {
                    found.push([i, j]);
                }
            });
        }
        Ok(found)
    };
    let found: Vec<Vec<_>> = all
        .par_chunks(CHUNK)
        .map(search)
        .collect::<Result<_, _>>()?;
    Ok(found.concat())
}

/// How deep two triangles cross: for every edge of one that passes through the inside of the other
/// the distance of its nearer end from the other's plane. Nothing where they share an edge.
pub fn depths(
    [a, b]: [[VertexId; 3]; 2],
    at: impl Fn(VertexId) -> DVec3 + Copy,
) -> impl Iterator<Item = f64> {
    let n_shared: usize = a.iter().map(|v| b.iter().filter(|w| v == *w).count()).sum();
    let through = move |[a, b]: [[VertexId; 3]; 2]| {
        let edges = (0..3).map(move |k| [a[k], a[(k + 1) % 3]]);
        let apart = edges.filter(move |ends| !ends.iter().any(|v| b.contains(v)));
        apart.filter_map(move |ends| depth(ends.map(at), b.map(at)))
    };
    let both = (n_shared < 2).then_some([[a, b], [b, a]]);
    both.into_iter().flatten().flat_map(through)
}

/// How far the nearer end of the open segment pq is from the plane of the open triangle that it
/// passes through, if it does.
fn depth([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let side = [a - b, b - c, c - a].map(|e| e.abs().max_element());
    let size = side.into_iter().fold(p.distance(q), f64::max);
    let touch = TOUCH * size * size * size;
    let [above, below] = [volume(a, b, c, p), volume(a, b, c, q)];
    if above.min(below) >= -touch || above.max(below) <= touch {
        return None;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    let is_through = around.iter().all(|&v| v > touch) || around.iter().all(|&v| v < -touch);
    is_through.then(|| above.abs().min(below.abs()) / (b - a).cross(c - a).length())
}

fn volume(u: DVec3, v: DVec3, w: DVec3, x: DVec3) -> f64 {
    (v - u).cross(w - u).dot(x - u)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(positions: &[[f64; 3]], triangles: [[u32; 3]; 2]) -> Vec<f64> {
        let at = |v: VertexId| DVec3::from_array(positions[v.index()]);
        depths(triangles.map(|t| t.map(VertexId)), at).collect()
    }

    #[test]
    fn an_edge_through_a_triangle_is_as_deep_as_its_nearer_end() {
        let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let with = |others: [[f64; 3]; 3]| found(&[flat, others].concat(), [[0, 1, 2], [3, 4, 5]]);
        let near = |depths: Vec<f64>, wanted: &[f64]| {
            assert_eq!(depths.len(), wanted.len());
            let all = depths.iter().zip(wanted);
            assert!(
                all.into_iter().all(|(a, b)| (a - b).abs() < 1e-12),
                "{depths:?}"
            );
        };
        // Two edges come up through it from one end below, with ends 1 and 3 above.
        near(
            with([[1.0, 1.0, -0.25], [1.0, 1.2, 1.0], [1.2, 1.0, 3.0]]),
            &[0.25, 0.25],
        );
        // It touches, and lies beside it.
        near(
            with([[1.0, 1.0, 0.0], [1.0, 1.2, 1.0], [1.2, 1.0, 3.0]]),
            &[],
        );
        near(
            with([[5.0, 5.0, -1.0], [5.0, 5.2, 1.0], [5.2, 5.0, 3.0]]),
            &[],
        );
    }

    #[test]
    fn neighbours_cross_only_where_they_share_no_edge() {
        let positions = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [1.0, 1.0, 1.0],
            [2.0, 1.0, -1.0],
        ];
        assert_eq!(found(&positions, [[0, 1, 2], [0, 3, 4]]).len(), 1);
        assert!(found(&positions, [[0, 1, 2], [1, 0, 3]]).is_empty());
    }
}
