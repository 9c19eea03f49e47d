//! A metric in lengths, and the flips that keep it one.

use std::f64::consts::PI;

use glam::DVec2;

use crate::elementary::{atan2, exp, sin};
use crate::flow::complex::{Complex, Dressing, flip_moves, move_values};
use crate::flow::field::Charts;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};

/// The part of its longest side by which a triangle must clear the triangle inequality.
const LEAST_EXCESS: f64 = 1e-7;
/// How far below 0 a sum of cotangents must lie to be worth a flip.
const SLACK: f64 = 1e-10;
/// The same for a sum of cosines: they round to the last bits of 1.
const COSINE_SLACK: f64 = 1e-12;
/// Flips lower an energy, so they end; a cap of so many per edge guards against rounding.
const MOST_FLIPS_PER_EDGE: usize = 50;

/// A complex whose metric is in lengths: its start vectors say nothing yet.
#[derive(Clone)]
pub(super) struct Metric {
    pub complex: Complex,
    pub lengths: HalfedgeMap<f64>,
}

impl Metric {
    /// The lengths of a mesh.
    pub fn of(mesh: &TriangleMesh, dressing: Dressing) -> Self {
        let charts = Charts::new(mesh);
        let nowhere = HalfedgeMap::filled(3 * mesh.n_faces(), DVec2::ZERO);
        let lengths = mesh.halfedge_ids().map(|h| charts.edge(h).length());
        Self {
            lengths: lengths.collect(),
            complex: Complex::over(mesh, nowhere, dressing),
        }
    }

    /// Sets the lengths to others, each times the scales of its ends to a power.
    pub fn scale(&mut self, log_scales: &VertexMap<f64>, power: f64, lengths: &HalfedgeMap<f64>) {
        for h in self.complex.halfedge_ids() {
            let ends = [self.complex.origins[h], self.complex.target(h)];
            // From the smaller end, so that twins agree to the last bit.
            let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            self.lengths[h] = lengths[h] * exp(0.5 * power * (log_scales[a] + log_scales[b]));
        }
    }

    /// Whether every triangle inequality holds with room to spare.
    pub fn is_metric(&self) -> bool {
        self.lengths.as_slice().chunks_exact(3).all(|sides| {
            let longest = sides[0].max(sides[1]).max(sides[2]);
            let excess = sides.iter().sum::<f64>() - 2.0 * longest;
            longest.is_normal() && excess > LEAST_EXCESS * longest
        })
    }

    /// The angle of the corner that a halfedge leaves.
    pub fn angle(&self, h: HalfedgeId) -> f64 {
        let [a, b, opposite] = [h, h.prev(), h.next()].map(|e| self.lengths[e]);
        // Half-angle form: exact for slivers too, where the cosine is not.
        let half = [
            (opposite + (a - b)) * (opposite - (a - b)),
            (a + b + opposite) * (a + b - opposite),
        ];
        2.0 * atan2(half[0].max(0.0).sqrt(), half[1].max(0.0).sqrt())
    }

    /// The cotangent of the angle opposite to a halfedge.
    pub fn cotangent(&self, h: HalfedgeId) -> f64 {
        let [side, a, b] = [h, h.next(), h.prev()].map(|e| self.lengths[e]);
        let squared = (side + a + b) * (a + b - side) * (side + (a - b)) * (side - (a - b));
        (a * a + b * b - side * side) / squared.max(f64::MIN_POSITIVE).sqrt()
    }

    /// The cosine of the angle opposite to a halfedge; beyond ±1 where there is no such triangle.
    fn cosine(&self, h: HalfedgeId) -> f64 {
        let [side, a, b] = [h, h.next(), h.prev()].map(|e| self.lengths[e]);
        (a * a + b * b - side * side) / (2.0 * a * b)
    }

    /// Flips edges until the triangulation is Delaunay in the lengths.
    pub fn delaunay(&mut self) {
        self.flip_where(|metric, h| {
            let t = metric.complex.twins[h];
            if metric.cotangent(h) + metric.cotangent(t) >= -SLACK {
                return None;
            }
            let at_origin = metric.angle(h) + metric.angle(t.next());
            let at_target = metric.angle(h.next()) + metric.angle(t);
            if at_origin.max(at_target) >= PI - 1e-9 {
                return None;
            }
            let [a, b] = [h.prev(), t.next()].map(|e| metric.lengths[e]);
            // |a − b|² + 4ab sin²: the law of cosines without its cancellation.
            let half = sin(0.5 * at_origin);
            Some(((a - b) * (a - b) + 4.0 * a * b * half * half).sqrt())
        });
    }

    /// Makes a metric of lengths that break triangle inequalities but are a metric's, scaled: flips
    /// edges until the triangulation is Delaunay, as if the corners at each lay on a circle. That
    /// metric is the one to which the scales belong (Gillespie, Springborn & Crane 2021).
    pub fn repair(&mut self) {
        self.flip_where(|metric, h| {
            let t = metric.complex.twins[h];
            let is_bad = metric.cosine(h) + metric.cosine(t) < -COSINE_SLACK;
            let product = |a: HalfedgeId, b| metric.lengths[a] * metric.lengths[b];
            let products = product(h.next(), t.next()) + product(h.prev(), t.prev());
            is_bad.then(|| products / metric.lengths[h])
        });
    }

    /// Flips edges, those around each flipped one anew, to the length that `diagonal` gives where it
    /// gives one.
    fn flip_where(&mut self, diagonal: impl Fn(&Self, HalfedgeId) -> Option<f64>) {
        let edges = self.complex.halfedge_ids();
        let mut waiting: Vec<HalfedgeId> = edges.filter(|&h| h < self.complex.twins[h]).collect();
        let mut n_left = MOST_FLIPS_PER_EDGE * waiting.len();
        while let Some(h) = waiting.pop() {
            let t = self.complex.twins[h];
            if h.face() == t.face() || n_left == 0 {
                continue;
            }
            let Some(diagonal) = diagonal(self, h) else {
                continue;
            };
            n_left -= 1;
            self.complex.flip_edge(h);
            move_values(&mut self.lengths, &flip_moves(h, t));
            self.lengths[h] = diagonal;
            self.lengths[t] = diagonal;
            waiting.extend([h.next(), h.prev(), t.next(), t.prev()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::shapes;

    /// What hangs on a mesh of which only the lengths matter.
    fn plain(mesh: &TriangleMesh) -> Dressing {
        Dressing {
            turns: HalfedgeMap::filled(3 * mesh.n_faces(), 0),
            indices: VertexMap::filled(mesh.n_vertices(), 0),
            wish: HalfedgeMap::filled(3 * mesh.n_faces(), DVec2::X),
        }
    }

    #[test]
    fn scales_that_break_triangles_are_taken_back_to_the_last_digits() {
        for (name, mesh) in shapes::closed(8) {
            let mut metric = Metric::of(&mesh, plain(&mesh));
            metric.delaunay();
            let before = metric.clone();
            let mut random = Random::new(3);
            let scales: VertexMap<f64> = mesh.vertex_ids().map(|_| 4.0 * random.unit()).collect();
            metric.scale(&scales, 1.0, &before.lengths);
            assert!(!metric.is_metric(), "{name}");
            metric.repair();
            assert!(metric.is_metric(), "{name}");
            let scaled = metric.lengths.clone();
            metric.scale(&scales, -1.0, &scaled);
            metric.repair();
            let sorted = |metric: &Metric| {
                let mut lengths = metric.lengths.as_slice().to_vec();
                lengths.sort_by(f64::total_cmp);
                lengths
            };
            let all = sorted(&metric).into_iter().zip(sorted(&before));
            for (own, other) in all {
                assert!((own / other - 1.0).abs() < 1e-9, "{name}: {own} {other}");
            }
        }
    }
}
