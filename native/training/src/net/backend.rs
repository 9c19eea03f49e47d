//! The gated sum as an operation of burn's backends.
#![cfg_attr(
    feature = "ndarray",
    expect(
        deprecated,
        reason = "burn-ndarray's makers have deprecated it for burn-flex"
    )
)]

use std::sync::Arc;

use burn::backend::tensor::FloatTensor;
use burn::backend::{Backend, Flex, backend_extension};
use burn::tensor::TensorData;
use orbflow_network::gated as kernel;
use orbflow_network::neighbours::Neighbours;

type FlexTensor = <Flex as burn::backend::BackendTypes>::FloatTensorPrimitive;

/// What a backend must do to run the network fused.
#[backend_extension(
    Flex,
    NdArray: cfg(feature = "ndarray"),
    Cube: cfg(any(feature = "wgpu", feature = "cuda")),
    Autodiff
)]
pub trait GatedOps: Backend {
    /// See [`kernel::gated_sum`].
    fn gated_sum(rows: FloatTensor<Self>, graph: Arc<Neighbours>) -> FloatTensor<Self>;

    /// See [`kernel::gated_sum_backward`].
    fn gated_sum_backward(
        rows: FloatTensor<Self>,
        by_sum: FloatTensor<Self>,
        graph: Arc<Neighbours>,
    ) -> FloatTensor<Self>;
}

/// How many rows there are, and the width of each of the four vectors in one.
pub(super) fn n_and_width(rows: &[f32], graph: &Neighbours) -> [usize; 2] {
    let n = graph.n_vertices();
    [n, rows.len() / n / 4]
}

impl GatedOps for Flex {
    fn gated_sum(rows: FlexTensor, graph: Arc<Neighbours>) -> FlexTensor {
        let rows = rows.to_contiguous();
        let rows = rows.as_slice::<f32>().expect("the network is f32");
        let [n, width] = n_and_width(rows, &graph);
        let sum = kernel::gated_sum(rows, &graph, width);
        FlexTensor::from_data(TensorData::new(sum, [n, width]))
    }

    fn gated_sum_backward(
        rows: FlexTensor,
        by_sum: FlexTensor,
        graph: Arc<Neighbours>,
    ) -> FlexTensor {
        let [rows, by_sum] = [rows, by_sum].map(|tensor| tensor.to_contiguous());
        let [rows, by_sum] =
            [&rows, &by_sum].map(|tensor| tensor.as_slice::<f32>().expect("the network is f32"));
        let [n, width] = n_and_width(rows, &graph);
        let by_rows = kernel::gated_sum_backward(rows, by_sum, &graph, width);
        FlexTensor::from_data(TensorData::new(by_rows, [n, 4 * width]))
    }
}

mod autodiff {
    use burn::backend::Autodiff;
    use burn::backend::autodiff::checkpoint::{base::Checkpointer, strategy::CheckpointStrategy};
    use burn::backend::autodiff::grads::Gradients;
    use burn::backend::autodiff::ops::{Backward, Ops, OpsKind, unary};

    use super::{Arc, Backend, FloatTensor, GatedOps, Neighbours};

    #[derive(Debug)]
    struct GatedSum;

    impl<B: Backend + GatedOps> Backward<B, 1> for GatedSum {
        type State = (FloatTensor<B>, Arc<Neighbours>);

        fn backward(self, ops: Ops<Self::State, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
            let (rows, graph) = ops.state;
            unary::<B, _>(ops.parents, ops.node, grads, |by_sum| {
                B::gated_sum_backward(rows, by_sum, graph)
            });
        }
    }

    impl<B: Backend + GatedOps, C: CheckpointStrategy> GatedOps for Autodiff<B, C> {
        fn gated_sum(rows: FloatTensor<Self>, graph: Arc<Neighbours>) -> FloatTensor<Self> {
            let (rows, node) = rows.into_parts();
            match GatedSum.prepare::<C>([node]).compute_bound().stateful() {
                OpsKind::Tracked(tracked) => {
                    let sum = B::gated_sum(rows.clone(), graph.clone());
                    tracked.finish((rows, graph), sum)
                }
                OpsKind::UnTracked(untracked) => untracked.finish(B::gated_sum(rows, graph)),
            }
        }

        fn gated_sum_backward(
            _: FloatTensor<Self>,
            _: FloatTensor<Self>,
            _: Arc<Neighbours>,
        ) -> FloatTensor<Self> {
            unreachable!("the backward pass runs on the inner backend: no second derivatives")
        }
    }
}
