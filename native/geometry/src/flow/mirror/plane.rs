//! Singularities in the plane.

use crate::flow::creases::Network;
use crate::flow::field::{self, OrientationField};
use crate::flow::singularities::{Reach, shift};
use crate::mesh::FaceMap;
use crate::mirror::Doubled;

/// How far from the plane a unit is put that may not stay in it, in edges of quads.
const ASIDE: f64 = 0.8;
/// How far at most.
const FARTHEST: f64 = 3.0;

/// Makes a field its own image, with no singularities in the plane but vertices of valence 6.
///
/// A corner of a network in the plane keeps its index. What else lies in the plane after mirroring
/// goes to both sides in equal parts, where the mesh has room. Directions near by do not agree with the turns then, as after `tidy`.
pub fn straighten(
    field: &mut OrientationField,
    doubled: &Doubled,
    (sizes, network): (&FaceMap<f64>, Option<&Network<'_>>),
) {
    field::mirror(field, doubled);
    let mesh = doubled.mesh();
    let mut reach = Reach::new(mesh, sizes);
    for v in doubled.border().iter().map(|&h| mesh.origin(h)) {
        let wanted = network.and_then(|network| network.index(v)).unwrap_or(0);
        let index = field.indices[v] - wanted;
        let unit = index.signum();
        let n = if index > 0 {
            index / 2
        } else {
            -(index + 2) / 2
        };
        for _ in 0..n.max(0) {
            reach.spread(v, FARTHEST);
            let is_free = |u: &&crate::mesh::VertexId| {
                let is_inside = mesh.outgoing(**u).all(|h| doubled.is_positive(h.face()));
                is_inside && field.indices[**u] == 0
            };
            let aside = |u: &&crate::mesh::VertexId| reach.distance(**u) >= ASIDE;
            let mut free = reach.seen().iter().filter(is_free);
            let place = free.clone().find(aside).or_else(|| free.next_back());
            let Some(&place) = place else {
                break;
            };
            shift(field, mesh, &reach.path(place), unit);
            field::mirror(field, doubled);
        }
    }
}
