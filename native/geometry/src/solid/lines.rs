//! Lines on the shells that vertices of the surface are to lie on.

use std::collections::HashMap;

use glam::DVec3;

use super::grid::Grid;

/// Places of a line in a cell, at least: between them a line may cut off a corner unseen.
const STEP: f64 = 0.2;
/// Where planes meet farther than that from the line, in cells, it lies on another side.
const NEAR: f64 = 1.0;

/// The middle of what passes each cell.
#[derive(Default)]
pub struct Lines(HashMap<u64, DVec3>);

impl Lines {
    /// Of lines in the grid's places.
    pub fn new(grid: &Grid, lines: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let mut sums: HashMap<u64, (DVec3, f64)> = HashMap::new();
        for [a, b] in lines {
            let n = (a.distance(b) / STEP).ceil().max(1.0);
            for i in 0..=n as u32 {
                let p = a.lerp(b, f64::from(i) / n);
                let cell = grid.key(p.to_array().map(|x| x as u64));
                let sum = sums.entry(cell).or_insert((DVec3::ZERO, 0.0));
                *sum = (sum.0 + p, sum.1 + 1.0);
            }
        }
        let middles = sums.into_iter().map(|(cell, (sum, n))| (cell, sum / n));
        Self(middles.collect())
    }

    /// The place of a line in a cell that is near to another.
    pub fn near(&self, cell: u64, p: DVec3) -> Option<DVec3> {
        let place = self.0.get(&cell).copied();
        place.filter(|place| place.distance_squared(p) <= NEAR * NEAR)
    }
}
