//! Straddling: faces cut through the surface instead of lying inside of it where it bulges.
//!
//! With its vertices on the surface, a mesh lies on one side of whatever is curved. Least squares
//! moves the vertices until samples of the faces lie on the tangent planes of their closest points:
//! minimise Σ (m · (Σᵢ wᵢ uᵢ − (c − x)))² + Σ a uᵢ², with x a sample of weights w, c its closest
//! point on the target, m the normal there and uᵢ the step of vertex i. About halves the distance;
//! steps along the surface draw edges to the ridges that they cross.

use glam::{DMat3, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::project::lift_towards;
use super::sheet::Sheet;
use super::target::Target;
use crate::mesh::{Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Quality that a step may not spoil unless the face is worse already.
const GUARDED_QUALITY: f64 = 0.35;
/// Sweeps of the block Gauss-Seidel solver. Samples couple neighbours so weakly that this is as good
/// as a factorisation, which takes ten times as long.
const N_SWEEPS: usize = 6;
/// How many samples a triangle has.
const N_SAMPLES: usize = 6;
/// Where: near the corners and in the middle of the sides.
const SAMPLES: [[f64; 3]; N_SAMPLES] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// How strongly vertices are held while faces are fitted, relative to the samples' pull.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Anchor {
    /// Along the normal: at 0 single vertices jump where samples say little.
    pub across: f64,
    /// Along the surface: below 0.02 faces become slivers, above 0.3 ridges are missed.
    pub along: f64,
}

impl Default for Anchor {
    fn default() -> Self {
        Self {
            across: 0.1,
            along: 0.06,
        }
    }
}

/// A triangle's samples: the normals at their closest points and the distances to those planes,
/// both weighted by how well the triangle agrees with the normal. Samples without a closest point
/// weigh nothing. Single precision is enough for directions, and there are many.
struct Samples {
    corners: [VertexId; 3],
    normals: [[f32; 3]; N_SAMPLES],
    gaps: [f64; N_SAMPLES],
}

/// Moves vertices to the least squares fit.
///
/// Pinned vertices stay, and none goes farther than half of `reach` or so that a face is spoiled.
pub(super) fn straddle(
    sheet: &mut Sheet,
    target: &Target,
    (reach, anchor): (f64, Anchor),
    progress: &Progress,
) -> Result<(), Cancelled> {
    let triangles = triangles(sheet);
    let samples = triangles.par_iter().map(|&corners| {
        progress.check()?;
        Ok(sample(sheet, target, corners, reach))
    });
    let samples = samples.collect::<Result<Vec<_>, Cancelled>>()?;
    let steps = solve(sheet, &samples, anchor, progress)?;
    for v in sheet.vertex_ids() {
        let wanted = sheet.position(v) + steps[v].clamp_length_max(reach / 2.0);
        lift_towards(sheet, v, wanted, GUARDED_QUALITY);
    }
    Ok(())
}

/// The faces cut into triangles, quads along the shorter diagonal.
pub(super) fn triangles(sheet: &Sheet) -> Vec<[VertexId; 3]> {
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

fn sample(sheet: &Sheet, target: &Target, corners: [VertexId; 3], reach: f64) -> Samples {
    let [a, b, c] = corners.map(|v| sheet.position(v));
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let mut samples = Samples {
        corners,
        normals: [[0.0; 3]; N_SAMPLES],
        gaps: [0.0; N_SAMPLES],
    };
    for (k, [u, v, w]) in SAMPLES.into_iter().enumerate() {
        let x = a * u + b * v + c * w;
        if let Some(foot) = target.closest_agreeing(x, normal, reach) {
            let plane = target.normal(foot.face);
            // Where the face does not follow the surface, as over a tip, the plane says little.
            let plane_weight = normal.dot(plane);
            samples.normals[k] = (plane * plane_weight).as_vec3().to_array();
            samples.gaps[k] = plane_weight * plane.dot(foot.position - x);
        }
    }
    samples
}

/// The steps of all vertices, by block Gauss-Seidel.
fn solve(
    sheet: &Sheet,
    samples: &[Samples],
    anchor: Anchor,
    progress: &Progress,
) -> Result<VertexMap<DVec3>, Cancelled> {
    let fans = Fans::new(samples, sheet.n_vertices());
    let mut steps = VertexMap::filled(sheet.n_vertices(), DVec3::ZERO);
    for _ in 0..N_SWEEPS {
        for v in sheet.vertex_ids().filter(|&v| !sheet.is_pinned(v)) {
            if v.0 % 4096 == 0 {
                progress.check()?;
            }
            let mut fit = Fit::held(anchor, sheet.point(v).normal, fans.of(v).len());
            for &(triangle, corner) in fans.of(v) {
                fit.add(&samples[triangle as usize], corner as usize, &steps);
            }
            let step = fit.matrix.inverse() * fit.pull;
            if step.is_finite() {
                steps[v] = step;
            }
        }
    }
    Ok(steps)
}

/// The normal equations of one vertex's step.
struct Fit {
    matrix: DMat3,
    pull: DVec3,
}

impl Fit {
    /// Anchors alone, for a vertex of so many triangles.
    fn held(anchor: Anchor, normal: DVec3, n_triangles: usize) -> Self {
        let n = n_triangles.max(1) as f64;
        let along = DMat3::from_diagonal(DVec3::splat(anchor.along * n));
        let across = outer(normal, (anchor.across - anchor.along) * n);
        Self {
            matrix: along + across,
            pull: DVec3::ZERO,
        }
    }

    /// Adds the samples of a triangle that has the vertex at a corner, its other corners staying.
    fn add(&mut self, samples: &Samples, corner: usize, steps: &VertexMap<DVec3>) {
        let [next, before] = [(corner + 1) % 3, (corner + 2) % 3];
        let [ahead, behind] = [next, before].map(|i| steps[samples.corners[i]]);
        for (k, weights) in SAMPLES.iter().enumerate() {
            let normal = DVec3::from_array(samples.normals[k].map(f64::from));
            let others = ahead * weights[next] + behind * weights[before];
            let gap = samples.gaps[k] - normal.dot(others);
            self.matrix += outer(normal, weights[corner] * weights[corner]);
            self.pull += normal * (weights[corner] * gap);
        }
    }
}

/// The matrix weight · n nᵀ.
fn outer(n: DVec3, weight: f64) -> DMat3 {
    let n = [n, n * weight];
    DMat3::from_cols(n[1] * n[0].x, n[1] * n[0].y, n[1] * n[0].z)
}

/// The triangles at each vertex, and which corner of them it is.
struct Fans {
    starts: Vec<u32>,
    corners: Vec<(u32, u8)>,
}

impl Fans {
    fn new(samples: &[Samples], n_vertices: usize) -> Self {
        let mut starts = vec![0; n_vertices + 1];
        for v in samples.iter().flat_map(|s| s.corners) {
            starts[v.index() + 1] += 1;
        }
        for v in 0..n_vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut corners = vec![(0, 0); 3 * samples.len()];
        for (triangle, s) in (0..).zip(samples) {
            for (corner, v) in (0..).zip(s.corners) {
                corners[next[v.index()] as usize] = (triangle, corner);
                next[v.index()] += 1;
            }
        }
        Self { starts, corners }
    }

    fn of(&self, v: VertexId) -> &[(u32, u8)] {
        let [from, to] = [self.starts[v.index()], self.starts[v.index() + 1]];
        &self.corners[from as usize..to as usize]
    }
}
