//! A field that is its own image in a plane.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;

use super::charts::Charts;
use super::shape::{axes, in_chart};
use super::{OrientationField, turns};
use crate::elementary::argument;
use crate::mesh::{HalfedgeId, Id};
use crate::mirror::Doubled;

/// Makes the crosses of the negative side the images of those of the positive one.
///
/// Across the plane the arms nearest to it are matched, so that it is a straight line of the field
/// along its arms: the indices of its vertices are even. Cost: linear.
pub fn mirror(field: &mut OrientationField, doubled: &Doubled) {
    let mesh = doubled.mesh();
    let positive = mesh.face_ids().take(mesh.n_faces() / 2);
    for face in positive {
        let image = doubled.image_of_face(face);
        field.directions[image] = doubled.reflection().of(field.directions[face]);
    }
    for h in mesh.halfedge_ids().take(3 * (mesh.n_faces() / 2)) {
        let image = doubled.image_of_halfedge(h);
        field.turns[image] = (4 - field.turns[h]) % 4;
        field.residuals[image] = -field.residuals[h];
    }
    let (charts, axes) = (Charts::new(mesh), axes(mesh));
    for &h in doubled.border() {
        let arm = in_chart(field.directions[h.face()], &axes[h.face()]);
        let back = DVec2::new(arm.x, -arm.y);
        let angle = argument(charts.edge(h).rotate(back)) / FRAC_PI_2;
        let quarters = angle.round();
        let image: HalfedgeId = doubled.image_of_halfedge(h);
        // The image of an arm is as far behind the edge as the arm is ahead of it.
        field.residuals[h] = 2.0 * (angle - quarters);
        field.residuals[image] = -field.residuals[h];
        field.turns[h] = (-2 * quarters as i64).rem_euclid(4) as u8;
        field.turns[image] = (4 - field.turns[h]) % 4;
    }
    field.indices = turns::indices(mesh, &charts, &field.residuals);
    debug_assert_eq!(field.check(mesh), Ok(()));
    debug_assert!(
        (doubled.border().iter()).all(|h| field.indices[mesh.origin(*h)] % 2 == 0),
        "vertex {:?} in the plane is odd",
        doubled.border()[0].index()
    );
}
