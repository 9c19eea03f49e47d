//! How periods move together at least cost: a dense inverse that equations and fixed values shrink.

use glam::DVec2;

use super::complex::Complex;
use super::periods::dot;
use crate::mesh::HalfedgeId;
use crate::sparse::SymmetricMatrix;

/// The bounds of an edge's weight: a needle must not outweigh the rest, nor an edge count nothing.
const WEIGHTS: [f64; 2] = [0.1, 3.0];
/// Added to the diagonal: an edge of weight 0 leaves its period loose otherwise.
const SHIFT: f64 = 1e-6;
/// A variance below this is 0: what it belongs to is decided already.
pub const DECIDED: f64 = 1e-9;

/// A symmetric matrix over the components of the periods (real and imaginary parts in turn).
#[derive(Clone, Debug)]
pub struct Dense {
    n: usize,
    values: Vec<f64>,
}

impl Dense {
    /// The matrix of the energy Σ w |v − v̂|² over all edges, as a square form of the periods.
    pub fn energy(complex: &Complex) -> Self {
        let n = 2 * complex.coefficients.n_columns();
        let mut values = vec![0.0; n * n];
        for h in complex.halfedge_ids().filter(|&h| h < complex.twins[h]) {
            let mean = 0.5 * (complex.cotangent(h) + complex.cotangent(complex.twins[h]));
            let weight = mean.clamp(WEIGHTS[0], WEIGHTS[1]);
            let row = complex.coefficients.row(h);
            let used: Vec<(usize, DVec2)> = row.map(|(j, c)| (j, c.as_dvec2())).collect();
            for &(i, a) in &used {
                for &(j, b) in &used {
                    // conj(a) b as a 2 × 2 real block.
                    let [re, im] = [weight * a.dot(b), weight * a.perp_dot(b)];
                    values[2 * i * n + 2 * j] += re;
                    values[2 * i * n + 2 * j + 1] -= im;
                    values[(2 * i + 1) * n + 2 * j] += im;
                    values[(2 * i + 1) * n + 2 * j + 1] += re;
                }
            }
        }
        for i in 0..n {
            values[i * n + i] += SHIFT;
        }
        Self { n, values }
    }

    /// A matrix by its entries.
    pub fn from_fn(n: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let values = (0..n * n).map(|i| entry(i / n, i % n)).collect();
        Self { n, values }
    }

    /// Lets a component follow the others so that `row`, of coefficient ±1 there, keeps the sum
    /// 0: the square form of the others; what is left of the component is 0.
    pub fn follow(&mut self, row: &[f64], component: usize) {
        let own = self.column(component).to_vec();
        let factors: Vec<f64> = (row.iter().enumerate())
            .map(|(k, &x)| {
                if k == component {
                    -1.0
                } else {
                    -row[component] * x
                }
            })
            .collect();
        for (k, line) in self.values.chunks_exact_mut(self.n).enumerate() {
            let with_own = own[k] + factors[k] * own[component];
            for (l, value) in line.iter_mut().enumerate() {
                *value += factors[k] * own[l] + with_own * factors[l];
            }
        }
    }

    /// The inverse of an energy's matrix: what a unit of pull on one component does to all.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let n = self.n;
        let mut matrix = SymmetricMatrix::new(n);
        for i in 0..n {
            for j in (0..=i).filter(|j| self.values[i * n + j] != 0.0) {
                matrix.add(i, j, self.values[i * n + j]);
            }
        }
        let factor = matrix
            .factorize()
            .expect("a sum of squares with a positive diagonal added is positive definite");
        let mut values = vec![0.0; n * n];
        for (i, column) in values.chunks_exact_mut(n).enumerate() {
            column[i] = 1.0;
            factor.solve(column);
        }
        // The same bits on both sides of the diagonal.
        for i in 0..n {
            for j in 0..i {
                values[j * n + i] = values[i * n + j];
            }
        }
        Self { n: self.n, values }
    }

    /// How many components there are.
    pub fn n(&self) -> usize {
        self.n
    }

    /// One entry.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.n + column]
    }

    /// The column, which is the row, of a component.
    pub fn column(&self, component: usize) -> &[f64] {
        &self.values[component * self.n..][..self.n]
    }

    /// The product with a vector that is mostly 0.
    pub fn times(&self, row: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.n];
        for (k, &factor) in row.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            for (sum, value) in product.iter_mut().zip(self.column(k)) {
                *sum += factor * value;
            }
        }
        product
    }

    /// What is left once the pull `row` is decided; `moved` = C · row, of variance `row` · `moved`.
    pub fn decide(&mut self, moved: &[f64], variance: f64) {
        for (own, &factor) in self.values.chunks_exact_mut(self.n).zip(moved) {
            let factor = factor / variance;
            if factor.abs() > 1e-15 {
                for (value, other) in own.iter_mut().zip(moved) {
                    *value -= factor * other;
                }
            }
        }
    }

    /// x·M·y.
    pub fn between(&self, x: &[f64], y: &[f64]) -> f64 {
        dot(&self.times(x), y)
    }
}

/// The mean squared distance of a metric from a wish: per unit of area, so that it has no scale.
pub fn energy(complex: &Complex, wish: &[f64]) -> f64 {
    let of = |h| {
        let wished = complex.coefficients.value(h, wish);
        energy_weight(complex, h) * complex.start[h].distance_squared(wished)
    };
    complex.halfedge_ids().map(of).sum::<f64>() / complex.area()
}

/// What the squared distance of a halfedge's vector counts in [`energy`].
pub fn energy_weight(complex: &Complex, h: HalfedgeId) -> f64 {
    0.5 * complex.cotangent(h).clamp(0.05, 3.0)
}
