//! The figures by which a result is known to be wrong, at small cost.

use super::surface::Surface;
use super::{Error, Settings, distance, features};
use crate::mesh::PolygonMesh;
use crate::progress::Progress;

/// Samples on each of the two surfaces: a finger of a body has some twenty.
const N_SAMPLES: usize = 4_000;

/// How far an output is from what it was to be.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Glance {
    /// The largest distance of a sample, in % of the input's diagonal.
    pub hausdorff_pct: f64,
    /// The share of the input's clear sharp lines that no sharp edge of the output is near; none
    /// without clear lines.
    pub lost_lines_pct: Option<f64>,
}

impl Glance {
    pub(super) fn new(distance: &distance::Distance, found: Option<&features::Found>) -> Self {
        Self {
            hausdorff_pct: distance.hausdorff_pct,
            lost_lines_pct: found.map(|found| 100.0 * (1.0 - found.recall)),
        }
    }
}

/// The figures of a glance alone, which a [`Score`](super::Score) has too.
///
/// # Errors
/// When one of the meshes has no area, or cancelled.
pub fn glance(
    input: &PolygonMesh,
    output: &PolygonMesh,
    progress: &Progress,
) -> Result<Glance, Error> {
    let [n_input, n_output] = [input, output].map(PolygonMesh::n_faces);
    let input = Surface::new(input, &progress.part("", 0.0, 0.4))?;
    let input = input.ok_or(Error::FlatInput { n_faces: n_input })?;
    let output = Surface::new(output, &progress.part("", 0.4, 0.5))?;
    let output = output.ok_or(Error::FlatOutput { n_faces: n_output })?;
    let settings = Settings {
        n_samples: N_SAMPLES,
        ..Settings::default()
    };
    let distance = distance::distance(&input, &output, &settings, &progress.part("", 0.5, 0.9))?;
    let found = features::found(&input, &output, &progress.part("", 0.9, 1.0))?;
    Ok(Glance::new(&distance, found.as_ref()))
}
