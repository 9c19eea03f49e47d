//! The one operation that reads neighbours: a sum of values, each behind a gate that the two ends
//! of its edge set together (residual gated graph convolutions, Bresson & Laurent 2017); and its
//! gradient, for training.
//!
//! A row of the input holds four vectors of one width: [self | key | query | value]. A vertex only
//! reads its neighbours and only writes its own row, so rows go to threads in any order and the
//! result is the same bits.

use rayon::prelude::*;

use crate::neighbours::Neighbours;

/// How many rows a task takes: small enough for two threads on a level of 500 vertices.
const ROWS: usize = 64;

/// `self_i + Σ_j σ(key_i + query_j) value_j` over the neighbours j of i.
pub fn gated_sum(rows: &[f32], graph: &Neighbours, width: usize) -> Vec<f32> {
    let mut out = vec![0.0; graph.n_vertices() * width];
    let tasks = out.par_chunks_mut(ROWS * width).enumerate();
    tasks.for_each(|(task, chunk)| {
        for (i, sum) in chunk.chunks_exact_mut(width).enumerate() {
            let v = task * ROWS + i;
            let [own, key, ..] = row(rows, v, width);
            sum.copy_from_slice(own);
            for &w in graph.of(v) {
                let [_, _, query, value] = row(rows, w as usize, width);
                for c in 0..width {
                    sum[c] += sigmoid(key[c] + query[c]) * value[c];
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
                gather(
                    [row(rows, v, width), row(rows, w, width)],
                    [by_own, by_other],
                    by_row,
                );
            }
        }
    });
    out
}

/// Adds what one neighbour (the second of each pair) contributes to the gradient of a row.
fn gather([own, other]: [[&[f32]; 4]; 2], [by_own, by_other]: [&[f32]; 2], by_row: &mut [f32]) {
    let width = by_own.len();
    let [_, by_key, by_query, by_value] = split(by_row, width);
    let ([_, key, query, value], [_, other_key, other_query, other_value]) = (own, other);
    for c in 0..width {
        let seen = sigmoid(key[c] + other_query[c]);
        by_key[c] += seen * (1.0 - seen) * other_value[c] * by_own[c];
        let shown = sigmoid(other_key[c] + query[c]);
        by_query[c] += shown * (1.0 - shown) * value[c] * by_other[c];
        by_value[c] += shown * by_other[c];
    }
}

fn row(rows: &[f32], v: usize, width: usize) -> [&[f32]; 4] {
    let row = &rows[v * 4 * width..][..4 * width];
    [0, 1, 2, 3].map(|i| &row[i * width..][..width])
}

fn split(row: &mut [f32], width: usize) -> [&mut [f32]; 4] {
    let (own, row) = row.split_at_mut(width);
    let (key, row) = row.split_at_mut(width);
    let (query, value) = row.split_at_mut(width);
    [own, key, query, value]
}

/// 1 / (1 + e⁻ˣ) to seven digits, by additions and products alone so that the loops vectorise and
/// every processor finds the same bits.
fn sigmoid(x: f32) -> f32 {
    // Half of the mantissa: adding and taking it away again rounds to the nearest whole number.
    const ROUNDER: f32 = 12_582_912.0;
    // Beyond these the sigmoid is 0 or 1 to single precision, and the exponent stays in its range.
    let x = (-x).clamp(-30.0, 30.0);
    let power = x * std::f32::consts::LOG2_E + ROUNDER;
    let whole = power - ROUNDER;
    // ln 2 in two parts, so that the product with `whole` is exact.
    let r = x - whole * 0.693_359_4 + whole * 2.121_944_4e-4;
    let series = 1.0
        + r * (1.0
            + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
    let scale = f32::from_bits((power.to_bits() << 23).wrapping_add(0x3f80_0000));
    1.0 / (1.0 + series * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orbflow_geometry::elementary::exp;

    #[test]
    fn the_sigmoid_is_right_to_single_precision() {
        for i in -40_000..40_000 {
            let x = i as f32 * 1e-3;
            let wanted = 1.0 / (1.0 + exp(-f64::from(x)));
            let error = (f64::from(sigmoid(x)) - wanted).abs();
            assert!(error < 2e-7, "{x}: {error}");
        }
        assert!(sigmoid(f32::INFINITY) > 0.999 && sigmoid(f32::NEG_INFINITY) < 1e-9);
    }
}
