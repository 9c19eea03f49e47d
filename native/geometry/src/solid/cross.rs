//! Where the edges of the grid cross triangles.
//!
//! Every triangle is drawn row by row in the three directions of the grid. Places on its rim and a
//! hair beyond it count, so that no row slips through between two triangles; so do edges on either
//! side of a vertex that lies on a triangle.

use glam::DVec3;
use rayon::prelude::*;

use super::grid::{Grid, others};
use crate::progress::{Cancelled, Progress};

/// Triangles between two looks at the progress.
const CHUNK: usize = 4096;
/// How far beyond its rim a triangle reaches, in cells: far more than rounding, far less than shows.
const HAIR: f64 = 1e-9;

/// A place where an edge of the grid crosses something.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Hit {
    /// The edge, by its low end.
    pub edge: u64,
    /// How far along it.
    pub at: f64,
    /// What is crossed.
    pub of: u32,
}

/// The hits of the edges along each axis, sorted by edges and places.
pub type Hits = [Vec<Hit>; 3];

/// Finds all hits of triangles, which are given in the grid's places; those that are skipped, and
/// those without area, have none.
///
/// # Errors
/// When cancelled.
pub fn hits(
    grid: &Grid,
    triangles: &[[DVec3; 3]],
    is_wanted: impl Fn(usize) -> bool + Sync,
    progress: &Progress,
) -> Result<Hits, Cancelled> {
    let of_axis = |axis: usize| {
        let chunks = triangles.par_chunks(CHUNK).enumerate();
        let found = chunks.map(|(chunk, corners)| {
            progress.check()?;
            let mut found = Vec::new();
            for (i, triangle) in corners.iter().enumerate() {
                let of = chunk * CHUNK + i;
                if is_wanted(of) {
                    draw(grid, (axis, triangle), of as u32, &mut found);
                }
            }
            Ok(found)
        });
        let found: Vec<Vec<Hit>> = found.collect::<Result<_, _>>()?;
        Ok(sorted(found.concat()))
    };
    Ok([of_axis(0)?, of_axis(1)?, of_axis(2)?])
}

/// Hits by edges, then by their places along them.
pub fn sorted(mut hits: Vec<Hit>) -> Vec<Hit> {
    hits.par_sort_unstable_by(|a, b| {
        let names = (a.edge, b.edge, a.of, b.of);
        names
            .0
            .cmp(&names.1)
            .then(a.at.total_cmp(&b.at))
            .then(names.2.cmp(&names.3))
    });
    hits
}

/// One row of a triangle: where it begins and ends across, and how high it is there.
struct Span {
    low: [f64; 2],
    high: [f64; 2],
}

fn draw(grid: &Grid, (axis, triangle): (usize, &[DVec3; 3]), of: u32, found: &mut Vec<Hit>) {
    let [b, c] = others(axis);
    let rows = triangle.map(|p| p[c]);
    let [first, last] = [
        rows.iter().copied().fold(f64::INFINITY, f64::min),
        rows.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    let mut row = (first - HAIR).ceil();
    while row <= last + HAIR {
        let span = span(triangle, (axis, b, c), row.clamp(first, last));
        let mut across = (span.low[0] - HAIR).ceil();
        while across <= span.high[0] + HAIR {
            let height = span.height(across);
            let mut at = [0; 3];
            [at[b], at[c]] = [across as u64, row as u64];
            push(grid, (axis, at, height), of, found);
            across += 1.0;
        }
        row += 1.0;
    }
}

/// The part of a triangle at `c = row`.
fn span(triangle: &[DVec3; 3], (axis, b, c): (usize, usize, usize), row: f64) -> Span {
    let mut span = Span {
        low: [f64::INFINITY, 0.0],
        high: [f64::NEG_INFINITY, 0.0],
    };
    let mut reach = |p: [f64; 2]| {
        if p[0] < span.low[0] {
            span.low = p;
        }
        if p[0] > span.high[0] {
            span.high = p;
        }
    };
    for i in 0..3 {
        // The same bits for both triangles at the edge.
        let [mut p, mut q] = [triangle[i], triangle[(i + 1) % 3]];
        if p.to_array() > q.to_array() {
            (p, q) = (q, p);
        }
        if p[c].min(q[c]) > row || p[c].max(q[c]) < row {
            continue;
        }
        let length = q[c] - p[c];
        if length == 0.0 {
            reach([p[b], p[axis]]);
            reach([q[b], q[axis]]);
        } else {
            let share = ((row - p[c]) / length).clamp(0.0, 1.0);
            let between = p + (q - p) * share;
            reach([between[b], between[axis]]);
        }
    }
    span
}

impl Span {
    fn height(&self, across: f64) -> f64 {
        let length = self.high[0] - self.low[0];
        let share = if length > 0.0 {
            ((across - self.low[0]) / length).clamp(0.0, 1.0)
        } else {
            0.5
        };
        self.low[1] + (self.high[1] - self.low[1]) * share
    }
}

/// A hit at a height, on both edges where it is at a vertex.
fn push(
    grid: &Grid,
    (axis, mut at, height): (usize, [u64; 3], f64),
    of: u32,
    found: &mut Vec<Hit>,
) {
    let low = height.floor();
    let share = height - low;
    let mut hit = |low: f64, share: f64| {
        at[axis] = low as u64;
        let edge = grid.key(at);
        found.push(Hit {
            edge,
            at: share,
            of,
        });
    };
    hit(low, share);
    if share <= HAIR {
        hit(low - 1.0, 1.0);
    } else if share >= 1.0 - HAIR {
        hit(low + 1.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_hit_by_the_rows_that_pass_it() {
        let corners = [DVec3::ZERO, DVec3::splat(8.0)];
        let grid = Grid::around(corners, 1.0).unwrap();
        let triangle = [[0.5, 0.5, 1.25], [4.5, 0.5, 1.25], [0.5, 4.5, 5.25]];
        let triangle = triangle.map(DVec3::from_array);
        let hits = hits(&grid, &[triangle], |_| true, &Progress::none()).unwrap();
        // Columns at whole x and y with x + y <= 5: the plane is z = y + 0.75.
        assert_eq!(hits[2].len(), 10);
        for hit in &hits[2] {
            let at = grid.place(hit.edge);
            assert!((at.z + hit.at - (at.y + 0.75)).abs() < 1e-12);
        }
    }

    #[test]
    fn no_row_slips_through_between_triangles_nor_at_vertices() {
        let corners = [DVec3::ZERO, DVec3::splat(8.0)];
        let grid = Grid::around(corners, 1.0).unwrap();
        // A square over rows, cut along a diagonal that rows meet, at the height of vertices.
        let p = |x: f64, y: f64| DVec3::new(x, y, 5.0);
        let square = [
            [p(1.0, 1.0), p(7.0, 1.0), p(7.0, 7.0)],
            [p(1.0, 1.0), p(7.0, 7.0), p(1.0, 7.0)],
        ];
        let hits = hits(&grid, &square, |_| true, &Progress::none()).unwrap();
        for x in 1..=7 {
            for y in 1..=7 {
                for z in [4, 5] {
                    let edge = grid.key([x, y, z]);
                    assert!(hits[2].iter().any(|hit| hit.edge == edge), "{x} {y} {z}");
                }
            }
        }
    }
}
