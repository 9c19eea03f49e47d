//! The pipeline of a thesis of 2024, as the baseline that the network here is measured against.
//!
//! A sphere of even points, as many as the mesh has, is to become the mesh: a graph network reads
//! positions and normals of the mesh and says for the vertex `i` how far the point `i` of the sphere
//! is to move. What it learns from are offsets that lower the Chamfer distance to the mesh, see
//! [`chamfer`]. Nothing ties the numbers of the mesh to those of the sphere; `docs/method.md` says why
//! that cannot be learnt. Meshes have as many vertices as a small icosphere, taken from the collapse
//! hierarchy; the thesis had whole ones, wider layers and many more steps: see [`Settings`]. What a
//! shape is to become hangs on nothing of the network: see [`target`].

pub mod chamfer;
mod net;
pub mod target;

use std::borrow::Cow;
use std::collections::BTreeMap;

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::{Device, Tensor, TensorData};
use glam::{DAffine3, DVec3};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::{Id, PolygonMesh};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;
use orbflow_network::features::N_FEATURES;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::net::numbers;
use crate::sample::Sample;
use crate::settings::{SettingsError, check_count};
use net::{N_INPUTS, ThesisNetwork};
use target::{Reading, Target, ThesisError, sphere};

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
        check_count("width", settings.width)?;
        settings.chamfer.check()?;
        let shares = [("rate", settings.rate), ("dropout", settings.dropout)];
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

/// A shape that the thesis's network is trained or measured on.
#[derive(Clone, Debug)]
pub struct Example {
    name: String,
    reading: Reading,
    /// From there to the frame that the network here sees.
    to_frame: DAffine3,
    /// The target that was made before.
    kept: Option<Target>,
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
    /// Reads a hierarchy, beside what the network here reads of it.
    ///
    /// # Errors
    /// [`ThesisError`].
    pub fn new(sample: &Sample, hierarchy: &CollapseHierarchy) -> Result<Self, ThesisError> {
        let reading = Reading::new(hierarchy)?;
        Ok(Self {
            name: sample.name.clone(),
            to_frame: to_frame(&reading, sample),
            reading,
            kept: None,
        })
    }

    /// Has the target that was made before, if there is one; it serves where the settings are the same.
    #[must_use]
    pub fn with_target(self, kept: Option<Target>) -> Self {
        Self { kept, ..self }
    }

    /// The offsets of its target by these settings, kept or made now.
    fn offsets(
        &self,
        settings: &chamfer::Settings,
        progress: &Progress,
    ) -> Result<Cow<'_, [f32]>, ThesisError> {
        match &self.kept {
            Some(kept) if kept.settings == *settings => Ok(Cow::Borrowed(&kept.offsets)),
            _ => Ok(Cow::Owned(self.reading.target(settings, progress)?.offsets)),
        }
    }

    fn inputs(&self, device: &Device) -> Tensor<2> {
        let rows = self.reading.level.features.chunks_exact(N_FEATURES);
        let inputs: Vec<f32> = rows.flat_map(|row| row[..N_INPUTS].to_vec()).collect();
        rows_of(inputs, N_INPUTS, device)
    }
}

/// The similarity from what the thesis reads to the frame of a sample. The turn is known; middle and
/// size are compared on the vertices that both have, the first of each.
fn to_frame(reading: &Reading, sample: &Sample) -> DAffine3 {
    let (from, to) = (&reading.positions, &sample.prepared.positions);
    let n = from.len().min(to.len());
    let spread = |points: &[DVec3]| {
        let middle = points.iter().sum::<DVec3>() / n as f64;
        let squares = points.iter().map(|p| p.distance_squared(middle));
        (middle, squares.sum::<f64>().max(f64::MIN_POSITIVE).sqrt())
    };
    let ((middle, size), (wanted, wanted_size)) = (spread(&from[..n]), spread(&to[..n]));
    let linear = sample.prepared.frame.transpose() * (wanted_size / size);
    DAffine3::from_mat3_translation(linear, wanted - linear * middle)
}

fn rows_of(numbers: Vec<f32>, width: usize, device: &Device) -> Tensor<2> {
    let n = numbers.len() / width;
    Tensor::from_data(TensorData::new(numbers, [n, width]), device)
}

impl Thesis {
    /// Trains on some shapes, one a step; makes their targets first, where none are kept.
    ///
    /// # Errors
    /// [`ThesisError`].
    pub fn trained(
        examples: &[Example],
        settings: Settings,
        progress: &Progress,
    ) -> Result<Self, ThesisError> {
        let stage = progress.part("thesis: targets", 0.0, 0.5);
        stage.at(0.0)?;
        let targets = examples.par_iter().map(|example| {
            let offsets = example.offsets(&settings.chamfer, &stage)?;
            Ok(offsets.into_owned())
        });
        let targets: Vec<Vec<f32>> = targets.collect::<Result<_, ThesisError>>()?;
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
            let found = network.forward(
                examples[i].inputs(&device),
                &examples[i].reading.level.graph,
            );
            let loss = (found - wanted).powi_scalar(2).mean();
            let gradients = GradientsParams::from_grads(loss.backward(), &network);
            network = optimizer.step(settings.rate, network, gradients);
        }
        let names = examples.iter().map(|example| example.name.clone());
        Ok(Self {
            network: network.valid(),
            sphere: sphere(),
            settings,
            targets: names.zip(targets).collect(),
        })
    }

    /// What the network makes of the sphere, for the vertices of a sample.
    pub fn predicted(&self, example: &Example, vertices: &[DVec3]) -> Moved {
        let inputs = example.inputs(&Device::flex());
        let offsets = numbers(self.network.forward(inputs, &example.reading.level.graph));
        self.moved(&offsets, example, vertices)
    }

    /// What the targets make of it: the best that the network could learn.
    ///
    /// # Errors
    /// [`ThesisError::NotFinite`].
    pub fn target(&self, example: &Example, vertices: &[DVec3]) -> Result<Moved, ThesisError> {
        let offsets = match self.targets.get(&example.name) {
            Some(known) => Cow::Borrowed(&known[..]),
            None => example.offsets(&self.settings.chamfer, &Progress::none())?,
        };
        Ok(self.moved(&offsets, example, vertices))
    }

    fn moved(&self, offsets: &[f32], example: &Example, vertices: &[DVec3]) -> Moved {
        let points = self.sphere.positions().iter().zip(offsets.chunks_exact(3));
        let moved: Vec<DVec3> = points
            .map(|(p, o)| {
                let offset = DVec3::new(o[0].into(), o[1].into(), o[2].into());
                example.to_frame.transform_point3(*p + offset)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::training_level;
    use crate::shapes::shape;

    #[test]
    fn what_the_thesis_reads_lies_where_the_network_sees_it() {
        let hierarchy = training_level(shape(5), 2_000).unwrap();
        for levels in [[500, 100], [900, 100], [200, 50]] {
            let sample = Sample::of(String::new(), &hierarchy, &levels).unwrap();
            let example = Example::new(&sample, &hierarchy).unwrap();
            let points = example.reading.positions.iter();
            for (p, wanted) in points.zip(&sample.prepared.positions) {
                let found = example.to_frame.transform_point3(*p);
                assert!(found.distance(*wanted) < 1e-12, "{found} {wanted}");
            }
        }
    }

    #[test]
    fn a_target_serves_where_it_was_made_with_the_same_settings_alone() {
        let hierarchy = training_level(shape(5), 2_000).unwrap();
        let sample = Sample::of(String::new(), &hierarchy, &[500, 100]).unwrap();
        let settings = |edge| chamfer::Settings {
            n_steps: 2,
            n_samples: 50,
            edge,
            ..chamfer::Settings::default()
        };
        let example = Example::new(&sample, &hierarchy).unwrap();
        let quiet = Progress::none();
        let made = example.offsets(&settings(1.0), &quiet).unwrap();
        let kept = Target {
            settings: settings(2.0),
            offsets: vec![0.25; made.len()],
        };
        let with_target = example.clone().with_target(Some(kept.clone()));
        let offsets = |edge| with_target.offsets(&settings(edge), &quiet).unwrap();
        assert_eq!(offsets(1.0), made);
        assert_eq!(*offsets(2.0), kept.offsets);
    }

    #[test]
    fn targets_that_cannot_be_made_are_refused() {
        for (text, words) in [
            ("n_samples = 0", "chamfer.n_samples = 0"),
            ("rate = 1.0", "chamfer.rate = 1;"),
            ("edge = nan", "chamfer.edge = NaN"),
            ("normal = -0.5", "chamfer.normal = -0.5"),
            ("laplacian = [0.5, inf]", "chamfer.laplacian = inf"),
        ] {
            let refused = Settings::from_toml(&format!("[chamfer]\n{text}\n"));
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains(words), "{text}: {refused}");
        }
    }
}
