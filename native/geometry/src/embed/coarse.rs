//! A proposal for a coarse level of the hierarchy: mended and relaxed there, where few vertices are,
//! then grown by a solver in a hurry.

use super::growth::{GrowError, Growth};
use super::partial::Partial;
use super::proposal::{ProposalReport, unit_vectors};
use super::rest::Stiffness;
use super::times::{Times, timed};
use super::{Error, PredictError, Proposal, Solver, Valid};
use crate::hierarchy::CollapseHierarchy;
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// The share of the level that a repair may take out. With more the level stays in a bad minimum,
/// and starting from the tetrahedron takes no longer than leading it out: maps from proposals of
/// which a fifth was moved were up to a tenth worse.
const MAX_MOVED: f64 = 0.125;

/// A valid map of the finest mesh, and what was proposed for the coarse level.
pub fn grown(
    hierarchy: &CollapseHierarchy,
    proposed: &Proposal,
    times: &mut Times,
    progress: &Progress,
) -> Result<(Valid, ProposalReport), Error> {
    let order = hierarchy.coarse_to_fine();
    let order = &order[..proposed.n_proposed.max(4)];
    let mesh = level(hierarchy, order)?;
    let given = unit_vectors(proposed, hierarchy.n_vertices());
    let sphere: VertexMap<_> = order.iter().map(|&v| given[v]).collect();
    let report = ProposalReport::new(&mesh, &sphere, proposed.n_relaxations, progress)?;
    let mut valid = Valid::new(sphere, proposed.n_relaxations);
    let mending = progress.part("", 0.0, 0.1);
    let most = MAX_MOVED * order.len() as f64;
    let mend = || {
        let is_mended = report.is_valid() || valid.mend(&mesh, report.n_folds, &mending)?;
        Ok::<_, Cancelled>(is_mended && valid.report.n_moved as f64 <= most)
    };
    let is_usable = timed(&mut times.repair_ms, mend)?;
    let growing = progress.part("", 0.1, 1.0);
    let mut grow = || grow(&mut valid, order, hierarchy, &growing);
    if !is_usable || !timed(&mut times.relax_ms, &mut grow)? {
        let fall_back = || valid.fall_back(hierarchy, Solver::BRISK, &growing);
        timed(&mut times.repair_ms, fall_back)?;
    }
    Ok((valid, report))
}

/// The mesh of the coarsest vertices.
fn level(hierarchy: &CollapseHierarchy, order: &[VertexId]) -> Result<TriangleMesh, Error> {
    let mut rank = VertexMap::filled(hierarchy.n_vertices(), VertexId(0));
    for (i, &v) in order.iter().enumerate() {
        rank[v] = VertexId::from_index(i);
    }
    let contradictory = |reason: String| Error::Predict(PredictError::Failed { reason });
    let faces = hierarchy.faces_at(order.len());
    let faces = faces.map_err(|error| contradictory(error.to_string()))?;
    let faces = faces.iter().map(|face| face.map(|v| rank[v])).collect();
    let positions = order.iter().map(|&v| hierarchy.mesh().position(v));
    TriangleMesh::new(positions.collect(), faces).map_err(|error| contradictory(error.to_string()))
}

/// Grows the valid map of a level to one of the finest mesh; false when there is no room.
fn grow(
    valid: &mut Valid,
    order: &[VertexId],
    hierarchy: &CollapseHierarchy,
    progress: &Progress,
) -> Result<bool, Cancelled> {
    let mut partial = Partial::tetrahedron(hierarchy);
    let (base, others) = valid.sphere.as_slice().split_at(4);
    for (&v, &point) in order.iter().zip(base) {
        partial.sphere[v] = point;
    }
    for (collapse, &point) in hierarchy.undone().zip(others) {
        partial.insert(collapse, point);
    }
    let mut growth = Growth::new(partial, hierarchy.mesh(), Stiffness::Shape, progress)?;
    let solver = Solver::BRISK;
    growth.sweeps(solver.limits(order.len()), progress)?;
    let grown = solver.grow(hierarchy, &mut growth, progress);
    valid.n_relaxations += growth.n_relaxations;
    match grown {
        Err(GrowError::Cancelled(cancelled)) => Err(cancelled),
        Err(GrowError::NoRoom { .. }) => Ok(false),
        Ok(()) => {
            valid.sphere = growth.partial.sphere;
            Ok(true)
        }
    }
}
