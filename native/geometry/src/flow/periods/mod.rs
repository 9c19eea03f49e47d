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
use crate::mesh::{FaceId, HalfedgeId, Id};

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
    let (mut rows, open) = tree::peel(complex, &tree)?;
    let values = |vectors: &dyn Fn(HalfedgeId) -> DVec2| tree.iter().map(|&h| vectors(h)).collect();
    let mut start: Vec<DVec2> = values(&|h| complex.start[h]);
    let mut wish: Vec<DVec2> = values(&|h| complex.wish[h]);
    if let Some(zero) = close(&mut rows, open, &mut [&mut start, &mut wish]) {
        start.remove(zero);
        wish.remove(zero);
        for row in &mut rows {
            row.remove(zero);
        }
    }
    complex.coefficients = sparse(complex, &rows, start.len());
    let flat = |values: Vec<DVec2>| values.iter().flat_map(DVec2::to_array).collect();
    Ok(Basis {
        start: flat(start),
        wish: flat(wish),
    })
}

/// Changes variables until one coefficient of the closing equation, the sum over a face, is left;
/// returns its column.
fn close(
    rows: &mut [Vec<IVec2>],
    face: FaceId,
    values: &mut [&mut Vec<DVec2>; 2],
) -> Option<usize> {
    let [a, b, c] = [0, 1, 2].map(|i| &rows[3 * face.index() + i]);
    let mut equation: Vec<IVec2> = (0..a.len()).map(|j| a[j] + b[j] + c[j]).collect();
    loop {
        // Of the smallest the last, which is the longest edge: the one least bound to be short.
        let columns = (0..equation.len()).filter(|&j| equation[j] != IVec2::ZERO);
        let pivot = columns.min_by_key(|&j| (norm(equation[j]), usize::MAX - j))?;
        let mut is_left = false;
        for j in (0..equation.len()).filter(|&j| j != pivot) {
            let q = quotient(equation[j], equation[pivot]);
            if q != IVec2::ZERO {
                let part = product(q, equation[pivot]);
                equation[j] -= part;
                // The variable of the pivot becomes itself plus q times the other.
                for row in &mut *rows {
                    let part = product(row[pivot], q);
                    row[j] -= part;
                }
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

fn sparse(complex: &Complex, rows: &[Vec<IVec2>], n_columns: usize) -> Rows {
    let mut sparse = Rows::new(complex.twins.len(), n_columns);
    for h in complex.halfedge_ids() {
        let twin = complex.twins[h];
        if h < twin {
            sparse.set([h, twin], complex.turns[h], &rows[h.index()]);
        }
    }
    sparse
}

#[cfg(test)]
mod tests;
