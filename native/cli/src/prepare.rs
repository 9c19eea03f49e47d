//! `orbflow prepare`: meshes and made shapes become a set to train on and to measure on.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use orbflow_training::prepare::{MOST_MADE, Settings, prepare as prepare_set};
use orbflow_training::thesis;

use crate::bar::with_bar;
use crate::error::Error;
use crate::interrupt::Interrupt;
use crate::outputs::Outputs;
use crate::parsers::whole;
use crate::place::Place;
use crate::train::read_settings;

#[derive(Args, Debug)]
pub struct Prepare {
    /// Folders of meshes, zip files of meshes, meshes: OBJ, PLY, OFF, STL
    #[arg(value_name = "DATA", required_unless_present = "procedural")]
    pub places: Vec<PathBuf>,
    /// The set to write; where a run was cut, the same command goes on
    #[arg(short, long, value_name = "SET")]
    pub output: PathBuf,
    /// How many shapes to make besides, 15 of 100 to be held back
    #[arg(long, value_name = "N", default_value_t = Settings::default().n_procedural, value_parser = whole(0..=MOST_MADE as u64))]
    pub procedural: usize,
    /// The seed of the first made shape
    #[arg(long, value_name = "S", default_value_t = Settings::default().seed)]
    pub seed: u64,
    /// How many faces the shapes get that are trained on: four for each vertex that the network is to
    /// propose, and 3,000 at least
    #[arg(long, value_name = "N", default_value_t = Settings::default().n_faces, value_parser = whole(100..=1_000_000))]
    pub faces: usize,
    /// The licence of meshes whose folder names none
    #[arg(long, value_name = "TEXT")]
    pub licence: Option<String>,
    /// Also make what the thesis's network learns from, for `orbflow evaluate --baseline thesis`, and
    /// keep it in the set
    #[arg(long, value_enum, value_name = "NAME")]
    pub targets: Option<Targets>,
    /// How targets are made, in its part `chamfer`; what it leaves out has its default
    #[arg(long, value_name = "T.toml", requires = "targets")]
    pub thesis: Option<PathBuf>,
    /// Write the manifest as JSON: each source, its licence, side and counts, and what was left out
    #[arg(long, value_name = "M.json")]
    pub manifest: Option<Place>,
}

/// What can be made for a network to learn from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Targets {
    /// The thesis's: offsets of an even sphere that lower its Chamfer distance to the shape
    Chamfer,
}

/// Makes the set, or what is missing of it.
pub fn prepare(arguments: &Prepare, interrupt: &Interrupt) -> Result<(), Error> {
    let settings = Settings {
        n_faces: arguments.faces,
        n_procedural: arguments.procedural,
        seed: arguments.seed,
        licence: arguments.licence.clone(),
        targets: match arguments.targets {
            None => None,
            Some(Targets::Chamfer) => Some(thesis_settings(arguments.thesis.as_deref())?.chamfer),
        },
    };
    let token = interrupt.start_work();
    let mut outputs = Outputs::new(&arguments.manifest)?;
    let (places, output) = (&arguments.places, &arguments.output);
    let set = with_bar(token, |progress| {
        prepare_set(places, &settings, output, progress)
    })?;
    let manifest = set.manifest();
    eprintln!("{}: {}", output.display(), manifest.sentence());
    if manifest.n_left_out > 0 {
        let n = manifest.n_left_out;
        eprintln!("{n} sources have no usable part; --manifest tells why");
    }
    if let Some(place) = &arguments.manifest {
        outputs.write_report(place, &manifest)?;
    }
    outputs.publish(token)
}

/// What a file says of the thesis's pipeline; the defaults without one.
pub fn thesis_settings(path: Option<&Path>) -> Result<thesis::Settings, Error> {
    match path {
        None => Ok(thesis::Settings::default()),
        Some(path) => Ok(read_settings(path, thesis::Settings::from_toml)?),
    }
}
