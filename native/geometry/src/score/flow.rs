//! How the edges run over the surface.

use std::f64::consts::FRAC_PI_2;

use rayon::prelude::*;
use serde::Serialize;

use super::Error;
use super::statistics::{mean, share};
use super::surface::Surface;
use super::watched::watched;
use crate::elementary::atan2;
use crate::measure::{CurvatureField, angle_between};
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
    /// ↓ Share of border vertices where not one face meets for every right angle that the surface
    /// has there: three edges along a straight border, two at its corners. None without borders.
    pub border_irregular_pct: Option<f64>,
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
        border_irregular_pct: border_irregular_pct(output),
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

fn border_irregular_pct(surface: &Surface) -> Option<f64> {
    let mesh = surface.mesh;
    let is_border = surface.edges.border_vertices(mesh.n_vertices());
    let mut angles = vec![0.0; mesh.n_vertices()];
    for face in mesh.faces() {
        for (i, &v) in face
            .iter()
            .enumerate()
            .filter(|(_, v)| is_border[v.index()])
        {
            let at = |i: usize| mesh.position(face[i % face.len()]);
            let [before, after] = [at(i + face.len() - 1), at(i + 1)].map(|p| p - at(i));
            angles[v.index()] += angle_between(before, after);
        }
    }
    let valences = surface.edges.valences(mesh.n_vertices());
    let is_irregular = |&v: &usize| {
        let n_right = (angles[v] / FRAC_PI_2).round().max(1.0);
        valences[v] != n_right as u32 + 1
    };
    let border: Vec<usize> = (0..mesh.n_vertices()).filter(|&v| is_border[v]).collect();
    (!border.is_empty()).then(|| 100.0 * share(&border, is_irregular))
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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::PolygonMesh;

    /// Squares at these places of a plane, the vertex at the origin moved.
    fn plate(squares: &[[u32; 2]], origin: DVec3) -> PolygonMesh {
        let at = |i: u32| DVec3::new(f64::from(i % 4), f64::from(i / 4), 0.0);
        let positions = std::iter::once(origin).chain((1..16).map(at)).collect();
        let square =
            |&[x, y]: &[u32; 2]| [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| x + a + 4 * (y + b));
        let faces: Vec<[u32; 4]> = squares.iter().map(square).collect();
        PolygonMesh::from_faces(positions, &faces).unwrap()
    }

    fn found(mesh: &PolygonMesh) -> Option<f64> {
        let surface = Surface::new(mesh, &Progress::none()).unwrap().unwrap();
        border_irregular_pct(&surface)
    }

    #[test]
    fn borders_are_regular_where_each_right_angle_has_its_face() {
        let square = [[0, 0], [1, 0], [0, 1], [1, 1]];
        assert_eq!(found(&plate(&square, DVec3::ZERO)), Some(0.0));
        assert_eq!(found(&plate(&square[..3], DVec3::ZERO)), Some(0.0), "an L");
        let flat = found(&plate(&square, DVec3::new(0.5, 0.5, 0.0)));
        assert_eq!(
            flat,
            Some(12.5),
            "one face of the eight vertices' has two right angles"
        );
        assert_eq!(
            found(&crate::shapes::polygons(&crate::shapes::sphere(3))),
            None
        );
    }
}
