//! Why the program ends without doing what was asked.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use orbflow_geometry::mesh::io::{ReadError, WriteError};
use orbflow_geometry::progress::Cancelled;
use orbflow_geometry::{pipeline, score};
use orbflow_network::weights::ReadWeightsError;
#[cfg(feature = "train")]
use orbflow_training::{evaluate::outcome::OutcomeError, prepare::PrepareError, set::SetError};
use thiserror::Error;

use crate::interrupt::CANCELLED;
use crate::parts;
use crate::place::Place;

/// Why the program ends without doing what was asked.
#[derive(Debug, Error)]
pub enum Error {
    /// The input cannot be opened or its bytes not fetched.
    #[error("cannot read {place}: {cause}")]
    Open { place: Place, cause: io::Error },
    /// The input is a file of another program.
    #[error(
        "{place}: a {name} file cannot be read; open it in Blender, where the add-on does the same, or \
         convert it to GLB, OBJ or PLY"
    )]
    Foreign { place: Place, name: &'static str },
    /// The input's bytes are no mesh.
    #[error("{place}: {cause}")]
    Read { place: Place, cause: ReadError },
    /// The input's bytes are no scene.
    #[error("{place}: {cause}")]
    ReadScene {
        place: Place,
        cause: orbflow_gltf::ReadError,
    },
    /// The result cannot be put in the scene.
    #[error("cannot write {place}: {cause}")]
    Scene {
        place: Place,
        cause: orbflow_gltf::WriteError,
    },
    /// The file of weights cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    OpenWeights { path: PathBuf, cause: io::Error },
    /// The file of densities cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    OpenNumbers { path: PathBuf, cause: io::Error },
    /// A word in it is no number.
    #[error("{}, line {line}: '{word}' is not a number", path.display())]
    NotANumber {
        path: PathBuf,
        line: usize,
        word: String,
    },
    /// A word in it names no faces of the mesh.
    #[error(
        "{}, line {line}: '{word}' names no faces; there are {n_faces}, from 0 on", path.display()
    )]
    NotFaces {
        path: PathBuf,
        line: usize,
        word: String,
        n_faces: usize,
    },
    /// The file of guides cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    OpenGuides { path: PathBuf, cause: io::Error },
    /// A word in it is no point, or no number of one.
    #[error("{}, line {line}: '{word}' names no point; there are {n_points}", path.display())]
    NotAGuide {
        path: PathBuf,
        line: usize,
        word: String,
        n_points: usize,
    },
    /// There is no line in it.
    #[error("{}: there is no line in it; guides are OBJ files with v and l elements", path.display())]
    NoGuides { path: PathBuf },
    /// The file holds no weights that this program can use.
    #[error("{}: {cause}", path.display())]
    Weights {
        path: PathBuf,
        cause: ReadWeightsError,
    },
    /// The output cannot be made.
    #[error("cannot write {place}: {cause}")]
    Write { place: Place, cause: WriteError },
    /// The mesh cannot be done.
    #[error("{place}: {cause}")]
    Pipeline {
        place: Place,
        cause: pipeline::Error,
    },
    /// No part of the mesh can be done, or in a strict run not all.
    #[error("{}", lines.join(&format!("\norbflow: {place}: ")))]
    Refused { place: Place, lines: Vec<String> },
    /// A strict run made a result that is not fit for use.
    #[error("{place}: the result is not sound, so no mesh was written; the warnings say why")]
    Unsound { place: Place },
    /// The network's proposal for a part was no use.
    #[error(
        "{place}: the proposal for part {part} of {n_parts} is beyond repair: {n_folds} triangles are \
         folded on its {n_vertices} vertices; orbflow remesh takes the solver's map in such a case"
    )]
    BeyondRepair {
        place: Place,
        part: usize,
        n_parts: usize,
        n_folds: usize,
        n_vertices: usize,
    },
    /// The meshes cannot be compared.
    #[error("cannot score: {0}")]
    Score(score::Error),
    /// The report cannot be put in words.
    #[error("cannot write the report: {0}")]
    Report(#[from] serde_json::Error),
    /// Training ends early.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Train(#[from] crate::train::Error),
    /// The set cannot be made, or not to its end.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// A set cannot be read.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Set(#[from] SetError),
    /// There are no shapes to evaluate.
    #[cfg(feature = "train")]
    #[error("the set has no such shapes")]
    NoShapes,
    /// The network of the thesis cannot be trained.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Outcome(#[from] OutcomeError),
    /// The signal handler cannot be set.
    #[error("cannot watch for ctrl-c: {0}")]
    Signal(#[from] ctrlc::Error),
    /// The user asked to stop.
    #[error("cancelled, nothing was written")]
    Cancelled(#[from] Cancelled),
    /// The user asked to stop an evaluation, which writes meshes as it makes them.
    #[cfg(feature = "train")]
    #[error("cancelled, no report was written; meshes made by then are in {}", .0.display())]
    CancelledAmongMeshes(PathBuf),
}

impl Error {
    /// The code that the program ends with.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(if self.is_cancelled() { CANCELLED } else { 3 })
    }

    /// Whether the user asked to stop.
    pub fn is_cancelled(&self) -> bool {
        match self {
            Self::Cancelled(_) => true,
            #[cfg(feature = "train")]
            Self::CancelledAmongMeshes(_) => true,
            #[cfg(feature = "train")]
            Self::Train(error) => error.is_cancelled(),
            #[cfg(feature = "train")]
            Self::Prepare(error) => matches!(error, PrepareError::Cancelled { .. }),
            #[cfg(feature = "train")]
            Self::Set(error) => matches!(error, SetError::Cancelled(_)),
            #[cfg(feature = "train")]
            Self::Outcome(error) => error.is_cancelled(),
            _ => false,
        }
    }

    /// An error of the pipeline on the mesh from `place`.
    pub fn pipeline(place: &Place, cause: pipeline::Error) -> Self {
        if cause.is_cancelled() {
            return Self::Cancelled(Cancelled);
        }
        let place = place.clone();
        match cause {
            pipeline::Error::Refused { kept, .. } => {
                let mut lines = parts::lines(&kept, "nothing was written");
                if let Some(first) = lines.first_mut() {
                    *first = format!("{place}: {first}");
                }
                Self::Refused { place, lines }
            }
            cause => Self::Pipeline { place, cause },
        }
    }
}
