//! Reads a set.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_network::weights::fnv;
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::encode::{PartError, Shape};
use super::manifest::{Head, Manifest, Source, Split};
use super::{BLOCK, BLOCK_FRONT, FRONT, MAGIC, MAX_TEXT, PLAIN, WITH_TARGETS, number, version};

/// Parts that are read between two reports of progress.
const N_AT_ONCE: usize = 64;

/// A set that is open.
#[derive(Debug)]
pub struct Set {
    path: PathBuf,
    file: Mutex<File>,
    head: Head,
    sources: Vec<Placed>,
    /// Where the last whole block ends.
    end: u64,
    sum: u64,
}

/// A source, and where its parts begin.
#[derive(Debug)]
struct Placed {
    source: Source,
    at: u64,
}

/// Why a file is no set.
#[derive(Debug, Error)]
pub enum SetError {
    /// It cannot be read.
    #[error("cannot read {path}: {cause}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// It begins with something else.
    #[error("{path} is no set of orbflow: it does not begin with ORBFLOWS")]
    NotASet {
        /// The file.
        path: PathBuf,
    },
    /// Made by another version.
    #[error(
        "{path} is a set of version {found}; this program reads versions {PLAIN} to {WITH_TARGETS}"
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// What it says.
        found: u32,
    },
    /// Its bytes changed since they were written.
    #[error("{path} is damaged at byte {at}: {reason}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        at: u64,
        /// What is wrong there.
        reason: String,
    },
    /// A part is not what it promises.
    #[error("{path}, {name} part {part}: {cause}")]
    Part {
        /// The file.
        path: PathBuf,
        /// The source.
        name: String,
        /// Which part of it, counted from 0.
        part: usize,
        /// Why.
        cause: PartError,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A shape of a set, and where it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Which<'a> {
    /// The source.
    pub source: &'a Source,
    /// Which part of it, counted from 0.
    pub part: usize,
    /// Where it begins.
    at: u64,
}

impl Which<'_> {
    /// What reports call the shape.
    pub fn name(&self) -> String {
        format!("{} part {}", self.source.name, self.part)
    }
}

impl Set {
    /// Opens a set and reads its manifest; parts are read when they are asked for.
    ///
    /// # Errors
    /// [`SetError`]. A last block that was cut is no error: [`Set::manifest`] says that the set is not
    /// complete.
    pub fn open(path: &Path) -> Result<Self, SetError> {
        let mut reading = Reading::new(path)?;
        let head = reading.head()?;
        let mut sources = Vec::new();
        while sources.len() < head.n_sources
            && let Some(placed) = reading.block()?
        {
            sources.push(placed);
        }
        let end = reading.at;
        if sources.len() == head.n_sources && end < reading.length {
            let n_left = reading.length - end;
            return Err(reading.damaged(format!("{n_left} bytes follow the last source")));
        }
        Ok(Self {
            path: path.to_owned(),
            file: Mutex::new(reading.file),
            head,
            sources,
            end,
            sum: fnv(&reading.sums),
        })
    }

    /// What it says of itself.
    pub fn manifest(&self) -> Manifest<'_> {
        Manifest::new(&self.head, self.sources().into_iter())
    }

    /// What it was asked for.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// FNV-1a over the sums of its head and its entries, which hold those of the parts: another set has
    /// another, and so has the same one when it has grown.
    pub fn sum(&self) -> u64 {
        self.sum
    }

    /// Its sources, in order.
    pub fn sources(&self) -> Vec<&Source> {
        self.sources.iter().map(|placed| &placed.source).collect()
    }

    /// Where the last whole block ends: a run that goes on writes from there.
    pub(super) fn end(&self) -> u64 {
        self.end
    }

    /// Its shapes, in the order of the sources.
    pub fn shapes(&self) -> Vec<Which<'_>> {
        let mut shapes = Vec::new();
        for Placed { source, at } in &self.sources {
            let mut at = *at;
            for (part, counts) in source.parts.iter().enumerate() {
                shapes.push(Which { source, part, at });
                at += counts.n_bytes;
            }
        }
        shapes
    }

    /// The shapes of one side.
    pub fn shapes_of(&self, split: Split) -> Vec<Which<'_>> {
        let mut shapes = self.shapes();
        shapes.retain(|which| which.source.split == split);
        shapes
    }

    /// Reads a shape.
    ///
    /// # Errors
    /// [`SetError`].
    pub fn read(&self, which: Which<'_>) -> Result<Shape, SetError> {
        let counts = &which.source.parts[which.part];
        let bytes = {
            let file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            read_at(&file, which.at, counts.n_bytes as usize)
        };
        let path = self.path.clone();
        let bytes = match bytes {
            Ok(bytes) => bytes,
            Err(cause) => return Err(SetError::Read { path, cause }),
        };
        let found = fnv(&bytes);
        if found != counts.sum {
            let reason = format!(
                "the sum of {} is {found:016x}, but was {:016x}",
                which.name(),
                counts.sum
            );
            let at = which.at;
            return Err(SetError::Damaged { path, at, reason });
        }
        Shape::from_bytes(&bytes, self.head.targets.as_ref()).map_err(|cause| SetError::Part {
            path,
            name: which.source.name.clone(),
            part: which.part,
            cause,
        })
    }

    /// Reads shapes and makes something of each, in their order; the same for any number of threads.
    ///
    /// # Errors
    /// [`SetError`], or what `make` says.
    pub fn read_all<'a, T: Send, E: From<SetError> + From<Cancelled> + Send>(
        &'a self,
        shapes: &[Which<'a>],
        make: impl Fn(Which<'a>, Shape) -> Result<T, E> + Sync,
        progress: &Progress,
    ) -> Result<Vec<T>, E> {
        let mut made = Vec::with_capacity(shapes.len());
        for chunk in shapes.chunks(N_AT_ONCE) {
            progress.at(made.len() as f64 / shapes.len() as f64)?;
            let chunk = chunk
                .par_iter()
                .map(|&which| make(which, self.read(which)?));
            made.extend(chunk.collect::<Result<Vec<T>, E>>()?);
        }
        Ok(made)
    }
}

/// A file on its way to be a set.
struct Reading {
    path: PathBuf,
    file: File,
    length: u64,
    at: u64,
    /// The sums of the texts so far.
    sums: Vec<u8>,
}

impl Reading {
    fn new(path: &Path) -> Result<Self, SetError> {
        let open = File::open(path).and_then(|file| Ok((file.metadata()?, file)));
        match open {
            Ok((known, file)) => Ok(Self {
                path: path.to_owned(),
                file,
                length: known.len(),
                at: 0,
                sums: Vec::new(),
            }),
            Err(cause) => Err(SetError::Read {
                path: path.to_owned(),
                cause,
            }),
        }
    }

    fn head(&mut self) -> Result<Head, SetError> {
        let path = self.path.clone();
        let n_front = self.length.min(FRONT as u64) as usize;
        let front = self.bytes(0, n_front)?;
        if !front.starts_with(MAGIC) {
            return Err(SetError::NotASet { path });
        }
        if front.len() < FRONT {
            return Err(self.damaged(format!("{n_front} bytes are no head; {FRONT} would be")));
        }
        let found = number(&front[8..12]) as u32;
        if !(PLAIN..=WITH_TARGETS).contains(&found) {
            return Err(SetError::Version { path, found });
        }
        self.at = FRONT as u64;
        let length = number(&front[12..16]);
        if length > self.length - self.at {
            let left = self.length - self.at;
            return Err(self.damaged(format!("the head has {length} bytes, but {left} are left")));
        }
        let text = self.text(length)?;
        let head: Head = self.json(&text, number(&front[16..24]))?;
        if found != version(&head) {
            let reason = format!("a set of version {found} has no such head");
            return Err(self.damaged(reason));
        }
        self.at += length;
        Ok(head)
    }

    /// The next block; none where it is cut or there is none.
    fn block(&mut self) -> Result<Option<Placed>, SetError> {
        if self.length - self.at < BLOCK_FRONT as u64 {
            return Ok(None);
        }
        let front = self.bytes(self.at, BLOCK_FRONT)?;
        let (found, wanted) = (fnv(&front[..24]), number(&front[24..]));
        if !front.starts_with(BLOCK) || found != wanted {
            return Err(self.damaged("there is no block".to_owned()));
        }
        let [n_entry, n_parts] = [number(&front[4..8]), number(&front[8..16])];
        let left = self.length - self.at - BLOCK_FRONT as u64;
        if n_entry.saturating_add(n_parts) > left {
            return Ok(None);
        }
        self.at += BLOCK_FRONT as u64;
        let text = self.text(n_entry)?;
        let source: Source = self.json(&text, number(&front[16..24]))?;
        let told = source.parts.iter();
        let told = told.fold(0u64, |sum, counts| sum.saturating_add(counts.n_bytes));
        if told != n_parts {
            let name = &source.name;
            return Err(self.damaged(format!(
                "the parts of {name} have {n_parts} bytes, but {told} by its entry"
            )));
        }
        let at = self.at + n_entry;
        self.at = at + n_parts;
        Ok(Some(Placed { source, at }))
    }

    /// A text that is here and short enough to be one.
    fn text(&mut self, length: u64) -> Result<Vec<u8>, SetError> {
        if length > MAX_TEXT as u64 {
            return Err(self.damaged(format!(
                "a text of {length} bytes; at most {MAX_TEXT} can be"
            )));
        }
        self.bytes(self.at, length as usize)
    }

    fn json<T: DeserializeOwned>(&mut self, text: &[u8], wanted: u64) -> Result<T, SetError> {
        let found = fnv(text);
        if found != wanted {
            return Err(self.damaged(format!("the sum is {found:016x}, but was {wanted:016x}")));
        }
        self.sums.extend(found.to_le_bytes());
        serde_json::from_slice(text).map_err(|error| self.damaged(error.to_string()))
    }

    fn bytes(&self, at: u64, n: usize) -> Result<Vec<u8>, SetError> {
        read_at(&self.file, at, n).map_err(|cause| SetError::Read {
            path: self.path.clone(),
            cause,
        })
    }

    fn damaged(&self, reason: String) -> SetError {
        SetError::Damaged {
            path: self.path.clone(),
            at: self.at,
            reason,
        }
    }
}

fn read_at(mut file: &File, at: u64, n: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; n];
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}
