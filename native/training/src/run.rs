//! The loop: batches, steps, log, checkpoints.

use std::io;
use std::path::{Path, PathBuf};

use burn::module::Module;
use burn::optim::{GradientsAccumulator, GradientsParams, ModuleOptimizer};
use burn::store::{ModuleRecord, RecordError};
use burn::tensor::Device;
use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_geometry::random::Random;
use orbflow_network::features::N_FEATURES;
use orbflow_network::frame::half_turns;
use orbflow_network::net::Network;
use orbflow_network::pyramid::Pyramid;
use orbflow_network::weights::{Header, Weights};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::checkpoint::{Checkpoint, State, broken, read_state};
use crate::evaluate::{Figures, evaluate};
use crate::log;
use crate::loss::Faces;
use crate::net::BurnNetwork;
use crate::optimizer::optimizer;
use crate::sample::Sample;
use crate::schedule::one_cycle;
use crate::settings::Settings;

/// A network on its way.
pub struct Training {
    network: BurnNetwork,
    optimizer: ModuleOptimizer,
    settings: Settings,
    device: Device,
    step: usize,
    /// The sum of the set that it is trained on.
    set: Option<u64>,
}

/// A line of the log.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Line {
    /// How many steps were done.
    pub step: usize,
    /// The mean loss since the last line.
    pub loss: f64,
    /// The rate of the last step.
    pub rate: f64,
    /// What the network reaches on shapes that it does not train on.
    pub held_out: Figures,
}

/// Why a run ends early.
#[derive(Debug, Error)]
pub enum TrainError {
    /// The user asked to stop; the last checkpoint is whole.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A file of the run cannot be read or written.
    #[error("cannot use {path}: {cause}")]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// A checkpoint's tensors cannot be read or written.
    #[error("the checkpoint in {path} cannot be used: {reason}")]
    Checkpoint {
        /// Where.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The run was begun with other settings.
    #[error("the run in {path} was begun with other settings; choose another folder")]
    OtherSettings {
        /// Where.
        path: PathBuf,
    },
    /// The run was begun with another set.
    #[error(
        "the run in {path} was begun with another set, or with this one before it had grown; choose \
         another folder"
    )]
    OtherSet {
        /// Where.
        path: PathBuf,
    },
    /// The loss is not a number any more.
    #[error("the loss of step {step} is not finite; a smaller rate may help")]
    Diverged {
        /// Which step.
        step: usize,
    },
}

impl Training {
    /// A new network, the same for the same seed on every device.
    pub fn new(settings: Settings, device: &Device) -> Self {
        let optimizer = optimizer(device);
        let device = device.clone().autodiff();
        Self {
            network: BurnNetwork::seeded(&settings.sizes, settings.seed, &device),
            optimizer,
            settings,
            device,
            step: 0,
            set: None,
        }
    }

    /// Continues from a checkpoint, of whatever device, or begins where there is none. `set` is the sum
    /// of the set that the samples are of, if they are of one.
    ///
    /// # Errors
    /// [`TrainError`], also when the checkpoint was made with other settings, or says of which set it is
    /// and that is another one.
    pub fn resumed(
        settings: Settings,
        set: Option<u64>,
        device: &Device,
        run: &Path,
    ) -> Result<Self, TrainError> {
        let mut training = Self::new(settings, device);
        training.set = set;
        let checkpoint = Checkpoint::of(run);
        let Some(folder) = checkpoint.recovered()? else {
            return Ok(training);
        };
        let state = read_state(folder)?;
        if state.settings != training.settings {
            let path = folder.to_owned();
            return Err(TrainError::OtherSettings { path });
        }
        if state.set.is_some() && state.set != set {
            let path = folder.to_owned();
            return Err(TrainError::OtherSet { path });
        }
        let record = ModuleRecord::load(folder.join("network.bpk"));
        let record = record.map_err(|e: RecordError| broken(folder, &e))?;
        let network = training.network.clone().try_load_record(record);
        training.network = network.map_err(|e| broken(folder, &e))?;
        let loaded = training.optimizer.load(folder.join("optimizer.bpk"));
        training.optimizer = loaded.map_err(|e| broken(folder, &e))?;
        training.step = state.step;
        Ok(training)
    }

    /// How many steps were done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// The network as it is, for predictions.
    pub fn network(&self) -> Network {
        let network = Network::new(&self.settings.sizes, &self.network.parameters());
        network.expect("burn's network has the same parts")
    }

    /// One step on some samples, each turned by one of the half turns; returns the loss.
    pub fn learn(&mut self, samples: &[&Sample], turns: &[usize]) -> f64 {
        let (loss, gradients) = self.gradients(samples, turns);
        let rate = self.rate();
        self.network = self.optimizer.step(rate, self.network.clone(), gradients);
        self.step += 1;
        loss
    }

    /// The mean loss of some samples and its gradients. On flex every sample is a task of its own,
    /// and sums are in the order of the samples, so that any number of threads finds the same bits;
    /// other engines are handed all at once.
    fn gradients(&self, samples: &[&Sample], turns: &[usize]) -> (f64, GradientsParams) {
        let is_flex = self.device.clone().inner() == Device::flex();
        let at_once = if is_flex { 1 } else { samples.len() };
        let tasks = samples.par_chunks(at_once).zip(turns.par_chunks(at_once));
        let parts = tasks.map(|(some, turns)| {
            let turned: Vec<Pyramid> = some
                .iter()
                .zip(turns)
                .map(|(sample, &turn)| sample.prepared.turned(half_turns()[turn]).pyramid)
                .collect();
            let joined = Pyramid::joined(&turned.iter().collect::<Vec<_>>());
            // Of its own: burn keeps all that hangs on the same parameters in one locked graph.
            let network = self.network.clone().fork(&self.device);
            let loss = Faces::new(some, &self.device).loss(network.forward(&joined, &self.device));
            let loss = loss.mul_scalar(some.len() as f32 / samples.len() as f32);
            let value = f64::from(loss.clone().into_scalar::<f32>());
            (
                value,
                GradientsParams::from_grads(loss.backward(), &network),
            )
        });
        let (mut mean, mut sum) = (0.0, GradientsAccumulator::new());
        for (loss, gradients) in parts.collect::<Vec<_>>() {
            mean += loss;
            sum.accumulate(&self.network, gradients);
        }
        (mean, sum.grads())
    }

    /// Runs to the end, logging and keeping a checkpoint every interval.
    ///
    /// # Errors
    /// [`TrainError`]; whatever happens, the last checkpoint is whole.
    pub fn run(
        &mut self,
        [training, held_out]: [&[Sample]; 2],
        run: &Path,
        progress: &Progress,
    ) -> Result<(), TrainError> {
        log::cut_back(run, self.step)?;
        let (mut sum, mut n) = (0.0, 0);
        let mut told = "train".to_owned();
        while self.step < self.settings.n_steps {
            let share = self.step as f64 / self.settings.n_steps as f64;
            progress.part(&told, 0.0, 1.0).at(share)?;
            // From the step's number alone, so that a resumed run sees what the whole one does.
            let mut random = Random::new(self.settings.seed ^ (self.step as u64) << 20);
            let batch = 0..self.settings.batch;
            let chosen: Vec<&Sample> = batch
                .clone()
                .map(|_| &training[random.below(training.len())])
                .collect();
            let turns: Vec<usize> = batch.map(|_| random.below(4)).collect();
            let loss = self.learn(&chosen, &turns);
            if !loss.is_finite() {
                return Err(TrainError::Diverged { step: self.step });
            }
            sum += loss;
            n += 1;
            if self.step.is_multiple_of(self.settings.interval)
                || self.step == self.settings.n_steps
            {
                let line = Line {
                    step: self.step,
                    loss: sum / f64::from(n),
                    rate: self.rate(),
                    held_out: evaluate(&self.network(), held_out),
                };
                (sum, n) = (0.0, 0);
                // A line without its checkpoint is cut back, one that is missing cannot be made again.
                log::add(run, &line)?;
                self.keep(run)?;
                told = format!(
                    "loss {:.3}, folds {:.2} %",
                    line.loss, line.held_out.folds_pct
                );
            }
        }
        Ok(())
    }

    /// The weights for predictions, and what they came from.
    pub fn weights(&self, provenance: &str) -> Weights {
        let header = Header {
            sizes: self.settings.sizes.clone(),
            n_features: N_FEATURES,
            provenance: format!("{provenance}; {} steps", self.step),
        };
        let parameters = self.network.parameters();
        Weights { header, parameters }
    }

    fn keep(&self, run: &Path) -> Result<(), TrainError> {
        let state = State {
            settings: self.settings.clone(),
            step: self.step,
            set: self.set,
        };
        Checkpoint::of(run).replace(&state, |folder| {
            let record = self.network.clone().into_record();
            record
                .save(folder.join("network.bpk"))
                .map_err(|e| broken(folder, &e))?;
            let kept = self.optimizer.save(folder.join("optimizer.bpk"));
            kept.map_err(|e| broken(folder, &e))
        })
    }

    fn rate(&self) -> f64 {
        one_cycle(self.step, self.settings.n_steps, self.settings.rate)
    }
}

pub(crate) fn file_error(path: &Path, cause: io::Error) -> TrainError {
    let path = path.to_owned();
    TrainError::File { path, cause }
}
