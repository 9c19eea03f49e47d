//! `orbflow evaluate`: what trained weights reach, on shapes trained on and on shapes never seen.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use orbflow_geometry::mesh::io::Format;
use orbflow_geometry::progress::{CancelToken, Progress};
use orbflow_network::weights::Weights;
use orbflow_training::evaluate::outcome::Subject;
use orbflow_training::evaluate::report::{Asked, Side, report, thinned};
use orbflow_training::load::{LoadError, check_levels};
use orbflow_training::set::{Set, SetError};
use orbflow_training::thesis;

use crate::bar::with_bar;
use crate::error::Error;
use crate::formats::FileFormat;
use crate::interrupt::Interrupt;
use crate::outputs::Outputs;
use crate::place::Place;
use crate::predictor::read_weights;
use crate::prepare::thesis_settings;

#[derive(Args, Debug)]
pub struct Evaluate {
    /// The set that the weights were trained on, as `orbflow prepare` writes it
    #[arg(value_name = "SET")]
    pub set: PathBuf,
    /// Which of its shapes to measure: those trained on, those held back
    #[arg(long, value_enum, default_value_t = Which::All)]
    pub split: Which,
    /// The weights, as `orbflow train` writes them [default: the program's own]
    #[arg(long, value_name = "FILE")]
    pub weights: Option<PathBuf>,
    /// Write the figures as JSON: medians by side and category, and every shape
    #[arg(long, value_name = "R.json")]
    pub report: Place,
    /// Sets of which training was given nothing; once for each
    #[arg(long, value_name = "SET")]
    pub other: Vec<PathBuf>,
    /// What to measure beside network, radial projection and solver, which are measured always: the
    /// thesis's network is trained first, on the shapes trained on, at most N of them, from the set's
    /// targets where they were made with the same settings
    #[arg(long, value_enum, value_name = "NAME")]
    pub baseline: Option<Baseline>,
    /// The size of the thesis's network; what it leaves out has its default
    #[arg(long, value_name = "T.toml", requires = "baseline")]
    pub thesis: Option<PathBuf>,
    /// At most how many shapes of each side, evenly taken
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub most: usize,
    /// Also finish the maps of whole meshes of 16,000 triangles, one after the other, for relaxations
    /// and processor time; not of shapes trained on
    #[arg(long)]
    pub finish: bool,
    /// Write the meshes of the measured shapes that were not trained on: the level, what the proposal
    /// rebuilds of it, and the mesh that is finished, named after the shape
    #[arg(long, value_name = "FOLDER")]
    pub meshes: Option<PathBuf>,
}

/// The sides of a set.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Which {
    /// Shapes trained on
    Train,
    /// Shapes held back
    Test,
    /// Both
    All,
}

/// What can be measured beside the network, at the cost of training it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Baseline {
    /// The pipeline of the thesis, at a size that fits a processor
    Thesis,
}

/// Measures the network, the solver and the radial projection beside each other.
pub fn evaluate(arguments: &Evaluate, interrupt: &Interrupt) -> Result<(), Error> {
    measure(arguments, interrupt).map_err(|error| match &arguments.meshes {
        Some(folder) if error.is_cancelled() => Error::CancelledAmongMeshes(folder.clone()),
        _ => error,
    })
}

fn measure(arguments: &Evaluate, interrupt: &Interrupt) -> Result<(), Error> {
    let weights = match &arguments.weights {
        Some(path) => read_weights(path)?,
        None => Weights::shipped(),
    };
    let subject = Subject::new(&weights).map_err(|cause| Error::Weights {
        path: arguments
            .weights
            .clone()
            .unwrap_or_else(|| "the program's own weights".into()),
        cause,
    })?;
    let set = Set::open(&arguments.set)?;
    let others = arguments.other.iter().map(|path| Set::open(path));
    let others: Vec<Set> = others.collect::<Result<_, SetError>>()?;
    for set in others.iter().chain([&set]) {
        check_levels(set, subject.levels())?;
    }
    let all: Vec<Asked<'_>> = Asked::of(&set)
        .chain(others.iter().flat_map(Asked::of_other))
        .collect();
    let all = thinned(&all, arguments.most);
    let shapes: Vec<Asked<'_>> = all
        .iter()
        .copied()
        .filter(|a| arguments.asks_for(a))
        .collect();
    if shapes.is_empty() {
        return Err(Error::NoShapes);
    }
    let thesis = arguments.thesis_asked((&set, &others))?;
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([&arguments.report])?;
    let report = with_bar(token, |progress| {
        let (subject, from) = match thesis {
            Some(settings) => {
                let stage = progress.part("", 0.0, 0.5);
                (with_thesis(subject, (&set, &all), settings, &stage)?, 0.5)
            }
            None => (subject, 0.0),
        };
        if let Some(folder) = &arguments.meshes {
            write_meshes(folder, &subject, &shapes, token)?;
        }
        let subject = (&weights.header, &subject);
        let stage = progress.part("measure", from, 1.0);
        Ok::<_, Error>(report(subject, &shapes, arguments.finish, &stage)?)
    })?;
    outputs.write_report(&arguments.report, &report)?;
    outputs.publish(token)
}

/// Whether the targets of the thesis are those of a set, in words.
fn whose_targets(set: &Set, settings: &thesis::Settings) -> &'static str {
    match &set.head().targets {
        Some(targets) if *targets == settings.chamfer => {
            "the thesis's targets are those of the set"
        }
        Some(_) => "the thesis's targets are made now, the set's were made with other settings",
        None => "the thesis's targets are made now, the set has none",
    }
}

/// Trains the network of the thesis on the shapes of the set that training saw.
fn with_thesis(
    subject: Subject,
    (set, shapes): (&Set, &[Asked<'_>]),
    settings: thesis::Settings,
    progress: &Progress,
) -> Result<Subject, Error> {
    let seen = shapes.iter().filter(|asked| asked.side == Side::Train);
    let seen: Vec<_> = seen.map(|asked| asked.which).collect();
    if seen.is_empty() {
        return Err(Error::NoShapes);
    }
    Ok(subject.with_thesis((set, &seen), settings, progress)?)
}

/// Writes as OBJ what there is to see of the shapes that were not trained on, each as it is made:
/// together they may be more files than a program may hold open.
fn write_meshes(
    folder: &Path,
    subject: &Subject,
    shapes: &[Asked<'_>],
    token: &CancelToken,
) -> Result<(), Error> {
    let place = |path: &Path| Place::File(path.to_owned());
    fs::create_dir_all(folder).map_err(|cause| Error::Write {
        place: place(folder),
        cause: cause.into(),
    })?;
    for asked in shapes.iter().filter(|asked| asked.side != Side::Train) {
        let shape = asked.set.read(asked.which)?;
        // A shape that cannot be measured is named in the report.
        let Ok(exhibits) = subject.exhibits(asked.which, &shape) else {
            continue;
        };
        for (what, mesh) in exhibits {
            let path = folder.join(format!("{}.{what}.obj", asked.file_stem()));
            let place = place(&path);
            let mut outputs = Outputs::new([&place])?;
            outputs.write_mesh(&place, &mesh.into(), FileFormat::Mesh(Format::Obj))?;
            outputs.publish(token)?;
        }
    }
    Ok(())
}

impl Evaluate {
    /// The settings of the thesis's pipeline, if it is to be measured; says whose targets it gets.
    fn thesis_asked(
        &self,
        (set, others): (&Set, &[Set]),
    ) -> Result<Option<thesis::Settings>, Error> {
        let Some(Baseline::Thesis) = self.baseline else {
            return Ok(None);
        };
        let settings = thesis_settings(self.thesis.as_deref())?;
        let paths = [&self.set].into_iter().chain(&self.other);
        for (path, set) in paths.zip([set].into_iter().chain(others)) {
            eprintln!("{}: {}", path.display(), whose_targets(set, &settings));
        }
        Ok(Some(settings))
    }

    fn asks_for(&self, asked: &Asked<'_>) -> bool {
        match self.split {
            Which::Train => asked.side == Side::Train,
            Which::Test => asked.side == Side::Test,
            Which::All => true,
        }
    }
}

impl From<LoadError> for Error {
    fn from(error: LoadError) -> Self {
        Self::Train(error.into())
    }
}
