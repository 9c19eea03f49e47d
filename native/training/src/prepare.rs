//! Makes a set: reads, cleans, splits, brings to size, collapses.

use std::path::{Path, PathBuf};

use orbflow_geometry::clean::clean;
use orbflow_geometry::decimate::{self, simplify};
use orbflow_geometry::mesh::TriangleMesh;
use orbflow_geometry::progress::{Cancelled, Progress};
use rayon::prelude::*;
use thiserror::Error;

use crate::parts::{Parts, split};
use crate::sample::{n_faces_for, training_level};
use crate::set::{Head, Set, SetError, Shape, Source, Writer, WriterError};
use crate::settings::SettingsError;
use crate::sources::{Found, Item, SourceError, items};
use crate::thesis::chamfer;
use crate::thesis::target::{N_FACES, Reading, ThesisError};

/// Parts of fewer triangles are boxes and wedges: any map of them will do.
const LEAST_FACES: usize = 32;
/// No file gives more parts, so that one with a hundred rivets does not outweigh the rest.
const MOST_PARTS: usize = 3;
/// Parts keep at most so many faces: evaluation finishes maps of this size.
pub const WHOLE_FACES: usize = 16_000;
/// At most so many shapes are made: beyond, the list of their names alone would fill the memory.
pub const MOST_MADE: usize = 1_000_000;
/// Longer reasons are cut: a hostile file may have a word of a megabyte, and reasons name words.
const LONGEST_REASON: usize = 300;
/// Sources between two reports of progress, and what a kill can lose.
const N_AT_ONCE: usize = 32;

/// What a set is made of.
#[derive(Clone, PartialEq, Debug)]
pub struct Settings {
    /// How many faces the level has that is collapsed.
    pub n_faces: usize,
    /// How many shapes are made from seeds, those held back among them.
    pub n_procedural: usize,
    /// Where the seeds start.
    pub seed: u64,
    /// The licence of files whose folder names none.
    pub licence: Option<String>,
    /// How targets of the thesis are made, if they are to be.
    pub targets: Option<chamfer::Settings>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            n_faces: n_faces_for(&[]),
            n_procedural: 0,
            seed: 0,
            licence: None,
            targets: None,
        }
    }
}

impl Settings {
    fn check(&self) -> Result<(), PrepareError> {
        let (n_faces, n_made) = (self.n_faces, self.n_procedural);
        if n_made > MOST_MADE {
            return Err(PrepareError::Many { n_made });
        }
        match &self.targets {
            None => Ok(()),
            Some(_) if n_faces < N_FACES => Err(PrepareError::Coarse { n_faces }),
            Some(targets) => Ok(targets.check()?),
        }
    }
}

/// Why a set is not made, or not to its end.
#[derive(Debug, Error)]
pub enum PrepareError {
    /// Targets cannot be made so.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Levels have too few faces for targets.
    #[error(
        "levels of {n_faces} faces are too coarse for targets; prepare the set with --faces {N_FACES} \
         or more"
    )]
    Coarse {
        /// How many they are to have.
        n_faces: usize,
    },
    /// More shapes are to be made than can be.
    #[error("{n_made} shapes cannot be made, at most {MOST_MADE} can be")]
    Many {
        /// How many were asked for.
        n_made: usize,
    },
    /// There is nothing to make it from.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] WriterError),
    /// It cannot be read back.
    #[error(transparent)]
    Read(#[from] SetError),
    /// The user asked to stop.
    #[error("cancelled: {n_done} of {n_sources} sources are in the set, the same command goes on")]
    Cancelled {
        /// How many sources were done.
        n_done: usize,
        /// How many there are.
        n_sources: usize,
    },
}

/// Makes a set of the meshes in some places and of made shapes, or goes on where it was cut. Targets
/// are made where the settings ask for them.
///
/// The same bytes for any number of threads, and with any number of cuts.
///
/// # Errors
/// [`PrepareError`]; a file that cannot be used is left out and named in the manifest. Whatever
/// happens, what was written is a set.
pub fn prepare(
    given: &[PathBuf],
    settings: &Settings,
    output: &Path,
    progress: &Progress,
) -> Result<Set, PrepareError> {
    settings.check()?;
    let procedural = (settings.n_procedural, settings.seed);
    let items = items(given, procedural, settings.licence.as_deref())?;
    let head = Head {
        n_faces: settings.n_faces,
        n_procedural: settings.n_procedural,
        seed: settings.seed,
        licence: settings.licence.clone(),
        n_sources: items.len(),
        targets: settings.targets.clone(),
    };
    let names: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
    let mut writer = Writer::begin_or_resume(output, &head, &names)?;
    let n_sources = items.len();
    while writer.n_done() < n_sources {
        let n_done = writer.n_done();
        let stop = |Cancelled| PrepareError::Cancelled { n_done, n_sources };
        let progress = progress.part("prepare", 0.0, 1.0);
        progress
            .at(n_done as f64 / n_sources as f64)
            .map_err(stop)?;
        let chunk = &items[n_done..n_sources.min(n_done + N_AT_ONCE)];
        let made = chunk.par_iter().map(|item| {
            let (mut source, mut shapes) = made(item, settings.n_faces);
            if let Some(targets) = &settings.targets {
                source
                    .left_out
                    .extend(add_targets(&mut shapes, targets, &progress)?);
            }
            Ok((source, shapes))
        });
        let made = made.collect::<Result<Vec<_>, Cancelled>>();
        for (source, shapes) in made.map_err(stop)? {
            writer.append(source, &shapes)?;
        }
    }
    // Whose lock would keep readers out on some systems.
    drop(writer);
    Ok(Set::open(output)?)
}

/// What becomes of a source.
fn made(item: &Item, n_faces: usize) -> (Source, Vec<Shape>) {
    let mut source = Source {
        name: item.name.clone(),
        category: item.category.clone(),
        licence: item.licence.clone(),
        split: item.split,
        parts: Vec::new(),
        left_out: Vec::new(),
    };
    let parts = match item.read() {
        Ok(Found::Made(mesh)) => vec![mesh],
        Ok(Found::File(mesh)) => match clean(&mesh, &Progress::none()) {
            Ok(cleaned) => chosen(split(&cleaned.mesh), &mut source.left_out),
            Err(error) => {
                source.left_out.push(error.to_string());
                Vec::new()
            }
        },
        Err(reason) => {
            source.left_out.push(reason);
            Vec::new()
        }
    };
    let mut shapes = Vec::with_capacity(parts.len());
    for (i, part) in parts.into_iter().enumerate() {
        match shape(part, n_faces) {
            Ok(shape) => shapes.push(shape),
            Err(reason) => source.left_out.push(format!("part {i}: {reason}")),
        }
    }
    for text in source.left_out.iter_mut().chain([&mut source.licence]) {
        if let Some((end, _)) = text.char_indices().nth(LONGEST_REASON) {
            text.truncate(end);
            text.push('…');
        }
    }
    (source, shapes)
}

/// Makes the targets of the shapes of a source; says of those without one why not.
fn add_targets(
    shapes: &mut [Shape],
    settings: &chamfer::Settings,
    progress: &Progress,
) -> Result<Vec<String>, Cancelled> {
    let mut left_out = Vec::new();
    for (i, shape) in shapes.iter_mut().enumerate() {
        let reading = Reading::new(&shape.level);
        match reading.and_then(|reading| reading.target(settings, progress)) {
            Ok(target) => shape.target = Some(target),
            Err(ThesisError::Cancelled(cancelled)) => return Err(cancelled),
            Err(error) => left_out.push(format!("the target of part {i}: {error}")),
        }
    }
    Ok(left_out)
}

/// The largest usable parts; says of the others why not.
fn chosen(parts: Parts, left_out: &mut Vec<String>) -> Vec<TriangleMesh> {
    let Parts {
        mut usable,
        n_open,
        n_with_handles,
    } = parts;
    let n_all = usable.len();
    usable.retain(|part| part.n_faces() >= LEAST_FACES);
    let n_small = n_all - usable.len();
    usable.sort_by_key(|part| std::cmp::Reverse(part.n_faces()));
    let n_more = usable.len().saturating_sub(MOST_PARTS);
    usable.truncate(MOST_PARTS);
    let small = format!("of fewer than {LEAST_FACES} triangles");
    let more = format!("beyond the {MOST_PARTS} largest");
    for (n, why) in [
        (n_open, "with a border"),
        (n_with_handles, "with handles"),
        (n_small, &small),
        (n_more, &more),
    ] {
        if n > 0 {
            let parts = if n == 1 { "part" } else { "parts" };
            left_out.push(format!("{n} {parts} {why}"));
        }
    }
    usable
}

fn shape(part: TriangleMesh, n_faces: usize) -> Result<Shape, String> {
    let whole = if part.n_faces() > WHOLE_FACES {
        let settings = decimate::Settings {
            n_faces: WHOLE_FACES,
        };
        let simplified = simplify(&part, &settings, &Progress::none());
        simplified.map_err(|e| e.to_string())?.mesh
    } else {
        part.clone()
    };
    let level = training_level(part, n_faces).map_err(|e| e.to_string())?;
    Ok(Shape {
        whole,
        level,
        target: None,
    })
}
