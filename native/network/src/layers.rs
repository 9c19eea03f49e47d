//! What the network is made of: matrix products and norms of rows.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// Added to the variance of a row before its root is divided by; what burn's layer norm adds.
const EPSILON: f32 = 1e-5;

/// `x W + b` for every row x.
#[derive(Clone, PartialEq, Debug)]
pub struct Linear {
    /// By rows, one row per input.
    weights: Vec<f32>,
    bias: Vec<f32>,
}

/// Every row shifted and scaled to mean 0 and variance 1, then to a mean and a variance of its own.
#[derive(Clone, PartialEq, Debug)]
pub struct Norm {
    scale: Vec<f32>,
    shift: Vec<f32>,
}

impl Linear {
    /// Takes the parameters from the front of a list.
    pub fn take(rest: &mut &[f32], n_in: usize, n_out: usize) -> Self {
        Self {
            weights: taken(rest, n_in * n_out),
            bias: taken(rest, n_out),
        }
    }

    /// The product with some rows, one after the other.
    pub fn forward(&self, rows: &[f32]) -> Vec<f32> {
        let n_out = self.bias.len();
        let n_in = self.weights.len() / n_out;
        let n = rows.len() / n_in;
        let mut out = self.bias.repeat(n);
        matmul(
            MatMut::from_row_major_slice_mut(&mut out, n, n_out),
            Accum::Add,
            MatRef::from_row_major_slice(rows, n, n_in),
            MatRef::from_row_major_slice(&self.weights, n_in, n_out),
            1.0,
            Par::Seq,
        );
        out
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
            let mean = row.iter().sum::<f32>() / n;
            let variance = row.iter().map(|x| (x - mean) * (x - mean)).sum::<f32>() / n;
            let inverse = (variance + EPSILON).sqrt().recip();
            for ((x, scale), shift) in row.iter_mut().zip(&self.scale).zip(&self.shift) {
                *x = (*x - mean) * inverse * scale + shift;
            }
        }
        out
    }
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
    let rows = left.chunks_exact(width).zip(right.chunks_exact(width));
    rows.flat_map(|(left, right)| left.iter().chain(right))
        .copied()
        .collect()
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
