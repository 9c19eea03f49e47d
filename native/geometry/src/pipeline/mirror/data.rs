//! Whether what lies on a mesh is symmetric too.

use std::collections::HashSet;

use glam::DVec3;

use super::plane::image_vertex;
use crate::guidance::Stroke;
use crate::measure::Polyline;
use crate::mesh::{Id, VertexId};
use crate::nearest::Bvh;
use crate::pipeline::Input;
use crate::pipeline::frame::Frame;
use crate::progress::{Cancelled, Progress};

/// Densities of a vertex and its image may differ by so much.
const SAME_DENSITY: f64 = 0.02;
/// A stroke across the plane is its own image if it is off that by no more than this share of its
/// length, in the mean: hands shake, but at 0.03 one is lost that is 8° off on a ball of 400 quads.
const OWN_IMAGE: f64 = 0.015;

/// Whether densities and marks of edges, if any are given, are those of their images in a plane
/// across an axis of the frame of work, and strokes across it are their own images. Strokes on one
/// side of it may have none: they get them.
///
/// # Errors
/// When cancelled.
pub fn data_is_symmetric(
    (input, frame): (&Input<'_>, &Frame),
    plane: (usize, f64),
    progress: &Progress<'_>,
) -> Result<bool, Cancelled> {
    if !input.guides.iter().all(|s| is_own_image(s, frame, plane)) {
        return Ok(false);
    }
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

/// Whether a stroke does not lie across a plane, or is its own image there.
fn is_own_image(stroke: &Stroke, frame: &Frame, (axis, at): (usize, f64)) -> bool {
    let round: Vec<DVec3> = stroke.round().collect();
    let points = frame.enter(&round);
    let line = Polyline::new(points.clone(), false);
    let slack = OWN_IMAGE * line.length();
    let sides = || points.iter().map(|p| p[axis] - at);
    let is_across = sides().any(|side| side < -slack) && sides().any(|side| side > slack);
    let off = points.iter().map(|&(mut p)| {
        p[axis] = 2.0 * at - p[axis];
        line.distance(p)
    });
    !is_across || off.sum::<f64>() <= slack * points.len() as f64
}
