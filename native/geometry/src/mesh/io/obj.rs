//! Wavefront OBJ.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Write};

use super::text::{Growing, Lines, integer, point, shown, words, write_point};
use super::{MeshFile, Problem, ReadError};
use crate::mesh::Id;

/// What faces belong to that stand before the first `usemtl` of a file that has one.
const UNNAMED: &str = "default";

pub(super) fn read(bytes: &[u8]) -> Result<MeshFile, ReadError> {
    let mut lines = Lines::new(bytes);
    let mut reader = Reader::default();
    while let Some(first) = lines.next() {
        let line = lines.number();
        let statement = joined(first, &mut lines);
        reader
            .statement(&statement, line)
            .map_err(|problem| ReadError::Line { line, problem })?;
    }
    reader.finish()
}

/// A line with the lines that continue it, each announced by a backslash at the end.
fn joined<'a>(first: &'a [u8], lines: &mut Lines<'a>) -> Cow<'a, [u8]> {
    let Some(start) = first.strip_suffix(b"\\") else {
        return Cow::Borrowed(first);
    };
    let mut statement = start.to_vec();
    for line in lines {
        statement.push(b' ');
        let Some(part) = line.strip_suffix(b"\\") else {
            statement.extend_from_slice(line);
            break;
        };
        statement.extend_from_slice(part);
    }
    Cow::Owned(statement)
}

#[derive(Default)]
struct Reader {
    growing: Growing,
    /// Faces that name a vertex not seen yet: line and index; each names a higher one than before.
    ahead: Vec<(usize, i64)>,
    materials: Vec<i32>,
    names: Vec<String>,
    by_name: HashMap<String, i32>,
    material: i32,
}

impl Reader {
    fn statement(&mut self, statement: &[u8], line: usize) -> Result<(), Problem> {
        let mut words = words(statement);
        match words.next() {
            None => Ok(()),
            Some(b"v") => self.growing.add_vertex(point(words)?),
            Some(b"f" | b"fo") => self.face(words, line),
            Some(b"usemtl") => {
                self.use_material(statement["usemtl".len()..].trim_ascii());
                Ok(())
            }
            // Texture coordinates, normals, groups, lines, curves and what programs add of their own.
            Some(word) if word.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_') => Ok(()),
            Some(word) => Err(Problem::Unexpected {
                expected: "a statement such as 'v' or 'f'",
                found: shown(word),
            }),
        }
    }

    fn face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a [u8]>,
        line: usize,
    ) -> Result<(), Problem> {
        let n_vertices = self.growing.positions.len();
        let mut wrong = None;
        let ahead = &mut self.ahead;
        let corners = words.map(|word| {
            corner(word, n_vertices)
                .inspect(|&index| {
                    let highest = ahead.last().map_or(n_vertices as i64 - 1, |last| last.1);
                    if index > highest {
                        ahead.push((line, index));
                    }
                })
                .and_then(|index| {
                    u32::try_from(index).map_err(|_| Problem::NoSuchVertex {
                        vertex: index + 1,
                        n_vertices,
                    })
                })
                .map_err(|problem| wrong = Some(problem))
        });
        let added = self.growing.add_face(corners.map_while(Result::ok));
        match wrong {
            Some(problem) => Err(problem),
            None => added,
        }?;
        if !self.names.is_empty() {
            self.materials.push(self.material);
        }
        Ok(())
    }

    fn use_material(&mut self, name: &[u8]) {
        if self.names.is_empty() && self.growing.n_faces() > 0 {
            self.material = self.material_index(UNNAMED);
            self.materials = vec![self.material; self.growing.n_faces()];
        }
        self.material = self.material_index(&String::from_utf8_lossy(name));
    }

    fn material_index(&mut self, name: &str) -> i32 {
        if let Some(&index) = self.by_name.get(name) {
            return index;
        }
        let index = i32::try_from(self.names.len()).unwrap_or(i32::MAX);
        self.names.push(name.to_owned());
        self.by_name.insert(name.to_owned(), index);
        index
    }

    fn finish(self) -> Result<MeshFile, ReadError> {
        let n_vertices = self.growing.positions.len();
        let missing = self
            .ahead
            .iter()
            .find(|(_, index)| *index >= n_vertices as i64);
        if let Some(&(line, index)) = missing {
            let problem = Problem::NoSuchVertex {
                vertex: index + 1,
                n_vertices,
            };
            return Err(ReadError::Line { line, problem });
        }
        Ok(MeshFile {
            mesh: self.growing.finish()?,
            materials: self.materials,
            material_names: self.names,
        })
    }
}

/// The vertex, counted from 0, of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers
/// count back from the last vertex.
fn corner(word: &[u8], n_vertices: usize) -> Result<i64, Problem> {
    let vertex = word.split(|&b| b == b'/').next().unwrap_or(word);
    let index = integer(vertex)?;
    let no_such_vertex = Problem::NoSuchVertex {
        vertex: index,
        n_vertices,
    };
    match index {
        0 => Err(no_such_vertex),
        1.. => Ok(index - 1),
        _ => Some(n_vertices as i64)
            .and_then(|n| n.checked_add(index))
            .filter(|&index| index >= 0)
            .ok_or(no_such_vertex),
    }
}

pub(super) fn write(file: &MeshFile, out: &mut dyn Write) -> io::Result<()> {
    for &position in file.mesh.positions() {
        out.write_all(b"v ")?;
        write_point(out, position)?;
        out.write_all(b"\n")?;
    }
    let mut last = None;
    for (i, face) in file.mesh.faces().enumerate() {
        let material = file.materials.get(i).copied();
        if let Some(material) = material.filter(|_| material != last) {
            let name = usize::try_from(material).ok();
            match name.and_then(|i| file.material_names.get(i)) {
                Some(name) => writeln!(out, "usemtl {name}")?,
                None => writeln!(out, "usemtl material_{material}")?,
            }
        }
        last = material;
        out.write_all(b"f")?;
        for vertex in face {
            write!(out, " {}", vertex.index() + 1)?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceId;

    fn message(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n";

    #[test]
    fn corners_come_in_every_notation() {
        let faces = "f 1/1 2//2 3/3/3 4\nf -4 -3 \\\n -2\n";
        let file = read(format!("{SQUARE}vt 0 0\nvn 0 0 1\no a\n{faces}").as_bytes()).unwrap();
        let corners = |f| file.mesh.face(FaceId(f)).iter().map(|v| v.0);
        assert!(corners(0).eq([0, 1, 2, 3]) && corners(1).eq([0, 1, 2]));
        assert!(file.materials.is_empty());
    }

    #[test]
    fn faces_may_stand_before_their_vertices() {
        let file = read(format!("f 1 2 3\n{SQUARE}").as_bytes()).unwrap();
        assert_eq!((file.mesh.n_vertices(), file.mesh.n_faces()), (4, 1));
        assert_eq!(
            message(&format!("f 1 2 3\nf 1 2 6\nf 1 2 5\n{SQUARE}")),
            "line 2: the face names vertex 6, but there are 4 vertices"
        );
    }

    #[test]
    fn materials_are_kept_per_face() {
        let faces = "f 1 2 3\nusemtl red paint\nf 1 3 4\nusemtl blue\nusemtl red paint\nf 2 3 4\n";
        let file = read(format!("{SQUARE}{faces}").as_bytes()).unwrap();
        assert_eq!(file.materials, [0, 1, 1]);
        assert_eq!(file.material_names, ["default", "red paint", "blue"]);
        let mut text = Vec::new();
        write(&file, &mut text).unwrap();
        let again = read(&text).unwrap();
        assert_eq!(
            (&again.mesh, &again.materials),
            (&file.mesh, &file.materials)
        );
    }

    #[test]
    fn wrong_statements_are_named_with_their_line() {
        assert_eq!(message("v 0 0 0\nv a b c"), "line 2: 'a' is not a number");
        assert_eq!(message("v 0 1"), "line 1: 3 coordinates expected, 2 found");
        assert_eq!(
            message("\n\nf 1 2"),
            "line 3: 3 corners of a face expected, 2 found"
        );
        assert_eq!(message("f 1 x 2"), "line 1: 'x' is not a whole number");
        for face in ["f 0 1 2", "f -5 1 2", "f -9223372036854775808 1 2"] {
            let text = message(&format!("{SQUARE}{face}"));
            assert!(text.starts_with("line 5: the face names vertex"), "{text}");
        }
        assert_eq!(
            message("v nan 0 0"),
            "line 1: vertex 0 has a coordinate that is not finite: (NaN, 0, 0)"
        );
        assert!(message("\u{1}\u{2}").starts_with("line 1: a statement such as"));
    }
}
