//! Hits where a field goes through nought: walls that no triangle is.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use rayon::prelude::*;

use super::cross::{Hit, Hits, sorted};
use super::grid::Grid;
use super::table;
use crate::progress::{Cancelled, Progress};

/// Steps of the search for the place along an edge.
const N_STEPS: usize = 4;
/// Cells between two looks at the progress.
const CHUNK: usize = 4096;
/// How far apart values are taken to find which way the field falls, in cells.
const APART: f64 = 0.2;

/// Something that is positive inside.
pub trait Field: Sync {
    fn at(&self, p: DVec3) -> f64;

    /// Whether cells are followed that lie inside, or those alone through which the wall goes.
    fn fills(&self) -> bool;
}

/// Walls found from some cells on.
pub struct Walls<'a, F> {
    grid: &'a Grid,
    field: &'a F,
    /// The values at vertices.
    values: HashMap<u64, f64>,
    seen: HashSet<u64>,
}

impl<'a, F: Field> Walls<'a, F> {
    pub fn new(grid: &'a Grid, field: &'a F) -> Self {
        Self {
            grid,
            field,
            values: HashMap::new(),
            seen: HashSet::new(),
        }
    }

    /// Adds the hits of the walls that can be followed from cells, and their normals. Edges that are
    /// hit already have no wall, unless the field fills.
    ///
    /// # Errors
    /// When cancelled.
    pub fn add(
        mut self,
        mut cells: Vec<u64>,
        (hits, normals): (&mut Hits, &mut Vec<DVec3>),
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut found: [Vec<u64>; 3] = Default::default();
        while !cells.is_empty() {
            cells.par_sort_unstable();
            cells.dedup();
            cells.retain(|&cell| self.seen.insert(cell));
            self.look(&cells, progress)?;
            let mut next = Vec::new();
            for &cell in &cells {
                self.pass(cell, hits, &mut found, &mut next);
            }
            cells = next;
        }
        for (axis, mut edges) in found.into_iter().enumerate() {
            edges.sort_unstable();
            edges.dedup();
            self.hit((axis, &edges), (&mut hits[axis], normals), progress)?;
        }
        Ok(())
    }

    fn corner(&self, cell: u64, corner: usize) -> u64 {
        let along = |axis: usize| (corner >> axis & 1) as u64 * self.grid.step(axis);
        cell + (0..3).map(along).sum::<u64>()
    }

    /// Takes the values at the corners of cells.
    fn look(&mut self, cells: &[u64], progress: &Progress) -> Result<(), Cancelled> {
        let corners = cells
            .iter()
            .flat_map(|&cell| (0..8).map(move |i| (cell, i)));
        let mut new: Vec<u64> = corners.map(|(cell, i)| self.corner(cell, i)).collect();
        new.par_sort_unstable();
        new.dedup();
        new.retain(|vertex| !self.values.contains_key(vertex));
        let (grid, field) = (self.grid, self.field);
        let value = |&vertex: &u64| (vertex, field.at(grid.place(vertex)));
        for chunk in new.chunks(CHUNK) {
            progress.check()?;
            let values: Vec<(u64, f64)> = chunk.par_iter().map(value).collect();
            self.values.extend(values);
        }
        Ok(())
    }

    /// The edges of a cell that have a wall, and the cells to follow.
    fn pass(&self, cell: u64, hits: &Hits, found: &mut [Vec<u64>; 3], next: &mut Vec<u64>) {
        let mut around = Vec::new();
        for edge in 0..12 {
            let axis = edge / 4;
            let ends = table::corners(edge).map(|corner| self.corner(cell, corner));
            let is_inside = ends.map(|vertex| self.values[&vertex] > 0.0);
            let is_wall = is_inside[0] != is_inside[1];
            let fills = self.field.fills();
            if is_wall && (fills || !is_hit(&hits[axis], ends[0])) {
                found[axis].push(ends[0]);
            } else if !(fills && is_inside[0]) {
                continue;
            }
            around.extend(self.grid.around_edge(axis, ends[0]));
        }
        let is_new = |cell: &u64| !self.seen.contains(cell);
        next.extend(around.into_iter().filter(is_new));
    }

    /// Hits edges where the field goes through nought.
    fn hit(
        &self,
        (axis, edges): (usize, &[u64]),
        (hits, normals): (&mut Vec<Hit>, &mut Vec<DVec3>),
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        for chunk in edges.chunks(CHUNK) {
            progress.check()?;
            let places: Vec<(f64, DVec3)> = chunk
                .par_iter()
                .map(|&edge| self.place(axis, edge))
                .collect();
            for (&edge, (at, normal)) in chunk.iter().zip(places) {
                let of = normals.len() as u32;
                hits.push(Hit { edge, at, of });
                normals.push(normal);
            }
        }
        *hits = sorted(std::mem::take(hits));
        Ok(())
    }

    /// Where along an edge the field goes through nought, and how it falls there.
    fn place(&self, axis: usize, edge: u64) -> (f64, DVec3) {
        let low = self.grid.place(edge);
        let at = |share: f64| low + DVec3::AXES[axis] * share;
        let ends = [edge, edge + self.grid.step(axis)].map(|vertex| self.values[&vertex]);
        let mut span = [(0.0, ends[0]), (1.0, ends[1])];
        for step in 0..N_STEPS {
            let [(a, x), (b, y)] = span;
            // Halves too: where the field jumps the straight guess stays at one end.
            let guess = if step % 2 == 0 { x / (x - y) } else { 0.5 };
            let middle = a + (b - a) * guess.clamp(0.02, 0.98);
            let value = self.field.at(at(middle));
            let side = usize::from((value > 0.0) != (x > 0.0));
            span[side] = (middle, value);
        }
        let [(a, x), (b, y)] = span;
        let share = a + (b - a) * (x / (x - y)).clamp(0.0, 1.0);
        let (place, here) = (at(share), self.field.at(at(share)));
        let slope = |axis: usize| here - self.field.at(place + DVec3::AXES[axis] * APART);
        let normal = DVec3::new(slope(0), slope(1), slope(2));
        (share, normal.normalize_or(DVec3::AXES[axis]))
    }
}

fn is_hit(hits: &[Hit], edge: u64) -> bool {
    hits.binary_search_by_key(&edge, |hit| hit.edge).is_ok()
}
