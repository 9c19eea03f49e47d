//! Singularities near sharp edges are moved onto them.

use crate::flow::field::OrientationField;
use crate::flow::singularities::{Reach, shift};
use crate::mesh::{FaceMap, TriangleMesh, VertexId, VertexMap};

use super::{Sharp, corners};

/// A corner takes singularities no farther away than this many edges of a quad.
const CORNER_RADIUS: f64 = 1.0;
/// A line takes those no farther away than this. Below, a singularity beside a line is in the way
/// of its edges; above, the shape suffers.
const LINE_RADIUS: f64 = 0.6;

/// Moves singularities beside sharp edges to the nearest corner of these or vertex on them, for
/// quads of the wanted sizes.
///
/// Where the result would not be between −2 and 1 they stay. Turns, residuals and indices change
/// as in [`tidy`](crate::flow::singularities::tidy).
pub fn attract(
    mesh: &TriangleMesh,
    field: &mut OrientationField,
    sharp: Sharp<'_>,
    sizes: &FaceMap<f64>,
) {
    let is_corner = corners(mesh, sharp);
    let sharp = sharp.edges;
    let is_sharp: VertexMap<bool> = mesh
        .vertex_ids()
        .map(|v| mesh.outgoing(v).any(|h| sharp[h]))
        .collect();
    let mut reach = Reach::new(mesh, sizes);
    let singular: Vec<VertexId> = mesh
        .vertex_ids()
        .filter(|&v| field.indices[v] != 0 && !is_corner[v])
        .collect();
    for v in singular {
        let index = field.indices[v];
        reach.spread(v, CORNER_RADIUS);
        let may_take = |u: &VertexId| *u != v && (-2..=1).contains(&(field.indices[*u] + index));
        let seen = || reach.seen().iter().copied().filter(may_take);
        let corner = seen().find(|&u| is_corner[u]);
        let on_line = || {
            let near = |u: &VertexId| is_sharp[*u] && reach.distance(*u) < LINE_RADIUS;
            seen().find(near).filter(|_| !is_sharp[v])
        };
        if let Some(to) = corner.or_else(on_line) {
            shift(field, mesh, &reach.path(to), index);
        }
    }
    debug_assert_eq!(field.check(mesh), Ok(()));
}
