//! Edges of the input, found again on edges of the result.

use std::collections::HashSet;

use glam::DVec3;
use serde::Serialize;

use super::frame::Frame;
use super::join::Joined;
use super::marks;
use super::mirror::Plane;
use super::{CarriedEdge, Input};
use crate::mirror::mirrored;
use crate::progress::{Cancelled, Progress};
use crate::transfer;

/// What became of the edges that were to be carried.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct CarriedReport {
    /// How many edges of the result lie on them.
    pub n_edges: usize,
    /// The length of these, in percent of that of the edges that were to be carried.
    pub length_pct: f64,
}

/// The edges that were found, and how long they and those to be carried are, in the frame of work.
#[derive(Default)]
pub struct Found {
    pub edges: Vec<CarriedEdge>,
    lengths: [f64; 2],
}

impl Found {
    /// What is told of it, with so many edges more, of such a length, that stayed as they were.
    pub fn report(&self, n_stayed: usize, stayed: f64) -> CarriedReport {
        let [new, old] = self.lengths;
        let share = (new + stayed) / (old + stayed);
        CarriedReport {
            n_edges: self.edges.len() + n_stayed,
            length_pct: if share.is_finite() {
                100.0 * share
            } else {
                0.0
            },
        }
    }
}

/// Finds those of some edges to be carried among the edges of the result that lie along lines.
///
/// Where a mesh is made symmetric, those of its positive side count, and their images.
pub fn carried(
    (input, which): (&Input<'_>, &[usize]),
    (frame, plane): (&Frame, Option<Plane>),
    joined: &Joined,
    progress: &Progress<'_>,
) -> Result<Found, Cancelled> {
    if which.is_empty() {
        return Ok(Found::default());
    }
    let ends = which.iter().flat_map(|&i| input.carried[i]);
    let ends: Vec<DVec3> = ends.map(|v| input.mesh.position(v)).collect();
    let old = frame.enter(&ends);
    let mut old: Vec<_> = old.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect();
    let mut names: Vec<usize> = which.to_vec();
    if let Some(plane) = plane.filter(|plane| !plane.was_symmetric) {
        let (of, both) = symmetric(&old, plane.axis);
        names = of.into_iter().map(|i| names[i]).collect();
        old = both;
    }
    let mut edges = transfer::edges(&old, &joined.mesh, &joined.features, progress)?;
    let new = edges
        .iter()
        .map(|c| c.ends.map(|v| joined.mesh.position(v)));
    let lengths = [new.map(length).sum(), length_of_places(&old)];
    for carried in &mut edges {
        carried.from = names[carried.from];
    }
    Ok(Found { edges, lengths })
}

fn length([a, b]: [DVec3; 2]) -> f64 {
    a.distance(b)
}

/// The length of edges; where a seam is split, two lie at one place, which counts once.
fn length_of_places(edges: &[[DVec3; 2]]) -> f64 {
    let mut seen = HashSet::new();
    let is_new = |&&[a, b]: &&[DVec3; 2]| seen.insert(marks::key(a, b));
    edges.iter().filter(is_new).copied().map(length).sum()
}

/// The edges of the positive side and their images, and which of the edges each comes from.
fn symmetric(old: &[[DVec3; 2]], axis: usize) -> (Vec<usize>, Vec<[DVec3; 2]>) {
    let kept = old.iter().enumerate();
    let kept = kept.filter(|(_, ends)| ends[0].midpoint(ends[1])[axis] >= 0.0);
    let both = kept.flat_map(|(name, &ends)| {
        let image = ends.map(|p| mirrored(p, axis));
        [(name, ends), (name, image)]
    });
    both.unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_edges_of_a_split_seam_count_once() {
        let seam = [DVec3::ZERO, DVec3::new(3.0, 4.0, -0.0)];
        let other = [DVec3::Z, DVec3::X];
        let turned = [DVec3::new(3.0, 4.0, 0.0), DVec3::ZERO];
        let found = length_of_places(&[seam, other, turned]);
        assert!((found - 5.0 - 2f64.sqrt()).abs() < 1e-12, "{found}");
    }
}
