//! What a network reaches on shapes.
//!
//! Training asks for medians of energy and folds, every interval. A [`report`] says everything, with
//! the solver and the radial projection beside it, for shapes trained on and shapes never seen.

mod exhibit;
pub mod outcome;
pub mod rebuilt;
pub mod report;
pub mod rotation;

use orbflow_network::net::Network;
use serde::{Deserialize, Serialize};

use crate::sample::{Quality, Sample, SampleError};

/// Medians over shapes, of the finest level that the network proposes.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Figures {
    /// How many shapes.
    pub n_shapes: usize,
    /// Distortion.
    pub energy: f64,
    /// Folded triangles of a hundred.
    pub folds_pct: f64,
}

/// The medians of what a network proposes.
pub fn evaluate(network: &Network, samples: &[Sample]) -> Figures {
    let qualities = samples.iter().map(|sample| assess(network, sample));
    medians(&qualities.collect::<Vec<_>>())
}

/// What a network proposes for one shape.
pub fn assess(network: &Network, sample: &Sample) -> Quality {
    sample.quality(&network.forward(&sample.prepared.pyramid))
}

/// The medians of some assessments; zeros of none.
pub fn medians(qualities: &[Quality]) -> Figures {
    let median = |value: fn(&Quality) -> f64| {
        let mut values: Vec<f64> = qualities.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    Figures {
        n_shapes: qualities.len(),
        energy: median(|quality| quality.energy),
        folds_pct: median(|quality| quality.folds_pct),
    }
}

/// What there is to beat.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Baselines {
    /// The direction of each vertex from the centre.
    pub radial: Figures,
    /// The solver, on the finest level alone.
    pub solver: Figures,
}

/// Measures radial projection and solver on shapes.
///
/// # Errors
/// [`SampleError`] when the solver fails on one.
pub fn baselines(samples: &[Sample]) -> Result<Baselines, SampleError> {
    let radial = samples
        .iter()
        .map(|sample| sample.quality(sample.mesh.positions()));
    let mut solved = Vec::with_capacity(samples.len());
    for sample in samples {
        solved.push(Quality {
            energy: sample.solver_energy()?,
            folds_pct: 0.0,
        });
    }
    Ok(Baselines {
        radial: medians(&radial.collect::<Vec<_>>()),
        solver: medians(&solved),
    })
}
