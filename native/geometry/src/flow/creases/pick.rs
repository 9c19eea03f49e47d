//! Which lines are kept, and where they end.

use super::{Sharp, chains};
use crate::flow::field::OrientationField;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexId};

/// Lines shorter than this many edges of a quad are left alone: a chamfer, noise of a scan.
const SHORTEST: f64 = 3.0;
/// A line does not end nearer than this many edges to a singularity or the end of another line:
/// in the result they lie at least one edge apart.
const ROOM: f64 = 0.8;
/// Lines are cut into pieces of about so many edges. In longer ones the straight segment between
/// the ends strays from the line or bends round a singularity; shorter ones leave quads no choice.
const PIECE: f64 = 15.0;

/// The least share of all sharp edges that lines of quads must cover.
const CLEAR: f64 = 0.7;

/// A line of sharp edges.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// Its halfedges from one end to the other, each beginning where the one before stops.
    pub halfedges: Vec<HalfedgeId>,
    /// The first and the last vertex; one and the same if the line is closed.
    pub ends: [VertexId; 2],
    /// Whether it has to be met.
    pub is_firm: bool,
}

/// The lines of sharp edges that are long enough for quads of edge length `h`, longest first.
///
/// They end at corners and singularities, and long ones come in pieces; where an end is too near to another or to a singularity
/// that is not on the line, the line ends before. O(n + lines · singularities).
pub fn lines(mesh: &TriangleMesh, field: &OrientationField, sharp: Sharp<'_>, h: f64) -> Vec<Line> {
    lines_beside(&[], (mesh, field, sharp), h)
}

/// The same beside lines that are followed in any case: edges of these are in none, and their ends
/// are ends too.
pub fn lines_beside(
    firm: &[Line],
    (mesh, field, sharp): (&TriangleMesh, &OrientationField, Sharp<'_>),
    h: f64,
) -> Vec<Line> {
    let all = longest_first(mesh, chains(mesh, field, sharp));
    let is_firm = on_either_side(mesh, firm);
    let long = all
        .into_iter()
        .filter(|(length, line)| *length >= SHORTEST * h && !line.iter().any(|&h| is_firm[h]));
    let singular = mesh.vertex_ids().filter(|&v| field.indices[v] != 0);
    let mut kept: Vec<VertexId> = singular.collect();
    kept.extend(firm.iter().flat_map(|line| line.ends));
    let mut lines = Vec::new();
    for (_, line) in long {
        let is_free = |v: VertexId| {
            let is_apart = |u: &VertexId| mesh.position(*u).distance(mesh.position(v)) > ROOM * h;
            kept.contains(&v) || kept.iter().all(is_apart)
        };
        let Some(halfedges) = with_free_ends(mesh, line, is_free) else {
            continue;
        };
        if length(mesh, &halfedges) < SHORTEST * h {
            continue;
        }
        for halfedges in pieces(mesh, halfedges, h) {
            let line = Line::new(mesh, halfedges);
            kept.extend(line.ends);
            lines.push(line);
        }
    }
    lines
}

/// All lines of a network of creases, however short, from corner to corner and longest first.
///
/// Long ones come in pieces, as those of [`lines`].
pub fn whole_lines(
    mesh: &TriangleMesh,
    field: &OrientationField,
    sharp: Sharp<'_>,
    h: f64,
) -> Vec<Line> {
    let all = longest_first(mesh, chains(mesh, field, sharp));
    let pieces = all.into_iter().flat_map(|(_, line)| pieces(mesh, line, h));
    pieces.map(|halfedges| Line::new(mesh, halfedges)).collect()
}

/// Those of the lines of a network that lie on some of its edges, as lines that have to be met.
pub fn firm_lines(all: Vec<Line>, is_wanted: &HalfedgeMap<bool>) -> Vec<Line> {
    let wanted = all.into_iter().filter(|line| is_wanted[line.halfedges[0]]);
    wanted.map(Line::firm).collect()
}

fn on_either_side(mesh: &TriangleMesh, lines: &[Line]) -> HalfedgeMap<bool> {
    let mut is_on = HalfedgeMap::filled(3 * mesh.n_faces(), false);
    for &h in lines.iter().flat_map(|line| &line.halfedges) {
        is_on[h] = true;
        if let Some(twin) = mesh.twin(h) {
            is_on[twin] = true;
        }
    }
    is_on
}

/// Lines with their lengths, longest first; of equally long ones the order stays.
fn longest_first(mesh: &TriangleMesh, lines: Vec<Vec<HalfedgeId>>) -> Vec<(f64, Vec<HalfedgeId>)> {
    let measured = lines.into_iter().map(|line| (length(mesh, &line), line));
    let mut all: Vec<_> = measured.collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all
}

/// Whether enough of the sharp edges lie on the lines of so much length in all: else they are the
/// facets of a coarse mesh or the noise of a scan, and quads do better without them.
pub fn are_clear(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>, on_lines: f64) -> bool {
    let all: Vec<HalfedgeId> = mesh.halfedge_ids().filter(|&h| sharp[h]).collect();
    // Each edge counts twice there.
    on_lines > 0.5 * CLEAR * length(mesh, &all)
}

impl Line {
    fn new(mesh: &TriangleMesh, halfedges: Vec<HalfedgeId>) -> Self {
        let [first, last] = [halfedges[0], halfedges[halfedges.len() - 1]];
        Self {
            ends: [mesh.origin(first), mesh.target(last)],
            halfedges,
            is_firm: false,
        }
    }

    /// The same as one that has to be met.
    #[must_use]
    pub fn firm(self) -> Self {
        Self {
            is_firm: true,
            ..self
        }
    }

    /// How long those of its edges are that `counts` says.
    pub fn length_of(&self, mesh: &TriangleMesh, counts: impl Fn(&HalfedgeId) -> bool) -> f64 {
        let counted: Vec<HalfedgeId> = self.halfedges.iter().copied().filter(counts).collect();
        length(mesh, &counted)
    }
}

fn length(mesh: &TriangleMesh, line: &[HalfedgeId]) -> f64 {
    let of = |h: &HalfedgeId| {
        let [a, b] = [mesh.origin(*h), mesh.target(*h)];
        mesh.position(a).distance(mesh.position(b))
    };
    line.iter().map(of).sum()
}

/// A long line cut into pieces of about equal length; a closed one stays whole, so that its ring
/// can be told from others.
fn pieces(mesh: &TriangleMesh, line: Vec<HalfedgeId>, h: f64) -> Vec<Vec<HalfedgeId>> {
    let is_closed = mesh.origin(line[0]) == mesh.target(line[line.len() - 1]);
    let whole = length(mesh, &line);
    let n = (whole / (PIECE * h)).round();
    if is_closed || n < 2.0 {
        return vec![line];
    }
    let mut pieces = vec![Vec::new()];
    let mut done = 0.0;
    for halfedge in line {
        if done >= pieces.len() as f64 * whole / n {
            pieces.push(Vec::new());
        }
        let last = pieces.len() - 1;
        pieces[last].push(halfedge);
        done += length(mesh, &[halfedge]);
    }
    pieces
}

/// A line without what lies before its first and after its last free vertex; a closed one is
/// turned to begin at a free vertex.
fn with_free_ends(
    mesh: &TriangleMesh,
    mut line: Vec<HalfedgeId>,
    is_free: impl Fn(VertexId) -> bool,
) -> Option<Vec<HalfedgeId>> {
    let first = line.iter().position(|&h| is_free(mesh.origin(h)))?;
    if mesh.origin(*line.first()?) == mesh.target(*line.last()?) {
        line.rotate_left(first);
        return Some(line);
    }
    let last = line.iter().rposition(|&h| is_free(mesh.target(h)))?;
    (first <= last).then(|| line[first..=last].to_vec())
}
