//! Meshes from files and from standard input.

use std::fs;
use std::io::{self, Read};

use orbflow_geometry::mesh::io::{self as mesh_io, Format, MeshFile};

use crate::error::Error;
use crate::place::Place;

/// Reads a mesh in the given format, or in that of the file's name, or in that of its bytes.
pub fn read(place: &Place, format: Option<Format>) -> Result<MeshFile, Error> {
    let bytes = bytes(place).map_err(|cause| Error::Open {
        place: place.clone(),
        cause,
    })?;
    let format = format
        .or_else(|| place.path().and_then(Format::from_path))
        .unwrap_or_else(|| Format::sniff(&bytes));
    mesh_io::read(&bytes, format).map_err(|cause| Error::Read {
        place: place.clone(),
        cause,
    })
}

fn bytes(place: &Place) -> io::Result<Vec<u8>> {
    if let Some(path) = place.path() {
        return fs::read(path);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}
