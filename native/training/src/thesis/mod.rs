//! The pipeline of a thesis of 2024, as the baseline that the network here is measured against.
//!
//! A sphere of even points, as many as the mesh has, is to become the mesh: a graph network reads
//! positions and normals of the mesh and says for the vertex `i` how far the point `i` of the sphere
//! is to move. What it learns from are offsets that lower the Chamfer distance to the mesh, see
//! [`chamfer`]. Nothing ties the numbers of the mesh to those of the sphere; `docs/method.md` says why
//! that cannot be learnt. Meshes have as many vertices as a small icosphere, taken from the collapse
//! hierarchy; the thesis had whole ones, wider layers and many more steps: see [`Settings`].

pub mod chamfer;
mod net;

use std::borrow::Cow;
use std::collections::BTreeMap;

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::{Device, Tensor, TensorData};
use glam::{DMat3, DVec3};
use orbflow_geometry::hierarchy::{CollapseHierarchy, HierarchyError};
use orbflow_geometry::mesh::{Id, PolygonMesh};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_geometry::random::Random;
use orbflow_geometry::sphere::icosphere;
use orbflow_network::features::N_FEATURES;
use orbflow_network::pyramid::{Level, Prepared};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::net::numbers;
use crate::sample::Sample;
use crate::settings::SettingsError;
use net::{N_INPUTS, ThesisNetwork};

/// Of the icosphere: 492 points.
const FREQUENCY: u32 = 7;

/// The size of the baseline. The thesis's own: width 256, a rate of 1e-5, some 400 epochs of 300 shapes,
/// 80,000 steps of Chamfer, the first 20,000 of them stiff. A network that sees a fiftieth of the steps
/// does not move at that rate; here it is a hundred times as high, so that shapes can be remembered.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// How many numbers a vertex holds inside.
    pub width: usize,
    /// Steps of training, a shape each.
    pub n_steps: usize,
    /// The learning rate.
    pub rate: f64,
    /// The share of numbers that dropout takes.
    pub dropout: f64,
    /// How targets are made.
    pub chamfer: chamfer::Settings,
    /// Where random choices start.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 64,
            n_steps: 2_000,
            rate: 1e-3,
            dropout: 0.1,
            chamfer: chamfer::Settings::default(),
            seed: 0,
        }
    }
}

impl Settings {
    /// Reads settings as TOML.
    ///
    /// # Errors
    /// [`SettingsError`].
    pub fn from_toml(text: &str) -> Result<Self, SettingsError> {
        let settings: Self = toml::from_str(text)?;
        let counts = [
            ("width", settings.width),
            ("n_samples", settings.chamfer.n_samples),
        ];
        if let Some((name, found)) = counts.into_iter().find(|(_, n)| *n == 0) {
            return Err(SettingsError::Range {
                name,
                found: found.to_string(),
                wanted: "1 or more",
            });
        }
        let shares = [
            ("rate", settings.rate),
            ("dropout", settings.dropout),
            ("chamfer.rate", settings.chamfer.rate),
        ];
        match shares.into_iter().find(|(_, x)| !(0.0..1.0).contains(x)) {
            None => Ok(settings),
            Some((name, found)) => Err(SettingsError::Range {
                name,
                found: found.to_string(),
                wanted: "0 or more and less than 1",
            }),
        }
    }
}

/// Why a shape is nothing for the thesis.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum ThesisError {
    /// It has too few vertices.
    #[error("the level has {found} vertices, but the sphere has {wanted} points")]
    Small {
        /// How many there are.
        found: usize,
        /// How many points the sphere has.
        wanted: usize,
    },
    /// Its levels contradict each other.
    #[error(transparent)]
    Hierarchy(#[from] HierarchyError),
}

/// A shape as the thesis reads it: as many vertices as the sphere has points, centred, scaled into the
/// unit sphere.
#[derive(Clone, Debug)]
pub struct Example {
    name: String,
    level: Level,
    /// Its triangles, scaled.
    surface: Vec<[DVec3; 3]>,
    /// From there to the frame that the network here sees.
    to_frame: DMat3,
}

/// What a sphere of even points became.
#[derive(Clone, Debug)]
pub struct Moved {
    /// The triangles, in the frame of the sample.
    pub surface: Vec<[DVec3; 3]>,
    /// The direction of the sphere that the surface has nearest to each vertex of the sample.
    pub directions: Vec<DVec3>,
}

/// The trained network.
pub struct Thesis {
    network: ThesisNetwork,
    sphere: PolygonMesh,
    settings: Settings,
    /// The targets of the shapes that it was trained on.
    targets: BTreeMap<String, Vec<f32>>,
}

impl Example {
    /// Reads the level of a sample's hierarchy that has as many vertices as the sphere has points.
    ///
    /// # Errors
    /// [`ThesisError`].
    pub fn new(sample: &Sample, hierarchy: &CollapseHierarchy) -> Result<Self, ThesisError> {
        let (found, wanted) = (
            sample.prepared.n_vertices(),
            icosphere(FREQUENCY).n_vertices(),
        );
        if found < wanted {
            return Err(ThesisError::Small { found, wanted });
        }
        let prepared = Prepared::new(hierarchy, &[wanted])?;
        // The thesis saw shapes as they stand, not in a frame of their own; vertices of a level are the
        // first ones of a finer level.
        let mut level = prepared.turned(prepared.frame).pyramid.levels.remove(0);
        let positions = sample.prepared.positions[..wanted].iter();
        let radius = positions
            .clone()
            .map(|p| p.length())
            .fold(f64::MIN_POSITIVE, f64::max);
        let from_frame = sample.prepared.frame * (1.0 / radius);
        let scaled: Vec<DVec3> = positions.map(|p| from_frame * *p).collect();
        for (row, p) in level.features.chunks_exact_mut(N_FEATURES).zip(&scaled) {
            row[..3].copy_from_slice(&p.as_vec3().to_array());
        }
        let faces = prepared.faces.iter();
        Ok(Self {
            name: sample.name.clone(),
            level,
            surface: faces.map(|f| f.map(|v| scaled[v.index()])).collect(),
            to_frame: from_frame.inverse(),
        })
    }

    fn inputs(&self, device: &Device) -> Tensor<2> {
        let rows = self.level.features.chunks_exact(N_FEATURES);
        let inputs: Vec<f32> = rows.flat_map(|row| row[..N_INPUTS].to_vec()).collect();
        rows_of(inputs, N_INPUTS, device)
    }
}

fn rows_of(numbers: Vec<f32>, width: usize, device: &Device) -> Tensor<2> {
    let n = numbers.len() / width;
    Tensor::from_data(TensorData::new(numbers, [n, width]), device)
}

impl Thesis {
    /// Makes the targets of some shapes and trains on them, one a step.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn trained(
        examples: &[Example],
        settings: Settings,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let sphere = icosphere(FREQUENCY);
        let stage = progress.part("thesis: targets", 0.0, 0.5);
        stage.at(0.0)?;
        let targets = examples.par_iter().map(|example| {
            stage.check()?;
            Ok(chamfer::offsets(
                &sphere,
                &example.surface,
                &settings.chamfer,
            ))
        });
        let targets: Vec<Vec<f32>> = targets.collect::<Result<_, Cancelled>>()?;
        let device = Device::flex().autodiff();
        device.seed(settings.seed);
        let mut network = ThesisNetwork::new(settings.width, settings.dropout, &device);
        let mut optimizer = AdamConfig::new().init();
        let stage = progress.part("thesis: training", 0.5, 1.0);
        let mut random = Random::new(settings.seed);
        for step in 0..settings.n_steps {
            stage.at(step as f64 / settings.n_steps as f64)?;
            let i = random.below(examples.len());
            let wanted = rows_of(targets[i].clone(), 3, &device);
            let found = network.forward(examples[i].inputs(&device), &examples[i].level.graph);
            let loss = (found - wanted).powi_scalar(2).mean();
            let gradients = GradientsParams::from_grads(loss.backward(), &network);
            network = optimizer.step(settings.rate, network, gradients);
        }
        let names = examples.iter().map(|example| example.name.clone());
        Ok(Self {
            network: network.valid(),
            sphere,
            settings,
            targets: names.zip(targets).collect(),
        })
    }

    /// What the network makes of the sphere, for the vertices of a sample.
    pub fn predicted(&self, example: &Example, vertices: &[DVec3]) -> Moved {
        let inputs = example.inputs(&Device::flex());
        let offsets = numbers(self.network.forward(inputs, &example.level.graph));
        self.moved(&offsets, example, vertices)
    }

    /// What the targets make of it: the best that the network could learn.
    pub fn target(&self, example: &Example, vertices: &[DVec3]) -> Moved {
        let made = || chamfer::offsets(&self.sphere, &example.surface, &self.settings.chamfer);
        let known = self.targets.get(&example.name);
        let offsets = known.map_or_else(|| Cow::Owned(made()), Cow::Borrowed);
        self.moved(&offsets, example, vertices)
    }

    fn moved(&self, offsets: &[f32], example: &Example, vertices: &[DVec3]) -> Moved {
        let points = self.sphere.positions().iter().zip(offsets.chunks_exact(3));
        let moved: Vec<DVec3> = points
            .map(|(p, o)| {
                let offset = DVec3::new(o[0].into(), o[1].into(), o[2].into());
                example.to_frame * (*p + offset)
            })
            .collect();
        let faces = || self.sphere.faces().map(|f| [f[0], f[1], f[2]]);
        let surface: Vec<[DVec3; 3]> = faces().map(|f| f.map(|v| moved[v.index()])).collect();
        let tree = Bvh::new(&surface);
        let corners: Vec<_> = faces().collect();
        let direction = |&x: &DVec3| {
            let closest = tree.closest(x);
            let face = corners[closest.face.index()];
            let points = face.map(|v| self.sphere.position(v));
            let weighted = points.iter().zip(closest.weights).map(|(p, w)| *p * w);
            weighted.sum::<DVec3>().normalize_or(DVec3::Z)
        };
        Moved {
            directions: vertices.iter().map(direction).collect(),
            surface,
        }
    }
}
