//! The program `orbflow`: the core's verbs on mesh files.
//!
//! Exit codes: 0 done, 2 wrong usage, 3 this input cannot be done (or, in strict runs, not soundly),
//! 130 stopped by Ctrl-C. Files
//! are written whole or not at all, all of a run's files together, after all work is done and after
//! what goes to streams and devices. On the way are written only the set, what training goes on
//! from, and the meshes of an evaluation.

mod arguments;
mod bar;
mod commands;
mod error;
#[cfg(feature = "train")]
mod evaluate;
mod foreign;
mod formats;
mod given;
mod guides;
mod inputs;
mod interrupt;
mod outputs;
mod parsers;
mod parts;
mod place;
mod predictor;
#[cfg(feature = "train")]
mod prepare;
#[cfg(feature = "train")]
mod train;

use std::process::ExitCode;

use clap::Parser;

use arguments::Arguments;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Err(wrong_usage) = arguments.check() {
        wrong_usage.exit();
    }
    match commands::run(&arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("orbflow: {error}");
            error.exit_code()
        }
    }
}
