//! The fused operation against the composed one, and against differences.

use std::sync::Arc;

use burn::tensor::{Device, Tensor, TensorData};
use orbflow_geometry::random::Random;
use orbflow_geometry::sphere::icosphere;
use orbflow_network::neighbours::Neighbours;
use orbflow_network::net::{Network, Sizes};
use orbflow_training::net::gated::{composed, gated_sum};
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
    let n = weights.len() / WIDTH;
    let tensor = |values: &[f32], width: usize| {
        Tensor::<2>::from_data(TensorData::new(values.to_vec(), [n, width]), &device)
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
