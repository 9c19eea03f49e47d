//! Wavefront OBJ.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Write};

use super::text::{
    Growing, Lines, integer, number, point, shown, words, write_number, write_point,
};
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
    libraries: Vec<String>,
    /// What `vt` says.
    coordinates: Vec<[f64; 2]>,
    /// Which of them each corner names, counted from 0; none after the last corner that names one.
    named: Vec<Option<usize>>,
}

impl Reader {
    fn statement(&mut self, statement: &[u8], line: usize) -> Result<(), Problem> {
        let mut words = words(statement);
        match words.next() {
            None => Ok(()),
            Some(b"v") => self.growing.add_vertex(point(words)?),
            Some(b"f" | b"fo") => self.face(words, line),
            Some(b"vt") => self.coordinate(words),
            Some(b"mtllib") => {
                let name = String::from_utf8_lossy(statement["mtllib".len()..].trim_ascii());
                self.libraries.push(name.into_owned());
                Ok(())
            }
            Some(b"usemtl") => {
                self.use_material(statement["usemtl".len()..].trim_ascii());
                Ok(())
            }
            // Normals, groups, lines, curves and what programs add of their own.
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
        let (ahead, named) = (&mut self.ahead, &mut self.named);
        let n_coordinates = self.coordinates.len();
        let n_corners = self.growing.n_corners();
        let corners = words.enumerate().map(|(i, word)| {
            let mut parts = word.split(|&b| b == b'/');
            let vertex = parts.next().unwrap_or(word);
            // Faces of broken files name coordinates that are not there: these have none.
            let coordinate = parts.next().and_then(|part| integer(part).ok());
            let coordinate = coordinate.and_then(|index| counted(index, n_coordinates));
            if coordinate.is_some() {
                named.resize(n_corners + i, None);
                named.push(coordinate.and_then(|index| usize::try_from(index).ok()));
            }
            name(vertex, n_vertices, (line, ahead)).map_err(|problem| wrong = Some(problem))
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

    fn coordinate<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), Problem> {
        let mut coordinate = [0.0; 2];
        for (value, word) in coordinate.iter_mut().zip(words) {
            let read = number(word)?;
            // What is not finite cannot be mixed.
            *value = if read.is_finite() { read } else { 0.0 };
        }
        self.coordinates.push(coordinate);
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

    fn finish(mut self) -> Result<MeshFile, ReadError> {
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
        if !self.named.is_empty() {
            self.named.resize(self.growing.n_corners(), None);
        }
        let named = self.named.iter();
        let coordinates = named.map(|&name| self.coordinates.get(name?).copied());
        Ok(MeshFile {
            coordinates: coordinates.collect(),
            mesh: self.growing.finish()?,
            materials: self.materials,
            material_names: self.names,
            material_libraries: self.libraries,
        })
    }
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0; one that is not known
/// yet is remembered with its line.
fn name(
    word: &[u8],
    n_vertices: usize,
    (line, ahead): (usize, &mut Vec<(usize, i64)>),
) -> Result<u32, Problem> {
    let given = integer(word)?;
    let no_such_vertex = |vertex| Problem::NoSuchVertex { vertex, n_vertices };
    let index = counted(given, n_vertices).ok_or_else(|| no_such_vertex(given))?;
    let highest = ahead.last().map_or(n_vertices as i64 - 1, |last| last.1);
    if index > highest {
        ahead.push((line, index));
    }
    u32::try_from(index).map_err(|_| no_such_vertex(index + 1))
}

/// An index counted from 0; negative ones count back from the last of those that are known.
fn counted(index: i64, n_known: usize) -> Option<i64> {
    match index {
        0 => None,
        1.. => Some(index - 1),
        _ => (n_known as i64)
            .checked_add(index)
            .filter(|&index| index >= 0),
    }
}

/// The texture coordinates of corners, each once.
struct Coordinates {
    each: Vec<[f64; 2]>,
    /// Of every corner, counted from 1 as in the file.
    of_corners: Vec<Option<usize>>,
}

impl Coordinates {
    fn new(corners: &[Option<[f64; 2]>]) -> Self {
        let mut known = HashMap::new();
        let mut each = Vec::new();
        let of_corner = |coordinate: &Option<[f64; 2]>| {
            coordinate.map(|coordinate| {
                *known
                    .entry(coordinate.map(f64::to_bits))
                    .or_insert_with(|| {
                        each.push(coordinate);
                        each.len()
                    })
            })
        };
        let of_corners = corners.iter().map(of_corner).collect();
        Self { each, of_corners }
    }
}

pub(super) fn write(file: &MeshFile, out: &mut dyn Write) -> io::Result<()> {
    for library in &file.material_libraries {
        writeln!(out, "mtllib {library}")?;
    }
    for &position in file.mesh.positions() {
        out.write_all(b"v ")?;
        write_point(out, position)?;
        out.write_all(b"\n")?;
    }
    let coordinates = Coordinates::new(&file.coordinates);
    for [u, v] in &coordinates.each {
        out.write_all(b"vt ")?;
        write_number(out, *u)?;
        out.write_all(b" ")?;
        write_number(out, *v)?;
        out.write_all(b"\n")?;
    }
    let mut of_corners = coordinates.of_corners.iter();
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
            if let Some(Some(coordinate)) = of_corners.next() {
                write!(out, "/{coordinate}")?;
            }
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
    fn texture_coordinates_and_libraries_come_back() {
        let faces = "vt 0 0\nvt 0.5 1 0\nvt nan\nf 1/1 2/2 3\nf 1 2/-1 4/9 3/2/1\nf 1 2 3\n";
        let text = format!("mtllib some paints.mtl\n{SQUARE}{faces}");
        let file = read(text.as_bytes()).unwrap();
        let [first, second] = [Some([0.0, 0.0]), Some([0.5, 1.0])];
        let wanted = [
            first, second, None, None, first, None, second, None, None, None,
        ];
        assert_eq!(file.coordinates, wanted);
        let mut text = Vec::new();
        write(&file, &mut text).unwrap();
        assert_eq!(read(&text).unwrap(), file);
        let text = String::from_utf8(text).unwrap();
        assert!(
            text.starts_with("mtllib some paints.mtl\nv 0 0 0\n"),
            "{text}"
        );
        assert!(text.contains("vt 0.5 1\nf 1/1 2/2 3\n"), "{text}");
        assert_eq!(read(SQUARE.as_bytes()).unwrap().coordinates, []);
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
