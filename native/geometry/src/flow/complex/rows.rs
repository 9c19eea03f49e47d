//! One row of Gaussian integers per halfedge.

use glam::{DVec2, IVec2};

use super::turn::Turn;
use crate::mesh::{HalfedgeId, Id};

/// No new place yet.
const NONE: u32 = u32::MAX;
/// Rows that nobody has any more are dropped once the entries are this many times those in use.
const WASTE: usize = 3;

/// A sparse matrix of Gaussian integers with one row per halfedge; without columns it is free.
///
/// The halfedges of an edge share entries and differ by quarter turns, so that frames turn and
/// rows move without a copy. All of it lies in two flat lists, which are cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    n_columns: usize,
    spans: Vec<Span>,
    entries: Vec<Entry>,
    /// How many entries there were when they were last packed.
    n_packed: usize,
}

/// Where the entries of a row are, and by how many quarter turns they are turned.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    first: u32,
    n: u32,
    turns: u8,
}

/// One value that is not 0; those of a row come in the order of their columns.
#[derive(Clone, Copy, Debug)]
struct Entry {
    column: u32,
    value: IVec2,
}

impl Rows {
    /// Zeros.
    pub fn new(n_halfedges: usize, n_columns: usize) -> Self {
        Self {
            n_columns,
            spans: vec![Span::default(); n_halfedges],
            ..Self::default()
        }
    }

    /// Sets the row of h to the given values, and its twin's to −iʳ times these, r = `turns`.
    pub fn set(&mut self, [h, twin]: [HalfedgeId; 2], turns: u8, row: &[IVec2]) {
        let first = self.entries.len();
        let values = row.iter().enumerate().filter(|(_, v)| **v != IVec2::ZERO);
        self.entries.extend(values.map(|(j, &value)| Entry {
            column: j as u32,
            value,
        }));
        self.name([h, twin], first, turns);
        self.n_packed = self.entries.len();
    }

    /// How many entries a row has, zeros included.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// The columns and values of a row that are not 0, in the order of the columns.
    pub fn row(&self, h: HalfedgeId) -> impl Iterator<Item = (usize, IVec2)> + Clone + '_ {
        let span = self.spans.get(h.index()).copied().unwrap_or_default();
        let entries = &self.entries[span.first as usize..][..span.n as usize];
        entries
            .iter()
            .map(move |e| (e.column as usize, e.value.turned(span.turns)))
    }

    /// Adds the row of a halfedge, turned, to values of all columns.
    pub fn add_to(&self, sum: &mut [IVec2], h: HalfedgeId, turns: u8) {
        for (column, value) in self.row(h) {
            sum[column] += value.turned(turns);
        }
    }

    /// The vector that a row makes of the values of the columns: real and imaginary in turn.
    pub fn value(&self, h: HalfedgeId, columns: &[f64]) -> DVec2 {
        let span = self.spans[h.index()];
        let columns = columns.as_chunks::<2>().0;
        let mut sum = DVec2::ZERO;
        for entry in &self.entries[span.first as usize..][..span.n as usize] {
            let value = DVec2::from_array(columns[entry.column as usize]);
            sum += entry.value.as_dvec2().rotate(value);
        }
        sum.turned(span.turns)
    }

    /// Turns each entry of a row.
    pub(super) fn turn(&mut self, h: HalfedgeId, quarters: u8) {
        if let Some(span) = self.spans.get_mut(h.index()) {
            span.turns = (span.turns + quarters) % 4;
        }
    }

    /// Moves rows from the first to the second of each pair, all at once.
    pub(super) fn move_all<const N: usize>(&mut self, moves: &[(HalfedgeId, HalfedgeId); N]) {
        if self.spans.is_empty() {
            return;
        }
        let taken = moves.map(|(from, _)| self.spans[from.index()]);
        for (&(_, to), span) in moves.iter().zip(taken) {
            self.spans[to.index()] = span;
        }
    }

    /// Makes the row of h close its triangle, and the twin's the opposite in the same frame.
    pub(super) fn close(&mut self, h: HalfedgeId, twin: HalfedgeId) {
        if self.spans.is_empty() {
            return;
        }
        let first = self.entries.len();
        let [a, b] = [h.next(), h.prev()].map(|e| self.spans[e.index()]);
        let (mut i, mut j) = (0, 0);
        while i < a.n || j < b.n {
            let read = |span: Span, k: u32| {
                let entry = (k < span.n).then(|| self.entries[(span.first + k) as usize]);
                entry.map_or((NONE, IVec2::ZERO), |e| {
                    (e.column, e.value.turned(span.turns))
                })
            };
            let [one, other] = [read(a, i), read(b, j)];
            let column = one.0.min(other.0);
            let mut value = IVec2::ZERO;
            if one.0 == column {
                value -= one.1;
                i += 1;
            }
            if other.0 == column {
                value -= other.1;
                j += 1;
            }
            if value != IVec2::ZERO {
                self.entries.push(Entry { column, value });
            }
        }
        self.name([h, twin], first, 0);
        if self.entries.len() > WASTE * self.n_packed + 64 {
            self.pack();
        }
    }

    /// Keeps the rows of some faces, in the given order.
    pub(super) fn keep_faces(&mut self, faces: &[usize]) {
        if !self.spans.is_empty() {
            let spans = faces.iter().flat_map(|&f| &self.spans[3 * f..][..3]);
            self.spans = spans.copied().collect();
            self.pack();
        }
    }

    /// Says that the last entries are the row of h, and turned that of its twin.
    fn name(&mut self, [h, twin]: [HalfedgeId; 2], first: usize, turns: u8) {
        let span = Span {
            first: first as u32,
            n: (self.entries.len() - first) as u32,
            turns: 0,
        };
        self.spans[h.index()] = span;
        self.spans[twin.index()] = Span {
            turns: (turns + 2) % 4,
            ..span
        };
    }

    /// Drops the entries of rows that are no more.
    fn pack(&mut self) {
        let mut new_place = vec![NONE; self.entries.len() + 1];
        let mut packed = Vec::with_capacity(self.entries.len());
        for span in &mut self.spans {
            let place = &mut new_place[span.first as usize];
            let old = &self.entries[span.first as usize..][..span.n as usize];
            if *place == NONE || old.is_empty() {
                *place = packed.len() as u32;
                packed.extend_from_slice(old);
            }
            span.first = *place;
        }
        self.entries = packed;
        self.n_packed = self.entries.len();
    }
}

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        let row = |rows: &Self, i: usize| rows.row(HalfedgeId::from_index(i)).collect::<Vec<_>>();
        self.n_columns == other.n_columns
            && self.spans.len() == other.spans.len()
            && (0..self.spans.len()).all(|i| row(self, i) == row(other, i))
    }
}
