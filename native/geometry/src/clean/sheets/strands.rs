//! Lines along which sheets meet, as they are told.

use std::collections::BTreeSet;

use super::super::triangulate::Triangulated;
use super::lines::Line;
use super::middles::Middles;
use crate::mesh::{FaceId, HalfedgeId, Id, TriangleMesh, VertexId};

/// A line of edges of more than two faces, and the sheets that meet there.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SharedLine {
    /// The input's vertices along it; of a closed line the last is not the first.
    pub vertices: Vec<VertexId>,
    /// Whether its last vertex is joined to its first.
    pub is_closed: bool,
    /// How many faces meet at each of its edges.
    pub n_faces: usize,
    /// What meets there, but for tangles.
    pub strands: Vec<Strand>,
}

/// Where a sheet runs along a line.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Strand {
    /// The component of the mesh taken apart.
    pub sheet: usize,
    /// Its vertices along the line, joined by edges: one for each vertex of the line, and one more
    /// between two where an edge had to be cut in the middle.
    pub vertices: Vec<VertexId>,
    /// Whether it ends there. If not it goes on, and two of the line's faces are its.
    pub is_border: bool,
}

impl SharedLine {
    /// The input's edges along it, the smaller end first.
    pub fn edges(&self) -> impl Iterator<Item = [VertexId; 2]> {
        let next = self.vertices.iter().cycle().skip(1);
        let n = self.vertices.len() - usize::from(!self.is_closed);
        let edges = self.vertices.iter().zip(next).take(n);
        edges.map(|(&a, &b)| [a.min(b), a.max(b)])
    }
}

/// What became of triangles after lines were found.
pub(in super::super) struct Turned {
    /// The triangles as they were.
    pub(in super::super) before: Vec<[VertexId; 3]>,
    /// Which of them were turned round.
    pub(in super::super) is_reversed: Vec<bool>,
    /// Which of them are left.
    pub(in super::super) is_sound: Vec<bool>,
}

/// The triangles of the lines in the mesh.
pub(in super::super) struct Sorted<'a> {
    turned: &'a Turned,
    middles: &'a Middles,
    /// What each triangle is called among those that are left.
    name: Vec<Option<FaceId>>,
    /// What the mesh calls each vertex.
    vertex: Vec<VertexId>,
    component: Vec<u32>,
}

impl<'a> Sorted<'a> {
    /// `was` is what each vertex of the mesh was called before.
    pub(in super::super) fn new(
        (turned, middles): (&'a Turned, &'a Middles),
        was: &[VertexId],
        mesh: &TriangleMesh,
    ) -> Self {
        let mut n = 0;
        let name = turned.is_sound.iter().map(|&is_sound| {
            n += usize::from(is_sound);
            is_sound.then(|| FaceId::from_index(n - 1))
        });
        let n_before = was.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut vertex = vec![VertexId(0); n_before];
        for (i, v) in was.iter().enumerate() {
            vertex[v.index()] = VertexId::from_index(i);
        }
        Self {
            name: name.collect(),
            turned,
            middles,
            vertex,
            component: mesh.face_components().0,
        }
    }
}

/// How many sheets meet at some lines.
pub(in super::super) fn count(lines: &[SharedLine]) -> usize {
    let strands = lines.iter().flat_map(|line| &line.strands);
    let sheets: BTreeSet<usize> = strands.map(|strand| strand.sheet).collect();
    sheets.len()
}

/// The lines as they are told, in order.
pub(in super::super) fn told(
    lines: &[Line],
    triangulated: &Triangulated,
    sorted: &Sorted<'_>,
) -> Vec<SharedLine> {
    let origin = |v: VertexId| triangulated.origins[v.index()];
    let told = |line: &Line| {
        let first = line.edges.iter().map(|edge| edge.ends[0]);
        let last = line.edges.last().filter(|_| !line.is_closed);
        let vertices = first.chain(last.map(|edge| edge.ends[1]));
        SharedLine {
            vertices: vertices.map(origin).collect(),
            is_closed: line.is_closed,
            n_faces: line.n_pages(),
            strands: (0..line.n_pages())
                .filter(|&page| line.partner[page].is_none_or(|other| other > page))
                .filter_map(|page| sorted.strand(line, page))
                .collect(),
        }
    };
    lines.iter().map(told).collect()
}

impl Sorted<'_> {
    /// Where a page runs along a line.
    fn strand(&self, line: &Line, page: usize) -> Option<Strand> {
        let first = self.name[line.edges[0].pages[page].face().index()]?;
        let mut vertices = Vec::with_capacity(line.edges.len() + 1);
        let mut end = None;
        for edge in &line.edges {
            let side = self.side(edge.pages[page], edge.ends[0])?;
            vertices.push(side.ends[0]);
            vertices.extend(side.middle);
            end = Some(side.ends[1]);
        }
        vertices.extend(end.filter(|_| !line.is_closed));
        Some(Strand {
            sheet: self.component[self.middles.starts[first.index()].index()] as usize,
            vertices: vertices.iter().map(|v| self.vertex[v.index()]).collect(),
            is_border: line.partner[page].is_none(),
        })
    }

    /// What a side of a triangle has become, from the end that was called `from`.
    fn side(&self, h: HalfedgeId, from: VertexId) -> Option<Side> {
        let old = h.face().index();
        let name = self.name[old]?;
        // Turned triangles are `a c b`.
        let corner = match h.corner() {
            corner if self.turned.is_reversed[old] => 2 - corner,
            corner => corner,
        };
        let h_now = HalfedgeId::from_index(3 * name.index() + corner);
        let face = self.middles.faces[name.index()];
        let mut ends = [face[corner], face[h_now.next().corner()]];
        let left = self.turned.before[old][h.corner()] == from;
        if left == self.turned.is_reversed[old] {
            ends.reverse();
        }
        let middle = self.middles.at.get(&h_now).copied();
        Some(Side { ends, middle })
    }
}

/// A side of a triangle.
struct Side {
    ends: [VertexId; 2],
    middle: Option<VertexId>,
}
