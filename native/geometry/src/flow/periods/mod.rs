//! The periods of a flat metric: free Gaussian integers that decide every vector.
//!
//! The vectors of a spanning tree of the cones decide all others as sums with Gaussian integer
//! coefficients; one closing equation Σ aⱼ xⱼ = 0 remains. Euclid's algorithm over the Gaussian
//! integers changes the variables so that it says "one of them is 0", exactly: the rest is free,
//! and every choice of it is integral everywhere and closes.

mod equations;
mod gaussian;
mod tree;

use glam::{DVec2, IVec2};
use thiserror::Error;

use super::complex::{Complex, Rows};
use crate::mesh::{FaceId, HalfedgeId};

pub use equations::{Equations, Part, common_divisor, dot, is_unit, real_row};
use gaussian::{norm, product, quotient};

/// The triangles do not close to a sphere, so that their periods are not free.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
#[error("the triangles do not close to one sphere")]
pub struct NotASphere;

/// Values of the free periods: real and imaginary parts in turn.
pub type Periods = Vec<f64>;

/// What the metric and the wish say about the free periods.
#[derive(Clone, PartialEq, Debug)]
pub struct Basis {
    /// The periods of the metric.
    pub start: Periods,
    /// The periods of the wish.
    pub wish: Periods,
}

/// Chooses the free periods and fills in the coefficients of all halfedges.
///
/// Each period is the vector of a short edge; when no coefficient of the closing equation is a
/// unit after division by their common factor (no cone of odd index is a leaf of the tree), some
/// are sums of such vectors. Costs O(halfedges × cones).
///
/// # Errors
/// [`NotASphere`] when the complex is not a connected closed surface of genus 0.
pub fn choose(complex: &mut Complex) -> Result<Basis, NotASphere> {
    let tree = tree::shortest_tree(complex);
    let open = tree::peel(complex, &tree)?;
    let values = |vectors: &dyn Fn(HalfedgeId) -> DVec2| tree.iter().map(|&h| vectors(h)).collect();
    let mut start: Vec<DVec2> = values(&|h| complex.start[h]);
    let mut wish: Vec<DVec2> = values(&|h| complex.wish[h]);
    let mut equation = sum_of_face(complex, open);
    let zero = close(complex, &mut equation, &mut [&mut start, &mut wish]);
    if let Some(zero) = zero {
        complex.coefficients = without_column(complex, zero);
        start.remove(zero);
        wish.remove(zero);
    }
    let flat = |values: Vec<DVec2>| values.iter().flat_map(DVec2::to_array).collect();
    Ok(Basis {
        start: flat(start),
        wish: flat(wish),
    })
}

/// The coefficients of the sum of a face's three vectors.
fn sum_of_face(complex: &Complex, face: FaceId) -> Vec<IVec2> {
    let h = complex.halfedge(face);
    let [a, b, c] = [h, h.next(), h.prev()].map(|e| complex.coefficients.row(e));
    (0..a.len()).map(|i| a[i] + b[i] + c[i]).collect()
}

/// Changes variables until one coefficient of the equation is left; returns its column.
fn close(
    complex: &mut Complex,
    equation: &mut [IVec2],
    values: &mut [&mut Vec<DVec2>; 2],
) -> Option<usize> {
    loop {
        // Of the smallest the last, which is the longest edge: the one least bound to be short.
        let columns = (0..equation.len()).filter(|&j| equation[j] != IVec2::ZERO);
        let pivot = columns.min_by_key(|&j| (norm(equation[j]), usize::MAX - j))?;
        let mut is_left = false;
        for j in (0..equation.len()).filter(|&j| j != pivot) {
            let q = quotient(equation[j], equation[pivot]);
            if q != IVec2::ZERO {
                equation[j] -= product(q, equation[pivot]);
                absorb(complex, pivot, j, q);
                for values in values.iter_mut() {
                    let part = q.as_dvec2().rotate(values[j]);
                    values[pivot] += part;
                }
            }
            is_left |= equation[j] != IVec2::ZERO;
        }
        if !is_left {
            return Some(pivot);
        }
    }
}

/// Replaces the variable of `pivot` by itself plus q times that of `column`.
fn absorb(complex: &mut Complex, pivot: usize, column: usize, q: IVec2) {
    for h in complex.halfedge_ids() {
        let row = complex.coefficients.row_mut(h);
        row[column] -= product(row[pivot], q);
    }
}

fn without_column(complex: &Complex, column: usize) -> Rows {
    let old = &complex.coefficients;
    let mut rows = Rows::new(complex.twins.len(), old.n_columns() - 1);
    for h in complex.halfedge_ids() {
        let [before, after] = [&old.row(h)[..column], &old.row(h)[column + 1..]];
        let row = rows.row_mut(h);
        row[..column].copy_from_slice(before);
        row[column..].copy_from_slice(after);
    }
    rows
}

/// The vector that a row of coefficients makes of the periods.
pub fn evaluate(row: &[IVec2], periods: &[f64]) -> DVec2 {
    let mut sum = DVec2::ZERO;
    for (c, x) in row.iter().zip(periods.as_chunks::<2>().0) {
        if *c != IVec2::ZERO {
            sum += c.as_dvec2().rotate(DVec2::from_array(*x));
        }
    }
    sum
}

#[cfg(test)]
mod tests;
