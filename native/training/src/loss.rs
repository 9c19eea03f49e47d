//! What training lowers: the distortion of the proposed map, folds included.
//!
//! Per triangle, d is the ratio of its areas on sphere and surface and g its Dirichlet density; the
//! loss is the mean of log(1 + g (1 + 1/d²)) over the surface. No targets: every map of little
//! distortion will do. A map of degree 1 covers the sphere once, folds counted negative; what a map
//! of a sample lacks of that is added squared.

use burn::tensor::{Device, Tensor, TensorData};

use crate::net::gather::{Gather, gathered};
use crate::sample::Sample;

/// Ratios below about this are folds, or nearly. They keep a gradient: the barrier goes on, ever
/// more slowly, instead of ending.
const LEAST_RATIO: f32 = 0.01;
/// What a map that covers nothing of the sphere costs besides. The bounded barrier alone would make
/// one point of the whole surface the best map of all.
const COVERAGE: f32 = 10.0;

/// The faces of some samples side by side, as tensors.
#[derive(Clone, Debug)]
pub struct Faces {
    corners: [Gather; 3],
    dirichlet: Tensor<2>,
    per_area: Tensor<2>,
    /// The share of each face in the surface of its sample.
    share: Tensor<2>,
    /// The faces of each sample.
    of_samples: Gather,
    n_samples: usize,
}

impl Faces {
    /// The faces of samples whose pyramids are joined in the same order.
    pub fn new(samples: &[&Sample], device: &Device) -> Self {
        let mut corners = [const { Vec::new() }; 3];
        let mut n_before = 0;
        for sample in samples {
            for face in sample.mesh.faces() {
                for (list, v) in corners.iter_mut().zip(face) {
                    list.push(n_before + v.0);
                }
            }
            n_before += sample.mesh.n_vertices() as u32;
        }
        let rests = || samples.iter().flat_map(|sample| &sample.rests);
        let n = rests().count();
        let column = |values: Vec<f32>, width: usize| {
            Tensor::<2>::from_data(TensorData::new(values, [n, width]), device)
        };
        let owners = samples.iter().enumerate();
        let owners = owners.flat_map(|(i, sample)| vec![i as u32; sample.rests.len()]);
        let owners = Gather::of_rows(owners.collect(), samples.len());
        Self {
            corners: corners.map(|list| Gather::of_rows(list, n_before as usize)),
            dirichlet: column(rests().flat_map(|rest| rest.dirichlet).collect(), 3),
            per_area: column(rests().map(|rest| rest.per_area).collect(), 1),
            share: column(rests().map(|rest| rest.share).collect(), 1),
            of_samples: owners.reversed(),
            n_samples: samples.len(),
        }
    }

    /// The mean distortion over the samples of directions of any length.
    pub fn loss(&self, directions: Tensor<2>) -> Tensor<1> {
        let length = squared(directions.clone()).add_scalar(1e-12).sqrt();
        let sphere = directions / length;
        let [p, q, r] = [0, 1, 2].map(|i| gathered(sphere.clone(), &self.corners[i]));
        let opposite = [(&q, &r), (&r, &p), (&p, &q)].map(|(a, b)| squared(a.clone() - b.clone()));
        let density = (Tensor::cat(opposite.to_vec(), 1) * self.dirichlet.clone()).sum_dim(1);
        let ratio = determinant([p, q, r]) * self.per_area.clone();
        let inverse = bounded(ratio.clone()).recip();
        // No triangle of the area ratio d has a density below 2d, so none counts less than at the
        // bound.
        let squeezed = density.clone().add_scalar(2.0 * LEAST_RATIO) * inverse.clone() * inverse;
        let distortion = ((density + squeezed).log1p() * self.share.clone()).sum();
        let n = self.n_samples as f32;
        let covered = gathered(ratio * self.share.clone(), &self.of_samples);
        let missing = covered.neg().add_scalar(1.0);
        (distortion + squared(missing).sum().mul_scalar(COVERAGE)).div_scalar(n)
    }
}

/// The squared length of every row.
pub fn squared(rows: Tensor<2>) -> Tensor<2> {
    (rows.clone() * rows).sum_dim(1)
}

fn determinant([p, q, r]: [Tensor<2>; 3]) -> Tensor<2> {
    let column = |rows: &Tensor<2>, i: usize| rows.clone().narrow(1, i, 1);
    let minor = |i: usize, j: usize| column(&q, i) * column(&r, j) - column(&q, j) * column(&r, i);
    column(&p, 0) * minor(1, 2) + column(&p, 1) * minor(2, 0) + column(&p, 2) * minor(0, 1)
}

/// ½ (d + √(d² + 4ε²)): d where it is large, small and positive where it is not.
fn bounded(ratio: Tensor<2>) -> Tensor<2> {
    let square = LEAST_RATIO * LEAST_RATIO;
    let size = ratio.clone().abs();
    let root = (size.clone() * size.clone())
        .add_scalar(4.0 * square)
        .sqrt();
    let above = (size + root).mul_scalar(0.5);
    // For d < 0 the same number without the difference of equals.
    let below = above.clone().recip().mul_scalar(square);
    above.mask_where(ratio.lower_elem(0.0), below)
}
