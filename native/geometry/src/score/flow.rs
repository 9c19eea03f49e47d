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

/// Of more triangles curvature is smoothed between patches of vertices, if these are larger than an
/// edge: on every vertex that would take most of a run's time at a million triangles.
const MOST_TRIANGLES: usize = 200_000;
/// Patches are so small a share of the scale that it must be this many edges long.
const PATCHES: f64 = 6.0;

/// Edges between two looks at the progress.
const CHUNK: usize = 2048;

/// Irregular vertices, and edges against principal directions; none without quads.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Flow {
    /// ↓ Share of inner vertices whose valence is not 4; none without inner vertices.
    pub irregular_pct: Option<f64>,
    /// ↓ Inner vertices with a valence of 6 or more, which artists avoid.
    pub high_valence: Option<usize>,
    /// ↓ Mean angle in degrees between the edges and the nearest of the input's two principal
    /// directions, weighted by length and by how much the curvatures differ. Random edges have 22.5.
    pub alignment_deg: Option<f64>,
}

pub fn flow(
    input: &Surface,
    output: &Surface,
    target: Option<usize>,
    progress: &Progress,
) -> Result<Flow, Error> {
    progress.at(0.0)?;
    if output.mesh.n_quads() == 0 {
        return Ok(Flow::default());
    }
    let n_quads = target.unwrap_or((output.triangles.len() / 2).max(1));
    let field = curvature(input, n_quads, progress)?;
    progress.at(0.8)?;
    let valences = inner_valences(output);
    let share_irregular = || 100.0 * share(&valences, |&valence| valence != 4);
    Ok(Flow {
        irregular_pct: (!valences.is_empty()).then(share_irregular),
        high_valence: Some(valences.iter().filter(|&&valence| valence >= 6).count()),
        alignment_deg: Some(alignment(input, &field, output, progress)?),
    })
}

/// The curvature at the scale of a quad.
fn curvature(
    input: &Surface,
    n_quads: usize,
    progress: &Progress,
) -> Result<CurvatureField, Error> {
    let edge = mean(&input.edge_lengths);
    // The edge of a square of the area of one quad, but nothing finer than the input itself.
    let scale = (input.area / n_quads as f64).sqrt().max(edge);
    let is_large = input.triangles.len() > MOST_TRIANGLES && scale > PATCHES * edge;
    let positions = input.mesh.positions().to_vec();
    let triangles = input.triangles.clone();
    let measure = if is_large {
        CurvatureField::in_patches
    } else {
        CurvatureField::new
    };
    let measure = move || measure(&positions, &triangles, scale);
    Ok(watched(measure, progress)??)
}

/// How many edges meet at each vertex that is in use and not on a border.
fn inner_valences(surface: &Surface) -> Vec<u32> {
    let n = surface.mesh.n_vertices();
    let all = surface.edges.valences(n).into_iter();
    let inner = all.zip(surface.edges.border_vertices(n));
    inner
        .filter(|&(valence, border)| valence > 0 && !border)
        .map(|(valence, _)| valence)
        .collect()
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
        let triangle = input.triangles[closest.face.index()];
        let at = field.at(triangle, closest.weights, closest.position);
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
