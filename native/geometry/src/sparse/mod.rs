//! Sparse symmetric systems: what least squares on a mesh ends in.
//!
//! A [`SymmetricMatrix`] is summed up entry by entry and factorised once as L Lᵀ; the [`Cholesky`]
//! factor then solves any number of right sides. The work is faer's, on one thread and in plain
//! arithmetic, so the same input gives the same bits on every machine. Matrices that are not
//! positive definite are refused; there is no pivoting and no iteration.

mod factor;
mod hermitian;

use faer::sparse::{SparseColMat, Triplet};
use glam::DVec3;
use thiserror::Error;

use factor::Factor;
pub use factor::Order;
pub use hermitian::{HermitianCholesky, HermitianMatrix};

/// A symmetric matrix under construction; entries at the same place add up.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix {
    n: usize,
    lower: Vec<Triplet<u32, u32, f64>>,
}

/// Why a matrix has no Cholesky factor.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
#[error("the matrix of {n} rows is not positive definite")]
pub struct NotPositiveDefinite {
    /// How many rows it has.
    pub n: usize,
}

/// The factor L of a matrix L Lᵀ.
#[derive(Clone, Debug)]
pub struct Cholesky {
    n: usize,
    factor: Factor<f64>,
}

impl SymmetricMatrix {
    /// The zero matrix of `n` rows.
    pub fn new(n: usize) -> Self {
        Self {
            n,
            lower: Vec::new(),
        }
    }

    /// Adds to one entry and, off the diagonal, to its mirror image.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let [low, high] = [row.min(column), row.max(column)];
        self.lower
            .push(Triplet::new(high as u32, low as u32, value));
    }

    /// Adds `weight` × wᵀw for a sparse row w: one equation of a least squares problem.
    /// No place may come twice.
    pub fn add_square(&mut self, row: &[(usize, f64)], weight: f64) {
        for (k, &(i, a)) in row.iter().enumerate() {
            for &(j, b) in &row[k..] {
                self.add(i, j, weight * a * b);
            }
        }
    }

    /// Factorises the matrix with a fill-reducing order.
    ///
    /// # Errors
    /// When the matrix is not positive definite, or an entry is not finite.
    ///
    /// # Panics
    /// When an entry lies outside of the matrix.
    pub fn factorize(&self) -> Result<Cholesky, NotPositiveDefinite> {
        let n = self.n;
        let refused = NotPositiveDefinite { n };
        if !self.lower.iter().all(|entry| entry.val.is_finite()) {
            return Err(refused);
        }
        let matrix = SparseColMat::try_new_from_triplets(n, n, &self.lower)
            .expect("every entry lies inside of the matrix");
        let order = Order::of(matrix.as_ref()).map_err(|_| refused)?;
        let factor = order.factorize(matrix.as_ref()).map_err(|_| refused)?;
        Ok(Cholesky { n, factor })
    }
}

impl Cholesky {
    /// Solves for one number per row, in place.
    ///
    /// # Panics
    /// When the number of rows differs.
    pub fn solve(&self, values: &mut [f64]) {
        assert_eq!(values.len(), self.n, "one value per row");
        let columns = faer::MatMut::from_column_major_slice_mut(values, self.n, 1);
        self.factor.solve(columns);
    }

    /// Solves for one vector per row, in place.
    ///
    /// # Panics
    /// When the number of rows differs.
    pub fn solve_vectors(&self, values: &mut [DVec3]) {
        assert_eq!(values.len(), self.n, "one vector per row");
        let mut columns = faer::Mat::from_fn(self.n, 3, |row, axis| values[row][axis]);
        self.factor.solve(columns.as_mut());
        for (row, value) in values.iter_mut().enumerate() {
            *value = DVec3::from_array([0, 1, 2].map(|axis| columns[(row, axis)]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// The Laplacian of a path of `n` vertices, shifted to be definite.
    fn path(n: usize, shift: f64) -> SymmetricMatrix {
        let mut matrix = SymmetricMatrix::new(n);
        for i in 0..n {
            matrix.add(i, i, shift);
        }
        for i in 1..n {
            matrix.add_square(&[(i - 1, 1.0), (i, -1.0)], 1.0);
        }
        matrix
    }

    #[test]
    fn a_solution_satisfies_the_equations() {
        let mut random = Random::new(3);
        let n = 60;
        let wanted: Vec<DVec3> = (0..n)
            .map(|_| DVec3::new(random.unit(), random.unit(), random.unit()))
            .collect();
        let at = |i: usize, j: isize| {
            let k = i as isize + j;
            wanted
                .get(k as usize)
                .map_or(DVec3::ZERO, |&x| wanted[i] - x)
        };
        let mut values: Vec<DVec3> = (0..n)
            .map(|i| wanted[i] * 0.1 + at(i, -1) + at(i, 1))
            .collect();
        let mut first: Vec<f64> = values.iter().map(|v| v.x).collect();
        let factor = path(n, 0.1).factorize().unwrap();
        factor.solve_vectors(&mut values);
        factor.solve(&mut first);
        for i in 0..n {
            assert!(values[i].distance(wanted[i]) < 1e-12);
            assert!((first[i] - wanted[i].x).abs() < 1e-12);
        }
    }

    #[test]
    fn indefinite_and_poisoned_matrices_are_refused() {
        assert_eq!(
            path(5, -0.5).factorize().unwrap_err(),
            NotPositiveDefinite { n: 5 }
        );
        let mut poisoned = path(5, 1.0);
        poisoned.add(2, 3, f64::NAN);
        assert!(poisoned.factorize().is_err());
        assert!(SymmetricMatrix::new(3).factorize().is_err());
    }
}
