//! Files of programs and engines that are not read here, told by their ending or their first bytes.

use std::path::Path;

/// What a file ends in, how its bytes start, and what it is called.
struct Foreign {
    name: &'static str,
    endings: &'static [&'static str],
    starts: &'static [&'static [u8]],
}

const FOREIGN: &[Foreign] = &[
    Foreign {
        name: "FBX",
        endings: &["fbx"],
        starts: &[b"Kaydara FBX Binary", b"; FBX "],
    },
    Foreign {
        name: "Blender",
        endings: &["blend"],
        starts: &[b"BLENDER"],
    },
    Foreign {
        name: "USD",
        endings: &["usd", "usda", "usdc", "usdz"],
        starts: &[b"PXR-USDC", b"#usda"],
    },
    Foreign {
        name: "Collada",
        endings: &["dae"],
        starts: &[],
    },
    Foreign {
        name: "Alembic",
        endings: &["abc"],
        starts: &[b"Ogawa"],
    },
    Foreign {
        name: "3MF",
        endings: &["3mf"],
        starts: &[],
    },
    Foreign {
        name: "3D Studio",
        endings: &["3ds", "max"],
        starts: &[],
    },
    Foreign {
        name: "VRML or X3D",
        endings: &["wrl", "x3d", "x3dv"],
        starts: &[b"#VRML"],
    },
    Foreign {
        name: "CAD",
        endings: &["step", "stp", "iges", "igs"],
        starts: &[b"ISO-10303-21"],
    },
];

/// How far into a text its first element is looked for.
const HEAD: usize = 1024;

/// What a file is called that is of another program's kind, by its name or its bytes.
pub fn name(path: Option<&Path>, bytes: &[u8]) -> Option<&'static str> {
    let ending = path
        .and_then(|path| path.extension()?.to_str())
        .map(str::to_ascii_lowercase);
    let is_named = |f: &&Foreign| ending.as_deref().is_some_and(|e| f.endings.contains(&e));
    let named = FOREIGN.iter().find(is_named).map(|foreign| foreign.name);
    named.or_else(|| by_bytes(bytes))
}

/// The same by the bytes alone.
fn by_bytes(bytes: &[u8]) -> Option<&'static str> {
    let starts = |f: &&Foreign| f.starts.iter().any(|start| bytes.starts_with(start));
    if let Some(foreign) = FOREIGN.iter().find(starts) {
        return Some(foreign.name);
    }
    let head = &bytes[..bytes.len().min(HEAD)];
    let has = |word: &[u8]| head.windows(word.len()).any(|at| at == word);
    match head.trim_ascii_start().first() {
        Some(b'<') if has(b"<COLLADA") => Some("Collada"),
        Some(b'<') if has(b"<X3D") => Some("VRML or X3D"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_programs_are_known_by_name_or_bytes() {
        let of = |path: &str, bytes: &[u8]| name(Some(Path::new(path)), bytes);
        for (path, bytes, wanted) in [
            ("a.FBX", &b"; FBX 7.3.0 project file"[..], "FBX"),
            ("a", b"Kaydara FBX Binary  \0", "FBX"),
            ("a.blend", b"\x28\xb5\x2f\xfd...", "Blender"),
            ("a.blend", b"BLENDER-v403", "Blender"),
            ("a.xml", b"<?xml version=\"1.0\"?>\n<COLLADA>", "Collada"),
        ] {
            assert_eq!(of(path, bytes), Some(wanted), "{path}");
        }
        for (path, bytes) in [
            ("a.obj", &b"v 0 0 0\n"[..]),
            ("a.glb", b"glTF\x02\0\0\0"),
            ("a.ply", b"ply\n"),
            ("a.stl", b"solid <a>\n"),
            ("a.weird", b"OFF\n"),
            ("a", b""),
        ] {
            assert_eq!(of(path, bytes), None, "{path}");
        }
    }
}
