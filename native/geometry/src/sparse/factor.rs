//! L Lᴴ by faer's simplicial factorisation.
//!
//! Its supernodal one is faster on large systems, but adds up in blocks of the processor's caches
//! and in the widest vectors that it has: other bits on another machine.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{LltError, SupernodalThreshold};
use faer::sparse::{FaerError, SparseColMatRef};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side, Spec};

/// A fill-reducing order with the pattern of its factor: the part of the work that matrices with
/// the same pattern share.
#[derive(Clone, Debug)]
pub struct Order(Arc<SymbolicCholesky<u32>>);

/// The factor L of a matrix L Lᴴ over real or complex numbers.
#[derive(Clone, Debug)]
pub(super) struct Factor<T> {
    order: Order,
    values: Vec<T>,
}

impl Order {
    /// Finds the order of matrices with this lower triangle's pattern.
    pub(super) fn of<T>(lower: SparseColMatRef<'_, u32, T>) -> Result<Self, FaerError> {
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..CholeskySymbolicParams::default()
        };
        let ordering = SymmetricOrdering::Amd;
        factorize_symbolic_cholesky(lower.symbolic(), Side::Lower, ordering, parameters)
            .map(|symbolic| Self(Arc::new(symbolic)))
    }

    /// Factorises the matrix with this lower triangle.
    pub(super) fn factorize<T: ComplexField>(
        &self,
        lower: SparseColMatRef<'_, u32, T>,
    ) -> Result<Factor<T>, LltError> {
        let symbolic = &self.0;
        let mut values: Vec<T> = (0..symbolic.len_val()).map(|_| T::zero_impl()).collect();
        let needed = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Spec::default());
        symbolic.factorize_numeric_llt(
            &mut values,
            lower,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(needed)),
            Spec::default(),
        )?;
        let order = self.clone();
        Ok(Factor { order, values })
    }
}

impl<T: ComplexField> Factor<T> {
    /// Solves for every column, in place.
    pub(super) fn solve(&self, columns: MatMut<'_, T>) {
        let symbolic = &self.order.0;
        let needed = symbolic.solve_in_place_scratch::<T>(columns.ncols(), Par::Seq);
        let factor = LltRef::new(symbolic, &self.values);
        let mut memory = MemBuffer::new(needed);
        factor.solve_in_place_with_conj(Conj::No, columns, Par::Seq, MemStack::new(&mut memory));
    }
}
