//! Lines, words and numbers of text formats, and the mesh that grows from them.

use std::io::{self, Write};

use glam::DVec3;

use super::{Problem, ReadError};
use crate::mesh::{MAX_ELEMENTS, PolygonMesh, PolygonMeshError, VertexId};

/// What some editors put in front of text.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The lines of a file, ended by `\n`, `\r\n`, or `\r` when there is no `\n` at all.
pub(super) struct Lines<'a> {
    rest: Option<&'a [u8]>,
    end: u8,
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        Self {
            rest: Some(bytes),
            end: if bytes.contains(&b'\n') { b'\n' } else { b'\r' },
            number: 0,
        }
    }

    /// The number of the line that came last, from 1.
    pub(super) fn number(&self) -> usize {
        self.number.max(1)
    }

    /// An error at the line that came last.
    pub(super) fn error(&self, problem: Problem) -> ReadError {
        ReadError::Line {
            line: self.number(),
            problem,
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let length = rest.iter().position(|&b| b == self.end);
        let line = &rest[..length.unwrap_or(rest.len())];
        self.rest = length.map(|length| &rest[length + 1..]);
        if self.rest.is_none() && line.is_empty() {
            return None;
        }
        self.number += 1;
        Some(line.trim_ascii())
    }
}

/// The words of a line, up to one that starts a comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
        .take_while(|word| word[0] != b'#')
}

/// A word as it can be shown in a message: readable, and not longer than a line.
pub(super) fn shown(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(400)]);
    let printable = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    text.chars().take(100).map(printable).collect()
}

pub(super) fn number(word: &[u8]) -> Result<f64, Problem> {
    let text = std::str::from_utf8(word).ok();
    text.and_then(|text| text.parse().ok())
        .ok_or_else(|| Problem::NotANumber { word: shown(word) })
}

pub(super) fn integer(word: &[u8]) -> Result<i64, Problem> {
    let text = std::str::from_utf8(word).ok();
    text.and_then(|text| text.parse().ok())
        .ok_or_else(|| Problem::NotAnInteger { word: shown(word) })
}

/// The first three words as coordinates.
pub(super) fn point<'a>(words: impl Iterator<Item = &'a [u8]>) -> Result<DVec3, Problem> {
    let mut coordinates = [0.0; 3];
    let mut found = 0;
    for (coordinate, word) in coordinates.iter_mut().zip(words) {
        *coordinate = number(word)?;
        found += 1;
    }
    if found < 3 {
        return Err(Problem::TooFew {
            expected: 3,
            what: "coordinates",
            found,
        });
    }
    Ok(DVec3::from_array(coordinates))
}

/// A polygon mesh that grows vertex by vertex and face by face.
#[derive(Default)]
pub(super) struct Growing {
    pub(super) positions: Vec<DVec3>,
    ends: Vec<u32>,
    corners: Vec<VertexId>,
}

impl Growing {
    pub(super) fn add_vertex(&mut self, position: DVec3) -> Result<(), Problem> {
        if !position.is_finite() {
            return Err(Problem::NotFinite {
                vertex: self.positions.len(),
                position,
            });
        }
        self.positions.push(position);
        Ok(())
    }

    /// Adds a face; a corner outside of 32 bits is clamped and thus refused at the end.
    pub(super) fn add_face(&mut self, corners: impl Iterator<Item = u32>) -> Result<(), Problem> {
        let before = self.corners.len();
        self.corners.extend(corners.map(VertexId));
        let found = self.corners.len() - before;
        if found < 3 {
            return Err(Problem::TooFew {
                expected: 3,
                what: "corners of a face",
                found,
            });
        }
        self.ends
            .push(u32::try_from(self.corners.len()).unwrap_or(u32::MAX));
        Ok(())
    }

    pub(super) fn n_corners(&self) -> usize {
        self.corners.len()
    }

    pub(super) fn n_faces(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn finish(mut self) -> Result<PolygonMesh, PolygonMeshError> {
        if self.corners.len() > MAX_ELEMENTS {
            let n = self.corners.len();
            return Err(PolygonMeshError::TooLarge { n });
        }
        self.ends.insert(0, 0);
        PolygonMesh::new(self.positions, self.ends, self.corners)
    }
}

/// Writes the shortest number that reads back as the same value.
pub(super) fn write_number(out: &mut dyn Write, value: f64) -> io::Result<()> {
    // `{:?}` is shortest and switches to exponents for large and small values; `{}` never does.
    let text = format!("{value:?}");
    out.write_all(text.strip_suffix(".0").unwrap_or(&text).as_bytes())
}

/// Writes three coordinates with spaces between them.
pub(super) fn write_point(out: &mut dyn Write, point: DVec3) -> io::Result<()> {
    for (i, value) in point.to_array().into_iter().enumerate() {
        if i > 0 {
            out.write_all(b" ")?;
        }
        write_number(out, value)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_counted_whatever_ends_them() {
        for text in ["a\nb\n", "a\r\nb", "a\rb\r", "\u{feff}a\nb"] {
            let mut lines = Lines::new(text.as_bytes());
            assert_eq!(lines.by_ref().collect::<Vec<_>>(), [b"a", b"b"], "{text:?}");
            assert_eq!(lines.number(), 2);
        }
        assert_eq!(Lines::new(b"").count(), 0);
    }

    #[test]
    fn numbers_are_written_short_and_read_back() {
        for value in [0.0, -1.0, 0.1, 1e30, 1e-30, 1.0 / 3.0, f64::MAX, 5e-324] {
            let mut out = Vec::new();
            write_number(&mut out, value).unwrap();
            assert!(out.len() < 25, "{}", shown(&out));
            assert_eq!(number(&out), Ok(value));
        }
    }

    #[test]
    fn a_shown_word_is_short_and_printable() {
        assert_eq!(shown(b"a\x00\xff"), "a\u{fffd}\u{fffd}");
        assert_eq!(shown(&[b'x'; 1000]).len(), 100);
    }
}
