//! The flat metric: a mesh's own lengths, scaled vertex by vertex until only the cones bend it.
//!
//! ```text
//! ℓᵢⱼ ← ℓᵢⱼ · e^{(uᵢ + uⱼ) / 2}      angle sum at i = (4 − kᵢ) · 90°
//! ```
//!
//! Newton's method on the convex energy of Springborn, Schröder & Pinkall 2008, with intrinsic
//! Delaunay flips before each step; one that would break a triangle flips edges on its way, by
//! Ptolemy's theorem (Gillespie, Springborn & Crane 2021). On a closed surface of genus 0 a metric
//! with these cone angles turns every vector as the orientation field does: its triangles can be
//! laid into the field's frames.

mod layout;
mod metric;

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use thiserror::Error;

use super::complex::{Complex, Dressing};
use super::field::OrientationField;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sparse::{Cholesky, NotPositiveDefinite, SymmetricMatrix};
use metric::Metric;

/// How far an angle sum may miss its goal, in radians: near the rounding of a sum of some arcs.
const EXACT: f64 = 1e-11;
/// Where no step lowers the misses any more, this much is still good enough to close the layout.
const CLOSE: f64 = 1e-8;
/// 4–10 steps are usual, some 40 on meshes with degenerate faces.
const MOST_STEPS: usize = 80;
/// The largest change of a log scale in one step: e³ᐟ² in length. Larger ones overshoot.
const LARGEST_STEP: f64 = 3.0;
/// How often a step is halved before edges are flipped on its way, and again before it is given up.
const MOST_HALVINGS: usize = 8;
/// Makes the Laplacian definite; a smaller shift is lost in its rounding.
const SHIFT: f64 = 1e-8;
/// Below this miss, in radians, Newton's steps may share a factor.
const NEAR: f64 = 0.05;
/// As long as each leaves no more than this share of the miss.
const GAIN: f64 = 0.1;

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
    let dressing = Dressing {
        turns: field.turns.clone(),
        indices: field.indices.clone(),
        wish,
    };
    let mut metric = Metric::of(mesh, dressing);
    metric.complex.follow_lines(lines);
    metric.level(progress)?;
    Ok(metric.into_layout())
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
        let now = squares(misses);
        let largest = step.iter().fold(0.0, |most: f64, u| u.abs().max(most));
        // So near to the end rounding may hide the gain of a last step.
        let is_last = misses.iter().all(|miss| miss.abs() < 100.0 * EXACT);
        let allowed = if is_last { 4.0 * now } else { now };
        let is_lower = |metric: &Self| metric.is_metric() && squares(&metric.misses()) < allowed;
        let shares = || {
            let first = (LARGEST_STEP / largest).min(1.0);
            std::iter::successors(Some(first), |share| Some(0.5 * share)).take(MOST_HALVINGS)
        };
        let before = self.lengths.clone();
        for share in shares() {
            self.scale(step, share, &before);
            if is_lower(self) {
                return true;
            }
        }
        for share in shares() {
            let mut flipped = self.clone();
            flipped.scale(step, share, &before);
            flipped.repair();
            if is_lower(&flipped) {
                *self = flipped;
                return true;
            }
        }
        self.lengths = before;
        false
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
