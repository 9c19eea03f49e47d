//! Files that appear whole, all together, or not at all, once streams have taken their share.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use orbflow_geometry::mesh::io::{self as mesh_io, MeshFile, WriteError};
use orbflow_geometry::progress::CancelToken;
use serde::Serialize;
use tempfile::NamedTempFile;

use crate::error::Error;
use crate::formats::FileFormat;
use crate::place::Place;

/// What a run will leave behind.
///
/// Each file is first written under another name in the same folder, which is where a folder that
/// cannot be written is noticed: before the work, if [`Outputs::new`] is called before it.
pub struct Outputs {
    pending: Vec<Pending>,
}

struct Pending {
    place: Place,
    /// Where the bytes wait.
    waiting: Waiting,
}

enum Waiting {
    /// In a file beside the one that it will replace.
    Beside(NamedTempFile, PathBuf),
    /// In memory, for standard output and for devices, which cannot be replaced.
    Memory(Vec<u8>),
}

impl Outputs {
    /// Makes room for what will be written to these places.
    pub fn new<'a>(places: impl IntoIterator<Item = &'a Place>) -> Result<Self, Error> {
        let pending = places.into_iter().map(|place| {
            let waiting = Waiting::room(place).map_err(|cause| failed(place, cause))?;
            let place = place.clone();
            Ok(Pending { place, waiting })
        });
        Ok(Self {
            pending: pending.collect::<Result<_, Error>>()?,
        })
    }

    /// Writes a mesh to where it waits.
    pub fn write_mesh(
        &mut self,
        place: &Place,
        file: &MeshFile,
        format: FileFormat,
    ) -> Result<(), Error> {
        match format {
            FileFormat::Mesh(format) => {
                let out = self.room_for(place);
                mesh_io::write(file, format, out).map_err(|cause| failed(place, cause))
            }
            FileFormat::Scene(container) => {
                let bytes = orbflow_gltf::plain(file, container);
                let bytes = bytes.map_err(|cause| Error::Scene {
                    place: place.clone(),
                    cause,
                })?;
                self.write_bytes(place, &bytes)
            }
        }
    }

    /// Writes a report as JSON to where it waits.
    pub fn write_report(&mut self, place: &Place, report: &impl Serialize) -> Result<(), Error> {
        let mut text = serde_json::to_string_pretty(report)?;
        text.push('\n');
        self.write_bytes(place, text.as_bytes())
    }

    /// Writes bytes to where they wait.
    pub fn write_bytes(&mut self, place: &Place, bytes: &[u8]) -> Result<(), Error> {
        let out = self.room_for(place);
        out.write_all(bytes).map_err(|cause| failed(place, cause))
    }

    /// Lets everything that waits appear, unless the user asked to stop.
    ///
    /// Streams and devices come first: they fail more readily than a change of a file's name, and
    /// then no file has appeared.
    pub fn publish(mut self, token: &CancelToken) -> Result<(), Error> {
        if token.is_cancelled() {
            return Err(Error::Cancelled(orbflow_geometry::progress::Cancelled));
        }
        self.pending
            .sort_by_key(|pending| matches!(pending.waiting, Waiting::Beside(..)));
        for Pending { place, waiting } in self.pending {
            waiting
                .publish(&place)
                .map_err(|cause| failed(&place, cause))?;
        }
        Ok(())
    }

    fn room_for(&mut self, place: &Place) -> &mut dyn Write {
        let pending = self
            .pending
            .iter_mut()
            .find(|pending| pending.place == *place);
        match &mut pending.expect("room was made for every place").waiting {
            Waiting::Beside(file, _) => file,
            Waiting::Memory(bytes) => bytes,
        }
    }
}

impl Waiting {
    fn room(place: &Place) -> io::Result<Self> {
        // A link stays a link: what it points to is replaced.
        let Place::File(path) = place.resolved() else {
            return Ok(Self::Memory(Vec::new()));
        };
        let known = fs::metadata(&path).ok();
        match &known {
            Some(known) if known.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Some(known) if !known.is_file() => return Ok(Self::Memory(Vec::new())),
            _ => {}
        }
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let file = beside(folder.unwrap_or(Path::new(".")))?;
        if let Some(known) = known {
            file.as_file().set_permissions(known.permissions())?;
        }
        Ok(Self::Beside(file, path))
    }

    fn publish(self, place: &Place) -> io::Result<()> {
        match (self, place.path()) {
            (Self::Beside(file, path), _) => file.persist(path).map(drop).map_err(|e| e.error),
            (Self::Memory(bytes), Some(path)) => fs::OpenOptions::new()
                .write(true)
                .open(path)?
                .write_all(&bytes),
            (Self::Memory(bytes), None) => {
                let mut out = io::stdout().lock();
                out.write_all(&bytes)?;
                out.flush()
            }
        }
    }
}

/// A new file under a name that says whose it is, should the machine stop.
fn beside(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".orbflow-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Readable as far as the user's mask allows, like any new file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn failed(place: &Place, cause: impl Into<WriteError>) -> Error {
    let (place, cause) = (place.clone(), cause.into());
    Error::Write { place, cause }
}
