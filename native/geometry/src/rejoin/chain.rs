//! The edges of a sheet that lie along a line.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::ops::Range;

use glam::DVec3;

use super::corners::Corners;
use super::line::on_segment;
use super::{Corner, Edge, Given, Line, Strand, sorted};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, bounds};

/// What a way costs beside its length: so many times its distance from the line. Below, ways cut
/// corners of the line; above, they go to and fro between vertices that lie a little off it.
const OFF: f64 = 4.0;
/// Ways of edges stay nearer to a line than so many mean edges of the sheet.
const REACH: f64 = 1.5;
/// A border belongs to a line that its vertices are nearer to in the mean than so many mean edges.
const NEAR: f64 = 1.0;

/// Where a sheet runs along a line.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// Which sheet.
    pub(super) sheet: usize,
    pub(super) vertices: Vec<VertexId>,
    pub(super) is_closed: bool,
    pub(super) is_border: bool,
    /// Whether its count was changed, so that its vertices are not even.
    pub(super) is_changed: bool,
}

impl Chain {
    /// Its edges, in order.
    pub(super) fn edges(&self) -> Vec<Edge> {
        self.sides()
            .into_iter()
            .map(|[a, b]| sorted([a, b]))
            .collect()
    }

    /// Its edges in order and along it.
    pub(super) fn sides(&self) -> Vec<Edge> {
        let next = self.vertices.iter().cycle().skip(1);
        let n = self.vertices.len() - usize::from(!self.is_closed);
        let edges = self.vertices.iter().zip(next).take(n);
        edges.map(|(&a, &b)| [a, b]).collect()
    }
}

/// The edges of all sheets.
pub(super) struct Sheets<'a> {
    mesh: &'a PolygonMesh,
    edges: Vec<Edges>,
}

/// The edges of a sheet.
struct Edges {
    /// Each once.
    ends: Vec<Edge>,
    /// The vertex after each along the border, which goes on from face to face.
    along_border: BTreeMap<VertexId, VertexId>,
    /// How many meet at each vertex.
    valences: BTreeMap<VertexId, usize>,
    mean: f64,
}

impl<'a> Sheets<'a> {
    pub(super) fn new(given: &Given<'a>) -> Self {
        let sheets = given.sheets.iter();
        let edges = sheets.map(|sheet| Edges::new(given.mesh, sheet.faces.clone()));
        Self {
            mesh: given.mesh,
            edges: edges.collect(),
        }
    }

    /// The mean length of a sheet's edges.
    pub(super) fn mean(&self, sheet: usize) -> f64 {
        self.edges[sheet].mean
    }

    /// The vertices of a sheet, or of its border, that are near a place, and how far they are; all, or
    /// those from which edges lead inside.
    pub(super) fn near(
        &self,
        sheet: usize,
        (place, reach): (DVec3, f64),
        (is_border, leads_inside): (bool, bool),
    ) -> Vec<(VertexId, f64)> {
        let edges = &self.edges[sheet];
        let is_fit = |(v, n): &(&VertexId, &usize)| {
            (!is_border || edges.along_border.contains_key(v)) && (!leads_inside || **n > 2)
        };
        let vertices = edges.valences.iter().filter(is_fit).map(|(&v, _)| v);
        let off = |v: VertexId| (v, self.mesh.position(v).distance(place));
        let all = vertices.map(off);
        all.filter(|&(_, off)| off <= reach).collect()
    }

    /// How far a place is from the border of a sheet.
    pub(super) fn off_border(&self, sheet: usize, place: DVec3) -> f64 {
        let sides = self.edges[sheet].along_border.iter();
        let off = |(&a, &b): (&VertexId, &VertexId)| {
            let [a, b] = [a, b].map(|v| self.mesh.position(v));
            on_segment([a, b], place).distance(place)
        };
        sides.map(off).fold(f64::INFINITY, f64::min)
    }

    /// The chains of a line's sheets, of those that have one. Those over inner edges keep off the
    /// vertices that are taken, and take theirs.
    pub(super) fn chains(
        &self,
        line: &Line,
        corners: &Corners,
        taken: &mut BTreeSet<VertexId>,
    ) -> Vec<Chain> {
        let mut chains = Vec::new();
        for strand in &line.strands {
            let sheet = strand.sheet;
            let ends = strand
                .ends
                .map(|name| corners.vertex(Corner { sheet, name }));
            let vertices = match (line.is_closed, ends) {
                (true, _) => self.round(line, strand, taken),
                (false, [Some(first), Some(last)]) if first != last => {
                    self.between((line, strand), [first, last], taken)
                }
                _ => None,
            };
            let Some(vertices) = vertices else { continue };
            let inner = if line.is_closed {
                0..vertices.len()
            } else {
                1..vertices.len() - 1
            };
            taken.extend(&vertices[inner]);
            chains.push(Chain {
                sheet,
                vertices,
                is_closed: line.is_closed,
                is_border: strand.is_border,
                is_changed: false,
            });
        }
        chains
    }

    /// The chain of an open line between two vertices.
    fn between(
        &self,
        (line, strand): (&Line, &Strand),
        [first, last]: [VertexId; 2],
        taken: &BTreeSet<VertexId>,
    ) -> Option<Vec<VertexId>> {
        let edges = &self.edges[strand.sheet];
        if !strand.is_border {
            return Near::new((self.mesh, edges), line, taken).way(line, [first, last]);
        }
        let there = edges.along(first, last)?;
        let mut back = edges.along(last, first)?;
        back.reverse();
        let free = [there, back].into_iter().filter(|way| {
            let mut inner = way[1..way.len() - 1].iter();
            inner.all(|v| !taken.contains(v))
        });
        self.nearest(free, line, edges.mean)
    }

    /// The chain of a closed line.
    fn round(
        &self,
        line: &Line,
        strand: &Strand,
        taken: &BTreeSet<VertexId>,
    ) -> Option<Vec<VertexId>> {
        let edges = &self.edges[strand.sheet];
        let round = if strand.is_border {
            let loops = edges.loops().into_iter();
            let free = loops.filter(|round| round.iter().all(|v| !taken.contains(v)));
            self.nearest(free, line, edges.mean)?
        } else {
            Near::new((self.mesh, edges), line, taken).round(line)?
        };
        (round.len() >= 3).then(|| self.along_line(round, line))
    }

    /// The way whose vertices and middles of edges are nearest to a line in the mean, if they are.
    fn nearest(
        &self,
        ways: impl Iterator<Item = Vec<VertexId>>,
        line: &Line,
        mean: f64,
    ) -> Option<Vec<VertexId>> {
        let off = |way: &Vec<VertexId>| {
            let places: Vec<DVec3> = way.iter().map(|&v| self.mesh.position(v)).collect();
            let middles = places.windows(2).map(|w| w[0].midpoint(w[1]));
            let all: Vec<DVec3> = places.iter().copied().chain(middles).collect();
            all.iter().map(|&p| line.distance(p)).sum::<f64>() / all.len() as f64
        };
        let with_off = ways.map(|way| (off(&way), way));
        let best = with_off.min_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|(off, _)| *off <= NEAR * mean)
            .map(|(_, way)| way)
    }

    /// A closed way that goes with a closed line, and from where this begins.
    fn along_line(&self, mut round: Vec<VertexId>, line: &Line) -> Vec<VertexId> {
        let at: Vec<f64> = round
            .iter()
            .map(|&v| line.share(self.mesh.position(v)))
            .collect();
        let next = at.iter().cycle().skip(1);
        let steps = at.iter().zip(next).map(|(a, b)| {
            let step = b - a;
            step - step.round()
        });
        let is_against = steps.sum::<f64>() < 0.0;
        let from_start = |share: &f64| share.min(1.0 - share);
        let first = at
            .iter()
            .enumerate()
            .min_by(|a, b| from_start(a.1).total_cmp(&from_start(b.1)))
            .map_or(0, |(i, _)| i);
        round.rotate_left(first);
        if is_against {
            round[1..].reverse();
        }
        round
    }
}

impl Edges {
    fn new(mesh: &PolygonMesh, faces: Range<usize>) -> Self {
        let mut sides: Vec<(Edge, Edge)> = Vec::new();
        for face in faces.map(FaceId::from_index) {
            let corners = mesh.face(face);
            let next = corners.iter().cycle().skip(1);
            let along = corners.iter().zip(next).map(|(&a, &b)| [a, b]);
            sides.extend(along.map(|side| (sorted(side), side)));
        }
        sides.sort_unstable();
        let length = |&([a, b], _): &(Edge, Edge)| mesh.position(a).distance(mesh.position(b));
        let mean = sides.iter().map(length).sum::<f64>() / sides.len().max(1) as f64;
        let runs = || sides.chunk_by(|a, b| a.0 == b.0);
        let border = runs().filter(|run| run.len() == 1);
        let ends: Vec<Edge> = runs().map(|run| run[0].0).collect();
        let mut valences = BTreeMap::new();
        for &v in ends.iter().flatten() {
            *valences.entry(v).or_default() += 1;
        }
        Self {
            ends,
            valences,
            along_border: border.map(|run| (run[0].1[0], run[0].1[1])).collect(),
            mean,
        }
    }

    /// The vertices along the border from one to another.
    fn along(&self, first: VertexId, last: VertexId) -> Option<Vec<VertexId>> {
        let mut way = vec![first];
        while way[way.len() - 1] != last {
            let next = *self.along_border.get(&way[way.len() - 1])?;
            if next == first {
                return None;
            }
            way.push(next);
        }
        Some(way)
    }

    /// The loops of the border.
    fn loops(&self) -> Vec<Vec<VertexId>> {
        let mut seen: BTreeSet<VertexId> = BTreeSet::new();
        let mut loops = Vec::new();
        for &first in self.along_border.keys() {
            let mut round = Vec::new();
            let mut at = Some(first);
            while let Some(v) = at.filter(|&v| seen.insert(v)) {
                round.push(v);
                at = self.along_border.get(&v).copied();
            }
            if at == Some(first) && !round.is_empty() {
                loops.push(round);
            }
        }
        loops
    }
}

/// The edges of a sheet near a line.
struct Near<'a> {
    mesh: &'a PolygonMesh,
    border: &'a BTreeMap<VertexId, VertexId>,
    neighbours: BTreeMap<VertexId, Vec<VertexId>>,
    taken: &'a BTreeSet<VertexId>,
}

impl<'a> Near<'a> {
    fn new(
        (mesh, edges): (&'a PolygonMesh, &'a Edges),
        line: &Line,
        taken: &'a BTreeSet<VertexId>,
    ) -> Self {
        let [low, high] = bounds(&line.points);
        let reach = DVec3::splat(REACH * edges.mean);
        let [low, high] = [low - reach, high + reach];
        let is_near = |v: &VertexId| {
            let p = mesh.position(*v);
            p.cmpge(low).all() && p.cmple(high).all() && line.distance(p) <= reach.x
        };
        let mut neighbours: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for &[a, b] in edges.ends.iter().filter(|ends| ends.iter().all(is_near)) {
            neighbours.entry(a).or_default().push(b);
            neighbours.entry(b).or_default().push(a);
        }
        Self {
            mesh,
            border: &edges.along_border,
            neighbours,
            taken,
        }
    }

    /// Whether a way may go through a vertex.
    fn is_free(&self, v: VertexId) -> bool {
        !self.taken.contains(&v) && !self.border.contains_key(&v)
    }

    /// The best way between two vertices.
    fn way(&self, line: &Line, [first, last]: [VertexId; 2]) -> Option<Vec<VertexId>> {
        let mut before: BTreeMap<VertexId, VertexId> = BTreeMap::new();
        // The bits of positive numbers are ordered as the numbers are.
        let mut heap = BinaryHeap::from([Reverse((0_u64, first, first))]);
        while let Some(Reverse((bits, v, from))) = heap.pop() {
            if before.contains_key(&v) {
                continue;
            }
            before.insert(v, from);
            if v == last {
                break;
            }
            for &w in self.neighbours.get(&v).into_iter().flatten() {
                if w != last && (before.contains_key(&w) || !self.is_free(w)) {
                    continue;
                }
                let [p, q] = [v, w].map(|v| self.mesh.position(v));
                let off = line.distance(p.midpoint(q)) + line.distance(q);
                let cost = f64::from_bits(bits) + p.distance(q) + OFF * off;
                heap.push(Reverse((cost.to_bits(), w, v)));
            }
        }
        before.get(&last)?;
        let back = std::iter::successors(Some(last), |v| Some(before[v]).filter(|from| from != v));
        let mut way: Vec<VertexId> = back.collect();
        way.reverse();
        Some(way)
    }

    /// The best way round a closed line: over its thirds, between the free vertices next to these.
    fn round(&self, line: &Line) -> Option<Vec<VertexId>> {
        let n = line.points.len();
        let starts = [0, n / 3, 2 * n / 3];
        let posts = starts.map(|i| {
            let off = |v: &VertexId| self.mesh.position(*v).distance(line.points[i]);
            let free = self.neighbours.keys().copied().filter(|&v| self.is_free(v));
            free.min_by(|a, b| off(a).total_cmp(&off(b)))
        });
        let mut round: Vec<VertexId> = Vec::new();
        for (i, &start) in starts.iter().enumerate() {
            let ends = [posts[i]?, posts[(i + 1) % 3]?];
            let to = if i == 2 { n } else { starts[i + 1] };
            let piece = Line {
                points: (start..=to).map(|k| line.points[k % n]).collect(),
                is_closed: false,
                strands: Vec::new(),
                stays: false,
            };
            let way = self.way(&piece, ends)?;
            round.extend(&way[..way.len() - 1]);
        }
        let mut once = round.clone();
        once.sort_unstable();
        once.dedup();
        (once.len() == round.len()).then_some(round)
    }
}
