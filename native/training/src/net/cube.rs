//! Graphs on GPUs, as kernels of `CubeCL`, with a thread for each column of each row.
//!
//! As in [`orbflow_network::gated`], a thread reads neighbours and writes only what is its own: no
//! sum is shared, so the same device finds the same bits again.

use std::sync::Arc;

use burn::backend::Cube;
use burn::backend::ops::{FloatTensorOps, IntTensorOps};
use burn::backend::tensor::{FloatTensor, IntTensor};
use burn::cubecl::prelude::*;
use burn::cubecl::{self, calculate_cube_count_elemwise};
use burn::tensor::{FloatDType, TensorData};
use orbflow_network::neighbours::Neighbours;

use super::backend::GraphOps;
use super::gather::Gather;

type CubeTensor = FloatTensor<Cube>;

impl GraphOps for Cube {
    fn gated_sum(rows: CubeTensor, graph: Arc<Neighbours>) -> CubeTensor {
        let n = graph.n_vertices();
        let width = rows.meta.shape()[1] / 4;
        let sum = Self::float_empty([n, width].into(), &rows.device, FloatDType::F32);
        let [starts, others] = lists(graph.table(), &rows).map(CubeTensor::into_buffer_arg);
        let (count, threads) = grid(&rows, n * width);
        sum_kernel::launch(
            &sum.client,
            count,
            threads,
            rows.into_tensor_arg(),
            starts,
            others,
            sum.clone().into_tensor_arg(),
        );
        sum
    }

    fn gated_sum_backward(
        rows: CubeTensor,
        by_sum: CubeTensor,
        graph: Arc<Neighbours>,
    ) -> CubeTensor {
        let n = graph.n_vertices();
        let width = rows.meta.shape()[1] / 4;
        let by_rows = Self::float_empty([n, 4 * width].into(), &rows.device, FloatDType::F32);
        let [starts, others] = lists(graph.table(), &rows).map(CubeTensor::into_buffer_arg);
        let (count, threads) = grid(&rows, n * width);
        backward_kernel::launch(
            &by_rows.client,
            count,
            threads,
            rows.into_tensor_arg(),
            by_sum.into_tensor_arg(),
            starts,
            others,
            by_rows.clone().into_tensor_arg(),
        );
        by_rows
    }

    fn gathered(rows: CubeTensor, gather: Gather) -> CubeTensor {
        let table = &*gather.to;
        let (n, width) = (table.starts.len() - 1, rows.meta.shape()[1]);
        let sums = Self::float_empty([n, width].into(), &rows.device, FloatDType::F32);
        let lists = lists([&table.starts, &table.rows], &rows);
        let [starts, others] = lists.map(CubeTensor::into_buffer_arg);
        let (count, threads) = grid(&rows, n * width);
        gather_kernel::launch(
            &sums.client,
            count,
            threads,
            rows.into_tensor_arg(),
            starts,
            others,
            sums.clone().into_tensor_arg(),
        );
        sums
    }
}

/// As many threads as there are elements, on the device of some rows.
fn grid(rows: &CubeTensor, n_elements: usize) -> (CubeCount, CubeDim) {
    let threads = CubeDim::new(&rows.client, n_elements);
    let count = calculate_cube_count_elemwise(&rows.client, n_elements, threads);
    (count, threads)
}

/// Where each list starts, and all lists, beside some rows.
fn lists(table: [&[u32]; 2], rows: &CubeTensor) -> [IntTensor<Cube>; 2] {
    table.map(|ids| {
        let n = ids.len();
        Cube::int_from_data(TensorData::new(ids.to_vec(), [n]), &rows.device)
    })
}

#[cube]
fn at(rows: &Tensor<f32>, row: usize, column: usize) -> f32 {
    rows[row * rows.stride(0) + column * rows.stride(1)]
}

/// As on the processor, it is 0 or 1 beyond 30, where the exponential is still finite.
#[cube]
fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + (-clamp(x, -30.0, 30.0)).exp())
}

#[cube(launch)]
fn sum_kernel(rows: &Tensor<f32>, starts: &[u32], others: &[u32], sum: &mut Tensor<f32>) {
    let width = sum.shape(1);
    let (v, c) = (ABSOLUTE_POS / width, ABSOLUTE_POS % width);
    if v < sum.shape(0) {
        let key = at(rows, v, width + c);
        let mut total = at(rows, v, c);
        for i in starts[v]..starts[v + 1] {
            let w = others[i as usize] as usize;
            let gate = sigmoid(key + at(rows, w, 2 * width + c));
            total += gate * at(rows, w, 3 * width + c);
        }
        let place = v * sum.stride(0) + c * sum.stride(1);
        sum[place] = total;
    }
}

#[cube(launch)]
fn gather_kernel(rows: &Tensor<f32>, starts: &[u32], others: &[u32], sums: &mut Tensor<f32>) {
    let width = sums.shape(1);
    let (v, c) = (ABSOLUTE_POS / width, ABSOLUTE_POS % width);
    if v < sums.shape(0) {
        let mut total = 0.0f32;
        for i in starts[v]..starts[v + 1] {
            total += at(rows, others[i as usize] as usize, c);
        }
        let place = v * sums.stride(0) + c * sums.stride(1);
        sums[place] = total;
    }
}

#[cube(launch)]
fn backward_kernel(
    rows: &Tensor<f32>,
    by_sum: &Tensor<f32>,
    starts: &[u32],
    others: &[u32],
    by_rows: &mut Tensor<f32>,
) {
    let width = by_sum.shape(1);
    let (v, c) = (ABSOLUTE_POS / width, ABSOLUTE_POS % width);
    if v < by_sum.shape(0) {
        let key = at(rows, v, width + c);
        let query = at(rows, v, 2 * width + c);
        let value = at(rows, v, 3 * width + c);
        let by_own = at(by_sum, v, c);
        let mut by_key = 0.0f32;
        let mut by_query = 0.0f32;
        let mut by_value = 0.0f32;
        for i in starts[v]..starts[v + 1] {
            let w = others[i as usize] as usize;
            let by_other = at(by_sum, w, c);
            let seen = sigmoid(key + at(rows, w, 2 * width + c));
            by_key += seen * (1.0 - seen) * at(rows, w, 3 * width + c) * by_own;
            let shown = sigmoid(at(rows, w, width + c) + query);
            by_query += shown * (1.0 - shown) * value * by_other;
            by_value += shown * by_other;
        }
        let (row, column) = (v * by_rows.stride(0), by_rows.stride(1));
        by_rows[row + c * column] = by_own;
        by_rows[row + (width + c) * column] = by_key;
        by_rows[row + (2 * width + c) * column] = by_query;
        by_rows[row + (3 * width + c) * column] = by_value;
    }
}
