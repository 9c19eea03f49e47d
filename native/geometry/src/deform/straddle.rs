//! Straddling: faces cut through the surface instead of lying inside of it where it bulges.
//!
//! With its vertices on the surface, a mesh lies on one side of whatever is curved. Least squares
//! moves the vertices along their normals until samples of the faces are on average on the surface:
//! minimise Σ |Σᵢ wᵢ hᵢ nᵢ − (c − x)|² + a Σ hᵢ², with x a sample of weights w, c its closest
//! point on the target, hᵢ the height and nᵢ the normal of vertex i. About halves the distance.

use glam::DVec3;
use rayon::prelude::*;

use super::project::lift_towards;
use super::sheet::Sheet;
use super::target::Target;
use crate::mesh::{Id, VertexId, VertexMap};
use crate::sparse::{NotPositiveDefinite, SymmetricMatrix};

/// Quality that a lift may not spoil unless the face is worse already.
const GUARDED_QUALITY: f64 = 0.35;
/// Where a triangle is sampled: three points near the corners, one in the middle of each side.
const SAMPLES: [[f64; 3]; 6] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// A sample of a face and the way from it to the target.
struct Sample {
    corners: [VertexId; 3],
    weights: [f64; 3],
    offset: DVec3,
}

/// Lifts vertices along their normals to the least squares fit; `anchor` holds them back.
///
/// Anchors are relative to the weight of an average vertex: at 0 single vertices jump where the
/// samples say little, at 1 half of the gain is lost. Pinned vertices stay, and
/// none is lifted farther than `reach` or so that a face is spoiled.
pub(super) fn straddle(
    sheet: &mut Sheet,
    target: &Target,
    [reach, anchor]: [f64; 2],
) -> Result<(), NotPositiveDefinite> {
    let samples: Vec<Sample> = triangles(sheet)
        .par_iter()
        .flat_map_iter(|&corners| samples(sheet, target, corners, reach))
        .collect();
    let normals = vertex_normals(sheet);
    let heights = heights(&samples, &normals, anchor, |v| sheet.is_pinned(v))?;
    for v in sheet.vertex_ids() {
        let height = heights[v.index()].clamp(-reach, reach);
        let wanted = sheet.position(v) + normals[v] * height;
        lift_towards(sheet, v, wanted, GUARDED_QUALITY);
    }
    Ok(())
}

/// The faces cut into triangles, quads along the shorter diagonal.
fn triangles(sheet: &Sheet) -> Vec<[VertexId; 3]> {
    let mut triangles = Vec::with_capacity(2 * sheet.faces().len());
    for face in sheet.faces() {
        match *face.corners() {
            [a, b, c, d] => {
                let along = |p, q| sheet.position(p).distance_squared(sheet.position(q));
                if along(a, c) <= along(b, d) {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
            ref corners => triangles.push([corners[0], corners[1], corners[2]]),
        }
    }
    triangles
}

/// The samples of one triangle that find the target.
fn samples(
    sheet: &Sheet,
    target: &Target,
    corners: [VertexId; 3],
    reach: f64,
) -> impl Iterator<Item = Sample> + use<> {
    let [a, b, c] = corners.map(|v| sheet.position(v));
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let found = SAMPLES.map(|weights| {
        let [u, v, w] = weights;
        let x = a * u + b * v + c * w;
        let foot = target.closest_agreeing(x, normal, reach)?;
        Some(Sample {
            corners,
            weights,
            offset: foot.position - x,
        })
    });
    found.into_iter().flatten()
}

/// Unit normals of the vertices of the sheet as it lies in space, by area.
fn vertex_normals(sheet: &Sheet) -> VertexMap<DVec3> {
    let mut sums = VertexMap::filled(sheet.n_vertices(), DVec3::ZERO);
    for face in sheet.faces() {
        let corners = face.corners();
        let p = |i: usize| sheet.position(corners[i]);
        let area = match corners.len() {
            3 => (p(1) - p(0)).cross(p(2) - p(0)),
            _ => (p(2) - p(0)).cross(p(3) - p(1)),
        };
        for &v in corners {
            sums[v] += area;
        }
    }
    sums.iter().map(|sum| sum.normalize_or_zero()).collect()
}

fn heights(
    samples: &[Sample],
    normals: &VertexMap<DVec3>,
    anchor: f64,
    is_fixed: impl Fn(VertexId) -> bool,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let n = normals.len();
    let mut matrix = SymmetricMatrix::new(n);
    let mut heights = vec![0.0; n];
    for Sample {
        corners,
        weights,
        offset,
    } in samples
    {
        for i in 0..3 {
            let (v, w) = (corners[i], weights[i]);
            heights[v.index()] += w * normals[v].dot(*offset);
            for j in i..3 {
                let product = normals[v].dot(normals[corners[j]]);
                matrix.add(v.index(), corners[j].index(), w * weights[j] * product);
            }
        }
    }
    let mean_weight = samples.len() as f64 / n as f64;
    for v in normals.ids() {
        // Samples sum to a few units a vertex: a millionfold of that does not move.
        let hold = if is_fixed(v) { 1e6 } else { anchor };
        matrix.add(v.index(), v.index(), hold * mean_weight.max(1.0));
    }
    matrix.factorize()?.solve(&mut heights);
    Ok(heights)
}
