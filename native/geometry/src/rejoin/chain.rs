//! The edges of a sheet that lie along a line.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec3;

use super::{Line, Strand};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, bounds};

/// What a way costs beside its length: so many times its distance from the line. Below, ways cut
/// corners of the line; above, they go to and fro between vertices that lie a little off it.
const OFF: f64 = 4.0;
/// Vertices lie on a line that are nearer than so many mean edges of the sheet.
const REACH: f64 = 1.0;

/// The edges of a sheet near a line.
pub(super) struct Sheet<'a> {
    mesh: &'a PolygonMesh,
    neighbours: BTreeMap<VertexId, Vec<VertexId>>,
}

impl<'a> Sheet<'a> {
    /// The edges near a line; of a sheet that ends there, those of its border.
    pub(super) fn near(mesh: &'a PolygonMesh, line: &Line, strand: &Strand) -> Self {
        let mut edges: Vec<[VertexId; 2]> = Vec::new();
        for face in strand.faces.clone().map(FaceId::from_index) {
            let corners = mesh.face(face);
            let next = corners.iter().cycle().skip(1);
            let sides = corners.iter().zip(next);
            edges.extend(sides.map(|(&a, &b)| [a.min(b), a.max(b)]));
        }
        edges.sort_unstable();
        let length = |&[a, b]: &[VertexId; 2]| mesh.position(a).distance(mesh.position(b));
        let mean = edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64;
        let [low, high] = bounds(&line.points);
        let reach = DVec3::splat(REACH * mean);
        let [low, high] = [low - reach, high + reach];
        let is_near = |v: &VertexId| {
            let p = mesh.position(*v);
            p.cmpge(low).all() && p.cmple(high).all() && distance(line, p) <= reach.x
        };
        let mut neighbours: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for run in edges.chunk_by(|a, b| a == b) {
            let [a, b] = run[0];
            if (run.len() == 1 || !strand.is_border) && run[0].iter().all(is_near) {
                neighbours.entry(a).or_default().push(b);
                neighbours.entry(b).or_default().push(a);
            }
        }
        Self { mesh, neighbours }
    }

    /// The vertices along the line, from its start; none where no edges lie along it.
    pub(super) fn along(&self, line: &Line) -> Option<Vec<VertexId>> {
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

    /// The vertex nearest to a point.
    fn nearest(&self, point: DVec3) -> Option<VertexId> {
        let distance = |v: &VertexId| self.mesh.position(*v).distance(point);
        let vertices = self.neighbours.keys().copied();
        vertices.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The best way between the vertices at both ends of an open line.
    fn way(&self, line: &Line) -> Option<Vec<VertexId>> {
        let [start, end] = [line.points.first()?, line.points.last()?].map(|&p| self.nearest(p));
        let (start, end) = (start?, end?);
        let mut before: BTreeMap<VertexId, (f64, VertexId)> = BTreeMap::new();
        let mut heap = BinaryHeap::from([Reverse((Cost(0.0), start, start))]);
        while let Some(Reverse((cost, v, from))) = heap.pop() {
            if before.contains_key(&v) {
                continue;
            }
            before.insert(v, (cost.0, from));
            if v == end {
                break;
            }
            for &w in self.neighbours.get(&v).into_iter().flatten() {
                let [p, q] = [v, w].map(|v| self.mesh.position(v));
                let off = distance(line, p.midpoint(q)) + distance(line, q);
                heap.push(Reverse((Cost(cost.0 + p.distance(q) + OFF * off), w, v)));
            }
        }
        let mut chain = vec![end];
        while chain.last() != Some(&start) {
            chain.push(before.get(chain.last()?)?.1);
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

/// How far a point is from a line.
fn distance(line: &Line, point: DVec3) -> f64 {
    let next = line.points.iter().cycle().skip(1);
    let n = line.points.len() - usize::from(!line.is_closed);
    let pieces = line.points.iter().zip(next).take(n);
    let to_piece = |(&a, &b): (&DVec3, &DVec3)| {
        let along = b - a;
        let share = (point - a).dot(along) / along.length_squared();
        let share = if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        };
        (a + along * share).distance(point)
    };
    pieces.map(to_piece).fold(f64::INFINITY, f64::min)
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
