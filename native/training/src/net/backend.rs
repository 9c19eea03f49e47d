//! What a graph network needs of burn's backends beside burn's own operations.
#![cfg_attr(
    feature = "ndarray",
    expect(
        deprecated,
        reason = "burn-ndarray's makers have deprecated it for burn-flex"
    )
)]

use std::sync::Arc;

use burn::backend::tensor::FloatTensor;
use burn::backend::{Backend, Flex, TensorMetadata, backend_extension};
use burn::tensor::TensorData;
use orbflow_network::gated as kernel;
use orbflow_network::neighbours::Neighbours;

use super::gather::Gather;

type FlexTensor = <Flex as burn::backend::BackendTypes>::FloatTensorPrimitive;

/// What a backend must do to run the network fused.
#[backend_extension(
    Flex,
    NdArray: cfg(feature = "ndarray"),
    Cube: cfg(any(feature = "wgpu", feature = "cuda")),
    Autodiff
)]
pub trait GraphOps: Backend {
    /// See [`kernel::gated_sum`].
    fn gated_sum(rows: FloatTensor<Self>, graph: Arc<Neighbours>) -> FloatTensor<Self>;

    /// See [`kernel::gated_sum_backward`].
    fn gated_sum_backward(
        rows: FloatTensor<Self>,
        by_sum: FloatTensor<Self>,
        graph: Arc<Neighbours>,
    ) -> FloatTensor<Self>;

    /// See [`super::gather::gathered`].
    fn gathered(rows: FloatTensor<Self>, gather: Gather) -> FloatTensor<Self>;
}

/// How many rows there are, and the width of each of the four vectors in one.
pub(super) fn n_and_width(rows: &[f32], graph: &Neighbours) -> [usize; 2] {
    let n = graph.n_vertices();
    [n, rows.len() / n / 4]
}

impl GraphOps for Flex {
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

    fn gathered(rows: FlexTensor, gather: Gather) -> FlexTensor {
        let rows = rows.to_contiguous();
        let width = rows.shape()[1];
        let sums = gather
            .to
            .sums(rows.as_slice().expect("the network is f32"), width);
        let n = sums.len() / width;
        FlexTensor::from_data(TensorData::new(sums, [n, width]))
    }
}

mod autodiff {
    use burn::backend::Autodiff;
    use burn::backend::autodiff::checkpoint::{base::Checkpointer, strategy::CheckpointStrategy};
    use burn::backend::autodiff::grads::Gradients;
    use burn::backend::autodiff::ops::{Backward, Ops, OpsKind, unary};

    use super::{Arc, Backend, FloatTensor, Gather, GraphOps, Neighbours};

    #[derive(Debug)]
    struct GatedSum;

    impl<B: Backend + GraphOps> Backward<B, 1> for GatedSum {
        type State = (FloatTensor<B>, Arc<Neighbours>);

        fn backward(self, ops: Ops<Self::State, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
            let (rows, graph) = ops.state;
            unary::<B, _>(ops.parents, ops.node, grads, |by_sum| {
                B::gated_sum_backward(rows, by_sum, graph)
            });
        }
    }

    #[derive(Debug)]
    struct Gathered;

    impl<B: Backend + GraphOps> Backward<B, 1> for Gathered {
        type State = Gather;

        fn backward(self, ops: Ops<Gather, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
            let back = ops.state.reversed();
            unary::<B, _>(ops.parents, ops.node, grads, |by_sums| {
                B::gathered(by_sums, back)
            });
        }
    }

    impl<B: Backend + GraphOps, C: CheckpointStrategy> GraphOps for Autodiff<B, C> {
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

        fn gathered(rows: FloatTensor<Self>, gather: Gather) -> FloatTensor<Self> {
            let (rows, node) = rows.into_parts();
            match Gathered.prepare::<C>([node]).compute_bound().stateful() {
                OpsKind::Tracked(tracked) => {
                    tracked.finish(gather.clone(), B::gathered(rows, gather))
                }
                OpsKind::UnTracked(untracked) => untracked.finish(B::gathered(rows, gather)),
            }
        }
    }
}
