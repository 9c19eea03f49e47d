//! Each command: read, run the core's verb, write.

use orbflow_geometry::mesh::io::{Format, MeshFile};
use orbflow_geometry::pipeline::{self, Input};
use orbflow_geometry::progress::Cancelled;
use orbflow_geometry::{clean, score};
use serde_json::Value;

use crate::arguments::{Command, Decimate, Embed, Remesh, Score, output_format};
use crate::bar::with_bar;
use crate::error::Error;
use crate::inputs::{numbers, read};
use crate::interrupt::Interrupt;
use crate::outputs::Outputs;
use crate::place::Place;

/// Does what was asked.
pub fn run(command: &Command) -> Result<(), Error> {
    let interrupt = Interrupt::watch()?;
    match command {
        Command::Remesh(arguments) => remesh(arguments, &interrupt),
        Command::Embed(arguments) => embed(arguments, &interrupt),
        Command::Decimate(arguments) => decimate(arguments, &interrupt),
        Command::Score(arguments) => score(arguments, &interrupt),
        #[cfg(feature = "train")]
        Command::Train(arguments) => Ok(crate::train::train(arguments, &interrupt)?),
        #[cfg(feature = "train")]
        Command::Evaluate(arguments) => crate::evaluate::evaluate(arguments, &interrupt),
    }
}

fn remesh(arguments: &Remesh, interrupt: &Interrupt) -> Result<(), Error> {
    let Remesh {
        files,
        report,
        sphere,
        run,
        ..
    } = arguments;
    let place = &files.input.input;
    let file = read(place, files.input.input_format)?;
    let token = interrupt.start_work();
    let places = [Some(&files.output), report.as_ref(), sphere.as_ref()];
    let mut outputs = Outputs::new(places.into_iter().flatten())?;
    let (settings, predictor) = (arguments.settings(), run.build()?);
    let density = arguments.density.as_deref().map(numbers).transpose()?;
    let input = Input {
        materials: materials(&file),
        density: density.as_deref(),
        ..Input::new(&file.mesh)
    };
    let remeshed = with_bar(token, |progress| {
        pipeline::remesh(input, &settings, predictor.as_ref(), progress)
    });
    let remeshed = remeshed.map_err(|cause| Error::pipeline(place, cause))?;
    tell(place, &remeshed.report.clean);
    if let Some(report) = report {
        outputs.write_report(report, &remeshed.report)?;
    }
    let mut result = MeshFile {
        mesh: remeshed.mesh,
        materials: remeshed.materials.unwrap_or_default(),
        material_names: file.material_names,
    };
    outputs.write_mesh(
        &files.output,
        &result,
        format(&files.output, files.output_format),
    )?;
    if let Some(sphere) = sphere {
        result.mesh = result.mesh.with_positions(remeshed.sphere);
        outputs.write_mesh(sphere, &result, format(sphere, files.output_format))?;
    }
    outputs.publish(token)
}

fn embed(arguments: &Embed, interrupt: &Interrupt) -> Result<(), Error> {
    let Embed {
        input,
        report,
        run,
        sphere,
        ..
    } = arguments;
    let place = &input.input;
    let file = read(place, input.input_format)?;
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([Some(report), sphere.as_ref()].into_iter().flatten())?;
    let predictor = run.build()?;
    let embedded = with_bar(token, |progress| {
        pipeline::embed(&file.mesh, run.threads, predictor.as_ref(), progress)
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
    let file = read(place, files.input.input_format)?;
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([&files.output])?;
    let input = Input {
        materials: materials(&file),
        ..Input::new(&file.mesh)
    };
    let decimated = with_bar(token, |progress| {
        pipeline::decimate(input, *faces, progress)
    });
    let decimated = decimated.map_err(|cause| Error::pipeline(place, cause))?;
    tell(place, &decimated.clean);
    let result = MeshFile {
        mesh: decimated.mesh,
        materials: decimated.materials.unwrap_or_default(),
        material_names: file.material_names,
    };
    outputs.write_mesh(
        &files.output,
        &result,
        format(&files.output, files.output_format),
    )?;
    outputs.publish(token)
}

fn score(arguments: &Score, interrupt: &Interrupt) -> Result<(), Error> {
    let input = read(&arguments.input, arguments.input_format)?;
    let output = read(&arguments.output, arguments.input_format)?;
    let token = interrupt.start_work();
    let place = arguments.report.as_ref().unwrap_or(&Place::Standard);
    let mut outputs = Outputs::new([place])?;
    let settings = score::Settings::default();
    let figures = with_bar(token, |progress| {
        score::score(&input.mesh, &output.mesh, &settings, progress)
    });
    let figures = figures.map_err(|error| match error {
        score::Error::Cancelled(Cancelled) => Error::Cancelled(Cancelled),
        error => Error::Score(error),
    })?;
    match arguments.report {
        Some(_) => outputs.write_report(place, &figures)?,
        None => outputs.write_text(place, &table(&serde_json::to_value(&figures)?))?,
    }
    outputs.publish(token)
}

fn materials(file: &MeshFile) -> Option<&[i32]> {
    Some(file.materials.as_slice()).filter(|materials| !materials.is_empty())
}

fn format(place: &Place, wanted: Option<Format>) -> Format {
    output_format(place, wanted).expect("the arguments were checked")
}

/// Says on standard error what had to be mended in the input.
fn tell(place: &Place, report: &clean::Report) {
    for sentence in report.sentences() {
        eprintln!("{place}: {sentence}");
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
