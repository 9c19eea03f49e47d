//! Meshes from files and from standard input.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use orbflow_geometry::mesh::io::{self as mesh_io, Format, MeshFile};

use crate::error::Error;
use crate::foreign;
use crate::place::Place;

/// Reads a mesh in the given format, or in that of the file's name, or in that of its bytes. Files of
/// other programs are named as such.
pub fn read(place: &Place, format: Option<Format>) -> Result<MeshFile, Error> {
    let bytes = bytes(place).map_err(|cause| Error::Open {
        place: place.clone(),
        cause,
    })?;
    if format.is_none()
        && let Some(name) = foreign::name(place.path(), &bytes)
    {
        let place = place.clone();
        return Err(Error::Foreign { place, name });
    }
    let format = format
        .or_else(|| place.path().and_then(Format::from_path))
        .unwrap_or_else(|| Format::sniff(&bytes));
    mesh_io::read(&bytes, format).map_err(|cause| Error::Read {
        place: place.clone(),
        cause,
    })
}

/// Numbers from a text file, between white space.
pub fn numbers(path: &Path) -> Result<Vec<f64>, Error> {
    let text = fs::read_to_string(path).map_err(|cause| Error::OpenNumbers {
        path: path.to_owned(),
        cause,
    })?;
    let lines = text.lines().enumerate();
    let words = lines.flat_map(|(i, line)| line.split_whitespace().map(move |word| (i + 1, word)));
    let number = |(line, word): (usize, &str)| {
        word.parse().map_err(|_| Error::NotANumber {
            path: path.to_owned(),
            line,
            word: word.to_owned(),
        })
    };
    words.map(number).collect()
}

fn bytes(place: &Place) -> io::Result<Vec<u8>> {
    if let Some(path) = place.path() {
        return fs::read(path);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}
