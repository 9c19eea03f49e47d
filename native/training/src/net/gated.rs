//! The gated sum of [`orbflow_network::gated`] as an operation of burn, with its gradient.
//!
//! [`gated_sum`] is fused into one loop; [`composed`] says the same in burn's operations, five times
//! slower.

use std::sync::Arc;

use burn::backend::Dispatch;
use burn::tensor::{IndexingUpdateOp, Int, Tensor, TensorData, activation};
use orbflow_network::neighbours::Neighbours;

use super::backend::GraphOps;

/// The gated sum over rows [self | key | query | value]; a quarter as wide as they are.
pub fn gated_sum(rows: Tensor<2>, graph: &Arc<Neighbours>) -> Tensor<2> {
    let [n, width] = rows.dims();
    assert!(
        n == graph.n_vertices() && width % 4 == 0,
        "{n} rows of {width}"
    );
    Tensor::from_dispatch(Dispatch::gated_sum(rows.into_dispatch(), graph.clone()))
}

/// The same by gathering and scattering, for any backend; the reference of the fused form.
pub fn composed(rows: &Tensor<2>, graph: &Neighbours) -> Tensor<2> {
    let [_, width] = rows.dims();
    let width = width / 4;
    let device = rows.device();
    let [to, from] = graph.pairs().map(|ids| {
        let n = ids.len();
        Tensor::<1, Int>::from_data(TensorData::new(ids, [n]), &device)
    });
    let [own, key, query, value] = [0, 1, 2, 3].map(|i| rows.clone().narrow(1, i * width, width));
    let gates = activation::sigmoid(key.select(0, to.clone()) + query.select(0, from.clone()));
    own.select_assign(0, to, gates * value.select(0, from), IndexingUpdateOp::Add)
}
