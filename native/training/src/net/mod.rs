//! The network of [`orbflow_network::net`] once more, in burn, so that it has gradients.
//!
//! Same parts, same order of parameters; a test compares what the two propose.

mod backend;
#[cfg(any(feature = "wgpu", feature = "cuda"))]
mod cube;
pub mod gated;
pub mod gather;
#[cfg(feature = "ndarray")]
mod ndarray;

use std::sync::{Arc, Mutex};

use burn::module::{Initializer, Module, ModuleVisitor, Param};
use burn::nn::{LayerNorm, LayerNormConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor, TensorData, activation};
use orbflow_network::features::N_FEATURES;
use orbflow_network::neighbours::Neighbours;
use orbflow_network::net::Sizes;
use orbflow_network::pyramid::{Level, Pyramid};
use orbflow_network::relaxation::{BIAS, LEAST_SQUARE};

use gated::gated_sum;
use gather::{Gather, gathered};

/// `x + out(relu(gated sum(norm(x))))`.
#[derive(Module, Debug)]
struct Block {
    norm: LayerNorm,
    rows: Linear,
    out: Linear,
}

/// What one level has.
#[derive(Module, Debug)]
struct Storey {
    enter: Linear,
    down: Vec<Block>,
    up: Vec<Block>,
    join: Linear,
}

/// The network.
#[derive(Module, Debug)]
pub struct BurnNetwork {
    storeys: Vec<Storey>,
    norm: LayerNorm,
    head: Linear,
    /// The gates of all relaxations; none without any.
    gates: Option<Linear>,
}

impl Block {
    fn new(width: usize, device: &Device) -> Self {
        Self {
            norm: LayerNormConfig::new(width).init(device),
            rows: LinearConfig::new(width, 4 * width).init(device),
            out: LinearConfig::new(width, width).init(device),
        }
    }

    fn forward(&self, x: Tensor<2>, graph: &Arc<Neighbours>) -> Tensor<2> {
        let rows = self.rows.forward(self.norm.forward(x.clone()));
        x + self.out.forward(activation::relu(gated_sum(rows, graph)))
    }
}

impl BurnNetwork {
    /// A network with random weights.
    pub fn new(sizes: &Sizes, device: &Device) -> Self {
        let width = sizes.width;
        let blocks = |n: usize| (0..n).map(|_| Block::new(width, device)).collect();
        let storeys = sizes.blocks.iter().map(|&n| Storey {
            enter: LinearConfig::new(N_FEATURES, width).init(device),
            down: blocks(n),
            up: blocks(n),
            join: LinearConfig::new(2 * width, width).init(device),
        });
        // A small head: the first proposal is the radial projection, nearly.
        let small = Initializer::Normal {
            mean: 0.0,
            std: 1e-2 / (width as f64).sqrt(),
        };
        Self {
            storeys: storeys.collect(),
            norm: LayerNormConfig::new(width).init(device),
            head: LinearConfig::new(width, 3)
                .with_initializer(small)
                .init(device),
            gates: (sizes.relaxations > 0)
                .then(|| LinearConfig::new(width, 2 * sizes.relaxations).init(device)),
        }
    }

    /// A network with random weights, the same for the same seed on every device: flex draws them.
    pub fn seeded(sizes: &Sizes, seed: u64, device: &Device) -> Self {
        // Flex has one source of random numbers for the whole process.
        static SOURCE: Mutex<()> = Mutex::new(());
        let _alone = SOURCE.lock();
        let flex = Device::flex().autodiff();
        flex.seed(seed);
        let network = Self::new(sizes, &flex);
        // Parameters are drawn when they are first read; those that were not yet read would be
        // drawn by the other device.
        network.parameters();
        network.fork(device)
    }

    /// All parameters, as [`orbflow_network::net::Network::new`] takes them.
    pub fn parameters(&self) -> Vec<f32> {
        struct List(Vec<f32>);
        impl ModuleVisitor for List {
            fn visit_float<const D: usize>(&mut self, parameter: &Param<Tensor<D>>) {
                self.0.extend(numbers(parameter.val()));
            }
        }
        let mut list = List(Vec::new());
        self.visit(&mut list);
        list.0
    }

    /// A direction per vertex of the finest level, in the frame of the pyramid: not normalised.
    pub fn forward(&self, pyramid: &Pyramid, device: &Device) -> Tensor<2> {
        let n_levels = self.storeys.len();
        assert_eq!(
            n_levels,
            pyramid.levels.len(),
            "levels of network and pyramid"
        );
        let inputs: Vec<Tensor<2>> = pyramid
            .levels
            .iter()
            .map(|level| features_of(level, device))
            .collect();
        // For the vertices of the next finer level, the rows of those that they collapsed into.
        let parents: Vec<Gather> = pyramid
            .levels
            .iter()
            .map(|level| Gather::of_rows(level.parents.clone(), level.graph.n_vertices()))
            .collect();
        let mut kept = Vec::with_capacity(n_levels);
        let mut x = self.storeys[0].enter.forward(inputs[0].clone());
        for (i, (storey, level)) in self.storeys.iter().zip(&pyramid.levels).enumerate() {
            if i > 0 {
                x = pooled(x, &parents[i], device) + storey.enter.forward(inputs[i].clone());
            }
            x = storey
                .down
                .iter()
                .fold(x, |x, block| block.forward(x, &level.graph));
            kept.push(x.clone());
        }
        for (i, (storey, level)) in self.storeys.iter().zip(&pyramid.levels).enumerate().rev() {
            if let Some(parents) = parents.get(i + 1) {
                x = gathered(x, parents);
            }
            x = storey
                .join
                .forward(Tensor::cat(vec![x, kept[i].clone()], 1));
            x = storey
                .up
                .iter()
                .fold(x, |x, block| block.forward(x, &level.graph));
        }
        let known = self.norm.forward(x);
        let radial = unit(inputs[0].clone().narrow(1, 0, 3));
        let places = radial + self.head.forward(known.clone());
        match &self.gates {
            Some(gates) => relaxed(places, &gates.forward(known), &pyramid.levels[0].graph),
            None => places,
        }
    }
}

/// [`orbflow_network::relaxation::relaxed`] in burn.
fn relaxed(mut places: Tensor<2>, gates: &Tensor<2>, graph: &Arc<Neighbours>) -> Tensor<2> {
    let [n, n_gates] = gates.dims();
    let column = |i: usize| gates.clone().narrow(1, i, 1).expand([n, 3]);
    for i in 0..n_gates / 2 {
        let key = column(i).add_scalar(BIAS);
        let from = unit(places);
        let rows = vec![from.clone(), key, column(n_gates / 2 + i), from];
        places = gated_sum(Tensor::cat(rows, 1), graph);
    }
    places
}

/// The directions of vectors, of a length below 1 near the centre.
fn unit(vectors: Tensor<2>) -> Tensor<2> {
    let squares = vectors.clone().powi_scalar(2).sum_dim(1);
    vectors / squares.add_scalar(LEAST_SQUARE).sqrt()
}

/// The numbers of a tensor, by rows.
pub fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    let numbers = tensor.into_data().try_to_vec::<f32>();
    numbers.expect("the network is f32")
}

fn features_of(level: &Level, device: &Device) -> Tensor<2> {
    let shape = [level.graph.n_vertices(), N_FEATURES];
    Tensor::from_data(TensorData::new(level.features.clone(), shape), device)
}

/// The mean over the vertices that collapsed into each vertex of a level, itself among them.
fn pooled(fine: Tensor<2>, parents: &Gather, device: &Device) -> Tensor<2> {
    let children = parents.reversed();
    let counts = children.counts();
    let n = counts.len();
    let counts = Tensor::from_data(TensorData::new(counts, [n, 1]), device);
    gathered(fine, &children) / counts
}
