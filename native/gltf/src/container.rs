//! The container of binary files: a header, a chunk of text, a chunk of bytes.

use crate::error::{Item, ReadError, WriteError};

/// How binary files start.
pub const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const TEXT: u32 = 0x4E4F_534A;
const BYTES: u32 = 0x004E_4942;

/// The two parts of a file.
#[derive(Clone, Copy, Debug)]
pub struct Parts<'a> {
    pub text: &'a [u8],
    pub bytes: Option<&'a [u8]>,
}

/// Takes a file apart; one without a header is text.
pub fn parts(file: &[u8]) -> Result<Parts<'_>, ReadError> {
    if !file.starts_with(MAGIC) {
        return Ok(Parts {
            text: file.strip_prefix(b"\xef\xbb\xbf").unwrap_or(file),
            bytes: None,
        });
    }
    let truncated = |what, expected| ReadError::Truncated {
        what,
        expected,
        found: file.len(),
    };
    let (Some(version), Some(length)) = (word(file, 4), word(file, 8)) else {
        return Err(truncated(Item::File, HEADER));
    };
    if version != VERSION {
        return Err(ReadError::Version { version });
    }
    let file = file
        .get(..length as usize)
        .ok_or(truncated(Item::File, length as usize))?;
    let (text, rest) = chunk(file.get(HEADER..).unwrap_or_default(), "JSON")?;
    let (TEXT, text) = text else {
        return Err(ReadError::NoText);
    };
    let mut bytes = None;
    if !rest.is_empty()
        && let ((BYTES, found), _) = chunk(rest, "BIN")?
    {
        bytes = Some(found);
    }
    Ok(Parts { text, bytes })
}

type Chunk<'a> = ((u32, &'a [u8]), &'a [u8]);

/// The first chunk, its kind in front, and what follows it.
fn chunk<'a>(file: &'a [u8], name: &'static str) -> Result<Chunk<'a>, ReadError> {
    let truncated = |expected| ReadError::Truncated {
        what: Item::Chunk(name),
        expected,
        found: file.len().saturating_sub(CHUNK_HEADER),
    };
    let (Some(length), Some(kind)) = (word(file, 0), word(file, 4)) else {
        return Err(truncated(0));
    };
    let inside = &file[CHUNK_HEADER..];
    let (inside, rest) = inside
        .split_at_checked(length as usize)
        .ok_or(truncated(length as usize))?;
    Ok(((kind, inside), rest))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at + 4)?;
    word.try_into().ok().map(u32::from_le_bytes)
}

/// Puts a file together.
pub fn joined(mut text: Vec<u8>, mut bytes: Vec<u8>) -> Result<Vec<u8>, WriteError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let n = HEADER + 2 * CHUNK_HEADER + text.len() + bytes.len();
    let length = u32::try_from(n).map_err(|_| WriteError::TooLarge { n })?;
    let mut file = Vec::with_capacity(n);
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    file.extend(length.to_le_bytes());
    for (kind, chunk) in [(TEXT, text), (BYTES, bytes)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(chunk);
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_put_together_comes_apart() {
        let file = joined(b"{}".to_vec(), vec![1, 2, 3]).unwrap();
        let Parts { text, bytes } = parts(&file).unwrap();
        assert_eq!((text, bytes), (&b"{}  "[..], Some(&[1, 2, 3, 0][..])));
        assert_eq!(file.len() % 4, 0);
    }

    #[test]
    fn every_cut_of_a_file_is_refused() {
        let file = joined(b"{}".to_vec(), vec![1, 2, 3]).unwrap();
        for n in 4..file.len() {
            let text = parts(&file[..n]).unwrap_err().to_string();
            assert!(text.contains("bytes"), "{n}: {text}");
        }
        let mut short = file[..24].to_vec();
        short[8] = 24;
        assert_eq!(
            parts(&short[..24]).unwrap().bytes,
            None,
            "a file without bytes is whole"
        );
        let mut old = file;
        old[4] = 1;
        let text = parts(&old).unwrap_err().to_string();
        assert_eq!(text, "version 1 of the container is not read; 2 is");
    }
}
