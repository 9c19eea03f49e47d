//! Straight segments between two cones that are nearly along an axis.

use glam::{DVec2, IVec2};

use super::close::places;
use super::off_axis;
use super::sight::{Limits, Sights};
use crate::elementary::direction;
use crate::flow::complex::Complex;

/// More edges than this are not crossed.
const MOST_CROSSED: usize = 25;
/// More triangles than this are not unfolded.
const MOST_SIGHTS: usize = 300_000;
/// Only segments this near to an axis: half a unit off it in one along it.
const ANGLE: f64 = 0.464;

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
        n_sights: MOST_SIGHTS,
        cone: direction(ANGLE),
        aside: off + 1e-6,
        clear: 0.0,
    };
    let mut found = Vec::new();
    Sights::from_all_corners(complex, limits, |sights, apex| {
        let miss = off_axis(apex).of(apex).abs();
        let is_wanted = (0.5..=limits.aside).contains(&miss) && apex.length() <= longest;
        let is_near = miss < 0.5 * apex.length();
        if sights.is_first() || !is_wanted || !is_near || !sights.sees(apex, false) {
            return;
        }
        let sight = *sights.last();
        let [_, mut end] = places(complex, sights.first().entered, &sights.entered());
        (complex.coefficients).add_to(&mut end, sight.entered.next(), sight.turns);
        found.push(Segment {
            vector: apex,
            coefficients: end,
        });
    });
    found
}
