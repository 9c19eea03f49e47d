//! Meshes from files and from standard input.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use orbflow_geometry::mesh::io as mesh_io;
use orbflow_gltf::Scene;

use crate::error::Error;
use crate::foreign;
use crate::formats::FileFormat;
use crate::given::Given;
use crate::place::Place;

/// Reads a mesh in the given format, or in that of the file's name, or in that of its bytes. Files of
/// other programs are named as such. Says what of a scene is not taken over.
pub fn read(place: &Place, format: Option<FileFormat>) -> Result<Given, Error> {
    let given = read_silently(place, format)?;
    given.tell(place);
    Ok(given)
}

/// The same where only the shape is of use.
pub fn read_silently(place: &Place, format: Option<FileFormat>) -> Result<Given, Error> {
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
    match format.unwrap_or_else(|| FileFormat::of_input(place, &bytes)) {
        FileFormat::Mesh(format) => {
            let file = mesh_io::read(&bytes, format);
            file.map(Given::from).map_err(|cause| Error::Read {
                place: place.clone(),
                cause,
            })
        }
        FileFormat::Scene(_) => {
            let folder = place.path().map(folder);
            let scene = Scene::read(&bytes, folder.as_deref());
            scene.map(Given::from).map_err(|cause| Error::ReadScene {
                place: place.clone(),
                cause,
            })
        }
    }
}

/// The folder that a file is in.
fn folder(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|path| !path.as_os_str().is_empty());
    folder.unwrap_or(Path::new(".")).to_owned()
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

/// Which of so many faces a text file of whitespace-separated numbers and ranges of them names.
pub fn faces(path: &Path, n_faces: usize) -> Result<Vec<bool>, Error> {
    let text = fs::read_to_string(path).map_err(|cause| Error::OpenNumbers {
        path: path.to_owned(),
        cause,
    })?;
    let mut are_named = vec![false; n_faces];
    for (i, line) in text.lines().enumerate() {
        for word in line.split_whitespace() {
            let not_faces = || Error::NotFaces {
                path: path.to_owned(),
                line: i + 1,
                word: word.to_owned(),
                n_faces,
            };
            let (first, last) = word.split_once('-').unwrap_or((word, word));
            let [first, last] = [first, last].map(str::parse::<usize>);
            let (Ok(first), Ok(last)) = (first, last) else {
                return Err(not_faces());
            };
            let named = are_named.get_mut(first..last.saturating_add(1));
            named
                .filter(|named| !named.is_empty())
                .ok_or_else(not_faces)?
                .fill(true);
        }
    }
    Ok(are_named)
}

fn bytes(place: &Place) -> io::Result<Vec<u8>> {
    if let Some(path) = place.path() {
        return fs::read(path);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}
