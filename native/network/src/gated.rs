//! The one operation that reads neighbours: a sum of values, each behind a gate that the two ends
//! of its edge set together (residual gated graph convolutions, Bresson & Laurent 2017); and its
//! gradient, for training.
//!
//! A row of the input holds four vectors of one width: [self | key | query | value]. A gate is
//! `σ(k + q) = 1 / (1 + e⁻ᵏ e⁻ᑫ)`, so that powers are taken once for each vertex and an edge is left
//! with products. A vertex only reads its neighbours and only writes its own row, so rows go to
//! threads in any order and the result is the same bits.

use rayon::prelude::*;

use crate::neighbours::Neighbours;

/// How many rows a task takes: small enough for two threads on a level of 500 vertices.
const ROWS: usize = 64;

/// `self_i + Σ_j σ(key_i + query_j) value_j` over the neighbours j of i.
pub fn gated_sum(rows: &[f32], graph: &Neighbours, width: usize) -> Vec<f32> {
    let vertices = Vertices::new(rows, width);
    let mut out = vec![0.0; graph.n_vertices() * width];
    let tasks = out.par_chunks_mut(ROWS * width).enumerate();
    tasks.for_each(|(task, chunk)| {
        for (i, sum) in chunk.chunks_exact_mut(width).enumerate() {
            let v = task * ROWS + i;
            let Vertex { own, key, .. } = vertices.at(v);
            sum.copy_from_slice(own);
            for &w in graph.of(v) {
                let Vertex { query, value, .. } = vertices.at(w as usize);
                let gates = key.iter().zip(query).map(|(k, q)| 1.0 + k * q);
                for ((sum, value), gate) in sum.iter_mut().zip(value).zip(gates) {
                    *sum += value / gate;
                }
            }
        }
    });
    out
}

/// The gradient by the rows, given the gradient by the sums.
///
/// Row v gathers what its neighbours make of it, which the symmetry of the graph allows.
pub fn gated_sum_backward(
    rows: &[f32],
    by_sum: &[f32],
    graph: &Neighbours,
    width: usize,
) -> Vec<f32> {
    let vertices = Vertices::new(rows, width);
    let mut out = vec![0.0; graph.n_vertices() * 4 * width];
    let tasks = out.par_chunks_mut(ROWS * 4 * width).enumerate();
    tasks.for_each(|(task, chunk)| {
        for (i, by_row) in chunk.chunks_exact_mut(4 * width).enumerate() {
            let v = task * ROWS + i;
            let by_own = &by_sum[v * width..][..width];
            by_row[..width].copy_from_slice(by_own);
            for &w in graph.of(v) {
                let w = w as usize;
                let by_other = &by_sum[w * width..][..width];
                gather([vertices.at(v), vertices.at(w)], [by_own, by_other], by_row);
            }
        }
    });
    out
}

/// Adds what one neighbour (the second of each pair) contributes to the gradient of a row.
fn gather([own, other]: [Vertex; 2], [by_own, by_other]: [&[f32]; 2], by_row: &mut [f32]) {
    let width = by_own.len();
    let [_, by_key, by_query, by_value] = split(by_row, width);
    for c in 0..width {
        let seen = 1.0 / (1.0 + own.key[c] * other.query[c]);
        by_key[c] += seen * (1.0 - seen) * other.value[c] * by_own[c];
        let shown = 1.0 / (1.0 + other.key[c] * own.query[c]);
        by_query[c] += shown * (1.0 - shown) * own.value[c] * by_other[c];
        by_value[c] += shown * by_other[c];
    }
}

/// Rows, and the powers of their keys and queries.
struct Vertices<'a> {
    rows: &'a [f32],
    powers: Vec<f32>,
    width: usize,
}

/// What a vertex shows to its edges: all of one width.
#[derive(Clone, Copy)]
struct Vertex<'a> {
    own: &'a [f32],
    /// e⁻ᵏ.
    key: &'a [f32],
    /// e⁻ᑫ.
    query: &'a [f32],
    value: &'a [f32],
}

impl<'a> Vertices<'a> {
    fn new(rows: &'a [f32], width: usize) -> Self {
        let mut powers = vec![0.0; rows.len() / 2];
        let tasks = powers.par_chunks_mut(ROWS * 2 * width);
        let tasks = tasks.zip(rows.par_chunks(ROWS * 4 * width));
        tasks.for_each(|(powers, rows)| {
            let rows = rows.chunks_exact(4 * width);
            for (powers, row) in powers.chunks_exact_mut(2 * width).zip(rows) {
                for (power, &x) in powers.iter_mut().zip(&row[width..3 * width]) {
                    *power = power_of(-x);
                }
            }
        });
        Self {
            rows,
            powers,
            width,
        }
    }

    #[inline]
    fn at(&self, v: usize) -> Vertex<'_> {
        let Self { powers, width, .. } = self;
        let row = &self.rows[v * 4 * width..][..4 * width];
        let (key, query) = powers[v * 2 * width..][..2 * width].split_at(*width);
        Vertex {
            own: &row[..*width],
            key,
            query,
            value: &row[3 * width..],
        }
    }
}

fn split(row: &mut [f32], width: usize) -> [&mut [f32]; 4] {
    let (own, row) = row.split_at_mut(width);
    let (key, row) = row.split_at_mut(width);
    let (query, value) = row.split_at_mut(width);
    [own, key, query, value]
}

/// eˣ to seven digits, by additions and products alone so that the loops vectorise and every
/// processor finds the same bits. Beyond ±43 it stays what it is there: so the product of two is a
/// normal number of single precision, and a gate with one of them shut or open to the last digit.
#[inline]
fn power_of(x: f32) -> f32 {
    // Half of the mantissa: adding and taking it away again rounds to the nearest whole number.
    const ROUNDER: f32 = 12_582_912.0;
    let x = x.clamp(-43.0, 43.0);
    let power = x * std::f32::consts::LOG2_E + ROUNDER;
    let whole = power - ROUNDER;
    // ln 2 in two parts, so that the product with `whole` is exact.
    let r = x - whole * 0.693_359_4 + whole * 2.121_944_4e-4;
    let series = 1.0
        + r * (1.0
            + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
    series * f32::from_bits((power.to_bits() << 23).wrapping_add(0x3f80_0000))
}

#[cfg(test)]
mod tests {
    use super::*;
    use orbflow_geometry::elementary::exp;

    #[test]
    fn gates_are_right_to_single_precision() {
        for i in -40_000..40_000 {
            let x = i as f32 * 1e-3;
            let wanted = 1.0 / (1.0 + exp(-f64::from(x)));
            for share in [0.0, 0.3, 1.0] {
                let (key, query) = (x * share, x - x * share);
                let gate = 1.0 / (1.0 + power_of(-key) * power_of(-query));
                let error = (f64::from(gate) - wanted).abs();
                assert!(error < 3e-7, "{key} + {query}: {error}");
            }
        }
    }

    #[test]
    fn gates_are_numbers_whatever_opens_and_shuts_them() {
        let shut = power_of(f32::INFINITY);
        let open = power_of(f32::NEG_INFINITY);
        assert!((1.0 + shut * shut).is_finite() && open * open >= f32::MIN_POSITIVE);
        assert!(1.0 / (1.0 + shut) < 1e-9 && 1.0 / (1.0 + open) > 0.999);
    }
}
