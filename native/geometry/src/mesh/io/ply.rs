//! Stanford PLY, read by the crate `ply-rs-bw`.

use std::io::{self, Write};

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult,
};

use super::text::{Growing, shown};
use super::{Problem, ReadError};
use crate::mesh::{Id, PolygonMesh};

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, ReadError> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader);
    let header = header.map_err(|error| problem(&error, true))?;
    let mut growing = Growing::default();
    for element in header.elements.values() {
        match element.name.as_str() {
            "vertex" => {
                for (i, Vertex(position)) in elements(&mut reader, element, &header)?.enumerate() {
                    at(
                        &header,
                        &reader,
                        element.count - i,
                        growing.add_vertex(position),
                    )?;
                }
            }
            "face" => {
                for (i, face) in elements::<Face>(&mut reader, element, &header)?.enumerate() {
                    let added = add_face(&face, element, &mut growing);
                    at(&header, &reader, element.count - i, added)?;
                }
            }
            "tristrips" => {
                let what = "a mesh of triangle strips".to_owned();
                return Err(ReadError::Binary(Problem::Unsupported { what }));
            }
            _ => drop(elements::<Skipped>(&mut reader, element, &header)?),
        }
    }
    Ok(growing.finish()?)
}

fn elements<E: PropertyAccess>(
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<impl Iterator<Item = E> + use<E>, ReadError> {
    // Elements without a property take no bytes, so that any count of them would be believed.
    if element.properties.is_empty() && element.count > 0 {
        let what = format!("an element without properties ('{}')", element.name);
        return Err(ReadError::Binary(Problem::Unsupported { what }));
    }
    let read = Parser::new().read_payload_for_element(reader, element, header);
    let is_text = header.encoding == Encoding::Ascii;
    Ok(read.map_err(|error| problem(&error, is_text))?.into_iter())
}

/// Puts an error that an element makes at the line of that element, `lines_back` before this one.
fn at(
    header: &Header,
    reader: &Reader<&[u8]>,
    lines_back: usize,
    result: Result<(), Problem>,
) -> Result<(), ReadError> {
    result.map_err(|problem| match header.encoding {
        Encoding::Ascii => {
            let line = reader.line().saturating_sub(lines_back);
            ReadError::Line { line, problem }
        }
        _ => ReadError::Binary(problem),
    })
}

/// The crate's message on one line: where the file ends, else the innermost of its causes.
fn problem(error: &ParseError, is_text: bool) -> ReadError {
    let whole = error.to_string();
    let cause = if error.kind() == io::ErrorKind::UnexpectedEof {
        whole.lines().next()
    } else {
        whole.rsplit("Error: ").next()
    };
    let cause = cause.unwrap_or(&whole);
    let cause = match cause.split_once(": ") {
        Some((place, rest)) if place.starts_with("Line ") => rest,
        _ => cause,
    };
    let problem = Problem::Ply {
        message: shown(cause.trim_end_matches('.').as_bytes()),
    };
    match error.line().filter(|_| is_text) {
        Some(line) => ReadError::Line { line, problem },
        None => ReadError::Binary(problem),
    }
}

fn add_face(face: &Face, element: &ElementDef, growing: &mut Growing) -> Result<(), Problem> {
    let n_vertices = growing.positions.len();
    let no_list = || Problem::Unsupported {
        what: format!(
            "an element '{}' without a list of whole numbers 'vertex_indices'",
            element.name
        ),
    };
    let corners = face.0.as_ref().ok_or_else(no_list)?;
    if let Some(&vertex) = corners.iter().find(|&&v| v < 0 || v >= n_vertices as i64) {
        return Err(Problem::NoSuchVertex { vertex, n_vertices });
    }
    growing.add_face(corners.iter().map(|&v| v as u32))
}

/// A vertex as the parser fills it.
struct Vertex(DVec3);

/// A face as the parser fills it; no list where the file has none.
struct Face(Option<Vec<i64>>);

/// An element that is read and dropped.
struct Skipped;

impl PropertyAccess for Vertex {
    fn new() -> Self {
        // A file without a coordinate is told from one with zeros by the finiteness check.
        Self(DVec3::NAN)
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let coordinate = match name {
            "x" => &mut self.0.x,
            "y" => &mut self.0.y,
            "z" => &mut self.0.z,
            _ => return PropertyAccessResult::Ignored,
        };
        *coordinate = match value {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(None)
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        self.0 = Some(match value {
            Property::ListChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListInt(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUInt(list) => list.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        });
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

pub(super) fn write(mesh: &PolygonMesh, out: &mut dyn Write) -> io::Result<()> {
    let most_corners = mesh.faces().map(<[_]>::len).max().unwrap_or(0);
    let is_narrow = u8::try_from(most_corners).is_ok();
    let count = if is_narrow { "uchar" } else { "uint" };
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double \
         y\nproperty double z\nelement face {}\nproperty list {count} int vertex_indices\nend_header\n",
        mesh.n_vertices(),
        mesh.n_faces()
    )?;
    for position in mesh.positions() {
        for coordinate in position.to_array() {
            out.write_all(&coordinate.to_le_bytes())?;
        }
    }
    for face in mesh.faces() {
        let count = (face.len() as u32).to_le_bytes();
        out.write_all(if is_narrow { &count[..1] } else { &count })?;
        for vertex in face {
            out.write_all(&(vertex.index() as i32).to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat ascii 1.0\ncomment mine\nelement vertex 3\nproperty float x\n\
        property double y\nproperty int z\nproperty uchar red\nelement face 1\n\
        property list uchar uint vertex_index\nend_header\n";
    const VERTICES: &str = "0 0 0 255\n1 0.1 0 255\n0 1 0 255\n";

    fn message(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn text_is_read_with_any_number_type() {
        let mesh = read(format!("{HEADER}{VERTICES}3 0 1 2\n").as_bytes()).unwrap();
        assert_eq!((mesh.n_vertices(), mesh.n_faces()), (3, 1));
        assert_eq!(mesh.positions()[1], DVec3::new(1.0, 0.1, 0.0));
    }

    #[test]
    fn both_byte_orders_are_read() {
        let text = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar short vertex_indices\nend_header\n";
        for (order, is_big) in [("little", false), ("big", true)] {
            let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{text}").into_bytes();
            for i in 0..9u8 {
                let value = f32::from(i) / 3.0;
                bytes.extend(if is_big {
                    value.to_be_bytes()
                } else {
                    value.to_le_bytes()
                });
            }
            bytes.push(3);
            for i in 0..3i16 {
                bytes.extend(if is_big {
                    i.to_be_bytes()
                } else {
                    i.to_le_bytes()
                });
            }
            let mesh = read(&bytes).unwrap();
            assert_eq!(mesh.positions()[2].to_array()[2..], [f64::from(8f32 / 3.0)]);
            let cut = read(&bytes[..bytes.len() - 1]).unwrap_err().to_string();
            assert!(cut.ends_with("element 'face' (expected 1, got 0)"), "{cut}");
        }
    }

    #[test]
    fn wrong_files_are_named_with_their_line() {
        let with = |face: &str| message(&format!("{HEADER}{VERTICES}{face}\n"));
        assert_eq!(
            with("3 0 1 3"),
            "line 15: the face names vertex 3, but there are 3 vertices"
        );
        assert_eq!(
            with("2 0 1"),
            "line 15: 3 corners of a face expected, 2 found"
        );
        assert!(with("3 0 1").starts_with("line 15: "), "{}", with("3 0 1"));
        let text = message(&format!("{HEADER}0 0 0 255\n1 nan 0 0\n0 0 0 0\n"));
        assert!(
            text.starts_with("line 14: ") || text.starts_with("line 13: "),
            "{text}"
        );
        let text = message(&HEADER.replace("vertex 3", "vertex 4000000000000"));
        assert!(text.starts_with("line 12: "), "{text}");
        assert!(
            message("ply\nfoo\n").starts_with("line 2: "),
            "{}",
            message("ply\nfoo\n")
        );
        let empty = "ply\nformat binary_little_endian 1.0\nelement x 9999999999999\nend_header\n";
        assert_eq!(
            message(empty),
            "an element without properties ('x') cannot be read"
        );
    }
}
