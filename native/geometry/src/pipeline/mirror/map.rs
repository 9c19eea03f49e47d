//! An even surface made its own image, with a map to the sphere of its own.

use crate::embed::Solver;
use crate::mesh::HalfedgeMap;
use crate::mirror::{Doubled, double, double_along};
use crate::pipeline::Error;
use crate::pipeline::part::embed_mesh;
use crate::progress::Progress;
use crate::sphere_map::SphereMap;

/// Vertices nearer to the plane than this share of an edge are moved onto it. Below, the triangles
/// beside the plane are thin; at a half next to none is split and the line in the plane is rough.
const SNAP: f64 = 0.35;

/// A surface that is nearly its own image in the plane where a coordinate is 0, made so exactly
/// from the positive side, and embedded anew; vertices on the lines given stay on them. An error says why that cannot be.
pub fn symmetric(
    (map, lines): (&SphereMap, Option<&HalfedgeMap<bool>>),
    axis: usize,
    progress: &Progress<'_>,
) -> Result<Result<(SphereMap, Doubled), String>, Error> {
    let doubled = match lines {
        Some(lines) => double_along(map.mesh(), lines, (axis, SNAP)),
        None => double(map.mesh(), axis, SNAP),
    };
    let doubled = match doubled {
        Ok(doubled) => doubled,
        Err(error) => return Ok(Err(error.to_string())),
    };
    let embedded = embed_mesh(doubled.mesh().clone(), &Solver::default(), progress)?;
    Ok(Ok((embedded.map, doubled)))
}
