//! Targets of the thesis: offsets that bring the points of a sphere near to a surface.
//!
//! ```text
//! Chamfer distance + edge · mean |edge|² + normal · mean (1 − cos between neighbouring normals)
//!                  + laplacian · mean |mean of the neighbours − point|
//! ```
//!
//! lowered by Adam. Several points may come to one place and hollows be passed over; that is what the
//! thesis trained on.

use burn::module::{Module, Param};
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::{Device, IndexingUpdateOp, Int, Tensor, TensorData};
use glam::DVec3;
use orbflow_geometry::mesh::{Id, PolygonMesh, TriangleMesh};
use orbflow_geometry::progress::{Cancelled, Progress};
use serde::{Deserialize, Serialize};

use crate::evaluate::rebuilt::samples;
use crate::loss::squared;
use crate::net::numbers;
use crate::settings::{SettingsError, check_count};

/// How targets are made. The weights are the thesis's; it took 80,000 steps, a quarter of them stiff.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Steps of Adam.
    pub n_steps: usize,
    /// Its rate.
    pub rate: f64,
    /// Points of the surface that are compared.
    pub n_samples: usize,
    /// The weight of the edges.
    pub edge: f64,
    /// The weight of the normals.
    pub normal: f64,
    /// The weight of the Laplacian in the first quarter of the steps, and after it.
    pub laplacian: [f64; 2],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            n_steps: 400,
            rate: 1e-2,
            n_samples: 800,
            edge: 1.0,
            normal: 0.1,
            laplacian: [0.5, 0.1],
        }
    }
}

impl Settings {
    /// Checks that targets can be made so.
    ///
    /// # Errors
    /// [`SettingsError`].
    pub fn check(&self) -> Result<(), SettingsError> {
        check_count("chamfer.n_samples", self.n_samples)?;
        let [stiff, soft] = self.laplacian;
        let weights = [
            ("chamfer.edge", self.edge),
            ("chamfer.normal", self.normal),
            ("chamfer.laplacian", stiff),
            ("chamfer.laplacian", soft),
        ];
        let is_rate = (0.0..1.0).contains(&self.rate);
        let rate = (!is_rate).then_some(("chamfer.rate", self.rate, "0 or more and less than 1"));
        let is_wrong = |(_, weight): &(&str, f64)| !(weight.is_finite() && *weight >= 0.0);
        let weight = weights.into_iter().find(is_wrong);
        match rate.or(weight.map(|(name, weight)| (name, weight, "a number of 0 or more"))) {
            None => Ok(()),
            Some((name, found, wanted)) => Err(SettingsError::Range {
                name,
                found: found.to_string(),
                wanted,
            }),
        }
    }
}

#[derive(Module, Debug)]
struct Offsets {
    offsets: Param<Tensor<2>>,
}

/// Three numbers for each point of the sphere.
///
/// # Errors
/// [`Cancelled`].
pub fn offsets(
    sphere: &PolygonMesh,
    surface: &[[DVec3; 3]],
    settings: &Settings,
    progress: &Progress,
) -> Result<Vec<f32>, Cancelled> {
    let device = Device::flex().autodiff();
    let surface = samples(surface, settings.n_samples);
    let problem = Problem::new(sphere, &surface, &device);
    let n = sphere.n_vertices();
    let mut moved = Offsets {
        offsets: Param::from_tensor(Tensor::zeros([n, 3], &device)),
    };
    let mut optimizer = AdamConfig::new().init();
    for step in 0..settings.n_steps {
        progress.check()?;
        let is_stiff = 4 * step < settings.n_steps;
        let laplacian = settings.laplacian[usize::from(!is_stiff)];
        let loss = problem.loss(moved.offsets.val(), (settings, laplacian));
        let gradients = GradientsParams::from_grads(loss.backward(), &moved);
        moved = optimizer.step(settings.rate, moved, gradients);
    }
    Ok(numbers(moved.offsets.val()))
}

/// What does not change from step to step.
struct Problem {
    sphere: Tensor<2>,
    surface: Tensor<2>,
    /// The same once more, for the search.
    points: Vec<[f32; 3]>,
    edges: [Tensor<1, Int>; 2],
    faces: [Tensor<1, Int>; 3],
    /// Faces that share an edge.
    pairs: [Tensor<1, Int>; 2],
    /// How many neighbours each point has.
    valence: Tensor<2>,
}

impl Problem {
    fn new(sphere: &PolygonMesh, surface: &[DVec3], device: &Device) -> Self {
        let faces: Vec<_> = sphere.faces().map(|f| [f[0], f[1], f[2]]).collect();
        let mesh = TriangleMesh::new(sphere.positions().to_vec(), faces.clone());
        let mesh = mesh.expect("an icosphere is a mesh");
        let twins = mesh.halfedge_ids().filter_map(|h| Some((h, mesh.twin(h)?)));
        let twins: Vec<_> = twins.filter(|(h, twin)| h < twin).collect();
        let ids = |list: Vec<usize>| {
            let list: Vec<i64> = list.into_iter().map(|i| i as i64).collect();
            let n = list.len();
            Tensor::<1, Int>::from_data(TensorData::new(list, [n]), device)
        };
        let rows = |points: &[DVec3]| {
            let numbers: Vec<f32> = points.iter().flat_map(|p| p.as_vec3().to_array()).collect();
            Tensor::<2>::from_data(TensorData::new(numbers, [points.len(), 3]), device)
        };
        let valences = mesh
            .vertex_ids()
            .map(|v| mesh.valence(v) as f32)
            .collect::<Vec<_>>();
        let n = valences.len();
        Self {
            sphere: rows(sphere.positions()),
            surface: rows(surface),
            points: surface.iter().map(|p| p.as_vec3().to_array()).collect(),
            edges: [
                ids(twins.iter().map(|(h, _)| mesh.origin(*h).index()).collect()),
                ids(twins.iter().map(|(h, _)| mesh.target(*h).index()).collect()),
            ],
            faces: [0, 1, 2].map(|i| ids(faces.iter().map(|f| f[i].index()).collect())),
            pairs: [
                ids(twins.iter().map(|(h, _)| h.face().index()).collect()),
                ids(twins.iter().map(|(_, twin)| twin.face().index()).collect()),
            ],
            valence: Tensor::from_data(TensorData::new(valences, [n, 1]), device),
        }
    }

    fn loss(&self, offsets: Tensor<2>, (settings, laplacian): (&Settings, f64)) -> Tensor<1> {
        let q = self.sphere.clone() + offsets;
        let [a, b] = self.edges.clone().map(|ids| q.clone().select(0, ids));
        let edges = squared(a - b).mean();
        self.chamfer(&q)
            + edges.mul_scalar(settings.edge)
            + self.bends(&q).mul_scalar(settings.normal)
            + self.roughness(q).mul_scalar(laplacian)
    }

    /// Mean squared distances, both ways.
    fn chamfer(&self, q: &Tensor<2>) -> Tensor<1> {
        let there: Vec<[f32; 3]> = numbers(q.clone().inner())
            .chunks_exact(3)
            .map(|p| [p[0], p[1], p[2]])
            .collect();
        let [to_surface, to_points] = nearest(&there, &self.points);
        let device = q.device();
        let ids = |list: Vec<i64>| {
            let n = list.len();
            Tensor::<1, Int>::from_data(TensorData::new(list, [n]), &device)
        };
        let there = self.surface.clone().select(0, ids(to_surface));
        let back = q.clone().select(0, ids(to_points));
        squared(q.clone() - there).mean() + squared(self.surface.clone() - back).mean()
    }

    /// The mean of 1 − cos between the normals of neighbouring faces.
    fn bends(&self, q: &Tensor<2>) -> Tensor<1> {
        let [a, b, c] = self.faces.clone().map(|ids| q.clone().select(0, ids));
        let normals = cross(&(b - a.clone()), &(c - a));
        let length = squared(normals.clone()).add_scalar(1e-12).sqrt();
        let normals = normals / length;
        let [m, n] = self.pairs.clone().map(|ids| normals.clone().select(0, ids));
        (m * n).sum_dim(1).neg().add_scalar(1.0).mean()
    }

    /// The mean distance of points from the middle of their neighbours.
    fn roughness(&self, q: Tensor<2>) -> Tensor<1> {
        let [a, b] = self.edges.clone();
        let sums = Tensor::zeros(q.dims(), &q.device());
        let [at_a, at_b] = [a.clone(), b.clone()].map(|ids| q.clone().select(0, ids));
        let sums = sums
            .select_assign(0, a, at_b, IndexingUpdateOp::Add)
            .select_assign(0, b, at_a, IndexingUpdateOp::Add);
        let away = sums / self.valence.clone() - q;
        squared(away).add_scalar(1e-12).sqrt().mean()
    }
}

fn cross(p: &Tensor<2>, q: &Tensor<2>) -> Tensor<2> {
    let column = |rows: &Tensor<2>, i: usize| rows.clone().narrow(1, i, 1);
    let minor = |i: usize, j: usize| column(p, i) * column(q, j) - column(p, j) * column(q, i);
    Tensor::cat(vec![minor(1, 2), minor(2, 0), minor(0, 1)], 1)
}

/// For each of some points the nearest of others, and the other way round.
fn nearest(some: &[[f32; 3]], others: &[[f32; 3]]) -> [Vec<i64>; 2] {
    let mut back = vec![(f32::INFINITY, 0i64); others.len()];
    let there = some.iter().enumerate().map(|(i, p)| {
        let mut best = (f32::INFINITY, 0i64);
        for (j, (q, back)) in others.iter().zip(&mut back).enumerate() {
            let [x, y, z] = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let d = x * x + y * y + z * z;
            if d < best.0 {
                best = (d, j as i64);
            }
            if d < back.0 {
                *back = (d, i as i64);
            }
        }
        best.1
    });
    let there = there.collect();
    [there, back.into_iter().map(|(_, i)| i).collect()]
}

#[cfg(test)]
mod tests {
    use orbflow_geometry::sphere::icosphere;

    use super::*;

    fn ellipsoid() -> Vec<[DVec3; 3]> {
        let ball = icosphere(8);
        let stretched =
            |v: orbflow_geometry::mesh::VertexId| ball.position(v) * DVec3::new(1.0, 0.6, 0.4);
        ball.faces()
            .map(|f| [f[0], f[1], f[2]].map(stretched))
            .collect()
    }

    #[test]
    fn an_ellipsoid_is_reached() {
        let sphere = icosphere(5);
        let settings = Settings {
            n_steps: 200,
            ..Settings::default()
        };
        let offsets = offsets(&sphere, &ellipsoid(), &settings, &Progress::none()).unwrap();
        let points = sphere.positions().iter().zip(offsets.chunks_exact(3));
        let away = points.map(|(p, o)| {
            let q = *p + DVec3::new(o[0].into(), o[1].into(), o[2].into());
            ((q / DVec3::new(1.0, 0.6, 0.4)).length() - 1.0).abs()
        });
        let mean = away.sum::<f64>() / sphere.n_vertices() as f64;
        assert!(mean < 0.06, "{mean}");
    }

    #[test]
    fn the_gradient_is_that_of_central_differences() {
        let sphere = icosphere(3);
        let device = Device::flex().autodiff();
        let settings = Settings::default();
        let problem = Problem::new(&sphere, &samples(&ellipsoid(), 200), &device);
        let n = sphere.n_vertices();
        let value = |offsets: &[f32]| {
            let rows = TensorData::new(offsets.to_vec(), [n, 3]);
            let rows = Tensor::<2>::from_data(rows, &device).require_grad();
            let loss = problem.loss(rows.clone(), (&settings, 0.5));
            let value = loss.clone().into_scalar::<f32>();
            let gradient = rows
                .grad(&loss.backward())
                .expect("offsets have a gradient");
            (value, numbers(gradient))
        };
        let mut random = orbflow_geometry::random::Random::new(1);
        let offsets: Vec<f32> = (0..3 * n).map(|_| 0.1 * random.unit() as f32).collect();
        let (_, gradient) = value(&offsets);
        for at in (0..3 * n).step_by(17) {
            let [up, down] = [1e-2, -1e-2].map(|step| {
                let mut moved = offsets.clone();
                moved[at] += step;
                value(&moved).0
            });
            let slope = (up - down) / 2e-2;
            assert!(
                (slope - gradient[at]).abs() < 2e-3,
                "{at}: {slope} {}",
                gradient[at]
            );
        }
    }
}
