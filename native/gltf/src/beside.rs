//! Files beside the file, and files in its text.

use std::fs;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig, STANDARD};

use crate::error::UriError;

/// As lenient about padding as others are.
const LENIENT: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes that a name stands for: those in itself, or those of a file in the folder.
pub fn bytes(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, UriError> {
    match uri.strip_prefix("data:") {
        Some(data) => decoded(data).ok_or(UriError::NotData),
        None => Ok(fs::read(inside(uri, folder.ok_or(UriError::NoFolder)?)?)?),
    }
}

/// Whether a name has the bytes in itself.
pub fn is_data(uri: &str) -> bool {
    uri.starts_with("data:")
}

/// Bytes as a name.
pub fn data(bytes: &[u8]) -> String {
    let bytes = STANDARD.encode(bytes);
    format!("data:application/octet-stream;base64,{bytes}")
}

fn decoded(data: &str) -> Option<Vec<u8>> {
    let (kind, text) = data.split_once(',')?;
    kind.ends_with(";base64")
        .then(|| LENIENT.decode(text).ok())?
}

/// The file of that name, which must lie in the folder, also once all links are followed.
fn inside(uri: &str, folder: &Path) -> Result<PathBuf, UriError> {
    let name = unescaped(uri).ok_or(UriError::Outside)?;
    let path = Path::new(&name);
    let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    // Other schemes and drives have a colon, other systems' folders a backslash.
    let is_plain = !name.contains([':', '\\', '\0']) && path.components().all(is_inside);
    if !is_plain {
        return Err(UriError::Outside);
    }
    let folder = fs::canonicalize(folder)?;
    let found = fs::canonicalize(folder.join(path))?;
    if !found.starts_with(&folder) {
        return Err(UriError::Outside);
    }
    Ok(found)
}

/// A name with its %20 and the like as the letters that they stand for.
fn unescaped(uri: &str) -> Option<String> {
    let mut letters = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&letter, after)) = rest.split_first() {
        rest = after;
        if letter != b'%' {
            letters.push(letter);
            continue;
        }
        let (code, after) = after.split_at_checked(2)?;
        let code = std::str::from_utf8(code).ok()?;
        letters.push(u8::from_str_radix(code, 16).ok()?);
        rest = after;
    }
    String::from_utf8(letters).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_bytes_in_it_gives_them_back() {
        assert_eq!(bytes(&data(b"any"), None).unwrap(), b"any");
        assert_eq!(bytes("data:;base64,YW55IQ", None).unwrap(), b"any!");
        assert!(bytes("data:text/plain,any", None).is_err());
        assert!(bytes("data:;base64,?", None).is_err());
    }

    #[test]
    fn files_beside_are_read_and_no_others() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("in");
        fs::create_dir_all(folder.join("deep")).unwrap();
        fs::write(root.path().join("secret"), "no").unwrap();
        fs::write(folder.join("deep/a b.bin"), "yes").unwrap();
        let read = |uri: &str| bytes(uri, Some(&folder));
        assert_eq!(read("deep/a%20b.bin").unwrap(), b"yes");
        let secret = root.path().join("secret");
        let absolute = secret.to_str().unwrap();
        for uri in [
            "../secret",
            "deep/../../secret",
            absolute,
            "%2e%2e/secret",
            "file:secret",
            "a%2",
        ] {
            assert!(matches!(read(uri), Err(UriError::Outside)), "{uri}");
        }
        assert!(matches!(read("nothing.bin"), Err(UriError::Io(_))));
        assert!(matches!(bytes("a.bin", None), Err(UriError::NoFolder)));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&secret, folder.join("link")).unwrap();
            assert!(matches!(read("link"), Err(UriError::Outside)));
        }
    }
}
