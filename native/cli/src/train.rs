//! `orbflow train`: shapes are collected, a network is trained on them, its weights are written.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use orbflow_training::collect::{CollectError, Collection, Sources, collect};
use orbflow_training::evaluate::{Baselines, baselines};
use orbflow_training::run::{Settings, TrainError, Training};
use orbflow_training::sample::SampleError;
use serde::Serialize;
use thiserror::Error;

use crate::bar::with_bar;
use crate::interrupt::Interrupt;

#[derive(Args, Debug)]
pub struct Train {
    /// The folder of the run: checkpoint, log.jsonl, shapes.json, weights
    #[arg(short, long, value_name = "RUN")]
    pub output: PathBuf,
    #[command(flatten)]
    pub data: Data,
    /// How many steps the whole run has
    #[arg(long, value_name = "N", default_value_t = Settings::default().n_steps)]
    pub steps: usize,
    /// Where random choices start; equal seeds give equal weights
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// On what data and under which licences, for the weights file
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub provenance: String,
}

/// What is trained on and what is held back.
#[derive(Args, Debug)]
pub struct Data {
    /// Folders of meshes besides the made shapes; some files are held back, by a hash of their names
    #[arg(value_name = "FOLDER")]
    pub folders: Vec<PathBuf>,
    /// How many shapes to make for training
    #[arg(long, value_name = "N", default_value_t = 400)]
    pub shapes: usize,
    /// How many more to make and hold back
    #[arg(long, value_name = "N", default_value_t = 40)]
    pub held_out: usize,
}

impl Data {
    /// Where its shapes come from.
    pub fn sources(&self) -> Sources {
        Sources {
            n_shapes: self.shapes,
            n_held_out: self.held_out,
            folders: self.folders.clone(),
        }
    }
}

/// Why training ends early.
#[derive(Debug, Error)]
pub enum Error {
    #[error(transparent)]
    Collect(#[from] CollectError),
    #[error("cannot measure the solver on the held-out shapes: {0}")]
    Sample(#[from] SampleError),
    #[error(transparent)]
    Train(#[from] TrainError),
    #[error("cannot write {path}: {cause}")]
    Write { path: PathBuf, cause: io::Error },
}

impl Error {
    /// Whether the user asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Collect(CollectError::Cancelled(_)) | Self::Train(TrainError::Cancelled(_))
        )
    }
}

/// What a run was trained on, and what there is to beat.
#[derive(Serialize)]
struct Shapes<'a> {
    sources: &'a Sources,
    n_training: usize,
    n_held_out: usize,
    baselines: Baselines,
    left_out: Vec<(&'a Path, &'a str)>,
}

/// Trains until the steps are done or the user stops; the next call goes on from there.
pub fn train(arguments: &Train, interrupt: &Interrupt) -> Result<(), Error> {
    let token = interrupt.start_work();
    let settings = Settings {
        n_steps: arguments.steps,
        seed: arguments.seed,
        ..Settings::default()
    };
    let sources = arguments.data.sources();
    let run = &arguments.output;
    fs::create_dir_all(run).map_err(|cause| write_error(run, cause))?;
    let levels = settings.sizes.levels.clone();
    let shapes = with_bar(token, |progress| collect(&sources, &levels, progress))?;
    write_shapes(&sources, &shapes, run)?;
    let mut training = Training::resumed(settings, run)?;
    with_bar(token, |progress| {
        training.run([&shapes.training, &shapes.held_out], run, progress)
    })?;
    let weights = training.weights(&arguments.provenance);
    write(&run.join("weights.orbflow"), &weights.to_bytes())
}

fn write_shapes(sources: &Sources, shapes: &Collection, run: &Path) -> Result<(), Error> {
    let path = run.join("shapes.json");
    if path.exists() {
        return Ok(());
    }
    let left_out = shapes.left_out.iter();
    let shapes = Shapes {
        sources,
        n_training: shapes.training.len(),
        n_held_out: shapes.held_out.len(),
        baselines: baselines(&shapes.held_out)?,
        left_out: left_out
            .map(|(path, why)| (path.as_path(), why.as_str()))
            .collect(),
    };
    let text = serde_json::to_vec_pretty(&shapes).map_err(io::Error::from);
    write(&path, &text.map_err(|cause| write_error(&path, cause))?)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    fs::write(path, bytes).map_err(|cause| write_error(path, cause))
}

fn write_error(path: &Path, cause: io::Error) -> Error {
    let path = path.to_owned();
    Error::Write { path, cause }
}
