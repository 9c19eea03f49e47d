//! Collects shapes to train on and shapes to hold back.

use std::fmt::Display;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use orbflow_geometry::clean::clean;
use orbflow_geometry::mesh::TriangleMesh;
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
/// Items between two reports of progress.
pub const N_AT_ONCE: usize = 32;

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

/// Whether training sees a shape.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// It is trained on.
    Training,
    /// It is held back.
    HeldOut,
    /// It is of a folder that training was not given.
    Other,
}

/// What one or a few shapes are made from.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Item {
    /// On which side its shapes are.
    pub side: Side,
    origin: Origin,
}

#[derive(Clone, PartialEq, Eq, Debug)]
enum Origin {
    Seed(u64),
    File(PathBuf),
}

/// A closed mesh of genus 0.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Where it comes from.
    pub name: String,
    /// The folder that its file is in.
    pub category: String,
    /// Itself.
    pub mesh: TriangleMesh,
}

/// What was made of shapes, each with its side.
#[derive(Clone, Debug)]
pub struct Gathered<T> {
    /// In the order of the items.
    pub all: Vec<(Side, T)>,
    /// Files without a usable part, and why.
    pub left_out: Vec<(PathBuf, String)>,
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
    /// There is no usable shape.
    #[error("there is no usable shape: {n_left_out} files were left out")]
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
    let sample = |_, shape: Shape| Sample::new(shape.name, shape.mesh, levels);
    let gathered = gather(&items(sources)?, sample, N_AT_ONCE, progress)?;
    let mut collection = Collection {
        left_out: gathered.left_out,
        ..Collection::default()
    };
    for (side, sample) in gathered.all {
        match side {
            Side::Training => collection.training.push(sample),
            Side::HeldOut | Side::Other => collection.held_out.push(sample),
        }
    }
    if collection.training.is_empty() {
        let n_left_out = collection.left_out.len();
        return Err(CollectError::Empty { n_left_out });
    }
    Ok(collection)
}

/// What there is to train on and to hold back: seeds first, then files in the order of their paths.
///
/// # Errors
/// [`CollectError::Read`].
pub fn items(sources: &Sources) -> Result<Vec<Item>, CollectError> {
    let mut paths = Vec::new();
    for folder in &sources.folders {
        list(folder, &mut paths)?;
    }
    let made = |side: Side, first: u64, n: usize| {
        let seeds = first..first + n as u64;
        seeds.map(move |seed| Item {
            side,
            origin: Origin::Seed(seed),
        })
    };
    let mut items: Vec<Item> = made(Side::Training, 0, sources.n_shapes)
        .chain(made(Side::HeldOut, FIRST_HELD_OUT, sources.n_held_out))
        .collect();
    items.extend(paths.into_iter().map(|path| Item {
        side: if is_held_out(&path) {
            Side::HeldOut
        } else {
            Side::Training
        },
        origin: Origin::File(path),
    }));
    Ok(items)
}

/// The files of a folder that training was not given.
///
/// # Errors
/// [`CollectError::Read`].
pub fn others(folder: &Path) -> Result<Vec<Item>, CollectError> {
    let mut paths = Vec::new();
    list(folder, &mut paths)?;
    let item = |path| Item {
        side: Side::Other,
        origin: Origin::File(path),
    };
    Ok(paths.into_iter().map(item).collect())
}

/// Makes something of every shape, of so many items at once; the same for any number of threads.
///
/// # Errors
/// [`Cancelled`]; a file whose shapes cannot be used is left out and named.
pub fn gather<T: Send, E: Display>(
    items: &[Item],
    make: impl Fn(Side, Shape) -> Result<T, E> + Sync,
    n_at_once: usize,
    progress: &Progress,
) -> Result<Gathered<T>, Cancelled> {
    let (mut all, mut left_out) = (Vec::with_capacity(items.len()), Vec::new());
    for (i, chunk) in items.chunks(n_at_once).enumerate() {
        progress.at((n_at_once * i) as f64 / items.len() as f64)?;
        let made = chunk.par_iter().map(|item| {
            let shapes = item.shapes()?.into_iter();
            let made = shapes.map(|shape| make(item.side, shape).map_err(|e| e.to_string()));
            made.collect::<Result<Vec<T>, String>>()
        });
        for (item, made) in chunk.iter().zip(made.collect::<Vec<_>>()) {
            match (made, &item.origin) {
                (Ok(made), _) => all.extend(made.into_iter().map(|one| (item.side, one))),
                (Err(reason), Origin::File(path)) => left_out.push((path.clone(), reason)),
                // A shape that does not collapse is not worth more than leaving it out.
                (Err(_), Origin::Seed(_)) => {}
            }
        }
    }
    Ok(Gathered { all, left_out })
}

impl Item {
    /// The largest usable parts, or why there are none.
    fn shapes(&self) -> Result<Vec<Shape>, String> {
        match &self.origin {
            Origin::Seed(seed) => Ok(vec![Shape {
                name: format!("shape {seed}"),
                category: "made".to_owned(),
                mesh: shape(*seed),
            }]),
            Origin::File(path) => from_file(path),
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
fn from_file(path: &Path) -> Result<Vec<Shape>, String> {
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
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
    let named = parts.into_iter().enumerate().map(|(i, mesh)| Shape {
        name: format!("{} part {i}", path.display()),
        category: folder.to_string_lossy().into_owned(),
        mesh,
    });
    Ok(named.collect())
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
