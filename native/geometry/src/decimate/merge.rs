//! What it costs to merge the two ends of an edge in the best place.

use glam::DVec3;

use super::quadric::Quadric;
use super::rings::{Rings, beside};
use super::rounds::{Candidate, Costs};
use crate::mesh::{VertexId, VertexMap};

/// A vertex with more edges is not made while there is another way.
const MAX_VALENCE: usize = 12;
/// Squared cosine of the angle (about 78°) by which a triangle may turn.
const MIN_TURN2: f64 = 0.04;
/// A triangle whose squared sides are more than 60 times twice its area (equilateral: 3.5), squared
/// again, is made only of a worse one.
const MAX_SIDES4: f64 = 3600.0;

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
    pub guard: Guard,
}

impl Costs for Merging {
    fn rings(&self) -> &Rings {
        &self.rings
    }

    /// The cheapest merge of a vertex with a neighbour of larger id, allowed or not.
    fn bound(&self, vertex: VertexId) -> f64 {
        let goals = self
            .rings
            .of(vertex)
            .iter()
            .filter(|&&into| self.owns(vertex, into));
        goals.fold(f64::INFINITY, |least, &into| {
            least.min(self.cost(vertex, into).0)
        })
    }

    /// The cheapest merge of a vertex with a neighbour of larger id that is allowed.
    fn best(&self, vertex: VertexId) -> Option<Candidate> {
        let mut best: Option<Candidate> = None;
        for (at, &into) in self.rings.of(vertex).iter().enumerate() {
            if !self.owns(vertex, into) {
                continue;
            }
            let (cost, goal) = self.cost(vertex, into);
            if best.is_none_or(|best| cost < best.cost)
                && self.rings.is_legal(vertex, at)
                && (self.guard == Guard::Topology || self.keeps_shape(vertex, into, goal))
            {
                best = Some(Candidate { cost, into });
            }
        }
        best
    }
}

impl Merging {
    /// Whether an edge is looked at from this end.
    fn owns(&self, vertex: VertexId, into: VertexId) -> bool {
        vertex < into && !self.rings.is_virtual(into)
    }

    /// The cost of a merge, and the place where it ends.
    fn cost(&self, vertex: VertexId, into: VertexId) -> (f64, DVec3) {
        let (goal, quadric) = self.place(vertex, into);
        let l2 = self.points[vertex].distance_squared(self.points[into]);
        // The lengths keep flat parts even, at a weight far below any visible error.
        (quadric + 1e-5 * l2 * l2 + 1e-9 * l2, goal)
    }

    /// Merges a vertex into a neighbour, if that is still legal.
    pub fn merge(&mut self, vertex: VertexId, into: VertexId) -> Option<usize> {
        let ring = self.rings.of(vertex);
        let at = ring.iter().position(|&w| w == into)?;
        if !self.rings.is_legal(vertex, at) {
            return None;
        }
        let is_real = |w: &VertexId| !self.rings.is_virtual(*w);
        let n_faces = beside(ring, at).into_iter().filter(is_real).count();
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
            Shape::of([goal, a, b]).may_replace(Shape::of([from, a, b]))
        })
    }
}

/// A triangle's size and shape.
#[derive(Clone, Copy)]
struct Shape {
    /// Twice the area times the normal.
    normal: DVec3,
    area2: f64,
    /// The sum of the squared lengths of the sides: twice the sum of cotangents times the area.
    sides2: f64,
}

impl Shape {
    fn of([p, a, b]: [DVec3; 3]) -> Self {
        let normal = (a - p).cross(b - p);
        Self {
            normal,
            area2: normal.length_squared(),
            sides2: p.distance_squared(a) + p.distance_squared(b) + a.distance_squared(b),
        }
    }

    /// Whether this triangle is not turned against the old one, nor a sliver unless that was worse.
    fn may_replace(self, old: Self) -> bool {
        let along = self.normal.dot(old.normal);
        let is_turned = along < 0.0 || along * along < MIN_TURN2 * self.area2 * old.area2;
        let sides4 = self.sides2 * self.sides2;
        let is_sliver = sides4 > MAX_SIDES4 * self.area2
            && sides4 * old.area2 > old.sides2 * old.sides2 * self.area2;
        !is_turned && !is_sliver
    }
}
