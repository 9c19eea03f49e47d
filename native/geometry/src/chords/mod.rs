//! Fewer quads: chords are taken out of a quad mesh, one after the other.
//!
//! A chord runs from a quad through opposite edges until it comes back or ends at borders; the edges that
//! it crosses are its rungs. Its quads become edges when each rung shrinks to a point (poly-chord
//! collapse: Daniels, Silva, Shepherd & Cohen 2008). What is left are quads alone, with the loops that
//! were there before. Lines, such as sharp edges and borders, stay lines, and their corners stay where
//! they are. Not done here: laying the quads on a surface, and closed quads that flow (`flow`).

mod chord;
mod leaving;
mod mesh;
#[cfg(test)]
mod tests;

use std::ops::RangeInclusive;

use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use chord::Chord;
pub use chord::normals;
pub use leaving::{Leaving, end, next, valences};
use mesh::State;

/// What stays of quads that get fewer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rules<'a> {
    /// Edges along lines, smaller end first; border edges are lines anyway.
    pub lines: &'a [[VertexId; 2]],
    /// The image of each vertex, where the quads are their own image and shall stay so.
    pub images: Option<&'a [VertexId]>,
}

/// Fewer quads.
#[derive(Clone, PartialEq, Debug)]
pub struct Fewer {
    /// They, each vertex in the middle of the vertices that became it: of its corner, of those on
    /// lines, or of all, in this order.
    pub quads: PolygonMesh,
    /// The edges along lines that are left, without those of borders, smaller end first, in order.
    pub lines: Vec<[VertexId; 2]>,
    /// The new vertex that each vertex became.
    pub vertex_of: Vec<VertexId>,
    /// The image of each vertex, where there were images.
    pub images: Option<Vec<VertexId>>,
}

/// Takes chords out until there are no more quads than the range has, and no fewer where that can be:
/// always the chord whose rungs are shortest and turn least, of those that leave the topology, the
/// lines and the shape of quads as they are.
///
/// None where faces are not quads, two at an edge at most, or where no chord is left before that.
/// O(n) for each chord that is tried; often the first one tried goes.
///
/// # Errors
/// When cancelled.
pub fn fewer(
    quads: &PolygonMesh,
    rules: Rules<'_>,
    counts: RangeInclusive<usize>,
    progress: &Progress,
) -> Result<Option<Fewer>, Cancelled> {
    let Some(mut state) = State::new(quads, rules) else {
        return Ok(None);
    };
    let n_first = state.quads.len();
    while state.quads.len() > *counts.end() {
        let done = (n_first - state.quads.len()) as f64 / (n_first - counts.end()) as f64;
        progress.at(done)?;
        let chords = Chord::all(&state);
        let leaves_enough = |chord: &&Chord| state.quads.len() - chord.n_quads >= *counts.start();
        let (first, last): (Vec<_>, Vec<_>) = chords.iter().partition(leaves_enough);
        let mut ordered = first.into_iter().chain(last);
        let Some(next) = ordered.find_map(|chord| chord.collapsed(&state)) else {
            return Ok(None);
        };
        state = next;
    }
    Ok(Some(state.fewer(quads.positions())))
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn ids(edge: [u32; 2]) -> [VertexId; 2] {
    edge.map(|v| VertexId::from_index(v as usize))
}
