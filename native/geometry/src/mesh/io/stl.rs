//! Stereolithography files: triangles that share nothing, as text or binary.

use glam::DVec3;

use super::text::{Growing, Lines, point, shown, words};
use super::{Problem, ReadError};
use crate::mesh::PolygonMesh;

/// Binary: a comment of 80 bytes, the number of facets, then 50 bytes for each facet.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Whether bytes of an unknown format are a text or a binary file of this one.
pub(super) fn looks_like_stl(bytes: &[u8]) -> bool {
    is_text(bytes) || n_facets(bytes).is_some_and(|n| bytes.len() == HEADER + n * FACET)
}

/// A text file starts with `solid`; so do the comments of some binary files, which have zeros.
fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let keyword = start.get(..5).unwrap_or_default();
    keyword.eq_ignore_ascii_case(b"solid") && !bytes[..bytes.len().min(512)].contains(&0)
}

fn n_facets(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?.try_into().ok()?;
    Some(u32::from_le_bytes(count) as usize)
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, ReadError> {
    if is_text(bytes) {
        read_text(bytes)
    } else {
        read_binary(bytes)
    }
}

fn read_binary(bytes: &[u8]) -> Result<PolygonMesh, ReadError> {
    let expected = "'solid' or a binary header of 84 bytes";
    let n = n_facets(bytes).ok_or(ReadError::Binary(Problem::EndOfFile { expected }))?;
    let facets = &bytes[HEADER..];
    if facets.len() / FACET < n {
        return Err(ReadError::Binary(Problem::TooFew {
            expected: n,
            what: "facets of 50 bytes",
            found: facets.len() / FACET,
        }));
    }
    let mut growing = Growing::default();
    for facet in facets.chunks_exact(FACET).take(n) {
        for corner in facet[12..48].chunks_exact(12) {
            let float = |i: usize| {
                let bytes = [corner[i], corner[i + 1], corner[i + 2], corner[i + 3]];
                f64::from(f32::from_le_bytes(bytes))
            };
            let position = DVec3::new(float(0), float(4), float(8));
            growing.add_vertex(position).map_err(ReadError::Binary)?;
        }
        add_facet(&mut growing, 3).map_err(ReadError::Binary)?;
    }
    Ok(growing.finish()?)
}

/// The last vertices become a face.
fn add_facet(growing: &mut Growing, n_corners: u32) -> Result<(), Problem> {
    let end = u32::try_from(growing.positions.len()).unwrap_or(u32::MAX);
    growing.add_face(end - n_corners..end)
}

fn read_text(bytes: &[u8]) -> Result<PolygonMesh, ReadError> {
    let mut lines = Lines::new(bytes);
    let mut growing = Growing::default();
    let mut open = Open::default();
    while let Some(line) = lines.next() {
        open.statement(line, &mut growing)
            .map_err(|problem| lines.error(problem))?;
    }
    if open.solid || open.n_corners > 0 {
        let expected = "'endsolid'";
        return Err(lines.error(Problem::EndOfFile { expected }));
    }
    Ok(growing.finish()?)
}

/// What has been opened and not closed yet.
#[derive(Default)]
struct Open {
    solid: bool,
    n_corners: u32,
}

impl Open {
    fn statement(&mut self, line: &[u8], growing: &mut Growing) -> Result<(), Problem> {
        let mut words = words(line);
        let Some(word) = words.next() else {
            return Ok(());
        };
        match word.to_ascii_lowercase().as_slice() {
            b"vertex" => {
                growing.add_vertex(point(words)?)?;
                self.n_corners += 1;
            }
            b"endloop" => add_facet(growing, std::mem::take(&mut self.n_corners))?,
            b"solid" => self.solid = true,
            b"endsolid" => self.solid = false,
            b"facet" | b"outer" | b"endfacet" => {}
            _ => {
                return Err(Problem::Unexpected {
                    expected: "a statement such as 'facet' or 'vertex'",
                    found: shown(word),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "solid a b\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  \
        vertex 1 0 0.1\n  vertex 0 1e0 0\n endloop\nendfacet\n";

    fn message(bytes: &[u8]) -> String {
        read(bytes).unwrap_err().to_string()
    }

    fn binary(n: u32, facets: usize) -> Vec<u8> {
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(80, 0);
        bytes.extend(n.to_le_bytes());
        for i in 0..facets * 12 {
            bytes.extend((i as f32).to_le_bytes());
            if i % 12 == 11 {
                bytes.extend([0; 2]);
            }
        }
        bytes
    }

    #[test]
    fn text_is_read_in_double_precision() {
        let mesh = read(format!("{TRIANGLE}endsolid a b\n").as_bytes()).unwrap();
        assert_eq!((mesh.n_vertices(), mesh.n_faces()), (3, 1));
        assert_eq!(mesh.positions()[1], DVec3::new(1.0, 0.0, 0.1));
    }

    #[test]
    fn binary_facets_have_vertices_of_their_own() {
        let mesh = read(&binary(2, 2)).unwrap();
        assert_eq!((mesh.n_vertices(), mesh.n_faces()), (6, 2));
        assert_eq!(mesh.positions()[3], DVec3::new(15.0, 16.0, 17.0));
    }

    #[test]
    fn cut_files_are_named_with_numbers() {
        assert_eq!(
            message(TRIANGLE.as_bytes()),
            "line 8: the file ends where 'endsolid' was expected"
        );
        assert_eq!(
            message(&binary(4_000_000_000, 2)),
            "4000000000 facets of 50 bytes expected, 2 found"
        );
        assert_eq!(
            message(b"solid\nvertex 0 0 0\nendloop"),
            "line 3: 3 corners of a face expected, 1 found"
        );
        assert!(message(b"nothing").starts_with("the file ends where"));
        assert!(message(b"solid\nfoo").starts_with("line 2: a statement such as"));
    }
}
