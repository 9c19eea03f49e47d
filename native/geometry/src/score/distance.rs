//! How far two surfaces are apart.

use rayon::prelude::*;
use serde::Serialize;

use super::statistics::{harmonic, mean, quantile, share};
use super::surface::Surface;
use super::{Error, Settings};
use crate::mesh::{FaceId, Id};
use crate::progress::{Cancelled, Progress};

/// Samples between two looks at the progress, neighbours that help each other find their triangle.
const CHUNK: usize = 2048;

/// Distances between input and output, from samples of both.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Distance {
    /// ↓ Mean of both mean distances.
    pub chamfer_pct: f64,
    /// ↓ The larger of both 95 % quantiles.
    pub p95_pct: f64,
    /// ↓ The largest distance of a sample.
    pub hausdorff_pct: f64,
    /// ↑ Mean |cosine| between the normals of a sample and of the closest triangle.
    pub normal_consistency: f64,
    /// ↑ Harmonic mean of both shares of samples closer than 0.5 %.
    #[serde(rename = "f1_at_0.5_pct")]
    pub f1_at_half_pct: f64,
    /// ↑ Harmonic mean of both shares of samples closer than 1 %.
    pub f1_at_1_pct: f64,
}

/// What the samples of one surface found on the other.
struct OneWay {
    distances: Vec<f64>,
    cosines: Vec<f64>,
}

pub fn distance(
    input: &Surface,
    output: &Surface,
    settings: &Settings,
    progress: &Progress,
) -> Result<Distance, Error> {
    let &Settings {
        n_samples, seed, ..
    } = settings;
    // Two seeds, so that equal surfaces are not sampled at equal points.
    let samples = output.sample(n_samples, seed.wrapping_add(1));
    let there = one_way(output, &samples, input, &progress.part("", 0.0, 0.5))?;
    let samples = input.sample(n_samples, seed);
    let back = one_way(input, &samples, output, &progress.part("", 0.5, 1.0))?;
    let scale = 100.0 / input.diagonal();
    let larger = |of: &dyn Fn(&[f64]) -> f64| scale * of(&there.distances).max(of(&back.distances));
    let middle = |a: &[f64], b: &[f64]| f64::midpoint(mean(a), mean(b));
    let f1 = |tolerance: f64| {
        let within = |way: &OneWay| share(&way.distances, |far| scale * far <= tolerance);
        100.0 * harmonic(within(&there), within(&back))
    };
    Ok(Distance {
        chamfer_pct: scale * middle(&there.distances, &back.distances),
        p95_pct: larger(&|far| quantile(far.to_vec(), 0.95)),
        hausdorff_pct: larger(&|far| far.iter().copied().fold(0.0, f64::max)),
        normal_consistency: middle(&there.cosines, &back.cosines),
        f1_at_half_pct: f1(0.5),
        f1_at_1_pct: f1(1.0),
    })
}

fn one_way(
    from: &Surface,
    samples: &[super::surface::Sample],
    to: &Surface,
    progress: &Progress,
) -> Result<OneWay, Cancelled> {
    progress.at(0.0)?;
    let search = |chunk: &[super::surface::Sample]| {
        progress.check()?;
        let mut hint = to.tree.closest(chunk[0].position).face;
        let found = chunk.iter().map(|sample| {
            let closest = to.tree.closest_near(sample.position, hint);
            hint = closest.face;
            (
                closest.distance_squared.sqrt(),
                cosine(from, sample.triangle, to, hint),
            )
        });
        Ok(found.collect::<Vec<_>>())
    };
    let chunks: Vec<Vec<(f64, f64)>> = samples
        .par_chunks(CHUNK)
        .map(search)
        .collect::<Result<_, Cancelled>>()?;
    let (distances, cosines) = chunks.into_iter().flatten().unzip();
    Ok(OneWay { distances, cosines })
}

fn cosine(from: &Surface, triangle: u32, to: &Surface, face: FaceId) -> f64 {
    from.normal(triangle as usize)
        .dot(to.normal(face.index()))
        .abs()
}
