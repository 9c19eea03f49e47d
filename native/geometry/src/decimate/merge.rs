//! What it costs to merge the two ends of an edge in the best place.

use glam::DVec3;

use super::quadric::Quadric;
use super::rings::Rings;
use super::rounds::Candidate;
use crate::mesh::{VertexId, VertexMap};

/// A vertex with more edges is not made while there is another way.
const MAX_VALENCE: usize = 12;
/// Cosine of the angle (about 78°) by which a triangle may turn.
const MIN_TURN: f64 = 0.2;
/// A triangle with a larger sum of cotangents (equilateral: 1.7) is made only of a worse one.
const MAX_COTANGENTS: f64 = 30.0;

/// Which shapes a merge may leave behind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Guard {
    /// No turned triangles, no new slivers, no large valences.
    Shape,
    /// Only the topology is kept: for surfaces on which nothing else is left to do.
    Topology,
}

/// A mesh on its way to fewer faces.
pub(super) struct Merging {
    pub rings: Rings,
    pub points: VertexMap<DVec3>,
    pub quadrics: VertexMap<Quadric>,
}

impl Merging {
    /// The cheapest legal merge of a vertex with a neighbour of larger id.
    pub fn best_merge(&self, vertex: VertexId, guard: Guard) -> Option<Candidate> {
        let ring = self.rings.of(vertex);
        let mut best: Option<Candidate> = None;
        for (at, &into) in ring.iter().enumerate() {
            if into < vertex || self.rings.is_virtual(into) {
                continue;
            }
            let (goal, quadric) = self.place(vertex, into);
            let l2 = self.points[vertex].distance_squared(self.points[into]);
            // The lengths keep flat parts even, at a weight far below any visible error.
            let cost = quadric + 1e-5 * l2 * l2 + 1e-9 * l2;
            if best.is_none_or(|best| cost < best.cost)
                && self.rings.is_legal(vertex, at)
                && (guard == Guard::Topology || self.keeps_shape(vertex, into, goal))
            {
                best = Some(Candidate { cost, into });
            }
        }
        best
    }

    /// Merges a vertex into a neighbour, if that is still legal.
    pub fn merge(&mut self, vertex: VertexId, into: VertexId) -> Option<usize> {
        let ring = self.rings.of(vertex);
        let at = ring.iter().position(|&w| w == into)?;
        if !self.rings.is_legal(vertex, at) {
            return None;
        }
        let k = ring.len();
        let beside = [ring[(at + 1) % k], ring[(at + k - 1) % k]];
        let n_faces = beside
            .iter()
            .filter(|&&w| !self.rings.is_virtual(w))
            .count();
        self.points[into] = self.place(vertex, into).0;
        let quadric = self.quadrics[vertex];
        self.quadrics[into] += quadric;
        self.rings.collapse(vertex, at);
        Some(n_faces)
    }

    /// Where the ends of an edge are merged, and the quadric error there. A border stays in place:
    /// only the two ends of a border edge move on it.
    fn place(&self, vertex: VertexId, into: VertexId) -> (DVec3, f64) {
        let quadric = self.quadrics[vertex] + self.quadrics[into];
        let ends = [self.points[vertex], self.points[into]];
        let goal = match [vertex, into].map(|v| self.rings.is_border(v)) {
            [true, false] => ends[0],
            [false, true] => ends[1],
            _ => quadric.lowest_near(ends),
        };
        (goal, quadric.at(goal))
    }

    /// Whether the triangles that stay do not turn over or become slivers.
    fn keeps_shape(&self, vertex: VertexId, into: VertexId, goal: DVec3) -> bool {
        let [old, new] = [vertex, into].map(|v| self.rings.of(v).len());
        old + new - 4 <= MAX_VALENCE.max(old).max(new)
            && self.keeps_fan(vertex, into, goal)
            && self.keeps_fan(into, vertex, goal)
    }

    /// The same for the triangles at one end.
    fn keeps_fan(&self, centre: VertexId, other: VertexId, goal: DVec3) -> bool {
        let ring = self.rings.of(centre);
        let from = self.points[centre];
        let mut last = ring[ring.len() - 1];
        ring.iter().all(|&next| {
            let (a, b) = (last, next);
            last = next;
            if a == other || b == other || self.rings.is_virtual(a) || self.rings.is_virtual(b) {
                return true;
            }
            let [a, b] = [self.points[a], self.points[b]];
            let [before, after] = [Shape::of([from, a, b]), Shape::of([goal, a, b])];
            let turn = MIN_TURN * before.area * after.area;
            before.normal.dot(after.normal) >= turn
                && after.cotangents <= before.cotangents.max(MAX_COTANGENTS)
        })
    }
}

/// A triangle's size and shape.
struct Shape {
    /// Twice the area times the normal, and its length.
    normal: DVec3,
    area: f64,
    /// The sum of the cotangents; large but finite without area.
    cotangents: f64,
}

impl Shape {
    fn of([p, a, b]: [DVec3; 3]) -> Self {
        let normal = (a - p).cross(b - p);
        let area = normal.length();
        let sum = p.distance_squared(a) + p.distance_squared(b) + a.distance_squared(b);
        Self {
            normal,
            area,
            cotangents: 0.5 * sum / area.max(1e-9 * sum).max(f64::MIN_POSITIVE),
        }
    }
}
