//! Writes a set, block by block.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use orbflow_network::weights::fnv;
use thiserror::Error;

use super::encode::Shape;
use super::manifest::{Counts, Head, Source};
use super::read::{Set, SetError};
use super::{BLOCK, MAGIC, version};

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
        let begun = if there == 0 {
            Vec::new()
        } else {
            first_bytes(path, front.len()).map_err(failed)?
        };
        // A run that was cut while it wrote the head left a part of it.
        let is_new = begun.len() < front.len() && front.starts_with(&begun);
        let (n_done, end) = if is_new {
            (0, 0)
        } else {
            let set = Set::open(path)?;
            // By their bytes: numbers may lose their last bit on the way through text.
            if begun != front {
                return Err(other_head(path, set.head(), head));
            }
            check_names(path, &set.sources(), names)?;
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
    front.extend(version(head).to_le_bytes());
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

/// The first bytes of a file, fewer where it has no more.
fn first_bytes(path: &Path, n: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(n);
    File::open(path)?.take(n as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn other_head(path: &Path, found: &Head, wanted: &Head) -> WriterError {
    let words = |head: &Head| serde_json::to_string(head).expect("a head is plain numbers");
    WriterError::Other {
        path: path.to_owned(),
        found: words(found),
        wanted: words(wanted),
    }
}

/// Checks that the sources that are there are the first of those that are wanted.
fn check_names(path: &Path, sources: &[&Source], names: &[&str]) -> Result<(), WriterError> {
    let pairs = sources.iter().zip(names).enumerate();
    let mut different = pairs.filter(|(_, (source, name))| source.name != **name);
    match different.next() {
        None => Ok(()),
        Some((i, (source, name))) => Err(WriterError::Other {
            path: path.to_owned(),
            found: format!("{} as source {i}", source.name),
            wanted: (*name).to_owned(),
        }),
    }
}
