//! The edges of a result that run along a stroke.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec3;

use crate::measure::Polyline;
use crate::mesh::{Id, PolygonMesh, VertexId};

/// Edges farther from the stroke than so many mean edges are not looked at.
const REACH: f64 = 1.0;
/// What an edge on the stroke costs per length, where one that is an edge away costs 1.
const ALONG: f64 = 0.02;
/// A stroke is looked at in so many stretches: so a way keeps to it where it comes near itself.
const N_STRETCHES: usize = 4;

/// How far edges are from a stroke that they run along.
pub struct Chain {
    /// In the mean, and at most.
    pub mean: f64,
    pub most: f64,
}

/// The edges near some strokes.
pub struct Edges {
    ways: BTreeMap<VertexId, Vec<VertexId>>,
    positions: BTreeMap<VertexId, DVec3>,
}

impl Edges {
    /// Those of a mesh near a line.
    pub fn near(mesh: &PolygonMesh, line: &Polyline, edge: f64) -> Self {
        let is_near: Vec<bool> = mesh
            .positions()
            .iter()
            .map(|&p| line.distance(p) < REACH * edge)
            .collect();
        let mut ways: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for face in mesh.faces() {
            for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
                if is_near[a.index()] && is_near[b.index()] {
                    ways.entry(a).or_default().push(b);
                    ways.entry(b).or_default().push(a);
                }
            }
        }
        let positions = ways.keys().map(|&v| (v, mesh.position(v))).collect();
        Self { ways, positions }
    }

    /// The chain of them along points of a line; none where they do not hang together.
    pub fn along(&self, points: &[DVec3], is_closed: bool, edge: f64) -> Option<Chain> {
        let n = points.len() - 1;
        let stops: Vec<usize> = (0..=N_STRETCHES).map(|k| k * n / N_STRETCHES).collect();
        let mut at: Vec<VertexId> = stops
            .iter()
            .map(|&i| self.nearest(points[i]))
            .collect::<Option<_>>()?;
        if is_closed {
            at[N_STRETCHES] = at[0];
        }
        let (mut sum, mut count, mut most) = (0.0, 0.0, 0.0_f64);
        for (ends, span) in at.windows(2).zip(stops.windows(2)) {
            let stretch = Polyline::new(points[span[0]..=span[1]].to_vec(), false);
            let way = self.way([ends[0], ends[1]], &stretch, edge)?;
            for pair in way.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|v| self.positions[&v]);
                for p in [a, (a + b) / 2.0] {
                    let off = stretch.distance(p);
                    // What reaches past the end of a stretch lies on the next.
                    let is_past = is_past(&stretch, p);
                    sum += if is_past { 0.0 } else { off };
                    count += f64::from(u8::from(!is_past));
                    most = most.max(if is_past { 0.0 } else { off });
                }
            }
        }
        (count > 0.0).then(|| Chain {
            mean: sum / count / edge,
            most: most / edge,
        })
    }

    fn nearest(&self, place: DVec3) -> Option<VertexId> {
        let away = |p: &DVec3| p.distance_squared(place);
        let nearest = self.positions.iter();
        let nearest = nearest.min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
        nearest.map(|(&v, _)| v)
    }

    /// The way from one vertex to another that keeps nearest to a line.
    fn way(&self, [from, to]: [VertexId; 2], line: &Polyline, edge: f64) -> Option<Vec<VertexId>> {
        let off: BTreeMap<VertexId, f64> = (self.positions.iter())
            .map(|(&v, &p)| (v, line.distance(p) / edge))
            .collect();
        let mut best: BTreeMap<VertexId, (f64, VertexId)> = BTreeMap::new();
        let mut queue = BinaryHeap::new();
        best.insert(from, (0.0, from));
        queue.push(Reverse((0_u64, from)));
        while let Some(Reverse((bits, v))) = queue.pop() {
            let cost = f64::from_bits(bits);
            if cost > best[&v].0 {
                continue;
            }
            if v == to {
                let mut way = vec![to];
                while way[way.len() - 1] != from {
                    way.push(best[&way[way.len() - 1]].1);
                }
                return Some(way);
            }
            for &u in &self.ways[&v] {
                let length = self.positions[&v].distance(self.positions[&u]);
                let away = f64::midpoint(off[&v], off[&u]);
                let through = cost + length * (ALONG + away * away);
                if best.get(&u).is_none_or(|(known, _)| through < *known) {
                    best.insert(u, (through, v));
                    // The bits of positive numbers are ordered as the numbers are.
                    queue.push(Reverse((through.to_bits(), u)));
                }
            }
        }
        None
    }
}

/// Whether the point of a stretch that is nearest to a place is an end of it.
fn is_past(stretch: &Polyline, p: DVec3) -> bool {
    let ends = [stretch.point(0.0), stretch.point(stretch.length())];
    let off = stretch.distance(p);
    ends.iter().any(|end| end.distance(p) <= off * (1.0 + 1e-9))
}
