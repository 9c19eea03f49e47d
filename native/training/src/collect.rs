//! Collects shapes to train on and shapes to hold back.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use orbflow_geometry::clean::clean;
use orbflow_geometry::mesh::io::{Format, read};
use orbflow_geometry::progress::{Cancelled, Progress};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::parts::closed_parts;
use crate::sample::Sample;
use crate::shapes::shape;

/// Seeds of shapes that are held back start here; training starts at 0 and never comes so far.
const FIRST_HELD_OUT: u64 = 1 << 40;
/// Of a hundred files, how many are held back, with all their parts.
const HELD_OUT_PCT: u64 = 15;
/// Parts of fewer triangles are boxes and wedges: any map of them will do.
const LEAST_FACES: usize = 32;
/// No file gives more parts, so that one with a hundred rivets does not outweigh the rest.
const MOST_PARTS: usize = 3;

/// Where shapes come from.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Sources {
    /// How many shapes are made for training.
    pub n_shapes: usize,
    /// How many more are made and held back.
    pub n_held_out: usize,
    /// Folders of meshes, read with their subfolders.
    pub folders: Vec<PathBuf>,
}

/// Shapes to train on and shapes that training never sees.
#[derive(Clone, Debug, Default)]
pub struct Collection {
    /// To train on.
    pub training: Vec<Sample>,
    /// To measure on.
    pub held_out: Vec<Sample>,
    /// Files without a usable part, and why.
    pub left_out: Vec<(PathBuf, String)>,
}

/// Why shapes cannot be collected.
#[derive(Debug, Error)]
pub enum CollectError {
    /// A folder or file cannot be read.
    #[error("cannot read {path}: {cause}")]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is nothing to train on.
    #[error("there is no shape to train on: {n_left_out} files were left out")]
    Empty {
        /// How many files had no usable part.
        n_left_out: usize,
    },
}

/// Makes and reads the shapes; the same for any number of threads.
///
/// # Errors
/// [`CollectError`]; a file that cannot be used is left out and named.
pub fn collect(
    sources: &Sources,
    levels: &[usize],
    progress: &Progress,
) -> Result<Collection, CollectError> {
    let mut collection = Collection::default();
    let mut paths = Vec::new();
    for folder in &sources.folders {
        list(folder, &mut paths)?;
    }
    let made = |first: u64, n: usize| first..first + n as u64;
    let seeds: Vec<u64> = made(0, sources.n_shapes)
        .chain(made(FIRST_HELD_OUT, sources.n_held_out))
        .collect();
    let n_all = (paths.len() + seeds.len()).max(1) as f64;
    for (i, seeds) in seeds.chunks(32).enumerate() {
        progress.at(32.0 * i as f64 / n_all)?;
        let samples = seeds.par_iter().map(|&seed| {
            let name = format!("shape {seed}");
            (
                seed >= FIRST_HELD_OUT,
                Sample::new(name, shape(seed), levels),
            )
        });
        for (is_held_out, sample) in samples.collect::<Vec<_>>() {
            // A shape that does not collapse is not worth more than leaving it out.
            collection.side(is_held_out).extend(sample);
        }
    }
    for (i, chunk) in paths.chunks(32).enumerate() {
        progress.at((seeds.len() as f64 + 32.0 * i as f64) / n_all)?;
        let read = chunk.par_iter().map(|path| from_file(path, levels));
        for (path, samples) in chunk.iter().zip(read.collect::<Vec<_>>()) {
            match samples {
                Ok(samples) => collection.side(is_held_out(path)).extend(samples),
                Err(reason) => collection.left_out.push((path.clone(), reason)),
            }
        }
    }
    if collection.training.is_empty() {
        let n_left_out = collection.left_out.len();
        return Err(CollectError::Empty { n_left_out });
    }
    Ok(collection)
}

impl Collection {
    fn side(&mut self, is_held_out: bool) -> &mut Vec<Sample> {
        if is_held_out {
            &mut self.held_out
        } else {
            &mut self.training
        }
    }
}

/// By the name without its number, so that more files do not move a file to the other side and
/// that the parts and variants of one model (`sofa2_01`, `sofa2_02`, `sofa_01`) are on one side.
fn is_held_out(path: &Path) -> bool {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let model = stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    let hash = model.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    (hash >> 32) % 100 < HELD_OUT_PCT
}

fn list(folder: &Path, paths: &mut Vec<PathBuf>) -> Result<(), CollectError> {
    let failed = |cause| CollectError::Read {
        path: folder.to_owned(),
        cause,
    };
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut entries: Vec<PathBuf> = entries
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()
        .map_err(failed)?;
    entries.sort();
    for path in entries {
        if path.is_dir() {
            list(&path, paths)?;
        } else if Format::from_path(&path).is_some() {
            paths.push(path);
        }
    }
    Ok(())
}

/// The largest usable parts of a file, or why there are none.
fn from_file(path: &Path, levels: &[usize]) -> Result<Vec<Sample>, String> {
    let format = Format::from_path(path).ok_or("not a mesh")?;
    let bytes = fs::read(path).map_err(|e| e.to_string())?;
    let file = read(&bytes, format).map_err(|e| e.to_string())?;
    let cleaned = clean(&file.mesh, &Progress::none()).map_err(|e| e.to_string())?;
    let mut parts = closed_parts(&cleaned.mesh);
    parts.retain(|part| part.n_faces() >= LEAST_FACES);
    parts.sort_by_key(|part| std::cmp::Reverse(part.n_faces()));
    parts.truncate(MOST_PARTS);
    if parts.is_empty() {
        return Err("no closed part of genus 0 that is large enough".to_owned());
    }
    let named = parts.into_iter().enumerate().map(|(i, part)| {
        let name = format!("{} part {i}", path.display());
        Sample::new(name, part, levels).map_err(|e| e.to_string())
    });
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_stays_on_its_side() {
        let held = |name: &str| is_held_out(Path::new(name));
        let n = (0..1000)
            .filter(|i| held(&format!("a/{i}.model.obj")))
            .count();
        assert!((100..200).contains(&n), "{n}");
        for i in 0..40 {
            let sides = ["a/{i}sofa_01.obj", "b/c/{i}sofa_12.off", "{i}sofa2_03.obj"];
            let sides = sides.map(|name| held(&name.replace("{i}", &i.to_string())));
            assert!(sides.iter().all(|&side| side == sides[0]), "{i}");
        }
    }
}
