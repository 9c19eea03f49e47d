//! Sharp edges as lines, which the result's edges run along.
//!
//! A line of sharp edges ends where it branches, stops, turns sharply or meets a singularity; a
//! closed line without such a place begins and ends at its first vertex. Those vertices are kept
//! in the flat metric ([`lines`]), singularities close by are moved there ([`attract`]). Between
//! its ends a line is one straight segment along an axis if the result is to have edges on it: a
//! linear equation on the periods ([`rows`]). In the end the segments are walked in the grid
//! ([`seams`]).

mod attract;
mod network;
mod pick;
mod rows;
mod seams;
mod sides;

use crate::flow::field::OrientationField;
use crate::flow::guides::FirmEdges;
use crate::measure::angle_between;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};

pub use attract::attract;
pub use network::Network;
pub use pick::{Line, are_clear, firm_lines, lines, lines_beside, whole_lines};
pub use rows::{Firm, Row, rows, tie_rows, twin_rows};
pub use seams::{goals, seams};

/// A line that turns by more than this at a vertex has a corner there (53°).
pub const CORNER_ANGLE: f64 = 0.927;

/// Edges that lines run along.
#[derive(Clone, Copy)]
pub struct Sharp<'a> {
    /// They, on both sides of each.
    pub edges: &'a HalfedgeMap<bool>,
    /// Those whose corners are known.
    pub firm: Option<&'a FirmEdges>,
}

/// The vertices at which lines of sharp edges branch, stop or turn sharply.
pub fn corners(mesh: &TriangleMesh, sharp: Sharp<'_>) -> VertexMap<bool> {
    mesh.vertex_ids()
        .map(|v| is_corner(mesh, sharp, v))
        .collect()
}

/// All lines of sharp edges, each in one of its two directions.
fn chains(mesh: &TriangleMesh, field: &OrientationField, sharp: Sharp<'_>) -> Vec<Vec<HalfedgeId>> {
    let mut is_end: VertexMap<bool> = corners(mesh, sharp)
        .iter_ids()
        .map(|(v, is_corner)| *is_corner || field.indices[v] != 0)
        .collect();
    let sharp = sharp.edges;
    let mut used = HalfedgeMap::filled(sharp.len(), false);
    let mut lines = Vec::new();
    // First the lines between ends; what is left are closed ones.
    for closed in [false, true] {
        for h in mesh.halfedge_ids().filter(|&h| sharp[h]) {
            if used[h] || (!closed && !is_end[mesh.origin(h)]) {
                continue;
            }
            is_end[mesh.origin(h)] = true;
            let line = follow(mesh, (sharp, &is_end), h);
            for &h in &line {
                used[h] = true;
                if let Some(twin) = mesh.twin(h) {
                    used[twin] = true;
                }
            }
            lines.push(line);
        }
    }
    lines
}

/// The sharp halfedges that leave a vertex.
fn sharp_from(
    mesh: &TriangleMesh,
    sharp: &HalfedgeMap<bool>,
    vertex: VertexId,
) -> impl Iterator<Item = HalfedgeId> {
    mesh.outgoing(vertex).filter(|&h| sharp[h])
}

fn is_corner(mesh: &TriangleMesh, sharp: Sharp<'_>, vertex: VertexId) -> bool {
    let mut leaving = sharp_from(mesh, sharp.edges, vertex);
    let [Some(a), Some(b), None] = [leaving.next(), leaving.next(), leaving.next()] else {
        // No corner either where there is no line at all.
        return sharp_from(mesh, sharp.edges, vertex).next().is_some();
    };
    if let Some(firm) = sharp.firm.filter(|firm| firm.is_on[a] && firm.is_on[b]) {
        return firm.is_corner[vertex];
    }
    let [a, b] = [a, b].map(|h| mesh.position(mesh.target(h)) - mesh.position(vertex));
    angle_between(-a, b) > CORNER_ANGLE
}

/// The line from a halfedge on to the next end.
fn follow(
    mesh: &TriangleMesh,
    (sharp, is_end): (&HalfedgeMap<bool>, &VertexMap<bool>),
    first: HalfedgeId,
) -> Vec<HalfedgeId> {
    let mut line = vec![first];
    let mut at = mesh.target(first);
    let mut from = mesh.origin(first);
    while !is_end[at] {
        let Some(h) = sharp_from(mesh, sharp, at).find(|&h| mesh.target(h) != from) else {
            break;
        };
        line.push(h);
        [from, at] = [at, mesh.target(h)];
    }
    line
}

#[cfg(test)]
mod tests;
