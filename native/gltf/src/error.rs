//! Why bytes make no scene, and why a scene makes no bytes.

use std::fmt;
use std::io;

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMeshError;
use thiserror::Error;

/// Why bytes do not make a scene.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The file is cut off.
    #[error("{what} should have {expected} bytes, but {found} are there")]
    Truncated {
        /// What is cut off.
        what: Item,
        /// How many bytes are announced.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// The container is of another version, or not what it says.
    #[error("version {version} of the container is not read; 2 is")]
    Version {
        /// What the header says.
        version: u32,
    },
    /// The text is of another version.
    #[error("version '{version}' of glTF is not read; 2.0 is")]
    AssetVersion {
        /// What it says.
        version: String,
    },
    /// A chunk with the text is missing.
    #[error("the first chunk of the file is not JSON")]
    NoText,
    /// The text is no glTF.
    #[error("its JSON is wrong: {0}")]
    Json(#[from] serde_json::Error),
    /// Data is packed in a way that is not read.
    #[error(
        "{item} is packed by {extension}, which is not read; unpack the file first, for example with \
         'gltf-transform copy'"
    )]
    Packed {
        /// Where that is said.
        item: Item,
        /// The name of the extension.
        extension: String,
    },
    /// Something names what does not exist.
    #[error("{by} names {what} {index}, but there are {n}")]
    NoSuch {
        /// What names it.
        by: Item,
        /// What is named.
        what: &'static str,
        /// Which one.
        index: usize,
        /// How many there are.
        n: usize,
    },
    /// A range does not lie in what it is a range of.
    #[error("{item} needs {needed} bytes of {of}, which has {has}")]
    OutOfRange {
        /// What has the range.
        item: Item,
        /// Where the range ends.
        needed: u64,
        /// What it is a range of.
        of: Item,
        /// How many bytes that has.
        has: usize,
    },
    /// An accessor has values that do not fit its use.
    #[error("{item} has {found} where {expected} {} expected", if expected.starts_with("one") { "is" } else { "are" })]
    Unexpected {
        /// The accessor.
        item: Item,
        /// What fits.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// Accessors of one primitive have different counts.
    #[error("{item} has {found} elements, but {expected} vertices have a position")]
    Count {
        /// The accessor.
        item: Item,
        /// How many are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// More numbers than fit the memory of usual machines.
    #[error("the meshes have more than {most} numbers")]
    TooLarge {
        /// The most that are read.
        most: usize,
    },
    /// The nodes are no forest.
    #[error(
        "node {node} is reached twice: nodes must not share children or be their own ancestors"
    )]
    NotATree {
        /// The node.
        node: usize,
    },
    /// A transform is not finite.
    #[error("node {node} has a transform that is not finite")]
    BadTransform {
        /// The node.
        node: usize,
    },
    /// A file beside it cannot be found from here.
    #[error("{item} is the file '{uri}', which is not read: {why}")]
    Uri {
        /// What is in the file.
        item: Item,
        /// What the file is called.
        uri: String,
        /// Why it is not read.
        why: UriError,
    },
    /// No mesh of the scene has triangles.
    #[error("no node of the scene shows a mesh of triangles")]
    Nothing,
    /// The arrays that were read do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] PolygonMeshError),
}

/// Why a name of a file is not followed.
#[derive(Debug, Error)]
pub enum UriError {
    /// The name leads elsewhere.
    #[error("it leads out of the folder that the file is in")]
    Outside,
    /// There is no folder: the bytes came from a stream.
    #[error("what comes from a stream has no files beside it")]
    NoFolder,
    /// The text is no data.
    #[error("it is not base64 of bytes")]
    NotData,
    /// The file is not there.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Why a scene cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The container counts bytes in 32 bits.
    #[error("the file would have {n} bytes; GLB can have 4294967295")]
    TooLarge {
        /// How many it would have.
        n: usize,
    },
    /// A coordinate is too large for single precision, which the format has.
    #[error("a vertex of the result lies at ({x}, {y}, {z}), which is too far for single precision", x = position.x, y = position.y, z = position.z)]
    NotFinite {
        /// Where it lies.
        position: DVec3,
    },
    /// The text cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

/// A thing of a file, as messages name it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Item {
    /// The whole file.
    File,
    /// Its chunk of text or of bytes.
    Chunk(&'static str),
    /// One of a list of the text.
    Of(&'static str, usize),
    /// A primitive of a mesh.
    Primitive(usize, usize),
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => f.write_str("the file"),
            Self::Chunk(name) => write!(f, "the {name} chunk"),
            Self::Of(what, index) => write!(f, "{what} {index}"),
            Self::Primitive(mesh, primitive) => write!(f, "primitive {primitive} of mesh {mesh}"),
        }
    }
}
