//! Drags a flat metric to other periods through valid metrics only.
//!
//! All vectors move together in a straight line. Before a triangle would fold its edges are
//! flipped: between steps the triangulation is made Delaunay again, so that the only true obstacle
//! is two cones that meet. Nothing is ever torn, so whatever is reached has the topology and the
//! cone angles of the start.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::Arc;

use super::complex::{Chains, Complex, LocatedPoints, Turn};
use super::periods::Periods;
use crate::mesh::Id;

/// The shortest edge that a metric may get on the way to whole periods. A wish with a collapsed
/// edge stops every drag at once if this is large (0.2 failed on all people).
pub const SHORT: f64 = 2e-3;
/// The least share of the way worth a step.
const LEAST_STEP: f64 = 1e-3;
/// How much a step grows once it was good.
const GROWTH: f64 = 1.7;
/// More steps than this lead nowhere.
const MOST_STEPS: usize = 400;
/// How flat a triangle may get, as double area by its longest side (squared, up to 1).
const FLAT: f64 = 1e-5;
/// How far the angle of a cone may be off: below the least change of a valid metric, 90°.
const ANGLE: f64 = 1e-4;

/// A metric with the periods that it has, and the way that it came.
#[derive(Clone, Debug)]
pub struct State {
    /// The metric, with coefficients and without located points. Its `wish` is of no meaning: it
    /// carries the vectors that a drag is on its way to.
    pub complex: Complex,
    /// Its periods.
    pub periods: Periods,
    way: Option<Arc<Leg>>,
}

/// One drag of a state's way, and those before it.
#[derive(Debug)]
struct Leg {
    to: Periods,
    short: f64,
    earlier: Option<Arc<Leg>>,
}

impl State {
    /// A metric at its start. Located points and lines stay behind, see [`State::replay`].
    pub fn new(complex: &Complex, periods: Periods) -> Self {
        let mut complex = complex.clone();
        complex.located = LocatedPoints::new(complex.n_faces());
        complex.chains = Chains::default();
        Self {
            complex,
            periods,
            way: None,
        }
    }

    /// Drags towards `to` as far as it goes; returns the share of the way, 1 when it is reached,
    /// and then the vectors are exactly those of the periods. No edge gets shorter than `short`.
    pub fn drag(&mut self, to: &[f64], short: f64) -> f64 {
        let share = drag(&mut self.complex, to, short);
        for (own, to) in self.periods.iter_mut().zip(to) {
            *own = if share >= 1.0 {
                *to
            } else {
                *own + (to - *own) * share
            };
        }
        if share > 0.0 {
            let earlier = self.way.take();
            self.way = Some(Arc::new(Leg {
                to: to.to_vec(),
                short,
                earlier,
            }));
        }
        share
    }

    /// Takes the complex that the state began as the same way, with its located points.
    pub fn replay(&self, start: &mut Complex) {
        let mut legs = Vec::new();
        let mut next = self.way.as_deref();
        while let Some(leg) = next {
            legs.push(leg);
            next = leg.earlier.as_deref();
        }
        for leg in legs.into_iter().rev() {
            drag(start, &leg.to, leg.short);
        }
    }
}

/// Drags all vectors towards those of the periods; overwrites `wish`, which flips carry along.
fn drag(complex: &mut Complex, to: &[f64], short: f64) -> f64 {
    for h in complex.halfedge_ids() {
        let twin = complex.twins[h];
        if h < twin {
            let wish = complex.coefficients.value(h, to);
            complex.wish[h] = wish;
            complex.wish[twin] = -wish.turned(complex.turns[h]);
        }
    }
    let [mut done, mut step] = [0.0, 1.0_f64];
    let mut before = complex.start.clone();
    for _ in 0..MOST_STEPS {
        let rest: f64 = 1.0 - done;
        let share = (step / rest).min(1.0);
        before
            .as_mut_slice()
            .copy_from_slice(complex.start.as_slice());
        advance(complex, share);
        if is_valid(complex, before.as_slice(), short) {
            complex.delaunay();
            if share >= 1.0 {
                return 1.0;
            }
            done += rest * share;
            step *= GROWTH;
        } else {
            complex
                .start
                .as_mut_slice()
                .copy_from_slice(before.as_slice());
            step = step.min(rest) * 0.5;
            if step < LEAST_STEP {
                break;
            }
        }
    }
    done
}

fn advance(complex: &mut Complex, share: f64) {
    let wish = complex.wish.as_slice();
    for (own, &to) in complex.start.as_mut_slice().iter_mut().zip(wish) {
        *own = if share >= 1.0 {
            to
        } else {
            *own + (to - *own) * share
        };
    }
}

/// Whether no triangle folds, no edge is short that was not, and no cone lost its angle.
fn is_valid(complex: &Complex, before: &[glam::DVec2], short: f64) -> bool {
    let vectors = complex.start.as_slice();
    let are_sound = |(own, old): (&[glam::DVec2; 3], &[glam::DVec2; 3])| {
        let squares = own.map(glam::DVec2::length_squared);
        let longest = squares.into_iter().fold(0.0, f64::max);
        let flat = FLAT * longest.min(1.0) / longest.sqrt().max(1.0);
        let shrinks = |i: usize| {
            squares[i] < short * short && squares[i] < old[i].length_squared() * 0.999_998
        };
        own[0].perp_dot(own[1]) >= flat && !(0..3).any(shrinks)
    };
    let faces = vectors.as_chunks::<3>().0.iter();
    faces.zip(before.as_chunks::<3>().0).all(are_sound) && has_turns(complex)
}

/// Whether no angle at a vertex is off by a turn; all faces are positive.
///
/// Vectors agree across edges, so that an angle is never off by less, and roughly is enough.
fn has_turns(complex: &Complex) -> bool {
    let mut miss = shortfall(complex);
    let faces = complex.start.as_slice().as_chunks::<3>().0;
    let origins = complex.origins.as_slice().as_chunks::<3>().0;
    for (&[a, b, c], origins) in faces.iter().zip(origins) {
        let area = a.perp_dot(b);
        for (origin, dot) in origins.iter().zip([a.dot(c), b.dot(a), c.dot(b)]) {
            miss[origin.index()] += rough_angle(-dot, area);
        }
    }
    miss.iter().all(|miss| miss.abs() < PI)
}

/// The angle of a vector of the upper half plane from the x axis, within 0.004.
fn rough_angle(x: f64, y: f64) -> f64 {
    let [long, short] = [x.abs().max(y), x.abs().min(y)];
    let ratio = short / long;
    let octant = ratio * (FRAC_PI_4 + 0.273 * (1.0 - ratio));
    let quadrant = if x.abs() < y {
        FRAC_PI_2 - octant
    } else {
        octant
    };
    if x < 0.0 { PI - quadrant } else { quadrant }
}

/// Less the angle that belongs to each vertex by its index.
fn shortfall(complex: &Complex) -> Vec<f64> {
    let wanted = |&k: &i32| f64::from(k - 4) * FRAC_PI_2;
    complex.indices.iter().map(wanted).collect()
}

/// Whether the angle at each vertex is that of its index.
pub fn has_angles(complex: &Complex) -> bool {
    let mut miss = shortfall(complex);
    for h in complex.halfedge_ids() {
        miss[complex.origins[h].index()] += complex.angle(h);
    }
    miss.iter().all(|miss| miss.abs() < ANGLE)
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // A share of 1 is exact.
mod tests {
    use super::*;
    use crate::elementary::sin_cos;
    use crate::flow::complex::tests::box_complex;
    use crate::flow::periods::choose;
    use crate::random::Random;

    /// The box of 10 × 8 × 6 and where to drag it: every period moved by up to half of `range`.
    fn problem(seed: u64, range: f64) -> (Complex, State, Periods) {
        let mut complex = box_complex(1);
        let basis = choose(&mut complex).unwrap();
        let state = State::new(&complex, basis.start);
        let mut random = Random::new(seed);
        let moved = |x: &f64| x + range * (random.unit() - 0.5);
        let to = state.periods.iter().map(moved).collect();
        (complex, state, to)
    }

    #[test]
    fn a_drag_arrives_at_a_valid_metric_and_leads_back() {
        for seed in 0..20 {
            let (_, mut state, to) = problem(seed, 4.0);
            let start = state.clone();
            assert_eq!(state.drag(&to, 0.1), 1.0);
            assert_eq!(state.complex.check(), Ok(()));
            assert_eq!(state.periods, to);
            assert_eq!(state.drag(&start.periods, 0.1), 1.0);
            assert!((state.complex.area() - start.complex.area()).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_out_of_reach_is_approached() {
        let (_, mut state, _) = problem(0, 0.0);
        let nothing = vec![0.0; state.periods.len()];
        let share = state.drag(&nothing, 2.0);
        assert!((0.5..1.0).contains(&share), "{share}");
        assert_eq!(state.complex.check(), Ok(()));
        let shortest = state
            .complex
            .start
            .iter()
            .map(|v| v.length())
            .fold(9.0, f64::min);
        assert!(shortest >= 2.0);
    }

    #[test]
    fn the_area_of_periods_is_known_before_they_are_reached() {
        for seed in 0..10 {
            let (complex, mut state, to) = problem(seed, 4.0);
            let vector = |h| complex.coefficients.value(h, &to);
            let double = |f| {
                let h = complex.halfedge(f);
                vector(h).perp_dot(vector(h.next()))
            };
            let area = 0.5 * complex.face_ids().map(double).sum::<f64>();
            assert_eq!(state.drag(&to, 0.1), 1.0);
            assert!((state.complex.area() - area).abs() < 1e-9 * area);
        }
    }

    #[test]
    fn rough_angles_are_near() {
        for i in 1..2000 {
            let angle = f64::from(i) * PI / 2000.0;
            let (y, x) = sin_cos(angle);
            assert!((rough_angle(7.0 * x, 7.0 * y) - angle).abs() < 4e-3);
        }
    }

    #[test]
    fn a_replay_goes_the_same_way() {
        let (mut complex, mut state, to) = problem(3, 5.0);
        state.drag(&to, SHORT);
        let whole: Periods = to.iter().map(|x| x.round()).collect();
        assert_eq!(state.drag(&whole, SHORT), 1.0);
        state.replay(&mut complex);
        assert_eq!(complex.start, state.complex.start);
        assert_eq!(complex.origins, state.complex.origins);
        assert!(complex.start.iter().all(|v| *v == v.round()));
    }
}
