//! The Object File Format of Geomview, text variant.

use std::io::{self, Write};

use super::text::{Growing, Lines, integer, point, shown, words, write_point};
use super::{Problem, ReadError};
use crate::mesh::{Id, PolygonMesh};

/// Whether the first word is a header keyword of the format.
pub(super) fn has_header(bytes: &[u8]) -> bool {
    let mut lines = Lines::new(bytes);
    let first = lines.find_map(|line| words(line).next());
    first.is_some_and(|word| word.len() <= 8 && word.ends_with(b"OFF"))
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, ReadError> {
    let mut lines = Lines::new(bytes);
    let [n_vertices, n_faces] = counts(&mut lines)?;
    let mut growing = Growing::default();
    for found in 0..n_vertices {
        let line = next_line(&mut lines, "vertices", n_vertices, found)?;
        let vertex = point(words(line)).and_then(|point| growing.add_vertex(point));
        vertex.map_err(|problem| lines.error(problem))?;
    }
    for found in 0..n_faces {
        let line = next_line(&mut lines, "faces", n_faces, found)?;
        add_face(line, &mut growing).map_err(|problem| lines.error(problem))?;
    }
    Ok(growing.finish()?)
}

/// The numbers of vertices and faces, on the line of the keyword or after it.
fn counts(lines: &mut Lines) -> Result<[usize; 2], ReadError> {
    let expected = "the numbers of vertices and faces";
    let mut line = next_words(lines).ok_or_else(|| lines.error(Problem::EndOfFile { expected }))?;
    let first = words(line).next().unwrap_or_default();
    if let Some(prefix) = first.strip_suffix(b"OFF") {
        if prefix.contains(&b'n') || prefix.contains(&b'4') {
            let what = format!("a mesh in other than 3 dimensions ('{}')", shown(first));
            return Err(lines.error(Problem::Unsupported { what }));
        }
        line = line[first.len()..].trim_ascii();
        if line.starts_with(b"BINARY") {
            let what = "binary off".to_owned();
            return Err(lines.error(Problem::Unsupported { what }));
        }
        if words(line).next().is_none() {
            line = next_words(lines).ok_or_else(|| lines.error(Problem::EndOfFile { expected }))?;
        }
    }
    let mut counts = [0; 2];
    let mut numbers = words(line);
    for (found, count) in counts.iter_mut().enumerate() {
        let word = numbers.next().ok_or_else(|| {
            let (expected, what) = (2, "counts");
            lines.error(Problem::TooFew {
                expected,
                what,
                found,
            })
        })?;
        let value = integer(word).and_then(|value| {
            usize::try_from(value).map_err(|_| Problem::NotAnInteger { word: shown(word) })
        });
        *count = value.map_err(|problem| lines.error(problem))?;
    }
    Ok(counts)
}

/// The next line that has a word on it.
fn next_words<'a>(lines: &mut Lines<'a>) -> Option<&'a [u8]> {
    lines.find(|line| words(line).next().is_some())
}

fn next_line<'a>(
    lines: &mut Lines<'a>,
    what: &'static str,
    expected: usize,
    found: usize,
) -> Result<&'a [u8], ReadError> {
    next_words(lines).ok_or_else(|| {
        lines.error(Problem::TooFew {
            expected,
            what,
            found,
        })
    })
}

/// A face: the number of its corners, the corners, then perhaps a colour.
fn add_face(line: &[u8], growing: &mut Growing) -> Result<(), Problem> {
    let mut words = words(line);
    let n_corners = integer(words.next().unwrap_or_default())?;
    let expected = usize::try_from(n_corners).unwrap_or(0);
    let n_vertices = growing.positions.len();
    let mut wrong = None;
    let mut found = 0;
    let corners = words.take(expected).map_while(|word| {
        found += 1;
        let vertex = integer(word).and_then(|vertex| {
            let index = u32::try_from(vertex).ok();
            index
                .filter(|&index| (index as usize) < n_vertices)
                .ok_or(Problem::NoSuchVertex { vertex, n_vertices })
        });
        vertex.map_err(|problem| wrong = Some(problem)).ok()
    });
    let added = growing.add_face(corners);
    let what = "corners of a face";
    match wrong {
        Some(problem) => Err(problem),
        None if found < expected => Err(Problem::TooFew {
            expected,
            what,
            found,
        }),
        None => added,
    }
}

pub(super) fn write(mesh: &PolygonMesh, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "OFF\n{} {} 0", mesh.n_vertices(), mesh.n_faces())?;
    for &position in mesh.positions() {
        write_point(out, position)?;
        out.write_all(b"\n")?;
    }
    for face in mesh.faces() {
        write!(out, "{}", face.len())?;
        for vertex in face {
            write!(out, " {}", vertex.index())?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn headers_comments_and_colours_are_tolerated() {
        let vertices = "0 0 0 9\n1 0 0 9 # a corner\n\n0 1 0 9\n";
        for header in [
            "OFF\n# mine\n3 1 3\n",
            "OFF 3 1\n",
            "COFF\n3 1 0\n",
            "3 1 0\n",
        ] {
            let mesh = read(format!("{header}{vertices}3 0 1 2 255 0 0\n").as_bytes()).unwrap();
            assert_eq!((mesh.n_vertices(), mesh.n_faces()), (3, 1), "{header}");
        }
    }

    #[test]
    fn wrong_files_are_named_with_their_line() {
        let vertices = "0 0 0\n1 0 0\n0 1 0\n";
        let with = |face: &str| message(&format!("OFF\n3 1 0\n{vertices}{face}"));
        assert_eq!(with(""), "line 5: 1 faces expected, 0 found");
        assert_eq!(
            with("3 0 1"),
            "line 6: 3 corners of a face expected, 2 found"
        );
        assert_eq!(
            with("2 0 1"),
            "line 6: 3 corners of a face expected, 2 found"
        );
        assert_eq!(
            with("3 0 1 3"),
            "line 6: the face names vertex 3, but there are 3 vertices"
        );
        assert_eq!(
            message("OFF\n4000000000 2 0\n0 0 0"),
            "line 3: 4000000000 vertices expected, 1 found"
        );
        assert_eq!(message("OFF\n-1 2 0"), "line 2: '-1' is not a whole number");
        assert_eq!(message("OFF BINARY\n"), "line 1: binary off cannot be read");
        assert_eq!(
            message(""),
            "line 1: the file ends where the numbers of vertices and faces was expected"
        );
    }
}
