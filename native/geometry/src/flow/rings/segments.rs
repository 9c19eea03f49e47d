//! Straight segments between two cones that are nearly along an axis.

use glam::{DVec2, IVec2};

use super::close::{apex_row, coefficients_to};
use super::off_axis;
use super::sight::{Limits, Sights};
use crate::flow::complex::Complex;

/// More edges than this are not crossed.
const MOST_CROSSED: usize = 25;
/// More triangles than this are not unfolded.
const MOST_SIGHTS: usize = 300_000;
/// Only segments this near to an axis: half a unit off it in one along it.
const ANGLE: f64 = 0.464;
/// The sine within which two directions are one.
const SAME: f64 = 1e-9;

/// A straight line from cone to cone.
#[derive(Clone, PartialEq, Debug)]
pub struct Segment {
    /// From end to end.
    pub vector: DVec2,
    /// The same over the free periods.
    pub coefficients: Vec<IVec2>,
}

/// The segments up to `longest` that are off an axis by some whole number up to `off`.
pub fn segments(complex: &Complex, longest: f64, off: f64) -> Vec<Segment> {
    let limits = Limits {
        longest,
        n_crossed: MOST_CROSSED,
        cone: DVec2::from_angle(ANGLE),
    };
    let mut found = Vec::new();
    let mut sights = Sights::new(complex, limits);
    let mut n_sights = 0;
    for corner in complex.halfedge_ids() {
        sights.begin(corner);
        while let Some((i, apex)) = sights.next() {
            n_sights += 1;
            if n_sights > MOST_SIGHTS {
                return found;
            }
            let miss = off_axis(apex).of(apex).abs();
            let is_wanted = (0.5..=off + 1e-6).contains(&miss) && apex.length() <= longest;
            let sight = *sights.sight(i);
            let sine = |a: DVec2, b: DVec2| a.perp_dot(b) / (a.length() * b.length());
            let is_seen = sine(sight.low, apex) > SAME && sine(apex, sight.high) > SAME;
            if i == 0 || !is_wanted || !is_seen || miss >= 0.5 * apex.length() {
                continue;
            }
            let [_, right] = coefficients_to(complex, corner, &sights.entered_to(i));
            found.push(Segment {
                vector: apex,
                coefficients: apex_row(complex, sight.entered, sight.turns, &right),
            });
        }
    }
    found
}
