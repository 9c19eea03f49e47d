//! The edges of a sheet that lie along a line.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::ops::Range;

use glam::DVec3;

use super::{Edge, Given, Line, Strand, sorted};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, bounds};

/// What a way costs beside its length: so many times its distance from the line. Below, ways cut
/// corners of the line; above, they go to and fro between vertices that lie a little off it.
const OFF: f64 = 4.0;
/// Ends of a way are at most so many mean edges of the sheet from those of the line.
const SKIP: f64 = 0.5;
/// Vertices lie on a line that are nearer than so many mean edges of the sheet.
const REACH: f64 = 1.0;

/// Where a sheet runs along a line.
#[derive(Clone)]
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
        let next = self.vertices.iter().cycle().skip(1);
        let n = self.vertices.len() - usize::from(!self.is_closed);
        let edges = self.vertices.iter().zip(next).take(n);
        edges.map(|(&a, &b)| sorted([a, b])).collect()
    }
}

/// The edges of all sheets.
pub(super) struct Sheets<'a> {
    mesh: &'a PolygonMesh,
    /// By where their faces begin.
    names: BTreeMap<usize, usize>,
    edges: Vec<Edges>,
}

/// The edges of a sheet.
struct Edges {
    /// Each once, and whether it has one face.
    ends: Vec<(Edge, bool)>,
    mean: f64,
}

impl<'a> Sheets<'a> {
    pub(super) fn new(given: &Given<'a>) -> Self {
        let sheets = given.sheets.iter();
        let names = sheets.clone().enumerate();
        let edges = sheets.map(|sheet| Edges::new(given.mesh, sheet.faces.clone()));
        Self {
            mesh: given.mesh,
            names: names.map(|(i, sheet)| (sheet.faces.start, i)).collect(),
            edges: edges.collect(),
        }
    }

    /// The chains of a line's sheets, of those that have one.
    pub(super) fn chains(&self, line: &Line) -> Vec<Chain> {
        let mut taken: BTreeSet<VertexId> = BTreeSet::new();
        let mut chains = Vec::new();
        for strand in &line.strands {
            let sheet = self.names[&strand.faces.start];
            let near = Near::new((self.mesh, &self.edges[sheet]), (line, strand), &taken);
            if let Some(vertices) = near.along(line) {
                // A sheet that meets itself does so with two chains, whose ends may be one.
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
        }
        chains
    }
}

impl Edges {
    fn new(mesh: &PolygonMesh, faces: Range<usize>) -> Self {
        let mut edges: Vec<[VertexId; 2]> = Vec::new();
        for face in faces.map(FaceId::from_index) {
            let corners = mesh.face(face);
            let next = corners.iter().cycle().skip(1);
            let sides = corners.iter().zip(next);
            edges.extend(sides.map(|(&a, &b)| [a.min(b), a.max(b)]));
        }
        edges.sort_unstable();
        let length = |&[a, b]: &[VertexId; 2]| mesh.position(a).distance(mesh.position(b));
        let mean = edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64;
        let runs = edges.chunk_by(|a, b| a == b);
        Self {
            ends: runs.map(|run| (run[0], run.len() == 1)).collect(),
            mean,
        }
    }
}

/// The edges of a sheet near a line.
struct Near<'a> {
    mesh: &'a PolygonMesh,
    mean: f64,
    neighbours: BTreeMap<VertexId, Vec<VertexId>>,
}

impl<'a> Near<'a> {
    /// The edges near a line but those at some vertices; of a sheet that ends there, those of its
    /// border.
    fn new(
        (mesh, edges): (&'a PolygonMesh, &Edges),
        (line, strand): (&Line, &Strand),
        taken: &BTreeSet<VertexId>,
    ) -> Self {
        let [low, high] = bounds(&line.points);
        let reach = DVec3::splat(REACH * edges.mean);
        let [low, high] = [low - reach, high + reach];
        let is_near = |v: &VertexId| {
            let p = mesh.position(*v);
            p.cmpge(low).all()
                && p.cmple(high).all()
                && line.distance(p) <= reach.x
                && !taken.contains(v)
        };
        let mut neighbours: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for &(ends, is_border) in &edges.ends {
            if (is_border || !strand.is_border) && ends.iter().all(is_near) {
                let [a, b] = ends;
                neighbours.entry(a).or_default().push(b);
                neighbours.entry(b).or_default().push(a);
            }
        }
        Self {
            mesh,
            mean: edges.mean,
            neighbours,
        }
    }

    /// The vertices along the line, from its start; none where no edges lie along it.
    fn along(&self, line: &Line) -> Option<Vec<VertexId>> {
        let chain = if line.is_closed {
            // The ways to the middle and back.
            let (there, back) = halves(line);
            let mut chain = self.way(&there)?;
            let back = self.way(&back)?;
            if chain.last() != back.first() || chain.first() != back.last() {
                return None;
            }
            chain.extend(&back[1..back.len() - 1]);
            chain
        } else {
            self.way(line)?
        };
        let mut once = chain.clone();
        once.sort_unstable();
        once.dedup();
        let fewest = if line.is_closed { 3 } else { 2 };
        (once.len() == chain.len() && chain.len() >= fewest).then_some(chain)
    }

    /// The vertices near a point, and what it costs to begin or end there.
    fn near_point(&self, point: DVec3) -> Vec<(VertexId, f64)> {
        let off = |&v: &VertexId| (v, self.mesh.position(v).distance(point));
        let vertices = self.neighbours.keys().map(off);
        let near = vertices.filter(|&(_, off)| off <= SKIP * self.mean);
        near.map(|(v, off)| (v, OFF * off)).collect()
    }

    /// The best way between vertices at both ends of an open line.
    fn way(&self, line: &Line) -> Option<Vec<VertexId>> {
        let starts = self.near_point(*line.points.first()?);
        let ends: BTreeMap<_, _> = self.near_point(*line.points.last()?).into_iter().collect();
        let mut before: BTreeMap<VertexId, (f64, VertexId)> = BTreeMap::new();
        let starts = starts
            .into_iter()
            .map(|(v, cost)| Reverse((Cost(cost), v, v)));
        let mut heap: BinaryHeap<_> = starts.collect();
        while let Some(Reverse((cost, v, from))) = heap.pop() {
            if before.contains_key(&v) {
                continue;
            }
            before.insert(v, (cost.0, from));
            for &w in self.neighbours.get(&v).into_iter().flatten() {
                let [p, q] = [v, w].map(|v| self.mesh.position(v));
                let off = line.distance(p.midpoint(q)) + line.distance(q);
                heap.push(Reverse((Cost(cost.0 + p.distance(q) + OFF * off), w, v)));
            }
        }
        let whole = |(v, cost): (&VertexId, &f64)| Some((Cost(before.get(v)?.0 + cost), *v));
        let (_, end) = ends.iter().filter_map(whole).min()?;
        let mut chain = vec![end];
        loop {
            let v = *chain.last()?;
            let from = before.get(&v)?.1;
            if from == v {
                break;
            }
            chain.push(from);
        }
        chain.reverse();
        Some(chain)
    }
}

/// A closed line as two open ones, there and back.
fn halves(line: &Line) -> (Line, Line) {
    let middle = line.points.len() / 2;
    let open = |points: Vec<DVec3>| Line {
        points,
        is_closed: false,
        strands: Vec::new(),
    };
    let mut back = line.points[middle..].to_vec();
    back.extend(line.points.first());
    (open(line.points[..=middle].to_vec()), open(back))
}

impl Line {
    /// The nearest point on the line.
    pub(super) fn closest(&self, point: DVec3) -> DVec3 {
        let next = self.points.iter().cycle().skip(1);
        let n = self.points.len() - usize::from(!self.is_closed);
        let pieces = self.points.iter().zip(next).take(n);
        let on_piece = |(&a, &b): (&DVec3, &DVec3)| {
            let along = b - a;
            let share = (point - a).dot(along) / along.length_squared();
            let share = if share.is_finite() {
                share.clamp(0.0, 1.0)
            } else {
                0.0
            };
            a + along * share
        };
        let places = pieces.map(on_piece);
        let off = |p: &DVec3| p.distance_squared(point);
        let nearest = places.min_by(|p, q| off(p).total_cmp(&off(q)));
        nearest.unwrap_or(point)
    }

    /// How far a point is from the line.
    fn distance(&self, point: DVec3) -> f64 {
        self.closest(point).distance(point)
    }
}

/// A number that is sorted by.
#[derive(Clone, Copy, PartialEq)]
struct Cost(f64);

impl Eq for Cost {}

impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cost {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
