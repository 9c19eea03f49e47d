//! The fused operation against the composed one, and against differences.

use std::sync::Arc;

use burn::tensor::{Device, IndexingUpdateOp, Int, Tensor, TensorData};
use orbflow_geometry::random::Random;
use orbflow_geometry::sphere::icosphere;
use orbflow_network::neighbours::Neighbours;
use orbflow_network::net::{Network, Sizes};
use orbflow_training::net::gated::{composed, gated_sum};
use orbflow_training::net::gather::{Gather, gathered};
use orbflow_training::net::{BurnNetwork, numbers};
use orbflow_training::sample::Sample;
use orbflow_training::shapes::shape;

const WIDTH: usize = 5;

fn graph() -> Arc<Neighbours> {
    let ball = icosphere(4);
    let faces: Vec<_> = ball.faces().map(|f| [f[0], f[1], f[2]]).collect();
    Arc::new(Neighbours::of_faces(ball.n_vertices(), &faces))
}

fn random(n: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..n).map(|_| (random.unit() * 4.0 - 2.0) as f32).collect()
}

/// The sum of `weights` times the operation, and its gradient by the rows.
fn weighted(
    rows: &[f32],
    weights: &[f32],
    operation: impl Fn(Tensor<2>) -> Tensor<2>,
) -> (f32, Vec<f32>) {
    let device = Device::flex().autodiff();
    let tensor = |values: &[f32], width: usize| {
        let shape = [values.len() / width, width];
        Tensor::<2>::from_data(TensorData::new(values.to_vec(), shape), &device)
    };
    let rows = tensor(rows, 4 * WIDTH).require_grad();
    let sum = (operation(rows.clone()) * tensor(weights, WIDTH)).sum();
    let value = sum.clone().into_scalar::<f32>();
    let gradient = rows
        .grad(&sum.backward())
        .expect("the rows have a gradient");
    (value, numbers(gradient))
}

#[test]
fn fused_and_composed_agree_in_value_and_gradient() {
    let graph = graph();
    let n = graph.n_vertices();
    let (rows, weights) = (random(n * 4 * WIDTH, 1), random(n * WIDTH, 2));
    let (value, gradient) = weighted(&rows, &weights, |rows| gated_sum(rows, &graph));
    let (wanted, wanted_gradient) = weighted(&rows, &weights, |rows| composed(&rows, &graph));
    assert!(
        (value - wanted).abs() < 1e-3 * wanted.abs().max(1.0),
        "{value} {wanted}"
    );
    for (found, wanted) in gradient.iter().zip(&wanted_gradient) {
        assert!((found - wanted).abs() < 1e-5, "{found} {wanted}");
    }
}

#[test]
fn the_gradient_is_that_of_central_differences() {
    let graph = graph();
    let n = graph.n_vertices();
    let (rows, weights) = (random(n * 4 * WIDTH, 3), random(n * WIDTH, 4));
    let (_, gradient) = weighted(&rows, &weights, |rows| gated_sum(rows, &graph));
    let mut random = Random::new(5);
    for _ in 0..60 {
        let at = random.below(rows.len());
        let value = |step: f32| {
            let mut moved = rows.clone();
            moved[at] += step;
            weighted(&moved, &weights, |rows| gated_sum(rows, &graph)).0
        };
        let slope = (value(0.05) - value(-0.05)) / 0.1;
        assert!(
            (slope - gradient[at]).abs() < 2e-2,
            "{at}: {slope} {}",
            gradient[at]
        );
    }
}

#[test]
fn gathered_rows_and_sums_are_what_burn_selects_and_adds() {
    // Some rows twice, some never; the width is that of the rows of `weighted`.
    let (ids, n) = ([3u32, 0, 3, 5, 1, 3, 7], 8);
    let gather = Gather::of_rows(ids.to_vec(), n);
    let device = Device::flex();
    let numbers_of = TensorData::new(ids.map(i64::from).to_vec(), [ids.len()]);
    let at = Tensor::<1, Int>::from_data(numbers_of, &device);
    let narrow = |rows: Tensor<2>| rows.narrow(1, 0, WIDTH);
    let (rows, weights) = (random(n * 4 * WIDTH, 6), random(ids.len() * WIDTH, 7));
    let found = weighted(&rows, &weights, |rows| gathered(narrow(rows), &gather));
    let wanted = weighted(&rows, &weights, |rows| narrow(rows).select(0, at.clone()));
    assert_eq!(found, wanted);

    let (rows, weights) = (random(ids.len() * 4 * WIDTH, 8), random(n * WIDTH, 9));
    let found = weighted(&rows, &weights, |rows| {
        gathered(narrow(rows), &gather.reversed())
    });
    let wanted = weighted(&rows, &weights, |rows| {
        let zeros = Tensor::zeros([n, WIDTH], &rows.device());
        zeros.select_assign(0, at.clone(), narrow(rows), IndexingUpdateOp::Add)
    });
    assert_eq!(found, wanted);
    assert_eq!(
        gather.reversed().counts(),
        [1.0, 1.0, 0.0, 3.0, 0.0, 1.0, 0.0, 1.0]
    );
}

#[test]
fn prediction_and_training_have_the_same_network() {
    let sizes = Sizes {
        width: 24,
        ..Sizes::default()
    };
    let device = Device::flex();
    device.seed(6);
    let trained = BurnNetwork::new(&sizes, &device);
    let sample = Sample::new(String::new(), shape(1), &sizes.levels).unwrap();
    let pyramid = &sample.prepared.pyramid;
    let wanted = numbers(trained.forward(pyramid, &device));
    let network = Network::new(&sizes, &trained.parameters()).unwrap();
    let found = network.forward(pyramid);
    assert_eq!(3 * found.len(), wanted.len());
    for (p, q) in found.iter().zip(wanted.chunks_exact(3)) {
        for (x, y) in p.to_array().iter().zip(q) {
            assert!((x - f64::from(*y)).abs() < 1e-4, "{p} {q:?}");
        }
    }
}
