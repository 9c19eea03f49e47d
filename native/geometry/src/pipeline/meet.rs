//! Lines along which sheets meet: edges are laid there, and the sheets of the result joined.

use std::collections::HashMap;

use super::fault::Fault;
use super::frame::{Frame, Prepared, bits};
use super::join::Joined;
use super::report::{Mirrored, PartReport, Rejoined};
use super::split::{Fate, Parts};
use crate::clean::{SharedLine, Strand};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::rejoin::{self, Given, Line, Sheet, rejoin};

/// The lines along which sheets meet, at least one of which was remeshed.
pub struct Meetings {
    lines: Vec<Line>,
    /// Of each, which parts meet there, in the order of its strands.
    parts: Vec<Vec<usize>>,
    /// Which of them have no sheet that stays as it was.
    are_done: Vec<bool>,
}

impl Meetings {
    /// The lines of a mesh, in the frame of work.
    pub fn new((mesh, frame): (&PolygonMesh, &Frame), parts: &Parts) -> Self {
        let mut meetings = Self {
            lines: Vec::new(),
            parts: Vec::new(),
            are_done: Vec::new(),
        };
        for line in &parts.shared {
            let fates = line.strands.iter().map(|strand| parts.fate(strand.sheet));
            let strands = line.strands.iter().zip(fates.clone());
            let done = strands.filter_map(|(strand, fate)| match fate {
                Fate::Done(part) => Some((part, strand.is_border)),
                _ => None,
            });
            let done: Vec<(usize, bool)> = done.collect();
            let n_staying = fates.filter(|&fate| fate == Fate::Stays).count() + line.n_tangled();
            if done.is_empty() || done.len() + n_staying < 2 {
                continue;
            }
            meetings.are_done.push(n_staying == 0);
            let points: Vec<_> = line.vertices.iter().map(|&v| mesh.position(v)).collect();
            let strand = |&(_, is_border): &(usize, bool)| rejoin::Strand {
                faces: 0..0,
                is_border,
            };
            meetings.lines.push(Line {
                points: frame.enter(&points),
                is_closed: line.is_closed,
                strands: done.iter().map(strand).collect(),
            });
            let parts = done.into_iter().map(|(part, _)| part);
            meetings.parts.push(parts.collect());
        }
        meetings
    }

    /// Joins the sheets of a result along them.
    ///
    /// # Errors
    /// When cancelled.
    pub fn join(
        mut self,
        mut joined: Joined,
        progress: &Progress<'_>,
    ) -> Result<Joined, Cancelled> {
        if self.lines.is_empty() {
            return Ok(joined);
        }
        let mut start = 0;
        let ranges = joined.parts.iter().map(|part| {
            start += part.n_faces;
            start - part.n_faces..start
        });
        let ranges: Vec<_> = ranges.collect();
        for (line, parts) in self.lines.iter_mut().zip(&self.parts) {
            for (strand, &part) in line.strands.iter_mut().zip(parts) {
                strand.faces = ranges[part].clone();
            }
        }
        let sheets = ranges.iter().zip(&joined.parts).map(|(faces, part)| Sheet {
            faces: faces.clone(),
            may_change: !part.is_mirrored(),
        });
        let given = Given {
            mesh: &joined.mesh,
            sheets: &sheets.collect::<Vec<_>>(),
            features: &joined.features,
        };
        let found = rejoin(&given, &self.lines, progress)?;
        let n_shared_lines = self.lines.len();
        let each = found.is_joined.iter().zip(&self.are_done);
        let n_joined = each.filter(|(joined, done)| **joined && **done).count();
        joined.rejoined = Some(Rejoined {
            n_shared_lines,
            n_joined,
            n_left: n_shared_lines - n_joined,
        });
        joined.rename(found);
        Ok(joined)
    }
}

impl Joined {
    /// Takes sheets that were joined; of vertices that are one now the first says where it lies on
    /// its sphere.
    fn rename(&mut self, found: rejoin::Rejoined) {
        let middle = |&[a, b]: &[VertexId; 2]| {
            let [a, b] = [a, b].map(|v| self.sphere[v.index()]);
            if a == b { a } else { (a + b).normalize_or(a) }
        };
        self.sphere = found.from.iter().map(middle).collect();
        for (part, &n) in self.parts.iter_mut().zip(&found.n_faces) {
            part.n_faces = n;
        }
        self.features = found.features;
        self.mesh = found.mesh;
    }
}

impl PartReport {
    /// Whether it would not be symmetric with other faces.
    fn is_mirrored(&self) -> bool {
        matches!(self.mirrored, Some(Mirrored::Used | Mirrored::Image { .. }))
    }
}

impl SharedLine {
    /// How many of its faces belong to no sheet.
    fn n_tangled(&self) -> usize {
        let pages = |strand: &Strand| if strand.is_border { 1 } else { 2 };
        self.n_faces - self.strands.iter().map(pages).sum::<usize>()
    }

    /// Whether a sheet that is remeshed goes on there.
    fn goes_through(&self, parts: &Parts) -> bool {
        let mut strands = self.strands.iter();
        strands.any(|s| !s.is_border && matches!(parts.fate(s.sheet), Fate::Done(_)))
    }
}

impl Rejoined {
    /// What is wrong with it.
    pub fn fault(self) -> Option<Fault> {
        let Self {
            n_left,
            n_shared_lines,
            ..
        } = self;
        (n_left > 0).then_some(Fault::Parted {
            n_left,
            n_shared_lines,
        })
    }
}

/// Edges of the input along which edges are laid: the marked ones, and those where sheets end at
/// others that go on.
pub fn laid(marked: &[[VertexId; 2]], parts: &Parts) -> Vec<[VertexId; 2]> {
    let lines = parts.shared.iter().filter(|line| line.goes_through(parts));
    let mut laid = marked.to_vec();
    laid.extend(lines.flat_map(SharedLine::edges));
    laid
}

/// The triangles that are remeshed, with one vertex where sheets meet, but where an edge of theirs
/// was cut in the middle.
pub fn whole(prepared: &Prepared, (mesh, shared): (&PolygonMesh, &[SharedLine])) -> PolygonMesh {
    let vertices = shared.iter().flat_map(|line| &line.vertices);
    let points: Vec<_> = vertices.map(|&v| mesh.position(v)).collect();
    let mut first: HashMap<_, Option<u32>> = HashMap::new();
    first.extend(
        prepared
            .frame
            .enter(&points)
            .into_iter()
            .map(|p| (bits(p), None)),
    );
    let own = &prepared.mesh;
    let name = |v: VertexId| match first.get_mut(&bits(own.position(v))) {
        Some(first) => *first.get_or_insert(v.0),
        None => v.0,
    };
    let names: Vec<u32> = own.vertex_ids().map(name).collect();
    let faces = own.faces().iter().map(|f| f.map(|v| names[v.index()]));
    let faces: Vec<[u32; 3]> = faces.collect();
    PolygonMesh::from_faces(own.positions().to_vec(), &faces).expect("corners are told apart")
}
