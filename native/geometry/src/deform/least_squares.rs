//! The least squares problem of a fit, solved vertex by vertex.

use glam::{DMat3, DVec3};

use super::Anchor;
use super::sheet::Sheet;
use super::springs::Springs;
use super::squares::Squares;
use crate::mesh::{Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Sweeps of the block Gauss-Seidel solver. Samples couple neighbours so weakly that this is as good
/// as a factorisation, which takes ten times as long.
const N_SWEEPS: usize = 6;
/// With springs, which couple neighbours strongly: fewer leave lengths uneven over long ways.
const N_SPRING_SWEEPS: usize = 20;
/// How much a vertex that is too far off the surface is called back, for each of its triangles, where
/// a sample weighs 1: at 1 quads of thin fingers get worse, at 0.5 spikes are left in creases.
const CALLED_BACK: f64 = 0.75;
/// How many samples a triangle has.
pub(super) const N_SAMPLES: usize = 6;
/// Where: near the corners and in the middle of the sides.
pub(super) const SAMPLES: [[f64; 3]; N_SAMPLES] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// A triangle's samples: the normals at their closest points and the distances to those planes,
/// both weighted by how well the triangle agrees with the normal. Samples without a closest point
/// weigh nothing. Single precision is enough for directions, and there are many.
pub(super) struct Samples {
    pub corners: [VertexId; 3],
    pub normals: [[f32; 3]; N_SAMPLES],
    pub gaps: [f64; N_SAMPLES],
}

/// A call of a site of the surface upon its closest triangle: the weights of its corners there, the
/// way to the site and how far it is, both times the root of the call's weight.
#[derive(Clone, Copy)]
pub(super) struct Call {
    pub triangle: u32,
    pub weights: [f64; 3],
    pub way: DVec3,
    pub gap: f64,
}

/// What a vertex wishes.
#[derive(Clone, Copy, Default)]
pub(super) struct Wish {
    /// Where it wants to go along the surface, and how much.
    pub step: DVec3,
    pub weight: f64,
    /// The way back towards the surface, where it is too far off.
    pub back: DVec3,
}

/// All that pulls and holds.
pub(super) struct Problem<'a> {
    pub samples: &'a [Samples],
    /// Sorted by triangle.
    pub calls: &'a [Call],
    pub wishes: &'a VertexMap<Wish>,
    pub anchor: Anchor,
    /// Where edges wish to be equally long.
    pub even: Option<&'a (Springs, Squares)>,
}

impl Problem<'_> {
    /// The steps of all vertices that are not pinned, by block Gauss-Seidel.
    pub fn solve(&self, sheet: &Sheet, progress: &Progress) -> Result<VertexMap<DVec3>, Cancelled> {
        let fans = Fans::new(self.samples, sheet.n_vertices());
        let triangles = self.calls.iter().map(|call| call.triangle as usize);
        let calls = starts(triangles, self.samples.len());
        let mut steps = VertexMap::filled(sheet.n_vertices(), DVec3::ZERO);
        let n_sweeps = self.even.map_or(N_SWEEPS, |_| N_SPRING_SWEEPS);
        for _ in 0..n_sweeps {
            for v in sheet.vertex_ids().filter(|&v| !sheet.is_pinned(v)) {
                if v.0 % 4096 == 0 {
                    progress.check()?;
                }
                let mut fit = self.held(v, sheet.point(v).normal, fans.of(v).len());
                for &(triangle, corner) in fans.of(v) {
                    let triangle = triangle as usize;
                    let samples = &self.samples[triangle];
                    let others = others(samples.corners, corner as usize, &steps);
                    fit.add(samples, corner as usize, others);
                    let [from, to] = [calls[triangle], calls[triangle + 1]];
                    for call in &self.calls[from as usize..to as usize] {
                        fit.answer(call, corner as usize, others);
                    }
                }
                if let Some((springs, squares)) = self.even {
                    for (way, gap, weight) in springs.at(sheet, v, &steps) {
                        fit.matrix += outer(way, weight);
                        fit.pull += way * (weight * gap);
                    }
                    for (step, weight) in squares.at(sheet, v, &steps) {
                        fit.pull_along(sheet.point(v).normal, step, weight);
                    }
                }
                let step = fit.matrix.inverse() * fit.pull;
                if step.is_finite() {
                    steps[v] = step;
                }
            }
        }
        Ok(steps)
    }

    /// The anchor and the wishes of a vertex of so many triangles.
    fn held(&self, v: VertexId, normal: DVec3, n_triangles: usize) -> Fit {
        let n = n_triangles.max(1) as f64;
        let Anchor { across, along } = self.anchor;
        let wish = self.wishes[v];
        let matrix = DMat3::from_diagonal(DVec3::splat(along * n + wish.weight));
        Fit {
            matrix: matrix
                + outer(normal, (across - along) * n - wish.weight)
                + outer(wish.back.normalize_or_zero(), CALLED_BACK * n),
            pull: wish.step * wish.weight + wish.back * (CALLED_BACK * n),
        }
    }
}

/// The steps of the next and the last corner of a triangle.
fn others(corners: [VertexId; 3], corner: usize, steps: &VertexMap<DVec3>) -> [DVec3; 2] {
    [1, 2].map(|i| steps[corners[(corner + i) % 3]])
}

/// The normal equations of one vertex's step.
struct Fit {
    matrix: DMat3,
    pull: DVec3,
}

impl Fit {
    /// Adds the samples of a triangle that has the vertex at a corner, its other corners staying.
    fn add(&mut self, samples: &Samples, corner: usize, [ahead, behind]: [DVec3; 2]) {
        let [next, before] = [(corner + 1) % 3, (corner + 2) % 3];
        for (k, weights) in SAMPLES.iter().enumerate() {
            let normal = DVec3::from_array(samples.normals[k].map(f64::from));
            let others = ahead * weights[next] + behind * weights[before];
            let gap = samples.gaps[k] - normal.dot(others);
            self.matrix += outer(normal, weights[corner] * weights[corner]);
            self.pull += normal * (weights[corner] * gap);
        }
    }

    /// Adds a wish for a step along the surface.
    fn pull_along(&mut self, normal: DVec3, step: DVec3, weight: f64) {
        self.matrix += DMat3::from_diagonal(DVec3::splat(weight)) - outer(normal, weight);
        self.pull += (step - normal * normal.dot(step)) * weight;
    }

    /// Adds a site's call.
    fn answer(&mut self, call: &Call, corner: usize, [ahead, behind]: [DVec3; 2]) {
        let weight = call.weights[corner];
        let others =
            ahead * call.weights[(corner + 1) % 3] + behind * call.weights[(corner + 2) % 3];
        self.matrix += outer(call.way, weight * weight);
        self.pull += call.way * (weight * (call.gap - call.way.dot(others)));
    }
}

/// The matrix weight · n nᵀ.
fn outer(n: DVec3, weight: f64) -> DMat3 {
    let n = [n, n * weight];
    DMat3::from_cols(n[1] * n[0].x, n[1] * n[0].y, n[1] * n[0].z)
}

/// Where the things of each of `n` owners begin, sorted by their owners, and where the last end.
fn starts(owners: impl Iterator<Item = usize>, n: usize) -> Vec<u32> {
    let mut starts = vec![0; n + 1];
    for owner in owners {
        starts[owner + 1] += 1;
    }
    for i in 0..n {
        starts[i + 1] += starts[i];
    }
    starts
}

/// The triangles at each vertex, and which corner of them it is.
struct Fans {
    starts: Vec<u32>,
    corners: Vec<(u32, u8)>,
}

impl Fans {
    fn new(samples: &[Samples], n_vertices: usize) -> Self {
        let owners = samples.iter().flat_map(|s| s.corners).map(Id::index);
        let starts = starts(owners, n_vertices);
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
