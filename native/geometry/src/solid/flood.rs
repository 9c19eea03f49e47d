//! What can be reached from outside along edges of the grid that cross nothing.
//!
//! Vertices of a row hang together up to the next edge that is blocked: a row is a few *runs*. Runs
//! of neighbouring rows hang together where an edge between them is free. So the work goes by the
//! edges that are blocked and by the rows, not by all vertices.

use super::cross::Hits;
use super::grid::Grid;
use crate::groups::Groups;
use crate::progress::{Cancelled, Progress};

/// Rows between two looks at the progress.
const CHUNK: usize = 4096;

/// Which vertices are outside.
pub struct Outside {
    /// How many vertices a row has.
    length: u64,
    /// The first run of each row, and the end.
    rows: Vec<u32>,
    /// Where each run begins.
    starts: Vec<u32>,
    is_reached: Vec<bool>,
}

impl Outside {
    /// Floods the grid from its first vertex.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(grid: &Grid, hits: &Hits, progress: &Progress) -> Result<Self, Cancelled> {
        let mut outside = Self::runs(grid, hits);
        let mut groups = Groups::new(outside.starts.len());
        for axis in [1, 2] {
            outside.link(grid, (axis, hits), &mut groups, progress)?;
        }
        let first = groups.root(0);
        outside.is_reached = (0..outside.starts.len())
            .map(|run| groups.root(run) == first)
            .collect();
        Ok(outside)
    }

    fn runs(grid: &Grid, hits: &Hits) -> Self {
        let length = grid.length(0);
        let mut rows = Vec::with_capacity(grid.n_rows() + 1);
        let mut starts = Vec::new();
        let mut blocked = edges(&hits[0]).peekable();
        for row in 0..grid.n_rows() as u64 {
            rows.push(starts.len() as u32);
            starts.push(0);
            while let Some(edge) = blocked.next_if(|edge| edge / length == row) {
                starts.push((edge % length) as u32 + 1);
            }
        }
        rows.push(starts.len() as u32);
        Self {
            length,
            rows,
            starts,
            is_reached: Vec::new(),
        }
    }

    /// Links the runs of every row to those of the next one along an axis.
    fn link(
        &self,
        grid: &Grid,
        (axis, hits): (usize, &Hits),
        groups: &mut Groups,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let ahead = (grid.step(axis) / self.length) as usize;
        let n_along = grid.length(axis) as usize;
        let mut blocked = edges(&hits[axis]).peekable();
        let mut here = Vec::new();
        for row in 0..grid.n_rows() {
            if row.is_multiple_of(CHUNK) {
                progress.check()?;
            }
            here.clear();
            while let Some(edge) = blocked.next_if(|edge| edge / self.length == row as u64) {
                here.push((edge % self.length) as u32);
            }
            if row / ahead % n_along + 1 < n_along {
                self.link_rows([row, row + ahead], &here, groups);
            }
        }
        Ok(())
    }

    fn link_rows(&self, rows: [usize; 2], blocked: &[u32], groups: &mut Groups) {
        let [ends_a, ends_b] = rows.map(|row| self.rows[row + 1]);
        let [mut a, mut b] = rows.map(|row| self.rows[row]);
        let mut n_before = 0;
        let mut low = 0;
        while a < ends_a && b < ends_b {
            let [end_a, end_b] = [self.end(a, ends_a), self.end(b, ends_b)];
            let end = end_a.min(end_b);
            let n_until = n_before + blocked[n_before..].partition_point(|&x| x < end);
            if n_until - n_before < (end - low) as usize {
                groups.link(a as usize, b as usize);
            }
            a += u32::from(end_a == end);
            b += u32::from(end_b == end);
            (low, n_before) = (end, n_until);
        }
    }

    /// Where a run ends, of which those of its row end with another.
    fn end(&self, run: u32, of_row: u32) -> u32 {
        if run + 1 < of_row {
            self.starts[run as usize + 1]
        } else {
            self.length as u32
        }
    }

    /// Whether a vertex is.
    pub fn contains(&self, vertex: u64) -> bool {
        let (row, x) = (vertex / self.length, (vertex % self.length) as u32);
        let [from, to] = [0, 1].map(|i| self.rows[row as usize + i] as usize);
        let run = from + self.starts[from..to].partition_point(|&start| start <= x) - 1;
        self.is_reached[run]
    }
}

/// The edges that are hit, each once.
fn edges(hits: &[super::cross::Hit]) -> impl Iterator<Item = u64> {
    let mut last = None;
    hits.iter()
        .map(|hit| hit.edge)
        .filter(move |&edge| last.replace(edge) != Some(edge))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use glam::DVec3;

    use super::super::cross::{Hit, sorted};
    use super::*;
    use crate::random::Random;

    /// The same, vertex by vertex.
    fn slowly(grid: &Grid, blocked: &[HashSet<u64>; 3]) -> HashSet<u64> {
        let mut seen = HashSet::from([0]);
        let mut stack = vec![0u64];
        while let Some(key) = stack.pop() {
            let at = grid.vertex(key);
            for axis in 0..3 {
                let step = grid.step(axis);
                let up = at[axis] + 1 < grid.length(axis) && !blocked[axis].contains(&key);
                let down = at[axis] > 0 && !blocked[axis].contains(&(key.wrapping_sub(step)));
                let next = [(up, key + step), (down, key.wrapping_sub(step))];
                for (_, to) in next.into_iter().filter(|(is_free, _)| *is_free) {
                    if seen.insert(to) {
                        stack.push(to);
                    }
                }
            }
        }
        seen
    }

    #[test]
    fn runs_reach_what_single_steps_reach() {
        let grid = Grid::around([DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0)], 1.0).unwrap();
        let n = grid.n_rows() as u64 * grid.length(0);
        let mut random = Random::new(5);
        // So many blocked edges leave some pockets.
        let blocked: [HashSet<u64>; 3] =
            [(); 3].map(|()| (1..n).filter(|_| random.unit() < 0.7).collect());
        let hits = blocked.clone().map(|edges| {
            let hit = |edge| Hit {
                edge,
                at: 0.5,
                of: 0,
            };
            sorted(edges.into_iter().map(hit).collect())
        });
        let outside = Outside::new(&grid, &hits, &Progress::none()).unwrap();
        let wanted = slowly(&grid, &blocked);
        assert!(
            wanted.len() > 20 && wanted.len() < n as usize - 20,
            "{}",
            wanted.len()
        );
        for vertex in 0..n {
            assert_eq!(outside.contains(vertex), wanted.contains(&vertex));
        }
    }
}
