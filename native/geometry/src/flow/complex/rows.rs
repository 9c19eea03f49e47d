//! One row of Gaussian integers per halfedge.

use glam::IVec2;

use super::turn::Turn;
use crate::mesh::{HalfedgeId, Id};

/// A dense matrix of Gaussian integers with one row per halfedge; without columns it is free.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Rows {
    n_columns: usize,
    values: Vec<IVec2>,
}

impl Rows {
    /// Zeros.
    pub fn new(n_halfedges: usize, n_columns: usize) -> Self {
        Self {
            n_columns,
            values: vec![IVec2::ZERO; n_halfedges * n_columns],
        }
    }

    /// How many entries a row has.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// The row of a halfedge.
    pub fn row(&self, h: HalfedgeId) -> &[IVec2] {
        &self.values[h.index() * self.n_columns..][..self.n_columns]
    }

    /// The row of a halfedge, to be changed.
    pub fn row_mut(&mut self, h: HalfedgeId) -> &mut [IVec2] {
        &mut self.values[h.index() * self.n_columns..][..self.n_columns]
    }

    /// Turns each entry of a row.
    pub fn turn(&mut self, h: HalfedgeId, quarters: u8) {
        for value in self.row_mut(h) {
            *value = value.turned(quarters);
        }
    }

    /// Copies rows from the first to the second of each pair, all at once.
    pub(super) fn move_all(&mut self, moves: &[(HalfedgeId, HalfedgeId)]) {
        if self.n_columns == 0 {
            return;
        }
        let taken: Vec<IVec2> = moves
            .iter()
            .flat_map(|&(from, _)| self.row(from))
            .copied()
            .collect();
        for (&(_, to), row) in moves.iter().zip(taken.chunks_exact(self.n_columns)) {
            self.row_mut(to).copy_from_slice(row);
        }
    }

    /// Makes the row of h close its triangle, and the twin's the opposite in the same frame.
    pub(super) fn close(&mut self, h: HalfedgeId, twin: HalfedgeId) {
        let n = self.n_columns;
        let [at, opposite, a, b] = [h, twin, h.next(), h.prev()].map(|e| e.index() * n);
        for i in 0..n {
            let sum = self.values[a + i] + self.values[b + i];
            self.values[at + i] = -sum;
            self.values[opposite + i] = sum;
        }
    }

    /// Keeps the rows of some faces, in the given order.
    pub(super) fn keep_faces(&mut self, faces: &[usize]) {
        let n = 3 * self.n_columns;
        let rows = faces.iter().flat_map(|&f| &self.values[f * n..][..n]);
        self.values = rows.copied().collect();
    }
}
