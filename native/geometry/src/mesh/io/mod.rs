//! Mesh files: OBJ, PLY, STL and OFF to [`PolygonMesh`], and back to OBJ, PLY and OFF.
//!
//! A file is read from memory in one pass, so that a sniffed pipe and a file behave alike, and
//! no count in a header is believed before the bytes for it are seen: a hostile header can
//! neither make the reader allocate nor make it panic. Text formats report the line.
//!
//! PLY is read by the crate `ply-rs-bw`. OBJ and STL have crates too, which do not fit: `tobj`
//! and `obj` give errors without line numbers (and `obj` single precision only), `stl_io` reads
//! text in single precision without line numbers. OFF has no maintained crate. These three are
//! line formats of a few statements each, and small parsers here read them. The writers are
//! loops over vertices and faces; a crate would want copies of both.
//!
//! Of OBJ, texture coordinates and the names of materials and their libraries are read and written.
//! Not read: normals, colours, curves, scenes, several objects as several meshes; `orbflow-gltf` reads
//! scenes.

mod obj;
mod off;
mod ply;
mod stl;
mod text;

use std::fmt;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{PolygonMesh, PolygonMeshError};

/// A file format for meshes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Wavefront OBJ: text, polygons, materials by name.
    Obj,
    /// Stanford PLY: text or binary, polygons; written binary in double precision.
    Ply,
    /// Stereolithography: text or binary, unconnected triangles; read only.
    Stl,
    /// Object File Format of Geomview: text, polygons.
    Off,
}

/// A mesh as a file holds it.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct MeshFile {
    /// The polygons.
    pub mesh: PolygonMesh,
    /// The material of each face as an index into the names; empty when no material is named.
    pub materials: Vec<i32>,
    /// The names of the materials, in the order in which faces or statements name them.
    pub material_names: Vec<String>,
    /// The texture coordinates of each corner, where it has any, from the lower left of the image on;
    /// empty when there are none.
    pub coordinates: Vec<Option<[f64; 2]>>,
    /// The files that say how the materials look, as the file calls them.
    pub material_libraries: Vec<String>,
}

/// Why bytes do not make a mesh.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum ReadError {
    /// A line of a text file is wrong.
    #[error("line {line}: {problem}")]
    Line {
        /// The line, counted from 1.
        line: usize,
        /// What is wrong there.
        problem: Problem,
    },
    /// A binary file is wrong.
    #[error("{0}")]
    Binary(Problem),
    /// The arrays that were read do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] PolygonMeshError),
}

/// What can be wrong at one place of a file.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Problem {
    /// A number was expected.
    #[error("'{word}' is not a number")]
    NotANumber {
        /// What stands there.
        word: String,
    },
    /// A vertex index or a count was expected.
    #[error("'{word}' is not a whole number")]
    NotAnInteger {
        /// What stands there.
        word: String,
    },
    /// A statement or a file stops too early.
    #[error("{expected} {what} expected, {found} found")]
    TooFew {
        /// How many are needed.
        expected: usize,
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite: ({x}, {y}, {z})", x = position.x, y = position.y, z = position.z)]
    NotFinite {
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its position.
        position: DVec3,
    },
    /// A face names a vertex that does not exist.
    #[error("the face names vertex {vertex}, but there are {n_vertices} vertices")]
    NoSuchVertex {
        /// What it names, as the file counts.
        vertex: i64,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// Something else stands where a statement of the format was expected.
    #[error("{expected} expected, '{found}' found")]
    Unexpected {
        /// What the format wants.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// The file ends too early.
    #[error("the file ends where {expected} was expected")]
    EndOfFile {
        /// What the format wants.
        expected: &'static str,
    },
    /// A variant of the format that is not read.
    #[error("{what} cannot be read")]
    Unsupported {
        /// The variant.
        what: String,
    },
    /// The PLY crate refuses the bytes.
    #[error("{message}")]
    Ply {
        /// Why.
        message: String,
    },
}

/// Why a mesh could not be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The format can only be read.
    #[error("{format} files are read but not written; obj, ply and off are")]
    ReadOnly {
        /// The format asked for.
        format: Format,
    },
    /// The device refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl Format {
    /// The format that a file name ends in, or none.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            _ => None,
        }
    }

    /// The name, as users write it and as file names end.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Off => "off",
        }
    }

    /// Guesses the format from the bytes; what looks like nothing else is OBJ, which has no header.
    pub fn sniff(bytes: &[u8]) -> Self {
        let start = bytes.strip_prefix(text::BYTE_ORDER_MARK).unwrap_or(bytes);
        if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
            Self::Ply
        } else if off::has_header(start) {
            Self::Off
        } else if stl::looks_like_stl(start) {
            Self::Stl
        } else {
            Self::Obj
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl From<PolygonMesh> for MeshFile {
    fn from(mesh: PolygonMesh) -> Self {
        Self {
            mesh,
            ..Self::default()
        }
    }
}

/// Reads a mesh from the bytes of a file.
///
/// STL triangles come back unconnected, each with three vertices of its own; `clean` welds them.
///
/// # Errors
/// The first thing that is wrong, with its line where the format has lines.
pub fn read(bytes: &[u8], format: Format) -> Result<MeshFile, ReadError> {
    match format {
        Format::Obj => obj::read(bytes),
        Format::Ply => ply::read(bytes).map(MeshFile::from),
        Format::Stl => stl::read(bytes).map(MeshFile::from),
        Format::Off => off::read(bytes).map(MeshFile::from),
    }
}

/// Writes a mesh; numbers are the shortest that read back as the same `f64`.
///
/// Material names and texture coordinates are kept by OBJ only.
///
/// # Errors
/// STL is not written; whatever the device says.
pub fn write(file: &MeshFile, format: Format, out: &mut dyn Write) -> Result<(), WriteError> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    match format {
        Format::Obj => obj::write(file, &mut out)?,
        Format::Ply => ply::write(&file.mesh, &mut out)?,
        Format::Off => off::write(&file.mesh, &mut out)?,
        Format::Stl => return Err(WriteError::ReadOnly { format }),
    }
    out.flush()?;
    Ok(())
}
