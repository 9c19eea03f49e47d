//! Twelve gated graph convolutions in three blocks.

use std::sync::Arc;

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, LayerNorm, LayerNormConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor, activation};
use orbflow_network::neighbours::Neighbours;

use crate::net::gated::gated_sum;

/// Position and normal.
pub const N_INPUTS: usize = 6;
const N_BLOCKS: usize = 3;
const LAYERS_OF_BLOCK: usize = 4;

/// `dropout(norm(relu(gated sum(…)) four times))`.
#[derive(Module, Debug)]
struct Block {
    rows: Vec<Linear>,
    norm: LayerNorm,
    dropout: Dropout,
}

/// The network of the thesis: an offset for each vertex.
#[derive(Module, Debug)]
pub struct ThesisNetwork {
    blocks: Vec<Block>,
    head: Linear,
}

impl ThesisNetwork {
    /// A network with random weights.
    pub fn new(width: usize, dropout: f64, device: &Device) -> Self {
        let rows = |first: bool| {
            let n_in = if first { N_INPUTS } else { width };
            LinearConfig::new(n_in, 4 * width).init(device)
        };
        let blocks = (0..N_BLOCKS).map(|b| Block {
            rows: (0..LAYERS_OF_BLOCK).map(|i| rows(b + i == 0)).collect(),
            norm: LayerNormConfig::new(width).init(device),
            dropout: DropoutConfig::new(dropout).init(),
        });
        Self {
            blocks: blocks.collect(),
            head: LinearConfig::new(width, 3).init(device),
        }
    }

    /// An offset for each vertex.
    pub fn forward(&self, inputs: Tensor<2>, graph: &Arc<Neighbours>) -> Tensor<2> {
        let through = |x: Tensor<2>, block: &Block| {
            let layers = block.rows.iter();
            let x = layers.fold(x, |x, rows| {
                activation::relu(gated_sum(rows.forward(x), graph))
            });
            block.dropout.forward(block.norm.forward(x))
        };
        self.head.forward(self.blocks.iter().fold(inputs, through))
    }
}
