//! From the map's surface onto the full-resolution one.

use glam::DVec3;
use rayon::prelude::*;

use super::sheet::Sheet;
use super::target::Target;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// Shares of the way to the full-resolution surface that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];

/// Lifts every vertex that is not pinned to the closest point of the target that agrees with its normal, no farther
/// than `reach`, and returns how many found none or would have spoiled a face on the whole way.
pub(super) fn project(
    sheet: &mut Sheet,
    target: &Target,
    reach: f64,
    progress: &Progress,
) -> Result<usize, Cancelled> {
    let feet = (0..sheet.n_vertices()).into_par_iter().map(|v| {
        progress.check()?;
        let point = sheet.point(VertexId::from_index(v));
        let found = target.closest_agreeing(point.position, point.normal, reach);
        Ok(found.map(|foot| foot.position))
    });
    let feet = feet.collect::<Result<Vec<_>, Cancelled>>()?;
    let mut n_missed = 0;
    for (v, foot) in sheet.vertex_ids().zip(feet) {
        if sheet.is_pinned(v) {
            continue;
        }
        let reached = foot.is_some_and(|foot| lift_towards(sheet, v, foot, 0.2) == Some(0));
        n_missed += usize::from(!reached);
    }
    Ok(n_missed)
}

/// Lifts a vertex as far towards a position as its faces keep the quality they have, or `enough`.
/// Returns which share of the way it went.
pub(super) fn lift_towards(
    sheet: &mut Sheet,
    vertex: VertexId,
    wanted: DVec3,
    enough: f64,
) -> Option<usize> {
    let now = *sheet.point(vertex);
    let before = sheet.worst_quality(vertex, &now).min(enough);
    let mut there = now;
    let share = SHARES.iter().position(|share| {
        there.position = now.position.lerp(wanted, *share);
        sheet.worst_quality(vertex, &there) >= before
    })?;
    sheet.lift(vertex, there.position);
    Some(share)
}
