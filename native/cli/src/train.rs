//! `orbflow train`: a network is trained on a set, its weights are written.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use orbflow_training::curve::draw_log;
use orbflow_training::engine::{Engine, EngineError, name_of};
use orbflow_training::evaluate::{Baselines, baselines};
use orbflow_training::load::{LoadError, load};
use orbflow_training::run::{TrainError, Training};
use orbflow_training::sample::{Sample, SampleError};
use orbflow_training::set::{Set, SetError};
use orbflow_training::settings::{Settings, SettingsError};
use orbflow_training::whole;
use serde::Serialize;
use serde_json::Value;
use thiserror::Error;

use crate::bar::with_bar;
use crate::interrupt::Interrupt;

#[derive(Args, Debug)]
pub struct Train {
    /// The set, as `orbflow prepare` writes it
    #[arg(value_name = "SET")]
    pub set: PathBuf,
    /// The settings of the run; what it leaves out has its default
    #[arg(long, value_name = "C.toml")]
    pub config: Option<PathBuf>,
    /// The folder of the run: checkpoint, log.jsonl, curve.svg, shapes.json, weights
    #[arg(short, long, value_name = "RUN")]
    pub output: PathBuf,
    /// What to train on
    #[arg(long, value_enum, default_value_t = Device::Cpu)]
    pub device: Device,
}

#[derive(Args, Debug)]
pub struct Curve {
    /// The folder of the run: log.jsonl is read, curve.svg written
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
}

/// What training can run on, if the program was built for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Device {
    /// The processor
    Cpu,
    /// The processor, through burn-ndarray, which its makers have deprecated
    Ndarray,
    /// An NVIDIA GPU
    Cuda,
    /// A GPU through Vulkan, Metal or Direct3D 12
    Wgpu,
}

/// Why training ends early.
#[derive(Debug, Error)]
pub enum Error {
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error("cannot read {path}: {cause}")]
    Read { path: PathBuf, cause: io::Error },
    #[error("{path}: {cause}")]
    Config { path: PathBuf, cause: SettingsError },
    #[error(transparent)]
    Set(#[from] SetError),
    #[error(transparent)]
    Load(#[from] LoadError),
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
            Self::Load(LoadError::Cancelled(_)) | Self::Train(TrainError::Cancelled(_))
        )
    }
}

/// What a run was trained on, and what there is to beat.
#[derive(Serialize)]
struct Shapes<'a> {
    set: &'a str,
    is_complete: bool,
    n_training: usize,
    n_held_out: usize,
    baselines: Baselines,
}

/// Trains until the steps are done or the user stops; the next call goes on from there.
pub fn train(arguments: &Train, interrupt: &Interrupt) -> Result<(), Error> {
    let device = Engine::from(arguments.device).open()?;
    if let Some(name) = name_of(&device) {
        eprintln!("training on {name}");
    }
    let settings = match &arguments.config {
        Some(path) => read_settings(path, Settings::from_toml)?,
        None => Settings::default(),
    };
    let set = Set::open(&arguments.set)?;
    let manifest = set.manifest();
    let about = manifest.sentence();
    if !manifest.is_complete {
        let (n, n_all) = (manifest.sources.len(), manifest.asked.n_sources);
        eprintln!("the set is not complete: {n} of {n_all} sources are in it");
    }
    let token = interrupt.start_work();
    let levels = &settings.sizes.levels;
    let [training, held_out] = with_bar(token, |progress| load(&set, levels, progress))?;
    let run = &arguments.output;
    fs::create_dir_all(run).map_err(|cause| write_error(run, cause))?;
    let mut trained = Training::resumed(settings, Some(set.sum()), &device, run)?;
    let shapes = run.join("shapes.json");
    // What a run without a checkpoint left may be of another set or of other settings.
    if trained.step() == 0 || !is_of(&about, &shapes) {
        let is_complete = manifest.is_complete;
        write_shapes(&about, is_complete, [&training, &held_out], &shapes)?;
    }
    with_bar(token, |progress| {
        trained.run([&training, &held_out], run, progress)
    })?;
    write(
        &run.join("weights.orbflow"),
        &trained.weights(&about).to_bytes(),
    )
}

/// Draws what a run has logged so far.
pub fn curve(arguments: &Curve) -> Result<(), Error> {
    Ok(draw_log(&arguments.run)?)
}

impl From<Device> for Engine {
    fn from(device: Device) -> Self {
        match device {
            Device::Cpu => Self::Flex,
            Device::Ndarray => Self::NdArray,
            Device::Cuda => Self::Cuda,
            Device::Wgpu => Self::Wgpu,
        }
    }
}

/// Reads a file of settings.
pub fn read_settings<T>(
    path: &Path,
    from_toml: impl Fn(&str) -> Result<T, SettingsError>,
) -> Result<T, Error> {
    let path = path.to_owned();
    match fs::read_to_string(&path) {
        Err(cause) => Err(Error::Read { path, cause }),
        Ok(text) => from_toml(&text).map_err(|cause| Error::Config { path, cause }),
    }
}

/// Whether a file of shapes is whole and of the set of this sentence.
fn is_of(set: &str, path: &Path) -> bool {
    let text = fs::read(path).unwrap_or_default();
    let shapes = serde_json::from_slice::<Value>(&text);
    shapes.is_ok_and(|shapes| shapes["set"] == set)
}

fn write_shapes(
    set: &str,
    is_complete: bool,
    [training, held_out]: [&[Sample]; 2],
    path: &Path,
) -> Result<(), Error> {
    let shapes = Shapes {
        set,
        is_complete,
        n_training: training.len(),
        n_held_out: held_out.len(),
        baselines: baselines(held_out)?,
    };
    let text = serde_json::to_vec_pretty(&shapes).map_err(io::Error::from);
    write(path, &text.map_err(|cause| write_error(path, cause))?)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    whole::write(path, bytes).map_err(|cause| write_error(path, cause))
}

fn write_error(path: &Path, cause: io::Error) -> Error {
    let path = path.to_owned();
    Error::Write { path, cause }
}
