//! Edges of the input, found again on edges of the result.

use glam::DVec3;
use serde::Serialize;

use super::frame::Frame;
use super::join::Joined;
use super::mirror::Plane;
use super::{CarriedEdge, Input};
use crate::mirror::mirrored;
use crate::progress::{Cancelled, Progress};
use crate::transfer;

/// What became of the edges that were to be carried.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct CarriedReport {
    /// How many edges of the result lie on them.
    pub n_edges: usize,
    /// The length of these, in percent of that of the edges that were to be carried.
    pub length_pct: f64,
}

/// Finds the edges to be carried among the edges of the result that lie along lines.
///
/// Where a mesh is made symmetric, those of its positive side count, and their images.
pub fn carried(
    input: &Input<'_>,
    (frame, plane): (&Frame, Option<Plane>),
    joined: &Joined,
    progress: &Progress<'_>,
) -> Result<(Vec<CarriedEdge>, Option<CarriedReport>), Cancelled> {
    if input.carried.is_empty() {
        return Ok((Vec::new(), None));
    }
    let ends = input.carried.iter().flatten();
    let ends: Vec<DVec3> = ends.map(|&v| input.mesh.position(v)).collect();
    let old = frame.enter(&ends);
    let mut old: Vec<_> = old.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect();
    let mut names: Vec<usize> = (0..old.len()).collect();
    if let Some(plane) = plane.filter(|plane| !plane.was_symmetric) {
        (names, old) = symmetric(&old, plane.axis);
    }
    let mut found = transfer::edges(&old, &joined.mesh, &joined.features, progress)?;
    let length = |[a, b]: [DVec3; 2]| a.distance(b);
    let new = found
        .iter()
        .map(|c| c.ends.map(|v| joined.mesh.position(v)));
    let share = new.map(length).sum::<f64>() / old.iter().copied().map(length).sum::<f64>();
    for carried in &mut found {
        carried.from = names[carried.from];
    }
    let report = CarriedReport {
        n_edges: found.len(),
        length_pct: if share.is_finite() {
            100.0 * share
        } else {
            0.0
        },
    };
    Ok((found, Some(report)))
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
