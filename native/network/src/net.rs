//! The network: a U-Net of residual gated graph convolutions over the collapse hierarchy.
//!
//! ```text
//! x ← x + out(relu(gated sum(rows(norm(x)))))          a block
//! ```
//!
//! Down: a few blocks on each level, then the mean over what collapsed into each vertex. Up: every
//! vertex takes what its parent knows, next to what it knew itself on the way down. The coarsest
//! level sees the whole shape in a few hops. The head adds to the direction of the vertex from the
//! centre, so an untrained network proposes the radial projection, nearly. At last the vertices move
//! towards their neighbours a few times: see [`relaxation`](crate::relaxation).
//!
//! This is prediction alone, in plain loops and matrix products. Training has the same network in
//! burn; a test there compares the two.

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::features::N_FEATURES;
use crate::gated::gated_sum;
use crate::layers::{Linear, Norm, add, join};
use crate::neighbours::Neighbours;
use crate::pyramid::{Level, Pyramid};
use crate::relaxation::{relaxed, unit};

/// The sizes of a network.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sizes {
    /// How many numbers a vertex holds inside.
    pub width: usize,
    /// At most how many vertices each level has, fine to coarse.
    pub levels: Vec<usize>,
    /// How many blocks each level has, on the way down and on the way up alike.
    pub blocks: Vec<usize>,
    /// How many times the vertices at last move towards their neighbours.
    pub relaxations: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self {
            width: 64,
            levels: vec![500, 125, 32],
            blocks: vec![2, 3, 4],
            relaxations: 8,
        }
    }
}

impl Sizes {
    /// How many parameters a network of these sizes has; none when they are too many to count.
    pub fn n_parameters(&self) -> Option<usize> {
        let linear = |n_in: usize, n_out: usize| n_in.checked_add(1)?.checked_mul(n_out);
        let sum = |parts: &[Option<usize>]| {
            let mut parts = parts.iter().copied();
            parts.try_fold(0usize, |sum, part| sum.checked_add(part?))
        };
        let w = self.width;
        let norm = w.checked_mul(2);
        let block = sum(&[norm, linear(w, w.checked_mul(4)?), linear(w, w)])?;
        let storeys = self.blocks.iter().map(|&n| {
            let blocks = n.checked_mul(2)?.checked_mul(block);
            sum(&[linear(N_FEATURES, w), blocks, linear(w.checked_mul(2)?, w)])
        });
        let gates = linear(w, self.relaxations.checked_mul(2)?);
        sum(&[sum(&storeys.collect::<Vec<_>>()), norm, linear(w, 3), gates])
    }
}

#[derive(Clone, PartialEq, Debug)]
struct Block {
    norm: Norm,
    rows: Linear,
    out: Linear,
}

/// What one level has.
#[derive(Clone, PartialEq, Debug)]
struct Storey {
    enter: Linear,
    down: Vec<Block>,
    up: Vec<Block>,
    join: Linear,
}

/// The network.
#[derive(Clone, PartialEq, Debug)]
pub struct Network {
    storeys: Vec<Storey>,
    norm: Norm,
    head: Linear,
    /// The gates of all relaxations; none without any.
    gates: Option<Linear>,
}

impl Network {
    /// The network with these parameters, in the order of its parts: per level enter, down, up and
    /// join, then norm, head and gates; matrices by rows, one row per input. None unless they are
    /// [`Sizes::n_parameters`].
    pub fn new(sizes: &Sizes, parameters: &[f32]) -> Option<Self> {
        if Some(parameters.len()) != sizes.n_parameters() {
            return None;
        }
        let (width, mut rest) = (sizes.width, parameters);
        let mut storeys = Vec::new();
        for &n in &sizes.blocks {
            storeys.push(Storey {
                enter: Linear::take(&mut rest, N_FEATURES, width),
                down: (0..n).map(|_| Block::take(&mut rest, width)).collect(),
                up: (0..n).map(|_| Block::take(&mut rest, width)).collect(),
                join: Linear::take(&mut rest, 2 * width, width),
            });
        }
        Some(Self {
            storeys,
            norm: Norm::take(&mut rest, width),
            head: Linear::take(&mut rest, width, 3),
            gates: (sizes.relaxations > 0)
                .then(|| Linear::take(&mut rest, width, 2 * sizes.relaxations)),
        })
    }

    /// A direction per vertex of the finest level, in the frame of the pyramid: not normalised.
    pub fn forward(&self, pyramid: &Pyramid) -> Vec<DVec3> {
        let levels = &pyramid.levels;
        assert_eq!(self.storeys.len(), levels.len(), "levels of the network");
        let mut kept = Vec::with_capacity(levels.len());
        let mut x = Vec::new();
        for (i, (storey, level)) in self.storeys.iter().zip(levels).enumerate() {
            let entered = storey.enter.forward(&level.features);
            x = if i == 0 {
                entered
            } else {
                add(pooled(&x, level), &entered)
            };
            x = storey
                .down
                .iter()
                .fold(x, |x, b| b.forward(x, &level.graph));
            kept.push(x.clone());
        }
        for (i, (storey, level)) in self.storeys.iter().zip(levels).enumerate().rev() {
            let own = kept.pop().expect("one of each level");
            if let Some(coarser) = levels.get(i + 1) {
                x = handed_down(&x, coarser);
            }
            let width = self.norm.width();
            x = storey.join.forward(&join([&x, &own], width));
            x = storey.up.iter().fold(x, |x, b| b.forward(x, &level.graph));
        }
        let Some(finest) = levels.first() else {
            return Vec::new();
        };
        let known = self.norm.forward(&x);
        let places = moved(&finest.features, &self.head.forward(&known));
        vectors(&match &self.gates {
            Some(gates) => relaxed(places, &gates.forward(&known), &finest.graph),
            None => places,
        })
    }
}

/// The directions of vertices from the centre, moved by offsets.
fn moved(features: &[f32], offsets: &[f32]) -> Vec<f32> {
    let rows = features
        .chunks_exact(N_FEATURES)
        .zip(offsets.chunks_exact(3));
    let place = |(features, offset): (&[f32], &[f32])| {
        let direction = unit(&features[..3]);
        [0, 1, 2].map(|i| direction[i] + offset[i])
    };
    rows.flat_map(place).collect()
}

/// Rows of three numbers as vectors.
fn vectors(rows: &[f32]) -> Vec<DVec3> {
    let rows = rows.chunks_exact(3);
    rows.map(|row| Vec3::from_slice(row).as_dvec3()).collect()
}

impl Block {
    fn take(rest: &mut &[f32], width: usize) -> Self {
        Self {
            norm: Norm::take(rest, width),
            rows: Linear::take(rest, width, 4 * width),
            out: Linear::take(rest, width, width),
        }
    }

    fn forward(&self, x: Vec<f32>, graph: &Neighbours) -> Vec<f32> {
        let rows = self.rows.forward(&self.norm.forward(&x));
        let mut sums = gated_sum(&rows, graph, self.norm.width());
        for sum in &mut sums {
            *sum = sum.max(0.0);
        }
        add(x, &self.out.forward(&sums))
    }
}

/// The mean over the vertices that collapsed into each vertex of a level, itself among them.
fn pooled(fine: &[f32], level: &Level) -> Vec<f32> {
    let n = level.graph.n_vertices();
    let width = fine.len() / level.parents.len().max(1);
    let (mut sums, mut counts) = (vec![0.0; n * width], vec![0.0f32; n]);
    for (row, &parent) in fine.chunks_exact(width.max(1)).zip(&level.parents) {
        let parent = parent as usize;
        counts[parent] += 1.0;
        let sum = &mut sums[parent * width..][..width];
        sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += x);
    }
    for (sum, count) in sums.chunks_exact_mut(width.max(1)).zip(&counts) {
        for sum in sum {
            *sum /= count;
        }
    }
    sums
}

/// For each vertex of the next finer level, what its parent knows.
fn handed_down(coarse: &[f32], level: &Level) -> Vec<f32> {
    let width = coarse.len() / level.graph.n_vertices();
    let mut rows = Vec::with_capacity(level.parents.len() * width);
    for &parent in &level.parents {
        rows.extend_from_slice(&coarse[parent as usize * width..][..width]);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_counted() {
        let sizes = Sizes {
            width: 2,
            levels: vec![8, 4],
            blocks: vec![1, 0],
            relaxations: 3,
        };
        // Two levels of 16 + 10, two blocks of 4 + 24 + 6, the norm, the head and the gates.
        let n = 2 * 26 + 2 * 34 + 4 + 9 + 18;
        assert_eq!(sizes.n_parameters(), Some(n));
        assert!(Network::new(&sizes, &vec![0.5; n]).is_some());
        assert!(Network::new(&sizes, &vec![0.5; n + 1]).is_none());
    }

    #[test]
    fn sizes_beyond_counting_have_no_number() {
        let sizes = Sizes {
            width: usize::MAX / 2,
            ..Sizes::default()
        };
        assert_eq!(sizes.n_parameters(), None);
    }
}
