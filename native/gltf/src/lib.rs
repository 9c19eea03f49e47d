//! glTF: scenes with all that lies on their meshes, to polygons for the core and back.
//!
//! ```text
//! bytes ─ Scene::read ─▶ Scene ─ mesh(), cuts() ─▶ pipeline::remesh ─▶ mesh, origins ─ Scene::written ─▶ bytes
//! ```
//!
//! A scene's triangles become one mesh of polygons, in the place where nodes put them. The core says of
//! every element of its result where on the input it comes from; by that texture coordinates, colours,
//! weights of bones and morph targets are mixed, and every face goes back to its primitive. The text of
//! the file (nodes, materials, textures, skins, animations, cameras, extensions) stays as it is; only the
//! primitives' accessors are new, and bytes that nothing names any more go.
//!
//! A reader of its own, because the crate `gltf` keeps only what it knows of the text, reads positions
//! in single precision alone (no quantised ones), and does not say where a broken file is broken. The
//! tests read with that crate what is written here.
//!
//! Not read: packed data (Draco, meshopt). Not kept: tangents, attributes of one's own, targets of
//! anything but positions and normals; all are named in [`Scene::notes`]. Points and lines, meshes
//! outside of the scene and meshes that a node squeezes flat stay as they are.

mod accessor;
mod beside;
mod build;
mod carry;
mod container;
mod error;
mod group;
mod load;
mod normals;
mod placed;
mod plain;
mod scene;
mod schema;
mod slots;
mod triangles;
mod uses;
mod write;

use std::path::Path;

pub use container::MAGIC;
pub use error::{Item, ReadError, UriError, WriteError};
pub use plain::plain;
pub use scene::{Cuts, Made, Scene};
pub use write::Written;

/// How a file holds its text and its bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Container {
    /// One binary file.
    Glb,
    /// Text, with the bytes in it as base64.
    Gltf,
}

impl Container {
    /// The container that a file name ends in, or none; `.vrm` is a GLB file.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "glb" | "vrm" => Some(Self::Glb),
            "gltf" => Some(Self::Gltf),
            _ => None,
        }
    }

    /// The container that bytes start like, or none.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(MAGIC) {
            return Some(Self::Glb);
        }
        let head = &bytes[..bytes.len().min(1 << 16)];
        let has = |word: &[u8]| head.windows(word.len()).any(|at| at == word);
        let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        let is_object = text.trim_ascii_start().starts_with(b"{");
        let is_scene = is_object && (has(b"\"asset\"") || has(b"\"meshes\""));
        is_scene.then_some(Self::Gltf)
    }

    /// The name, as users write it and as file names end.
    pub fn name(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn containers_are_known_by_name_and_by_bytes() {
        for (path, wanted) in [
            ("a.GLB", Some(Container::Glb)),
            ("a.vrm", Some(Container::Glb)),
            ("a.gltf", Some(Container::Gltf)),
            ("a.obj", None),
            ("glb", None),
        ] {
            assert_eq!(Container::from_path(Path::new(path)), wanted, "{path}");
        }
        for (bytes, wanted) in [
            (&b"glTF\x02\0\0\0"[..], Some(Container::Glb)),
            (b" {\n\"asset\": {}}", Some(Container::Gltf)),
            (b"{\"a\": 1}", None),
            (b"v 0 0 0 \"asset\"", None),
            (b"", None),
        ] {
            assert_eq!(Container::sniff(bytes), wanted);
        }
    }
}
