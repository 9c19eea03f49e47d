//! Finds the flat cylinders of a metric.

use std::collections::BTreeSet;

use super::close::close;
use super::sight::{Limits, Sights, nears_axis};
use super::{Cylinder, Reach};
use crate::elementary::direction;
use crate::flow::complex::Complex;
use crate::mesh::HalfedgeId;

/// More triangles than this are not unfolded: a second or two.
const MOST_SIGHTS: usize = 3_000_000;

/// All maximal cylinders within reach, each once, none that crosses itself.
///
/// Every maximal cylinder has a cone on its left border, and is seen from one of its corners as
/// that cone again in the direction of the period. Costs 1 to 30 ms for a hundred cones.
pub fn cylinders(complex: &Complex, reach: &Reach) -> Vec<Cylinder> {
    let limits = Limits {
        longest: reach.longest,
        n_crossed: reach.n_crossed,
        n_sights: MOST_SIGHTS,
        cone: direction(reach.angle),
        aside: reach.aside,
        clear: reach.narrowest,
    };
    let mut found = Vec::new();
    let mut known: BTreeSet<Vec<HalfedgeId>> = BTreeSet::new();
    Sights::from_all_corners(complex, limits, |sights, apex| {
        let [seen, from] = [sights.last().entered.prev(), sights.first().entered];
        if complex.origins[seen] != complex.origins[from]
            || apex.length() > reach.longest
            || !sights.sees(apex, true)
            || !nears_axis(apex, apex, limits.cone)
        {
            return;
        }
        let Some(cylinder) = close(complex, sights, apex, reach.narrowest) else {
            return;
        };
        let mut edges: Vec<HalfedgeId> = (cylinder.entered.iter())
            .map(|&h| h.min(complex.twins[h]))
            .collect();
        edges.sort_unstable();
        if known.insert(edges) && cylinder.is_simple(complex) {
            found.push(cylinder);
        }
    });
    found
}
