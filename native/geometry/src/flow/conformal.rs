//! The flat metric: a mesh's own lengths, scaled vertex by vertex until only the cones bend it.
//!
//! ```text
//! ℓᵢⱼ ← ℓᵢⱼ · e^{(uᵢ + uⱼ) / 2}      angle sum at i = (4 − kᵢ) · 90°
//! ```
//!
//! Newton's method on the convex energy of Springborn, Schröder & Pinkall 2008, with intrinsic
//! Delaunay flips before each step (Gillespie, Springborn & Crane 2021), so that no triangle
//! degenerates on the way. On a closed surface of genus 0 a metric with these cone angles turns
//! every vector as the orientation field does: its triangles can be laid into the field's frames.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use thiserror::Error;

use super::complex::{Complex, Dressing, Turn, flip_moves, move_values};
use super::field::{Charts, OrientationField};
use crate::elementary::{atan2, direction, exp, sin};
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sparse::{Cholesky, NotPositiveDefinite, SymmetricMatrix};

/// How far an angle sum may miss its goal, in radians: near the rounding of a sum of some arcs.
const EXACT: f64 = 1e-11;
/// Where no step lowers the misses any more, this much is still good enough to close the layout.
const CLOSE: f64 = 1e-8;
/// 4–10 steps are usual, some 40 on meshes with degenerate faces.
const MOST_STEPS: usize = 80;
/// The largest change of a log scale in one step: e³ᐟ² in length. Larger ones overshoot.
const LARGEST_STEP: f64 = 3.0;
/// Makes the Laplacian definite; a smaller shift is lost in its rounding.
const SHIFT: f64 = 1e-8;
/// Below this miss, in radians, Newton's steps may share a factor.
const NEAR: f64 = 0.05;
/// As long as each leaves no more than this share of the miss.
const GAIN: f64 = 0.1;
/// The part of its longest side by which a triangle must clear the triangle inequality.
const LEAST_EXCESS: f64 = 1e-7;
/// How far below 0 a sum of cotangents must lie to be worth a flip.
const SLACK: f64 = 1e-10;

/// Why there is no flat metric.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum FlattenError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The lengths of the mesh overflow.
    #[error(transparent)]
    Unsolvable(#[from] NotPositiveDefinite),
    /// No step lowers the misses any more.
    #[error("an angle sum of the flat metric misses its goal by {miss} after {n_steps} steps")]
    Stalled {
        /// The largest miss, in radians.
        miss: f64,
        /// How many steps were taken.
        n_steps: usize,
    },
}

/// Makes a metric with the field's cones of the lengths of a closed mesh of genus 0, and lays it
/// into the field's frames; turned and scaled as a whole to fit the wish.
///
/// The triangulation is flipped on the way; wish, turns and lines are carried along. Cost: a sparse
/// factorisation a step, 4–10 steps.
///
/// # Errors
/// [`FlattenError`].
///
/// # Panics
/// When the mesh has a border.
pub fn flatten(
    mesh: &TriangleMesh,
    field: &OrientationField,
    wish: HalfedgeMap<DVec2>,
    lines: &[Vec<HalfedgeId>],
    progress: &Progress,
) -> Result<Complex, FlattenError> {
    let charts = Charts::new(mesh);
    let dressing = Dressing {
        turns: field.turns.clone(),
        indices: field.indices.clone(),
        wish,
    };
    let nowhere = HalfedgeMap::filled(3 * mesh.n_faces(), DVec2::ZERO);
    let mut complex = Complex::over(mesh, nowhere, dressing);
    complex.follow_lines(lines);
    let mut metric = Metric {
        complex,
        lengths: mesh
            .halfedge_ids()
            .map(|h| charts.edge(h).length())
            .collect(),
    };
    metric.level(progress)?;
    Ok(metric.into_layout())
}

/// A complex whose metric is in lengths: its start vectors say nothing yet.
struct Metric {
    complex: Complex,
    lengths: HalfedgeMap<f64>,
}

impl Metric {
    /// Newton steps until every angle sum is right.
    fn level(&mut self, progress: &Progress) -> Result<(), FlattenError> {
        let mut largest = f64::INFINITY;
        let mut factor: Option<Cholesky> = None;
        for n_steps in 0..MOST_STEPS {
            progress.at(n_steps as f64 / MOST_STEPS as f64)?;
            self.delaunay();
            let misses = self.misses();
            let before = largest;
            largest = misses.iter().fold(0.0, |most, miss| miss.abs().max(most));
            if largest < EXACT {
                return Ok(());
            }
            // Near the goal the last factor is as good as a new one, while it gains a digit a step.
            let is_good = largest < NEAR && largest < GAIN * before;
            let last = factor.take().filter(|_| is_good);
            let factor = factor.insert(match last {
                Some(last) => last,
                None => self.laplacian().factorize()?,
            });
            let mut step = misses.clone();
            factor.solve(step.as_mut_slice());
            progress.check()?;
            if !self.go(&step, &misses) {
                return done_if_close(largest, n_steps);
            }
        }
        done_if_close(largest, MOST_STEPS)
    }

    /// By how much the angle sum at each vertex exceeds its goal.
    fn misses(&self) -> VertexMap<f64> {
        let goal = |&k: &i32| -f64::from(4 - k) * FRAC_PI_2;
        let mut sums: VertexMap<f64> = self.complex.indices.iter().map(goal).collect();
        for h in self.complex.halfedge_ids() {
            sums[self.complex.origins[h]] += self.angle(h);
        }
        sums
    }

    /// How angle sums change with log scales.
    fn laplacian(&self) -> SymmetricMatrix {
        let complex = &self.complex;
        let mut matrix = SymmetricMatrix::new(complex.n_vertices());
        for vertex in 0..complex.n_vertices() {
            matrix.add(vertex, vertex, SHIFT);
        }
        for h in complex.halfedge_ids().filter(|&h| h < complex.twins[h]) {
            let ends = [complex.origins[h], complex.target(h)].map(|v| v.0 as usize);
            if ends[0] != ends[1] {
                let weight = 0.5 * (self.cotangent(h) + self.cotangent(complex.twins[h]));
                matrix.add_square(&[(ends[0], 1.0), (ends[1], -1.0)], weight);
            }
        }
        matrix
    }

    /// Goes as far along a step as lowers the misses; false where nothing does.
    fn go(&mut self, step: &VertexMap<f64>, misses: &VertexMap<f64>) -> bool {
        let squares = |of: &VertexMap<f64>| of.iter().map(|miss| miss * miss).sum::<f64>();
        let (now, before) = (squares(misses), self.lengths.clone());
        let largest = step.iter().fold(0.0, |most: f64, u| u.abs().max(most));
        // So near to the end rounding may hide the gain of a last step.
        let is_last = misses.iter().all(|miss| miss.abs() < 100.0 * EXACT);
        let allowed = if is_last { 4.0 * now } else { now };
        let mut share = (LARGEST_STEP / largest).min(1.0);
        for _ in 0..30 {
            for h in self.complex.halfedge_ids() {
                let ends = [self.complex.origins[h], self.complex.target(h)];
                // From the smaller end, so that twins agree to the last bit.
                let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                self.lengths[h] = before[h] * exp(0.5 * share * (step[a] + step[b]));
            }
            if self.is_metric() && squares(&self.misses()) < allowed {
                return true;
            }
            share *= 0.5;
        }
        self.lengths = before;
        false
    }

    /// Whether every triangle inequality holds with room to spare.
    fn is_metric(&self) -> bool {
        self.lengths.as_slice().chunks_exact(3).all(|sides| {
            let longest = sides[0].max(sides[1]).max(sides[2]);
            let excess = sides.iter().sum::<f64>() - 2.0 * longest;
            longest.is_normal() && excess > LEAST_EXCESS * longest
        })
    }

    /// The angle of the corner that a halfedge leaves.
    fn angle(&self, h: HalfedgeId) -> f64 {
        let [a, b, opposite] = [h, h.prev(), h.next()].map(|e| self.lengths[e]);
        // Half-angle form: exact for slivers too, where the cosine is not.
        let half = [
            (opposite + (a - b)) * (opposite - (a - b)),
            (a + b + opposite) * (a + b - opposite),
        ];
        2.0 * atan2(half[0].max(0.0).sqrt(), half[1].max(0.0).sqrt())
    }

    /// The cotangent of the angle opposite to a halfedge.
    fn cotangent(&self, h: HalfedgeId) -> f64 {
        let [side, a, b] = [h, h.next(), h.prev()].map(|e| self.lengths[e]);
        let squared = (side + a + b) * (a + b - side) * (side + (a - b)) * (side - (a - b));
        (a * a + b * b - side * side) / squared.max(f64::MIN_POSITIVE).sqrt()
    }

    /// Flips edges until the triangulation is Delaunay in the lengths.
    fn delaunay(&mut self) {
        let edges = self.complex.halfedge_ids();
        let mut waiting: Vec<HalfedgeId> = edges.filter(|&h| h < self.complex.twins[h]).collect();
        // Flips lower an energy, so they end; the cap guards against rounding.
        let mut n_left = 50 * waiting.len();
        while let Some(h) = waiting.pop() {
            let t = self.complex.twins[h];
            if h.face() == t.face() || self.cotangent(h) + self.cotangent(t) >= -SLACK {
                continue;
            }
            let at_origin = self.angle(h) + self.angle(t.next());
            let at_target = self.angle(h.next()) + self.angle(t);
            if at_origin.max(at_target) >= std::f64::consts::PI - 1e-9 || n_left == 0 {
                continue;
            }
            n_left -= 1;
            self.flip(h, at_origin);
            let t = self.complex.twins[h];
            waiting.extend([h.next(), h.prev(), t.next(), t.prev()]);
        }
    }

    fn flip(&mut self, h: HalfedgeId, at_origin: f64) {
        let t = self.complex.twins[h];
        let [a, b] = [self.lengths[h.prev()], self.lengths[t.next()]];
        // |a − b|² + 4ab sin²: the law of cosines without its cancellation.
        let half = sin(0.5 * at_origin);
        let diagonal = ((a - b) * (a - b) + 4.0 * a * b * half * half).sqrt();
        self.complex.flip_edge(h);
        move_values(&mut self.lengths, &flip_moves(h, t));
        self.lengths[h] = diagonal;
        self.lengths[t] = diagonal;
    }

    /// Lays face after face into the frames, then turns and scales the whole to fit the wish.
    fn into_layout(mut self) -> Complex {
        let mut is_laid = vec![false; self.complex.n_faces()];
        let mut queue = std::collections::VecDeque::new();
        self.lay(HalfedgeId(0), DVec2::new(self.lengths[HalfedgeId(0)], 0.0));
        is_laid[0] = true;
        queue.push_back(FaceId(0));
        while let Some(face) = queue.pop_front() {
            let first = self.complex.halfedge(face);
            for h in [first, first.next(), first.prev()] {
                let t = self.complex.twins[h];
                let seen = &mut is_laid[t.face().0 as usize];
                if !std::mem::replace(seen, true) {
                    let vector = -self.complex.start[h].turned(self.complex.turns[h]);
                    self.lay(t, vector);
                    queue.push_back(t.face());
                }
            }
        }
        self.fit_to_wish();
        self.complex
    }

    fn lay(&mut self, h: HalfedgeId, vector: DVec2) {
        let [angle, side] = [self.angle(h), self.lengths[h.prev()]];
        let along = vector / self.lengths[h];
        let apex = along.rotate(direction(angle)) * side;
        let start = &mut self.complex.start;
        start[h] = vector;
        start[h.next()] = apex - vector;
        start[h.prev()] = -apex;
    }

    /// Multiplies the metric by the complex number that brings it nearest to the wish, with long
    /// and short edges counting alike.
    fn fit_to_wish(&mut self) {
        let (mut fit, mut size) = (DVec2::ZERO, 0.0);
        for h in self.complex.halfedge_ids() {
            let [start, wish] = [self.complex.start[h], self.complex.wish[h]];
            fit += DVec2::new(start.x, -start.y).rotate(wish) / self.lengths[h];
            size += start.length_squared() / self.lengths[h];
        }
        if fit.length_squared() > 0.0 {
            let factor = fit / size;
            for vector in self.complex.start.as_mut_slice() {
                *vector = vector.rotate(factor);
            }
        }
    }
}

fn done_if_close(miss: f64, n_steps: usize) -> Result<(), FlattenError> {
    if miss < CLOSE {
        return Ok(());
    }
    Err(FlattenError::Stalled { miss, n_steps })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::cones::keep_cones;
    use crate::flow::{field, singularities, wish};
    use crate::mesh::FaceMap;
    use crate::shapes;

    fn flat(mesh: &TriangleMesh, n_quads: f64) -> Complex {
        let quiet = Progress::none();
        let side = (crate::measure::total_area(mesh) / n_quads).sqrt();
        let sizes = FaceMap::filled(mesh.n_faces(), side);
        let mut field = field::orient(mesh, &field::Settings::default(), &quiet).unwrap();
        singularities::tidy(mesh, &mut field, &sizes);
        let wish = wish::wish(mesh, &field, &sizes, &quiet).unwrap();
        flatten(mesh, &field, wish, &[], &quiet).unwrap()
    }

    #[test]
    fn closed_shapes_get_flat_metrics_with_the_cones_of_their_fields() {
        for (name, mesh) in shapes::closed(12) {
            let complex = flat(&mesh, 300.0);
            if let Err(broken) = complex.check() {
                panic!("{name}: {broken}");
            }
            assert_eq!(complex.indices.iter().sum::<i32>(), 8, "{name}");
        }
    }

    #[test]
    fn flat_metrics_are_reduced_to_their_cones() {
        for (name, mesh) in shapes::closed(10) {
            let complex = flat(&mesh, 200.0);
            let n_cones = complex.indices.iter().filter(|&&k| k != 0).count();
            let area = complex.area();
            let none = VertexMap::filled(complex.n_vertices(), false);
            let cones = keep_cones(complex, &none, &Progress::none()).unwrap();
            if let Err(broken) = cones.check() {
                panic!("{name}: {broken}");
            }
            assert_eq!(cones.n_vertices(), n_cones, "{name}");
            assert_eq!(cones.n_faces(), 2 * n_cones - 4, "{name}");
            assert!((cones.area() / area - 1.0).abs() < 1e-6, "{name}");
        }
    }

    #[test]
    fn lengths_without_a_size_are_refused() {
        let (_, mesh) = shapes::closed(4).swap_remove(0);
        let quiet = Progress::none();
        let field = field::orient(&mesh, &field::Settings::default(), &quiet).unwrap();
        let wish = HalfedgeMap::filled(3 * mesh.n_faces(), DVec2::X);
        let broken = mesh.with_positions(vec![glam::DVec3::splat(1e300); mesh.n_vertices()]);
        assert!(flatten(&broken, &field, wish, &[], &quiet).is_err());
    }

    #[test]
    fn the_run_can_be_cancelled() {
        let (_, mesh) = shapes::closed(4).swap_remove(0);
        let field = field::orient(&mesh, &field::Settings::default(), &Progress::none()).unwrap();
        let wish = HalfedgeMap::filled(3 * mesh.n_faces(), DVec2::X);
        let token = crate::progress::CancelToken::default();
        token.cancel();
        let progress = Progress::silent(token);
        let result = flatten(&mesh, &field, wish, &[], &progress);
        assert!(matches!(result, Err(FlattenError::Cancelled(_))));
    }
}
