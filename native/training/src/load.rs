//! Loads the samples of a set.

use orbflow_geometry::progress::{Cancelled, Progress};
use thiserror::Error;

use crate::sample::{Sample, SampleError, n_faces_for};
use crate::set::{Set, SetError, Shape, Split, Which};

/// Why a set cannot be trained on.
#[derive(Debug, Error)]
pub enum LoadError {
    /// It cannot be read.
    #[error(transparent)]
    Set(#[from] SetError),
    /// A shape of it cannot be used.
    #[error("{name}: {cause}")]
    Sample {
        /// Which.
        name: String,
        /// Why.
        cause: SampleError,
    },
    /// It was prepared for coarser levels.
    #[error(
        "the set has levels of {n_faces} faces, but a network for {n_vertices} vertices wants {wanted}; \
         prepare it with --faces {wanted}"
    )]
    Coarse {
        /// What it has.
        n_faces: usize,
        /// What the network proposes.
        n_vertices: usize,
        /// What that needs.
        wanted: usize,
    },
    /// There is nothing to train on.
    #[error(
        "the set has no shape to train on: {n_test} shapes are held back, {n_left_out} sources left out"
    )]
    Empty {
        /// Shapes that are held back.
        n_test: usize,
        /// Sources without a usable part.
        n_left_out: usize,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Checks that a network with levels of these sizes can be trained and measured on a set.
///
/// # Errors
/// [`LoadError::Coarse`].
pub fn check_levels(set: &Set, levels: &[usize]) -> Result<(), LoadError> {
    let (n_faces, wanted) = (set.head().n_faces, n_faces_for(levels));
    if n_faces >= wanted {
        return Ok(());
    }
    Err(LoadError::Coarse {
        n_faces,
        n_vertices: levels.first().copied().unwrap_or(0),
        wanted,
    })
}

/// The samples to train on and those held back.
///
/// # Errors
/// [`LoadError`].
pub fn load(
    set: &Set,
    levels: &[usize],
    progress: &Progress,
) -> Result<[Vec<Sample>; 2], LoadError> {
    check_levels(set, levels)?;
    let of = |split: Split, progress: &Progress| {
        let make = |which: Which, shape: Shape| {
            let name = which.name();
            let sample = Sample::of(name.clone(), &shape.level, levels);
            sample.map_err(|cause| LoadError::Sample { name, cause })
        };
        set.read_all(&set.shapes_of(split), make, progress)
    };
    let train = of(Split::Train, &progress.part("load", 0.0, 0.8))?;
    if train.is_empty() {
        let manifest = set.manifest();
        return Err(LoadError::Empty {
            n_test: manifest.n_test,
            n_left_out: manifest.n_left_out,
        });
    }
    let test = of(Split::Test, &progress.part("load", 0.8, 1.0))?;
    Ok([train, test])
}
