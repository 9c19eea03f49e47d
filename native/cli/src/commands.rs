//! Each command: read, run the core's verb, write.

use orbflow_geometry::embed::OffsetPredictor;
use orbflow_geometry::guidance::Stroke;
use orbflow_geometry::pipeline::{self, Input, Remeshed, Settings};
use orbflow_geometry::progress::{CancelToken, Cancelled};
use orbflow_geometry::{clean, score};
use serde_json::Value;

use crate::arguments::{
    Command, Decimate, Embed, InAndOut, Predict, Rebuilt, Remesh, Score, Wanted,
};
use crate::bar::with_bar;
use crate::error::Error;
use crate::formats::FileFormat;
use crate::given::{Carried, Given, Remade};
use crate::inputs::{faces, numbers, read, read_silently};
use crate::interrupt::Interrupt;
use crate::outputs::Outputs;
use crate::parts;
use crate::place::Place;
use crate::predictor::network;

/// Does what was asked.
pub fn run(command: &Command) -> Result<(), Error> {
    let interrupt = Interrupt::watch()?;
    match command {
        Command::Remesh(arguments) => remesh(arguments, &interrupt),
        Command::Predict(arguments) => predict(arguments, &interrupt),
        Command::Embed(arguments) => embed(arguments, &interrupt),
        Command::Decimate(arguments) => decimate(arguments, &interrupt),
        Command::Score(arguments) => score(arguments, &interrupt),
        #[cfg(feature = "train")]
        Command::Prepare(arguments) => crate::prepare::prepare(arguments, &interrupt),
        #[cfg(feature = "train")]
        Command::Train(arguments) => Ok(crate::train::train(arguments, &interrupt)?),
        #[cfg(feature = "train")]
        Command::Curve(arguments) => Ok(crate::train::curve(arguments)?),
        #[cfg(feature = "train")]
        Command::Evaluate(arguments) => crate::evaluate::evaluate(arguments, &interrupt),
    }
}

fn remesh(arguments: &Remesh, interrupt: &Interrupt) -> Result<(), Error> {
    let Remesh {
        files,
        wanted,
        run,
        work,
    } = arguments;
    let predictor = run.build()?;
    let mut job = Rebuilding::begin((files, wanted), interrupt)?;
    let settings = wanted.settings(*work, files);
    let remeshed = job.remesh(&settings, predictor.as_ref())?;
    job.finish(remeshed)
}

/// The same from the network's proposal alone: no other map takes its place.
fn predict(arguments: &Predict, interrupt: &Interrupt) -> Result<(), Error> {
    let Predict {
        files,
        wanted,
        weights,
        work,
    } = arguments;
    let predictor = network(weights.as_deref())?;
    let mut job = Rebuilding::begin((files, wanted), interrupt)?;
    let settings = wanted.settings(*work, files);
    let remeshed = job.remesh(&settings, &predictor)?;
    match beyond_repair(&files.files.input.input, &remeshed.report) {
        None => job.finish(remeshed),
        Some(error) => {
            job.tell_only(&remeshed.report)?;
            Err(error)
        }
    }
}

/// The first part whose proposal was given up.
fn beyond_repair(place: &Place, report: &pipeline::Report) -> Option<Error> {
    let mut parts = report.parts.iter().enumerate();
    let (part, of_part) = parts.find(|(_, part)| part.embedding.repair.fell_back_to_solver)?;
    let proposal = of_part.embedding.proposal;
    Some(Error::BeyondRepair {
        place: place.clone(),
        part: part + 1,
        n_parts: report.parts.len(),
        n_folds: proposal.n_folds,
        n_vertices: proposal.n_vertices,
    })
}

/// A mesh on its way through the pipeline.
struct Rebuilding<'a> {
    files: &'a Rebuilt,
    token: &'a CancelToken,
    given: Given,
    /// What of it goes onto the result.
    carried: Carried,
    /// How much denser quads are wanted at every vertex, where a file says it.
    density: Option<Vec<f64>>,
    /// Lines that edges are to follow.
    guides: Vec<Stroke>,
    /// Which faces are kept, where a file says it.
    keep: Option<Vec<bool>>,
    outputs: Outputs,
}

impl<'a> Rebuilding<'a> {
    /// Reads what is to be rebuilt and makes room for the result; whatever else is read was read
    /// before, because from here on Ctrl-C no longer ends the program.
    fn begin(
        (files, wanted): (&'a Rebuilt, &Wanted),
        interrupt: &'a Interrupt,
    ) -> Result<Self, Error> {
        let InAndOut {
            input,
            output,
            output_format,
        } = &files.files;
        let given = read(&input.input, input.input_format)?;
        let carried = given.carried(format(output, *output_format), wanted.parts.weld.0);
        let density = wanted.density.as_deref().map(numbers).transpose()?;
        let guides = wanted.drawn.read()?;
        let n_faces = given.file.mesh.n_faces();
        let keep = wanted.keep.as_deref().map(|path| faces(path, n_faces));
        let keep = keep.transpose()?;
        let token = interrupt.start_work();
        let places = [Some(output), files.report.as_ref(), files.sphere.as_ref()];
        let outputs = Outputs::new(places.into_iter().flatten())?;
        Ok(Self {
            files,
            token,
            given,
            carried,
            density,
            guides,
            keep,
            outputs,
        })
    }

    fn remesh(
        &mut self,
        settings: &Settings,
        predictor: &dyn OffsetPredictor,
    ) -> Result<Remeshed, Error> {
        let files = self.files;
        let place = &files.files.input.input;
        let input = Input {
            materials: self.given.materials(),
            density: self.density.as_deref(),
            cuts: self.carried.cuts(),
            guides: &self.guides,
            keep_faces: self.keep.as_deref(),
            ..Input::new(&self.given.file.mesh)
        };
        let remeshed = with_bar(self.token, |progress| {
            pipeline::remesh(input, settings, predictor, progress)
        });
        let remeshed = match remeshed {
            Err(pipeline::Error::Unsound { report, .. }) => {
                tell_all(place, &report);
                self.tell_only(&report)?;
                let place = place.clone();
                return Err(Error::Unsound { place });
            }
            remeshed => remeshed.map_err(|cause| Error::pipeline(place, cause))?,
        };
        tell_all(place, &remeshed.report);
        if let Some(report) = &files.report {
            self.outputs.write_report(report, &remeshed.report)?;
        }
        Ok(remeshed)
    }

    /// Writes all that was asked for.
    fn finish(mut self, remeshed: Remeshed) -> Result<(), Error> {
        let InAndOut {
            output,
            output_format,
            ..
        } = &self.files.files;
        let made = Remade {
            mesh: remeshed.mesh,
            materials: remeshed.materials,
            origins: remeshed.origins,
        };
        let outputs = &mut self.outputs;
        let place = (output, format(output, *output_format));
        let mut result = self.given.write(made, &self.carried, place, outputs)?;
        if let Some(sphere) = &self.files.sphere {
            result.mesh = result.mesh.with_positions(remeshed.sphere);
            outputs.write_mesh(sphere, &result, format(sphere, *output_format))?;
        }
        self.outputs.publish(self.token)
    }

    /// Writes the report alone, where one was asked for.
    fn tell_only(&self, report: &pipeline::Report) -> Result<(), Error> {
        let mut outputs = Outputs::new(&self.files.report)?;
        if let Some(place) = &self.files.report {
            outputs.write_report(place, report)?;
        }
        outputs.publish(self.token)
    }
}

fn embed(arguments: &Embed, interrupt: &Interrupt) -> Result<(), Error> {
    let Embed {
        input,
        report,
        run,
        threads,
        sphere,
        ..
    } = arguments;
    let place = &input.input;
    let predictor = run.build()?;
    let file = read_silently(place, input.input_format)?.file;
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([Some(report), sphere.as_ref()].into_iter().flatten())?;
    let embedded = with_bar(token, |progress| {
        pipeline::embed(&file.mesh, threads.n, predictor.as_ref(), progress)
    });
    let embedded = embedded.map_err(|cause| Error::pipeline(place, cause))?;
    tell(place, &embedded.report.clean);
    outputs.write_report(report, &embedded.report)?;
    if let Some(sphere) = sphere {
        let mesh = embedded.mesh.with_positions(embedded.sphere);
        let format = format(sphere, arguments.output_format);
        outputs.write_mesh(sphere, &mesh.into(), format)?;
    }
    outputs.publish(token)
}

fn decimate(arguments: &Decimate, interrupt: &Interrupt) -> Result<(), Error> {
    let Decimate { files, faces } = arguments;
    let place = &files.input.input;
    let given = read(place, files.input.input_format)?;
    let output = (&files.output, format(&files.output, files.output_format));
    let carried = given.carried(output.1, Some(clean::WELD));
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([&files.output])?;
    let input = Input {
        materials: given.materials(),
        cuts: carried.cuts(),
        ..Input::new(&given.file.mesh)
    };
    let decimated = with_bar(token, |progress| {
        pipeline::decimate(input, *faces, progress)
    });
    let decimated = decimated.map_err(|cause| Error::pipeline(place, cause))?;
    tell(place, &decimated.clean);
    let made = Remade {
        mesh: decimated.mesh,
        materials: decimated.materials,
        origins: decimated.origins,
    };
    given.write(made, &carried, output, &mut outputs)?;
    outputs.publish(token)
}

fn score(arguments: &Score, interrupt: &Interrupt) -> Result<(), Error> {
    let input = read_silently(&arguments.input, arguments.input_format)?.file;
    let output = read_silently(&arguments.output, arguments.input_format)?.file;
    let token = interrupt.start_work();
    let place = arguments.report.as_ref().unwrap_or(&Place::Standard);
    let mut outputs = Outputs::new([place])?;
    let settings = score::Settings::default();
    let figures = with_bar(token, |progress| {
        pipeline::score(&input.mesh, &output.mesh, &settings, progress)
    });
    let figures = figures.map_err(|error| match error {
        score::Error::Cancelled(Cancelled) => Error::Cancelled(Cancelled),
        error => Error::Score(error),
    })?;
    match arguments.report {
        Some(_) => outputs.write_report(place, &figures)?,
        None => outputs.write_bytes(place, table(&serde_json::to_value(&figures)?).as_bytes())?,
    }
    outputs.publish(token)
}

fn format(place: &Place, wanted: Option<FileFormat>) -> FileFormat {
    FileFormat::of_output(place, wanted).expect("the arguments were checked")
}

/// Says on standard error what had to be mended in the input.
fn tell(place: &Place, report: &clean::Report) {
    for sentence in report.sentences() {
        eprintln!("{place}: {sentence}");
    }
}

/// Says what had to be mended in the input, what was filled, which parts are as they were, and what
/// is not as it was to be in the result.
fn tell_all(place: &Place, report: &pipeline::Report) {
    tell(place, &report.clean);
    parts::tell_filled(place, &report.parts);
    parts::tell_sealed(place, &report.parts);
    if let Some(solid) = &report.solid {
        parts::tell_solid(place, solid);
    }
    if let Some(kept) = &report.kept_faces {
        eprintln!("{place}: {}", kept.text());
    }
    parts::tell(place, &report.kept);
    for warning in &report.warnings {
        eprintln!("{place}: warning: {}", warning.text);
    }
}

/// Figures as lines of name and value.
fn table(figures: &Value) -> String {
    let Value::Object(figures) = figures else {
        return figures.to_string();
    };
    let width = figures.keys().map(String::len).max().unwrap_or(0);
    let line = |(name, value): (&String, &Value)| match value.as_f64() {
        Some(number) if value.is_f64() => format!("{name:width$}  {number:.4}\n"),
        _ => format!("{name:width$}  {value}\n"),
    };
    figures.iter().map(line).collect()
}
