//! Directions that agree with given singularities.

use std::f64::consts::FRAC_PI_2;

use super::charts::Charts;
use super::shape::{self, Axes, Pull};
use super::{FieldError, OrientationField, Settings};
use crate::elementary::{angle_to, direction};
use crate::mesh::{FaceMap, HalfedgeMap, Id, TriangleMesh};
use crate::progress::Progress;
use crate::sparse::SymmetricMatrix;

/// How often the pulls choose their nearest arm anew. After three nothing moves much.
const N_ROUNDS: usize = 3;

/// Turns the crosses so that they are as smooth as the singularities allow, and along the shape.
///
/// Where singularities were merged or moved, turns were changed and crosses were not; here crosses
/// follow. With the turns fixed, smoothness is linear in the crosses' angles (trivial connections,
/// Crane, Desbrun & Schröder 2010). Turns and indices are kept; directions and residuals change.
/// One sparse factorisation, O(n^1.5).
///
/// # Errors
/// When sizes overflow or on cancellation; then nothing has changed.
///
/// # Panics
/// When the field belongs to another mesh.
pub fn settle(
    mesh: &TriangleMesh,
    field: &mut OrientationField,
    settings: &Settings,
    progress: &Progress,
) -> Result<(), FieldError> {
    let none = HalfedgeMap::filled(3 * mesh.n_faces(), false);
    settle_along(mesh, field, (settings, &none), progress)
}

/// As [`settle`], with some edges that are followed as sharp ones are, whatever their angle.
///
/// # Errors
/// As those of [`settle`].
pub fn settle_along(
    mesh: &TriangleMesh,
    field: &mut OrientationField,
    (settings, along): (&Settings, &HalfedgeMap<bool>),
    progress: &Progress,
) -> Result<(), FieldError> {
    let charts = Charts::new(mesh);
    let axes = shape::axes(mesh);
    let pulls = shape::pulls(mesh, (&charts, &axes), settings, along);
    progress.at(0.2)?;
    let mut system = SymmetricMatrix::new(mesh.n_faces());
    for (face, pull) in pulls.iter_ids() {
        system.add(face.index(), face.index(), pull.weight + 1e-6);
    }
    for h in mesh.halfedge_ids() {
        if let Some(twin) = mesh.twin(h).filter(|twin| h < *twin) {
            let ends = [(h.face().index(), -1.0), (twin.face().index(), 1.0)];
            system.add_square(&ends, 1.0);
        }
    }
    let factor = system.factorize()?;
    progress.at(0.8)?;
    for _ in 0..N_ROUNDS {
        let mut steps = right_side(mesh, field, &axes, &pulls);
        factor.solve(&mut steps);
        turn(mesh, field, &axes, &FaceMap::from_vec(steps));
    }
    debug_assert_eq!(field.check(mesh), Ok(()));
    Ok(())
}

/// What makes residuals small and moves each cross towards the nearest arm of its pull, in
/// quarters.
fn right_side(
    mesh: &TriangleMesh,
    field: &OrientationField,
    axes: &FaceMap<Axes>,
    pulls: &FaceMap<Pull>,
) -> Vec<f64> {
    let mut right: Vec<f64> = mesh
        .face_ids()
        .map(|face| {
            let Pull { toward, weight } = pulls[face];
            let cross = shape::fourth_power(shape::in_chart(field.directions[face], &axes[face]));
            weight * angle_to(cross, toward) / (4.0 * FRAC_PI_2)
        })
        .collect();
    for h in mesh.halfedge_ids() {
        right[h.face().index()] += field.residuals[h];
    }
    right
}

/// Turns every cross by some quarters within its face.
fn turn(
    mesh: &TriangleMesh,
    field: &mut OrientationField,
    axes: &FaceMap<Axes>,
    steps: &FaceMap<f64>,
) {
    for face in mesh.face_ids() {
        let now = shape::in_chart(field.directions[face], &axes[face]);
        let turned = direction(steps[face] * FRAC_PI_2).rotate(now);
        field.directions[face] = axes[face].u * turned.x + axes[face].v * turned.y;
    }
    for h in mesh.halfedge_ids() {
        if let Some(twin) = mesh.twin(h) {
            field.residuals[h] += steps[twin.face()] - steps[h.face()];
        }
    }
}
