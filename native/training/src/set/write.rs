//! Writes a set, block by block.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use orbflow_network::weights::fnv;
use thiserror::Error;

use super::encode::Shape;
use super::manifest::{Counts, Head, Source};
use super::read::{Set, SetError};
use super::{BLOCK, MAGIC, VERSION};

/// A set that is being written.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    file: File,
    n_done: usize,
}

/// Why a set cannot be written.
#[derive(Debug, Error)]
pub enum WriterError {
    /// It cannot be written.
    #[error("cannot write {path}: {cause}")]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// Another program writes it.
    #[error("another run is writing {path}")]
    Locked {
        /// The file.
        path: PathBuf,
    },
    /// What is there is no set.
    #[error(transparent)]
    Set(#[from] SetError),
    /// What is there was begun with something else.
    #[error("{path} was begun with {found}, not with {wanted}; choose another file or remove it")]
    Other {
        /// The file.
        path: PathBuf,
        /// What it has.
        found: String,
        /// What is wanted.
        wanted: String,
    },
}

impl Writer {
    /// Begins a set, or goes on after the last whole block where the same was begun before.
    ///
    /// # Errors
    /// [`WriterError`]; what is there is left as it is.
    pub fn begin_or_resume(path: &Path, head: &Head, names: &[&str]) -> Result<Self, WriterError> {
        let failed = |cause| WriterError::Write {
            path: path.to_owned(),
            cause,
        };
        let front = front(head);
        // Read before it is locked: a lock keeps readers out too on some systems.
        let there = match fs::metadata(path) {
            Ok(known) => known.len(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => 0,
            Err(cause) => return Err(failed(cause)),
        };
        // A run that was cut while it wrote the head left a part of it.
        let is_new = there < front.len() as u64
            && (there == 0 || front.starts_with(&fs::read(path).map_err(failed)?));
        let (n_done, end) = if is_new {
            (0, 0)
        } else {
            let set = Set::open(path)?;
            check_same(path, (set.head(), head), (&set.sources(), names))?;
            (set.sources().len(), set.end())
        };
        let mut open = OpenOptions::new();
        let open = open.read(true).write(true).create(true).truncate(false);
        let file = open.open(path).map_err(failed)?;
        lock(&file, path)?;
        if file.metadata().map_err(failed)?.len() != there {
            let path = path.to_owned();
            return Err(WriterError::Locked { path });
        }
        let mut writer = Self {
            path: path.to_owned(),
            file,
            n_done,
        };
        writer.file.set_len(end).map_err(failed)?;
        writer.file.seek(SeekFrom::Start(end)).map_err(failed)?;
        if is_new {
            writer.file.write_all(&front).map_err(failed)?;
        }
        Ok(writer)
    }

    /// How many sources are written.
    pub fn n_done(&self) -> usize {
        self.n_done
    }

    /// Writes the next source; `source.parts` is replaced by the counts of the shapes.
    ///
    /// # Errors
    /// [`WriterError::Write`].
    pub fn append(&mut self, source: Source, shapes: &[Shape]) -> Result<(), WriterError> {
        let parts: Vec<Vec<u8>> = shapes.iter().map(Shape::to_bytes).collect();
        let counts = shapes.iter().zip(&parts).map(|(shape, bytes)| Counts {
            n_vertices: shape.whole.n_vertices(),
            n_faces: shape.whole.n_faces(),
            n_level_vertices: shape.level.n_vertices(),
            n_bytes: bytes.len() as u64,
            sum: fnv(bytes),
        });
        let source = Source {
            parts: counts.collect(),
            ..source
        };
        let entry = serde_json::to_vec(&source).expect("an entry is plain numbers and text");
        let parts = parts.concat();
        let mut block = BLOCK.to_vec();
        block.extend((entry.len() as u32).to_le_bytes());
        block.extend((parts.len() as u64).to_le_bytes());
        block.extend(fnv(&entry).to_le_bytes());
        block.extend(fnv(&block).to_le_bytes());
        block.extend(entry);
        block.extend(parts);
        let written = self.file.write_all(&block);
        written.map_err(|cause| WriterError::Write {
            path: self.path.clone(),
            cause,
        })?;
        self.n_done += 1;
        Ok(())
    }
}

/// What stands before the blocks.
fn front(head: &Head) -> Vec<u8> {
    let text = serde_json::to_vec(head).expect("a head is plain numbers");
    let mut front = MAGIC.to_vec();
    front.extend(VERSION.to_le_bytes());
    front.extend((text.len() as u32).to_le_bytes());
    front.extend(fnv(&text).to_le_bytes());
    front.extend(text);
    front
}

fn lock(file: &File, path: &Path) -> Result<(), WriterError> {
    let path = || path.to_owned();
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(WriterError::Locked { path: path() }),
        Err(TryLockError::Error(cause)) => Err(WriterError::Write {
            path: path(),
            cause,
        }),
    }
}

/// Checks that what is there is the beginning of what is wanted.
fn check_same(
    path: &Path,
    (found, wanted): (&Head, &Head),
    (sources, names): (&[&Source], &[&str]),
) -> Result<(), WriterError> {
    let other = |found: String, wanted: String| WriterError::Other {
        path: path.to_owned(),
        found,
        wanted,
    };
    if found != wanted {
        let words = |head: &Head| serde_json::to_string(head).expect("a head is plain numbers");
        let [found, wanted] = [found, wanted].map(words);
        return Err(other(found, wanted));
    }
    let pairs = sources.iter().zip(names).enumerate();
    let mut different = pairs.filter(|(_, (source, name))| source.name != **name);
    match different.next() {
        None => Ok(()),
        Some((i, (source, name))) => Err(other(
            format!("{} as source {i}", source.name),
            (*name).to_owned(),
        )),
    }
}
