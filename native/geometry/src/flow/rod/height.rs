//! How high every place of a rod is, from one end to the other.
//!
//! The height is harmonic but for two vertices, the ends: no other place is higher or lower than
//! all around it, and on a sphere there is then no saddle either. So every level is one closed line
//! that goes round the rod.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::fine::length;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};
use crate::sparse::SymmetricMatrix;

/// Weights of edges lie between these: positive ones alone keep the height free of saddles.
const WEIGHTS: [f64; 2] = [0.05, 10.0];
/// The ends are looked for this many girths from where the rod seems to end.
const END: f64 = 1.0;

/// The height of every vertex, 0 at one end and 1 at the other.
pub(super) struct Height {
    pub of: VertexMap<f64>,
    /// The vertices of heights 0 and 1.
    pub ends: [VertexId; 2],
    /// A way over edges from one end to the other.
    pub path: Vec<VertexId>,
}

impl Height {
    /// None where the ends cannot be told apart or no height fits.
    pub fn new(mesh: &TriangleMesh, girth: f64) -> Option<Self> {
        let farthest = |from: &VertexMap<f64>| {
            let all = from.iter_ids();
            all.max_by(|a, b| a.1.total_cmp(b.1)).map(|(v, _)| v)
        };
        let any = distances(mesh, &[VertexId(0)]).0;
        let first = farthest(&any)?;
        let second = middle_of_end(mesh, first, girth)?;
        let first = middle_of_end(mesh, second, girth)?;
        let (way, before) = distances(mesh, &[first]);
        if !way[second].is_finite() || first == second {
            return None;
        }
        let mut path = vec![second];
        while path[path.len() - 1] != first {
            path.push(before[path[path.len() - 1]]?);
        }
        path.reverse();
        let ends = [first, second];
        Some(Self {
            of: harmonic(mesh, ends)?,
            ends,
            path,
        })
    }
}

/// The middle of the end that lies farthest from a vertex.
fn middle_of_end(mesh: &TriangleMesh, from: VertexId, girth: f64) -> Option<VertexId> {
    let far = distances(mesh, &[from]).0;
    let most = far.iter().copied().fold(0.0, f64::max);
    let rest: Vec<VertexId> = mesh
        .vertex_ids()
        .filter(|&v| far[v] < most - END * girth)
        .collect();
    let depth = distances(mesh, &rest).0;
    let deepest = depth.iter_ids().filter(|(_, d)| d.is_finite());
    deepest.max_by(|a, b| a.1.total_cmp(b.1)).map(|(v, _)| v)
}

/// How far every vertex is from the nearest of some, over edges, and by way of which.
fn distances(
    mesh: &TriangleMesh,
    from: &[VertexId],
) -> (VertexMap<f64>, VertexMap<Option<VertexId>>) {
    let mut ways = VertexMap::filled(mesh.n_vertices(), f64::INFINITY);
    let mut before = VertexMap::filled(mesh.n_vertices(), None);
    let mut queue = BinaryHeap::new();
    for &v in from {
        ways[v] = 0.0;
        queue.push(Reverse((0u64, v)));
    }
    while let Some(Reverse((bits, v))) = queue.pop() {
        let way = f64::from_bits(bits);
        if way > ways[v] {
            continue;
        }
        for h in mesh.outgoing(v) {
            let to = mesh.target(h);
            let there = way + length(mesh, [v, to]);
            if there < ways[to] {
                ways[to] = there;
                before[to] = Some(v);
                queue.push(Reverse((there.to_bits(), to)));
            }
        }
    }
    (ways, before)
}

fn harmonic(mesh: &TriangleMesh, [low, high]: [VertexId; 2]) -> Option<VertexMap<f64>> {
    let row = |v: VertexId| v.index() - usize::from(v > low) - usize::from(v > high);
    let n = mesh.n_vertices() - 2;
    let mut matrix = SymmetricMatrix::new(n);
    let mut values = vec![0.0; n];
    for h in mesh.halfedge_ids() {
        let (Some(twin), [a, b]) = (mesh.twin(h), [mesh.origin(h), mesh.target(h)]) else {
            return None;
        };
        if a > b {
            continue;
        }
        let [least, most] = WEIGHTS;
        let weight = (0.5 * (cotangent(mesh, h) + cotangent(mesh, twin))).clamp(least, most);
        for (v, other) in [(a, b), (b, a)] {
            if v == low || v == high {
                continue;
            }
            matrix.add(row(v), row(v), weight);
            if other == high {
                values[row(v)] += weight;
            } else if other != low && v < other {
                matrix.add(row(v), row(other), -weight);
            }
        }
    }
    matrix.factorize().ok()?.solve(&mut values);
    let height = |v| match v {
        v if v == low => 0.0,
        v if v == high => 1.0,
        v => values[row(v)],
    };
    Some(mesh.vertex_ids().map(height).collect())
}

/// The cotangent of the angle opposite to a halfedge.
fn cotangent(mesh: &TriangleMesh, h: HalfedgeId) -> f64 {
    let [a, b, top] = [h, h.next(), h.prev()].map(|h| mesh.position(mesh.origin(h)));
    let [u, v] = [a - top, b - top];
    u.dot(v) / u.cross(v).length().max(f64::MIN_POSITIVE)
}
