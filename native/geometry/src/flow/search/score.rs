//! How good the grid of a metric with whole periods is.

use serde::{Deserialize, Serialize};

use crate::flow::complex::Complex;
use crate::flow::covariance::energy;
use crate::flow::lines::trace;

/// A count of quads this near to the wanted one is as good as exact.
const EXACT: f64 = 0.005;
/// What a grid with doubled edges costs more than one without, and each of them.
const NOT_SIMPLE: f64 = 5.0;
const DOUBLED: f64 = 0.2;

/// How much each fault counts against a whole grid in spirals.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Weights {
    /// Per share of quads in spirals.
    pub spiral: f64,
    /// Per share of edges on loops, to its credit.
    pub loops: f64,
    /// Per unit of mean squared distance from the wish.
    pub energy: f64,
    /// Per relative error of the count beyond half a percent.
    pub count: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self {
            spiral: 1.0,
            loops: 1.0,
            energy: 1.0,
            count: 20.0,
        }
    }
}

/// The figures of one grid.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Score {
    /// How many quads there are.
    pub n_quads: usize,
    /// The count's relative error.
    pub count_error: f64,
    /// The mean squared distance of vectors from the wish, in edges.
    pub energy: f64,
    /// The share of quads that one strip crosses twice.
    pub spiral: f64,
    /// The share of edges on closed lines.
    pub loops: f64,
    /// How many halfedges double another; the mesh is simple without any.
    pub n_doubled: usize,
    /// How many lines of a solid are no straight ways.
    #[serde(skip)]
    pub n_unmet: usize,
}

pub(super) fn relative_error(area: f64, n_wanted: f64) -> f64 {
    (area / n_wanted - 1.0).abs()
}

impl Score {
    /// Scores a metric with whole periods, but for doubled edges.
    pub fn of_lines(complex: &Complex, wish: &[f64], n_wanted: f64) -> Self {
        let area = complex.area();
        let strips = trace(complex);
        Self {
            n_quads: area.round() as usize,
            count_error: relative_error(area, n_wanted),
            energy: energy(complex, wish),
            spiral: strips.spiral,
            loops: strips.loops,
            n_doubled: 0,
            n_unmet: 0,
        }
    }

    /// The count's error that counts, for a metric of some area.
    pub(super) fn excess_error(area: f64, n_wanted: f64) -> f64 {
        (relative_error(area, n_wanted) - EXACT).max(0.0)
    }

    /// What the search makes small.
    pub fn cost(&self, weights: &Weights) -> f64 {
        let mut cost = weights.spiral * self.spiral - weights.loops * self.loops
            + weights.energy * self.energy
            + weights.count * (self.count_error - EXACT).max(0.0);
        if self.n_doubled > 0 {
            cost += NOT_SIMPLE + DOUBLED * self.n_doubled as f64;
        }
        if self.n_unmet > 0 {
            cost += NOT_SIMPLE + self.n_unmet as f64;
        }
        cost
    }
}
