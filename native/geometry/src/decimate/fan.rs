//! What it costs to collapse a vertex into a neighbour that keeps its place.

use glam::DVec3;

use super::quadric::Quadric;
use super::rings::Rings;
use super::rounds::{Candidate, Costs};
use crate::mesh::{VertexId, VertexMap};

/// A vertex with more neighbours waits until they are fewer: undoing its collapse needs the kernel
/// of a polygon, at cubic cost. Every mesh has a vertex of valence 5 or less that can go, so
/// nothing is ever stuck on this bound.
pub(super) const MAX_RING: usize = 8;

/// A level of the hierarchy while it is being collapsed.
pub(super) struct Level {
    pub rings: Rings,
    pub points: VertexMap<DVec3>,
    pub quadrics: VertexMap<Quadric>,
    /// A collapse may give its goal no more edges than this, unless it had more.
    pub max_valence: usize,
}

impl Costs for Level {
    fn rings(&self) -> &Rings {
        &self.rings
    }

    fn bound(&self, vertex: VertexId) -> f64 {
        let ring = self.rings.of(vertex);
        if ring.len() > MAX_RING {
            return f64::INFINITY;
        }
        ring.iter().fold(f64::INFINITY, |least, &into| {
            least.min(self.distance(vertex, into))
        })
    }

    fn best(&self, vertex: VertexId) -> Option<Candidate> {
        let ring = self.rings.of(vertex);
        if ring.len() > MAX_RING {
            return None;
        }
        let fan = Fan::new(self, vertex);
        let mut bounds = [f64::INFINITY; MAX_RING];
        for (bound, &into) in bounds.iter_mut().zip(ring) {
            *bound = self.distance(vertex, into);
        }
        let mut best: Option<Candidate> = None;
        for _ in ring {
            let (at, bound) = smallest(&bounds);
            if best.is_some_and(|best| bound >= best.cost) || bound == f64::INFINITY {
                break;
            }
            bounds[at] = f64::INFINITY;
            if !self.rings.is_legal(vertex, at) {
                continue;
            }
            let cost = bound * (1.0 + 0.05 * fan.badness(at));
            if best.is_none_or(|best| cost < best.cost) {
                let into = ring[at];
                best = Some(Candidate { cost, into });
            }
        }
        best
    }
}

impl Level {
    /// The cost of a collapse but for the shape of its triangles, which can only raise it.
    fn distance(&self, vertex: VertexId, into: VertexId) -> f64 {
        let [old, new] = [self.rings.of(vertex).len(), self.rings.of(into).len()];
        let valence = old + new - 4;
        if valence > self.max_valence.max(new) {
            return f64::INFINITY;
        }
        let goal = self.points[into];
        let quadric = self.quadrics[vertex].at(goal) + self.quadrics[into].at(goal);
        let l2 = self.points[vertex].distance_squared(goal);
        // The length keeps flat parts evenly spaced; the last term orders what has no area at all.
        let distance = quadric + 1e-3 * l2 * l2 + 1e-8 * l2;
        distance * (1.0 + 0.3 * valence.saturating_sub(6) as f64)
    }
}

fn smallest(bounds: &[f64; MAX_RING]) -> (usize, f64) {
    let mut best = (0, bounds[0]);
    for (i, &bound) in bounds.iter().enumerate() {
        if bound < best.1 {
            best = (i, bound);
        }
    }
    best
}

/// The corners of the ring of a vertex and the normals of the triangles around it.
struct Fan {
    points: [DVec3; MAX_RING],
    /// Twice the area times the normal of the triangle between a corner and the next.
    normals: [DVec3; MAX_RING],
    n: usize,
}

impl Fan {
    fn new(level: &Level, vertex: VertexId) -> Self {
        let (centre, ring) = (level.points[vertex], level.rings.of(vertex));
        let n = ring.len();
        let mut points = [DVec3::ZERO; MAX_RING];
        let mut normals = [DVec3::ZERO; MAX_RING];
        for (point, &w) in points.iter_mut().zip(ring) {
            *point = level.points[w];
        }
        for i in 0..n {
            let next = if i + 1 == n { 0 } else { i + 1 };
            normals[i] = (points[i] - centre).cross(points[next] - centre);
        }
        Self { points, normals, n }
    }

    /// How bad the worst triangle gets when the centre moves to a corner: the sum of its
    /// cotangents, and 100 at least when it turns by more than about 78°.
    fn badness(&self, at: usize) -> f64 {
        let goal = self.points[at];
        let mut worst: f64 = 0.0;
        for i in 1..self.n - 1 {
            let from = (at + i) % self.n;
            let a = self.points[from] - goal;
            let b = self.points[(from + 1) % self.n] - goal;
            let normal = a.cross(b);
            let old = self.normals[from];
            let area2 = normal.length_squared();
            let sum = a.length_squared() + b.length_squared() + a.distance_squared(b);
            // Σ cot = Σ l² / 4A; the cap keeps triangles without area comparable.
            let cot = 0.5 * sum / area2.sqrt().max(1e-6 * sum);
            worst = worst.max(cot);
            if normal.dot(old) < 0.2 * (area2 * old.length_squared()).sqrt() {
                worst = worst.max(100.0);
            }
        }
        worst
    }
}
