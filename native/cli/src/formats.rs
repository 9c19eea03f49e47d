//! The formats of files: plain meshes and scenes.

use std::path::Path;

use orbflow_geometry::mesh::io::Format;
use orbflow_gltf::Container;

use crate::place::Place;

/// A format that meshes are read from or written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FileFormat {
    /// A mesh alone.
    Mesh(Format),
    /// A scene with materials, textures, bones and the like.
    Scene(Container),
}

const GLB: FileFormat = FileFormat::Scene(Container::Glb);
const GLTF: FileFormat = FileFormat::Scene(Container::Gltf);

/// What is read.
pub const READ: &[FileFormat] = &[
    FileFormat::Mesh(Format::Obj),
    FileFormat::Mesh(Format::Ply),
    FileFormat::Mesh(Format::Stl),
    FileFormat::Mesh(Format::Off),
    GLB,
    GLTF,
];
/// What is written.
pub const WRITTEN: &[FileFormat] = &[
    FileFormat::Mesh(Format::Obj),
    FileFormat::Mesh(Format::Ply),
    FileFormat::Mesh(Format::Off),
    GLB,
    GLTF,
];

impl FileFormat {
    /// The name, as users write it and as file names end.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.name(),
            Self::Scene(container) => container.name(),
        }
    }

    /// The format that a file name ends in, or none.
    pub fn from_path(path: &Path) -> Option<Self> {
        let mesh = || Format::from_path(path).map(Self::Mesh);
        Container::from_path(path).map(Self::Scene).or_else(mesh)
    }

    /// The format that a mesh is written in.
    pub fn of_output(place: &Place, wanted: Option<Self>) -> Option<Self> {
        let is_written = |format: &Self| WRITTEN.contains(format);
        match place.path() {
            _ if wanted.is_some() => wanted,
            Some(path) => Self::from_path(path).filter(is_written),
            None => Some(Self::Mesh(Format::Obj)),
        }
    }

    /// The format of bytes from a place: scenes are known by their first bytes whatever they are
    /// called, others by their name if it says anything.
    pub fn of_input(place: &Place, bytes: &[u8]) -> Self {
        if bytes.starts_with(orbflow_gltf::MAGIC) {
            return GLB;
        }
        let named = place.path().and_then(Self::from_path);
        let guessed = || Container::sniff(bytes).map(Self::Scene);
        let guessed = || guessed().unwrap_or_else(|| Self::Mesh(Format::sniff(bytes)));
        named.unwrap_or_else(guessed)
    }
}
