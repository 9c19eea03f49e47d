//! Whether what lies on a mesh is symmetric too.

use std::collections::HashSet;

use super::plane::image_vertex;
use crate::mesh::{Id, VertexId};
use crate::nearest::Bvh;
use crate::pipeline::Input;
use crate::pipeline::frame::Frame;
use crate::progress::{Cancelled, Progress};

/// Densities of a vertex and its image may differ by so much.
const SAME_DENSITY: f64 = 0.02;

/// Whether densities and marks of edges, if any are given, are those of their images in a plane
/// across an axis of the frame of work.
///
/// # Errors
/// When cancelled.
pub fn data_is_symmetric(
    (input, frame): (&Input<'_>, &Frame),
    plane: (usize, f64),
    progress: &Progress<'_>,
) -> Result<bool, Cancelled> {
    let density = input.density.unwrap_or_default();
    if density.is_empty() && input.marked.is_empty() {
        return Ok(true);
    }
    let places = frame.enter(input.mesh.positions());
    let tree = Bvh::build_of_points(&places, progress)?;
    let image = |v: VertexId| image_vertex(&tree, places[v.index()], plane);
    for (i, value) in density.iter().enumerate() {
        progress.check()?;
        // A vertex without a face need not have an image.
        let other = image(VertexId::from_index(i)).map(|v| density[v.index()]);
        if other.is_some_and(|other| (value - other).abs() > SAME_DENSITY) {
            return Ok(false);
        }
    }
    // Of vertices in one place each edge may have another: the one that the tree finds stands for all.
    let one = |v: VertexId| VertexId(tree.closest(places[v.index()]).face.0);
    let sorted = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
    let marked: HashSet<[VertexId; 2]> = input.marked.iter().map(|e| sorted(e.map(one))).collect();
    let has_image = |edge: &[VertexId; 2]| match edge.map(image) {
        [Some(a), Some(b)] => marked.contains(&sorted([a, b].map(one))),
        _ => false,
    };
    Ok(input.marked.iter().all(has_image))
}
