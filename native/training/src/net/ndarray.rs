//! Graphs on burn-ndarray: the same loops as on flex, on copies of its numbers.
#![expect(
    deprecated,
    reason = "burn-ndarray's makers have deprecated it for burn-flex"
)]

use std::sync::Arc;

use burn::backend::ndarray::NdArrayTensor;
use burn::backend::ops::FloatTensorOps;
use burn::backend::{NdArray, TensorMetadata};
use burn::tensor::{TensorData, read_sync};
use orbflow_network::gated as kernel;
use orbflow_network::neighbours::Neighbours;

use super::backend::{GraphOps, n_and_width};
use super::gather::Gather;

impl GraphOps for NdArray {
    fn gated_sum(rows: NdArrayTensor, graph: Arc<Neighbours>) -> NdArrayTensor {
        let rows = numbers(rows);
        let [n, width] = n_and_width(&rows, &graph);
        let sum = kernel::gated_sum(&rows, &graph, width);
        NdArrayTensor::from_data(TensorData::new(sum, [n, width]))
    }

    fn gated_sum_backward(
        rows: NdArrayTensor,
        by_sum: NdArrayTensor,
        graph: Arc<Neighbours>,
    ) -> NdArrayTensor {
        let [rows, by_sum] = [rows, by_sum].map(numbers);
        let [n, width] = n_and_width(&rows, &graph);
        let by_rows = kernel::gated_sum_backward(&rows, &by_sum, &graph, width);
        NdArrayTensor::from_data(TensorData::new(by_rows, [n, 4 * width]))
    }

    fn gathered(rows: NdArrayTensor, gather: Gather) -> NdArrayTensor {
        let width = rows.shape()[1];
        let sums = gather.to.sums(&numbers(rows), width);
        let n = sums.len() / width;
        NdArrayTensor::from_data(TensorData::new(sums, [n, width]))
    }
}

/// The numbers of a tensor, by rows.
fn numbers(tensor: NdArrayTensor) -> Vec<f32> {
    let data = read_sync(NdArray::float_into_data(tensor)).expect("they are in memory");
    data.try_into_vec().expect("the network is f32")
}
