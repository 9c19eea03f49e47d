//! Sharp lines of the input and of the output, compared.

use glam::DVec3;
use rayon::prelude::*;

use super::statistics::harmonic;
use super::surface::Surface;
use crate::groups::Groups;
use crate::measure::angle_between;
use crate::mesh::{FaceId, Id, bounds};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// What is sharp on the input, in degrees between normals.
const SHARP_INPUT: f64 = 40.0;
/// What is sharp on the output; less, because larger faces cut corners.
const SHARP_OUTPUT: f64 = 30.0;
/// Shorter lines are noise, in diagonals.
const SHORTEST_LINE: f64 = 0.1;
/// With shorter lines in all, or with a smaller share of all sharp edges on lines, the input has
/// no clear ones: noise and folds of skin make short, scattered lines.
const LEAST_TOTAL: f64 = 2.0;
const LEAST_SHARE: f64 = 0.75;
/// How far apart a found line may be, in diagonals.
const TOLERANCE: f64 = 0.005;
/// Between two samples of a line, in diagonals.
const SPACING: f64 = 0.001;
/// Faces between two looks at the progress.
const CHUNK: usize = 2048;
/// Lines have some so many samples at most, or those of an output in other units would fill the memory.
const MOST_SAMPLES: f64 = 1e6;

/// How much of the sharp lines of the one mesh is near those of the other.
#[derive(Clone, Copy)]
pub struct Found {
    /// The share of the output's lines.
    pub precision: f64,
    /// The share of the input's lines.
    pub recall: f64,
}

impl Found {
    pub fn f1_pct(&self) -> f64 {
        100.0 * harmonic(self.precision, self.recall)
    }
}

/// Compares sharp lines; none where the input has no clear ones.
pub fn found(
    input: &Surface,
    output: &Surface,
    progress: &Progress,
) -> Result<Option<Found>, Cancelled> {
    let diagonal = input.diagonal();
    let wanted = SharpLines::find(input, SHARP_INPUT, SHORTEST_LINE * diagonal, progress)?;
    let is_clear = wanted.length >= LEAST_TOTAL * diagonal
        && wanted.length >= LEAST_SHARE * wanted.length_of_all.max(1e-300);
    if !is_clear {
        return Ok(None);
    }
    let found = SharpLines::find(output, SHARP_OUTPUT, 0.0, progress)?;
    let [wanted, found] = [&wanted, &found].map(|lines| lines.samples(SPACING * diagonal));
    if found.is_empty() {
        let [precision, recall] = [0.0; 2];
        return Ok(Some(Found { precision, recall }));
    }
    let tolerance = TOLERANCE * diagonal;
    Ok(Some(Found {
        precision: share_near(&found, &wanted, tolerance, progress)?,
        recall: share_near(&wanted, &found, tolerance, progress)?,
    }))
}

/// The share of points that have another point within the tolerance.
fn share_near(
    points: &[DVec3],
    others: &[DVec3],
    tolerance: f64,
    progress: &Progress,
) -> Result<f64, Cancelled> {
    let tree = Bvh::build_of_points(others, progress)?;
    let [low, high] = bounds(others);
    // Of points as far away as other units make them the tree, in single precision, rules out nothing.
    let may_be_near = |p: DVec3| p.clamp(low, high).distance(p) <= tolerance;
    let mut n_near = 0;
    for &p in points {
        progress.check()?;
        let is_near = |p| {
            tree.closest_where(p, tolerance * tolerance, |_| true)
                .is_some()
        };
        n_near += usize::from(may_be_near(p) && is_near(p));
    }
    Ok(n_near as f64 / points.len() as f64)
}

struct SharpLines {
    segments: Vec<[DVec3; 2]>,
    length: f64,
    /// The length of all sharp edges, on lines or not.
    length_of_all: f64,
}

impl SharpLines {
    /// Edges with a larger angle between their faces, in connected lines no shorter than asked.
    fn find(
        surface: &Surface,
        degrees: f64,
        shortest: f64,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let edges = sharp_edges(surface, degrees, progress)?;
        let mut groups = Groups::new(surface.mesh.n_vertices());
        for &edge in &edges {
            let [a, b] = surface.edges.ends[edge];
            groups.link(a.index(), b.index());
        }
        let (line, n) = groups.numbered();
        let line_of = |edge: usize| line[surface.edges.ends[edge][0].index()] as usize;
        let mut totals = vec![0.0; n];
        for &edge in &edges {
            totals[line_of(edge)] += surface.edge_lengths[edge];
        }
        let length_of = |edges: &[usize]| edges.iter().map(|&e| surface.edge_lengths[e]).sum();
        let length_of_all = length_of(&edges);
        let kept: Vec<usize> = edges
            .into_iter()
            .filter(|&edge| totals[line_of(edge)] >= shortest)
            .collect();
        let segment = |&e: &usize| surface.edges.ends[e].map(|v| surface.mesh.position(v));
        let segments = kept.iter().map(segment).collect();
        Ok(Self {
            segments,
            length: length_of(&kept),
            length_of_all,
        })
    }

    fn samples(&self, spacing: f64) -> Vec<DVec3> {
        let spacing = spacing.max(self.length / MOST_SAMPLES);
        let along = |&[a, b]: &[DVec3; 2]| {
            let n = (a.distance(b) / spacing).ceil() as usize;
            (0..n).map(move |i| a.lerp(b, (i as f64 + 0.5) / n as f64))
        };
        self.segments.iter().flat_map(along).collect()
    }
}

/// Edges of two faces whose normals differ by more, in order.
fn sharp_edges(
    surface: &Surface,
    degrees: f64,
    progress: &Progress,
) -> Result<Vec<usize>, Cancelled> {
    let edges = &surface.edges;
    let faces: Vec<FaceId> = surface.mesh.face_ids().collect();
    let of_chunk = |chunk: &[FaceId]| {
        progress.check()?;
        let normals = chunk.iter().map(|&face| newell_normal(surface, face));
        Ok(normals.collect())
    };
    let normals = faces.par_chunks(CHUNK).map(of_chunk);
    let normals: Vec<Vec<DVec3>> = normals.collect::<Result<_, Cancelled>>()?;
    let normals = normals.concat();
    let mut is_sharp = vec![false; edges.len()];
    for corner in 0..edges.n_corners() {
        progress.check()?;
        if let Some(twin) = edges.twin(corner).filter(|&twin| twin > corner) {
            let [a, b] = [corner, twin].map(|c| normals[edges.face_of[c] as usize]);
            let angle = angle_between(a, b).to_degrees();
            is_sharp[edges.of_corner[corner] as usize] = angle > degrees;
        }
    }
    Ok((0..edges.len()).filter(|&edge| is_sharp[edge]).collect())
}

/// The unit normal of a polygon that need not be flat.
fn newell_normal(surface: &Surface, face: FaceId) -> DVec3 {
    let corners = surface.mesh.face(face);
    let first = surface.mesh.position(corners[0]);
    let at = |i: usize| surface.mesh.position(corners[i]) - first;
    let sum: DVec3 = (1..corners.len() - 1).map(|i| at(i).cross(at(i + 1))).sum();
    sum.normalize_or_zero()
}
