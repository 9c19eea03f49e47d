//! How the edges run over the surface.

use rayon::prelude::*;
use serde::Serialize;

use super::Error;
use super::statistics::{mean, share};
use super::surface::Surface;
use super::watched::watched;
use crate::elementary::atan2;
use crate::measure::CurvatureField;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// Edges between two looks at the progress.
const CHUNK: usize = 2048;

/// Irregular vertices, and edges against principal directions.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Flow {
    /// ↓ Share of inner vertices whose valence is not 4; none without inner vertices.
    pub irregular_pct: Option<f64>,
    /// ↓ Mean angle in degrees between the edges and the nearest of the input's two principal
    /// directions, weighted by length and by how much the curvatures differ. Random edges have 22.5.
    pub alignment_deg: f64,
}

pub fn flow(
    input: &Surface,
    output: &Surface,
    target: Option<usize>,
    progress: &Progress,
) -> Result<Flow, Error> {
    progress.at(0.0)?;
    let n_quads = target.unwrap_or((output.triangles.len() / 2).max(1));
    // The edge of a square of the area of one quad, but nothing finer than the input itself.
    let scale = (input.area / n_quads as f64)
        .sqrt()
        .max(mean(&input.edge_lengths));
    let positions = input.mesh.positions().to_vec();
    let triangles = input.triangles.clone();
    let field = watched(
        move || CurvatureField::new(&positions, &triangles, scale),
        progress,
    )??;
    progress.at(0.8)?;
    let irregular_pct = irregular_pct(output);
    let alignment_deg = alignment(input, &field, output, progress)?;
    Ok(Flow {
        irregular_pct,
        alignment_deg,
    })
}

fn irregular_pct(surface: &Surface) -> Option<f64> {
    let n = surface.mesh.n_vertices();
    let inner = surface
        .edges
        .valences(n)
        .into_iter()
        .zip(surface.edges.border_vertices(n));
    let inner: Vec<u32> = inner
        .filter(|&(valence, border)| valence > 0 && !border)
        .map(|(v, _)| v)
        .collect();
    (!inner.is_empty()).then(|| 100.0 * share(&inner, |&valence| valence != 4))
}

fn alignment(
    input: &Surface,
    field: &CurvatureField,
    output: &Surface,
    progress: &Progress,
) -> Result<f64, Cancelled> {
    let least = 2.0 / input.diagonal();
    let angle = |ends: &[VertexId; 2], length: f64| {
        let [a, b] = ends.map(|v| output.mesh.position(v));
        let closest = input.tree.closest((a + b) / 2.0);
        let at = field.at(input.triangles[closest.face.index()], closest.weights);
        let [x, y] = [(b - a).dot(at.d1).abs(), (b - a).dot(at.d2).abs()];
        let weight = length * (at.k1 - at.k2).abs() / (at.k1.abs() + at.k2.abs() + least);
        (atan2(x.min(y), x.max(y)).to_degrees() * weight, weight)
    };
    let search = |(ends, lengths): (&[[VertexId; 2]], &[f64])| {
        progress.check()?;
        let found = ends
            .iter()
            .zip(lengths)
            .map(|(ends, &length)| angle(ends, length));
        Ok(found.collect())
    };
    let chunks = output
        .edges
        .ends
        .par_chunks(CHUNK)
        .zip(output.edge_lengths.par_chunks(CHUNK));
    let found: Vec<Vec<(f64, f64)>> = chunks.map(search).collect::<Result<_, _>>()?;
    let sum = |(a, b): (f64, f64), (c, d): (f64, f64)| (a + c, b + d);
    let (angles, weights) = found.into_iter().flatten().fold((0.0, 0.0), sum);
    Ok(angles / weights.max(1e-300))
}
