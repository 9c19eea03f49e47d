//! Sparse Hermitian systems: least squares over complex numbers, written as [`DVec2`].

use faer::c64;
use faer::sparse::{SparseColMat, Triplet};
use glam::DVec2;

use super::factor::Factor;
use super::{NotPositiveDefinite, Order};

/// A Hermitian matrix under construction; entries at the same place add up.
#[derive(Clone, Debug)]
pub struct HermitianMatrix {
    n: usize,
    lower: Vec<Triplet<u32, u32, c64>>,
}

/// The factor L of a matrix L Lᴴ.
#[derive(Clone, Debug)]
pub struct HermitianCholesky {
    n: usize,
    factor: Factor<c64>,
}

impl HermitianMatrix {
    /// The zero matrix of `n` rows.
    pub fn new(n: usize) -> Self {
        Self {
            n,
            lower: Vec::new(),
        }
    }

    /// Adds to one entry and, off the diagonal, the conjugate to its mirror image.
    pub fn add(&mut self, row: usize, column: usize, value: DVec2) {
        let sign = if row < column { -1.0 } else { 1.0 };
        let value = c64::new(value.x, sign * value.y);
        let [low, high] = [row.min(column), row.max(column)];
        self.lower
            .push(Triplet::new(high as u32, low as u32, value));
    }

    /// Adds `weight` × wᴴw for a sparse row w: the equation w x = 0 of a least squares problem.
    /// A place may come twice.
    pub fn add_square(&mut self, row: &[(usize, DVec2)], weight: f64) {
        for (k, &(i, a)) in row.iter().enumerate() {
            self.add(i, i, DVec2::X * (weight * a.length_squared()));
            for &(j, b) in &row[k + 1..] {
                let product = DVec2::new(a.x, -a.y).rotate(b) * weight;
                let shared = if i == j {
                    DVec2::X * (2.0 * product.x)
                } else {
                    product
                };
                self.add(i, j, shared);
            }
        }
    }

    /// Finds the order of elimination of every matrix with this one's pattern.
    ///
    /// # Errors
    /// When the matrix is too large for its indices.
    ///
    /// # Panics
    /// When an entry lies outside of the matrix.
    pub fn order(&self) -> Result<Order, NotPositiveDefinite> {
        let refused = NotPositiveDefinite { n: self.n };
        Order::of(self.columns().as_ref()).map_err(|_| refused)
    }

    /// Factorises the matrix in an order found for its pattern.
    ///
    /// # Errors
    /// When the matrix is not positive definite, or an entry is not finite.
    ///
    /// # Panics
    /// When an entry lies outside of the matrix, or the order belongs to another pattern.
    pub fn factorize(&self, order: &Order) -> Result<HermitianCholesky, NotPositiveDefinite> {
        let n = self.n;
        let refused = NotPositiveDefinite { n };
        let is_finite = |z: c64| z.re.is_finite() && z.im.is_finite();
        if !self.lower.iter().all(|entry| is_finite(entry.val)) {
            return Err(refused);
        }
        let columns = self.columns();
        let factor = order.factorize(columns.as_ref()).map_err(|_| refused)?;
        Ok(HermitianCholesky { n, factor })
    }

    fn columns(&self) -> SparseColMat<u32, c64> {
        SparseColMat::try_new_from_triplets(self.n, self.n, &self.lower)
            .expect("every entry lies inside of the matrix")
    }
}

impl HermitianCholesky {
    /// Solves for one complex number per row, in place.
    ///
    /// # Panics
    /// When the number of rows differs.
    pub fn solve(&self, values: &mut [DVec2]) {
        assert_eq!(values.len(), self.n, "one value per row");
        let mut column: Vec<c64> = values.iter().map(|z| c64::new(z.x, z.y)).collect();
        self.factor.solve(faer::MatMut::from_column_major_slice_mut(
            &mut column,
            self.n,
            1,
        ));
        for (value, z) in values.iter_mut().zip(column) {
            *value = DVec2::new(z.re, z.im);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::direction;
    use crate::random::Random;

    /// `Σ weight |x_i + a_i x_{i+1}|² + shift Σ |x_i|²` over a ring, and its entries in full.
    fn ring(n: usize, shift: f64, seed: u64) -> (HermitianMatrix, Vec<Vec<DVec2>>) {
        let mut random = Random::new(seed);
        let mut matrix = HermitianMatrix::new(n);
        let mut full = vec![vec![DVec2::ZERO; n]; n];
        for i in 0..n {
            matrix.add(i, i, DVec2::X * shift);
            full[i][i].x += shift;
            let turn = direction(6.0 * random.unit());
            let row = [(i, DVec2::ONE), ((i + 1) % n, turn)];
            matrix.add_square(&row, 0.5);
            for (i, a) in row {
                for (j, b) in row {
                    full[i][j] += DVec2::new(a.x, -a.y).rotate(b) * 0.5;
                }
            }
        }
        (matrix, full)
    }

    #[test]
    fn a_solution_satisfies_the_equations() {
        let (first, _) = ring(40, 0.1, 1);
        let order = first.order().unwrap();
        for seed in [1, 2] {
            let (matrix, full) = ring(40, 0.1, seed);
            let mut random = Random::new(9);
            let right: Vec<DVec2> = (0..40)
                .map(|_| DVec2::new(random.unit(), random.unit()))
                .collect();
            let mut x = right.clone();
            matrix.factorize(&order).unwrap().solve(&mut x);
            for (row, right) in full.iter().zip(&right) {
                let sum: DVec2 = row.iter().zip(&x).map(|(a, x)| a.rotate(*x)).sum();
                assert!(sum.distance(*right) < 1e-12);
            }
        }
    }

    #[test]
    fn a_place_may_come_twice_in_an_equation() {
        let mut matrix = HermitianMatrix::new(1);
        matrix.add_square(&[(0, DVec2::ONE), (0, DVec2::new(1.0, -3.0))], 1.0);
        let mut x = [DVec2::X];
        let order = matrix.order().unwrap();
        matrix.factorize(&order).unwrap().solve(&mut x);
        // |1 + i + 1 − 3i|² = 8.
        assert!(x[0].distance(DVec2::X / 8.0) < 1e-15);
    }

    #[test]
    fn indefinite_and_poisoned_matrices_are_refused() {
        let (matrix, _) = ring(5, -9.0, 1);
        let order = matrix.order().unwrap();
        assert!(matrix.factorize(&order).is_err());
        let (mut poisoned, _) = ring(5, 1.0, 1);
        poisoned.add(0, 1, DVec2::new(f64::NAN, 0.0));
        assert!(poisoned.factorize(&order).is_err());
    }
}
