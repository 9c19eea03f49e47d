//! Finds the flat cylinders of a metric.

use std::collections::BTreeSet;

use glam::DVec2;

use super::close::close;
use super::sight::{Limits, Sights, nears_axis};
use super::{Cylinder, Reach};
use crate::flow::complex::Complex;
use crate::mesh::HalfedgeId;

/// More triangles than this are not unfolded: a few seconds.
const MOST_SIGHTS: usize = 3_000_000;
/// The sine within which two directions are one.
const SAME: f64 = 1e-9;

/// All maximal cylinders within reach, each once, none that crosses itself.
///
/// Every maximal cylinder has a cone on its left border, and is seen from one of its corners as
/// that cone again in the direction of the period. Costs 10 to 200 ms for a hundred cones.
pub fn cylinders(complex: &Complex, reach: &Reach) -> Vec<Cylinder> {
    let limits = Limits {
        longest: reach.longest,
        n_crossed: reach.n_crossed,
        cone: DVec2::from_angle(reach.angle),
    };
    let mut found = Vec::new();
    let mut known: BTreeSet<Vec<HalfedgeId>> = BTreeSet::new();
    let mut sights = Sights::new(complex, limits);
    let mut n_sights = 0;
    for corner in complex.halfedge_ids() {
        sights.begin(corner);
        while let Some((i, apex)) = sights.next() {
            n_sights += 1;
            if n_sights > MOST_SIGHTS {
                return found;
            }
            if !is_seen_again(complex, &sights, i, apex) || apex.length() > reach.longest {
                continue;
            }
            if !nears_axis(apex, apex, limits.cone) {
                continue;
            }
            let Some(cylinder) = close(complex, &sights, i, reach.narrowest) else {
                continue;
            };
            let mut edges: Vec<HalfedgeId> = (cylinder.entered.iter())
                .map(|&h| h.min(complex.twins[h]))
                .collect();
            edges.sort_unstable();
            if known.insert(edges) && cylinder.is_simple(complex) {
                found.push(cylinder);
            }
        }
    }
    found
}

/// Whether the third corner of a triangle is the first corner's vertex, in plain sight.
fn is_seen_again(complex: &Complex, sights: &Sights, i: usize, apex: DVec2) -> bool {
    let [sight, first] = [sights.sight(i), sights.sight(0)];
    if complex.origins[sight.entered.prev()] != complex.origins[first.entered] {
        return false;
    }
    let sine = |a: DVec2, b: DVec2| a.perp_dot(b) / (a.length() * b.length());
    sine(sight.low, apex) > SAME && sine(apex, sight.high) >= -SAME
}
