//! `orbflow evaluate`: what trained weights reach, on shapes trained on and on shapes never seen.

use std::path::PathBuf;

use clap::Args;
use orbflow_training::collect::{CollectError, items, others};
use orbflow_training::evaluate::outcome::Subject;
use orbflow_training::evaluate::report::{report, thinned};

use crate::bar::with_bar;
use crate::error::Error;
use crate::interrupt::Interrupt;
use crate::outputs::Outputs;
use crate::place::Place;
use crate::predictor::read_weights;
use crate::train::Data;

#[derive(Args, Debug)]
pub struct Evaluate {
    /// The weights, as `orbflow train` writes them
    #[arg(long, value_name = "FILE")]
    pub weights: PathBuf,
    /// Write the figures as JSON: medians by side and category, and every shape
    #[arg(long, value_name = "R.json")]
    pub report: Place,
    #[command(flatten)]
    pub data: Data,
    /// Folders of meshes that training was not given; once for each
    #[arg(long, value_name = "FOLDER")]
    pub other: Vec<PathBuf>,
    /// At most how many made shapes and files of each side, evenly taken
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub most: usize,
    /// Also finish the maps of whole meshes of 16,000 triangles, one after the other, for relaxations
    /// and processor time; not of shapes trained on
    #[arg(long)]
    pub finish: bool,
}

/// Measures the network, the solver and the radial projection beside each other.
pub fn evaluate(arguments: &Evaluate, interrupt: &Interrupt) -> Result<(), Error> {
    let token = interrupt.start_work();
    let mut outputs = Outputs::new([&arguments.report])?;
    let weights = read_weights(&arguments.weights)?;
    let subject = Subject::new(&weights).map_err(|cause| Error::Weights {
        path: arguments.weights.clone(),
        cause,
    })?;
    let mut items = items(&arguments.data.sources())?;
    for folder in &arguments.other {
        items.extend(others(folder)?);
    }
    let items = thinned(&items, arguments.most);
    if items.is_empty() {
        return Err(CollectError::Empty { n_left_out: 0 }.into());
    }
    let report = with_bar(token, |progress| {
        report(
            (&weights.header, &subject),
            &items,
            arguments.finish,
            progress,
        )
    })?;
    outputs.write_report(&arguments.report, &report)?;
    outputs.publish(token)
}
