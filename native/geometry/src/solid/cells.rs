//! The edges through which the outer surface passes, and the cells around them.

use rayon::prelude::*;

use super::cross::{Hit, Hits};
use super::flood::Outside;
use super::grid::Grid;
use super::table::{self, Pattern, Table};
use crate::progress::{Cancelled, Progress};

/// Edges or cells between two looks at the progress.
const CHUNK: usize = 16_384;

/// An edge through which the surface passes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Crossing {
    /// Where it does, first as seen from outside.
    pub hit: Hit,
    /// Whether its low end is inside.
    pub rises: bool,
}

/// All such edges, and the cells around them.
pub struct Cells {
    /// For each axis, sorted by their edges.
    pub crossings: [Vec<Crossing>; 3],
    /// The low corners of the cells, in order.
    pub keys: Vec<u64>,
    /// Which corners of each are inside.
    pub signs: Vec<u8>,
    pub table: Table,
}

impl Cells {
    /// Finds them: of what blocks the flood that has one end outside and one not.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(
        grid: &Grid,
        hits: &Hits,
        outside: &Outside,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let mut crossings = [const { Vec::new() }; 3];
        let mut keys = Vec::new();
        for (axis, found) in crossings.iter_mut().enumerate() {
            *found = crossed(grid, (axis, &hits[axis]), outside, progress)?;
            for chunk in found.chunks(CHUNK) {
                progress.check()?;
                let around = chunk.iter();
                keys.extend(around.flat_map(|c| grid.around_edge(axis, c.hit.edge)));
            }
        }
        keys.par_sort_unstable();
        keys.dedup();
        progress.check()?;
        let steps = [0, 1, 2].map(|axis| grid.step(axis));
        let signs = |&key: &u64| {
            (0..8u64).fold(0, |signs, corner| {
                let vertex = key + (0..3).map(|a| (corner >> a & 1) * steps[a]).sum::<u64>();
                signs | u8::from(!outside.contains(vertex)) << corner
            })
        };
        let signs = keys.par_iter().with_min_len(CHUNK).map(signs).collect();
        progress.check()?;
        Ok(Self {
            crossings,
            keys,
            signs,
            table: Table::new(),
        })
    }

    /// The place of a cell among all.
    pub fn index(&self, key: u64) -> usize {
        let found = self.keys.binary_search(&key);
        found.expect("the cells around every crossing are listed")
    }

    /// How the surface passes a cell.
    pub fn pattern(&self, cell: usize) -> &Pattern {
        self.table.of(self.signs[cell])
    }

    /// The crossing of an edge of a cell.
    pub fn crossing(&self, grid: &Grid, cell: usize, edge: usize) -> (usize, Crossing) {
        let axis = edge / 4;
        let [low, _] = table::corners(edge);
        let key = self.keys[cell]
            + (0..3)
                .map(|a| (low as u64 >> a & 1) * grid.step(a))
                .sum::<u64>();
        let all = &self.crossings[axis];
        let found = all.binary_search_by_key(&key, |c| c.hit.edge);
        let at = found.expect("ends on two sides were parted by a hit");
        (at, all[at])
    }
}

/// The hit edges along an axis that lead from inside to outside.
fn crossed(
    grid: &Grid,
    (axis, hits): (usize, &[Hit]),
    outside: &Outside,
    progress: &Progress,
) -> Result<Vec<Crossing>, Cancelled> {
    let step = grid.step(axis);
    let edges: Vec<&[Hit]> = hits.chunk_by(|a, b| a.edge == b.edge).collect();
    let crossing = |hits: &&[Hit]| {
        let edge = hits[0].edge;
        let [low, high] = [edge, edge + step].map(|vertex| outside.contains(vertex));
        (low != high).then(|| Crossing {
            hit: if low { hits[0] } else { hits[hits.len() - 1] },
            rises: high,
        })
    };
    let found = edges.par_chunks(CHUNK).map(|chunk| {
        progress.check()?;
        Ok(chunk.iter().filter_map(crossing).collect())
    });
    let found: Vec<Vec<Crossing>> = found.collect::<Result<_, Cancelled>>()?;
    Ok(found.concat())
}
