//! What the network is made of: matrix products and norms of rows.
//!
//! Plain products and sums in a fixed order: libraries take fused ones where the processor has them,
//! so that a proposal would have other bits on another machine.

use pulp::{Arch, Simd, WithSimd};

/// How many columns of a product are worked out at once, and how many rows: what fits into sixteen
/// registers of eight numbers.
const COLUMNS: usize = 16;
const ROWS: usize = 4;
/// Added to the variance of a row before its root is divided by; what burn's layer norm adds.
const EPSILON: f32 = 1e-5;

/// `x W + b` for every row x.
#[derive(Clone, PartialEq, Debug)]
pub struct Linear {
    /// Strips of [`COLUMNS`] columns, each by rows, one row per input; filled up with zeros.
    strips: Vec<f32>,
    bias: Vec<f32>,
    n_in: usize,
}

/// Every row shifted and scaled to mean 0 and variance 1, then to a mean and a variance of its own.
#[derive(Clone, PartialEq, Debug)]
pub struct Norm {
    scale: Vec<f32>,
    shift: Vec<f32>,
}

impl Linear {
    /// Takes the parameters from the front of a list: the matrix by rows, one row per input, and
    /// the bias.
    pub fn take(rest: &mut &[f32], n_in: usize, n_out: usize) -> Self {
        let weights = taken(rest, n_in * n_out);
        let mut strips = Vec::with_capacity(n_in * n_out.next_multiple_of(COLUMNS));
        for first in (0..n_out).step_by(COLUMNS) {
            let n = COLUMNS.min(n_out - first);
            for row in weights.chunks_exact(n_out) {
                strips.extend_from_slice(&row[first..][..n]);
                strips.extend([0.0].repeat(COLUMNS - n));
            }
        }
        Self {
            strips,
            bias: taken(rest, n_out),
            n_in,
        }
    }

    /// The product with some rows, one after the other.
    pub fn forward(&self, rows: &[f32]) -> Vec<f32> {
        let mut out = self.bias.repeat(rows.len() / self.n_in);
        Arch::new().dispatch(Product {
            layer: self,
            rows,
            out: &mut out,
        });
        out
    }
}

/// A product on its way, compiled for several processors.
struct Product<'a> {
    layer: &'a Linear,
    rows: &'a [f32],
    out: &'a mut [f32],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "only what is inlined is compiled for newer processors"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { layer, rows, out } = self;
        let [n_in, n_out] = [layer.n_in, layer.bias.len()];
        for (rows, out) in rows.chunks(ROWS * n_in).zip(out.chunks_mut(ROWS * n_out)) {
            let last = rows.len() / n_in - 1;
            // Of a block that is not full the last row is worked out again.
            let row = |i: usize| &rows[i.min(last) * n_in..][..n_in];
            let [a, b, c, d]: [&[f32]; ROWS] = std::array::from_fn(row);
            for first in (0..n_out).step_by(COLUMNS) {
                let strip = layer.strips[first * n_in..].as_chunks::<COLUMNS>().0;
                let mut sums = [[0.0; COLUMNS]; ROWS];
                // Counted loops: without link-time optimisation iterators stay calls in here.
                for k in 0..n_in {
                    let (x, weights) = ([a[k], b[k], c[k], d[k]], &strip[k]);
                    for i in 0..ROWS {
                        for j in 0..COLUMNS {
                            sums[i][j] += x[i] * weights[j];
                        }
                    }
                }
                for (out, sums) in out.chunks_exact_mut(n_out).zip(sums) {
                    let out = out[first..].iter_mut();
                    out.zip(sums).for_each(|(out, sum)| *out += sum);
                }
            }
        }
    }
}

impl Norm {
    /// Takes the parameters from the front of a list.
    pub fn take(rest: &mut &[f32], width: usize) -> Self {
        Self {
            scale: taken(rest, width),
            shift: taken(rest, width),
        }
    }

    /// How long a row is.
    pub fn width(&self) -> usize {
        self.scale.len()
    }

    /// The norm of some rows, one after the other.
    pub fn forward(&self, rows: &[f32]) -> Vec<f32> {
        let mut out = rows.to_vec();
        let n = self.width() as f32;
        for row in out.chunks_exact_mut(self.width()) {
            let mean = sum_of(row, |x| x) / n;
            let variance = sum_of(row, |x| (x - mean) * (x - mean)) / n;
            let inverse = (variance + EPSILON).sqrt().recip();
            for ((x, scale), shift) in row.iter_mut().zip(&self.scale).zip(&self.shift) {
                *x = (*x - mean) * inverse * scale + shift;
            }
        }
        out
    }
}

/// The sum of a term for each number, in eight sums side by side: the loop vectorises, and adds in
/// the same order everywhere.
fn sum_of(row: &[f32], term: impl Fn(f32) -> f32) -> f32 {
    let mut sums = [0.0; 8];
    let chunks = row.chunks_exact(8);
    let rest: f32 = chunks.remainder().iter().map(|&x| term(x)).sum();
    for chunk in chunks {
        for (sum, &x) in sums.iter_mut().zip(chunk) {
            *sum += term(x);
        }
    }
    rest + sums.iter().sum::<f32>()
}

fn taken(rest: &mut &[f32], n: usize) -> Vec<f32> {
    let (taken, left) = rest.split_at(n);
    *rest = left;
    taken.to_vec()
}

/// The sum of two lists.
pub fn add(mut to: Vec<f32>, more: &[f32]) -> Vec<f32> {
    to.iter_mut().zip(more).for_each(|(to, more)| *to += more);
    to
}

/// Rows of two lists side by side, each of them `width` long.
pub fn join([left, right]: [&[f32]; 2], width: usize) -> Vec<f32> {
    let mut joined = Vec::with_capacity(left.len() + right.len());
    for (left, right) in left.chunks_exact(width).zip(right.chunks_exact(width)) {
        joined.extend_from_slice(left);
        joined.extend_from_slice(right);
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_layer_multiplies_and_adds() {
        // The matrix [[1, 2, 3], [4, 5, 6]] and the bias [0.5, 0, -0.5].
        let parameters = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.5, 0.0, -0.5, 9.0];
        let mut rest = &parameters[..];
        let layer = Linear::take(&mut rest, 2, 3);
        assert_eq!(rest, [9.0]);
        let out = layer.forward(&[1.0, 0.0, 1.0, -1.0]);
        assert_eq!(out, [1.5, 2.0, 2.5, -2.5, -3.0, -3.5]);
    }

    #[test]
    fn products_are_right_whatever_is_left_over() {
        for (n, n_in, n_out) in [(1, 1, 1), (4, 3, 8), (9, 5, 17), (6, 7, 3), (8, 2, 16)] {
            let value = |i: usize| (i * i % 13) as f32 - 6.0;
            let parameters: Vec<f32> = (0..(n_in + 1) * n_out).map(value).collect();
            let rows: Vec<f32> = (0..n * n_in).map(|i| value(3 * i + 1)).collect();
            let out = Linear::take(&mut &parameters[..], n_in, n_out).forward(&rows);
            let wanted = (0..n * n_out).map(|i| {
                let (r, c) = (i / n_out, i % n_out);
                let terms = (0..n_in).map(|k| rows[r * n_in + k] * parameters[k * n_out + c]);
                terms.sum::<f32>() + parameters[n_in * n_out + c]
            });
            // Whole numbers, so that no order of sums matters.
            assert_eq!(out, wanted.collect::<Vec<_>>(), "{n} {n_in} {n_out}");
        }
    }

    #[test]
    fn a_norm_has_the_mean_and_deviation_of_its_parameters() {
        let parameters = [2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0];
        let out = Norm::take(&mut &parameters[..], 4).forward(&[3.0, 5.0, 3.0, 5.0]);
        for (x, wanted) in out.iter().zip([-1.0, 3.0, -1.0, 3.0]) {
            assert!((x - wanted).abs() < 1e-4, "{out:?}");
        }
    }

    #[test]
    fn rows_are_joined_side_by_side() {
        let joined = join([&[1.0, 2.0, 3.0, 4.0], &[5.0, 6.0, 7.0, 8.0]], 2);
        assert_eq!(joined, [1.0, 2.0, 5.0, 6.0, 3.0, 4.0, 7.0, 8.0]);
    }
}
