//! A part before anything is made of it: its own image where that is its role.

use super::plane::Plane;
use super::roles::Role;
use crate::mesh::{HalfedgeMap, TriangleMesh, VertexMap};
use crate::mirror::double;
use crate::pipeline::report::Mirrored;

/// Vertices nearer to the plane than this share of an edge across it are moved onto it: only those
/// that belong there but for rounding, for the surface is to stay what it is.
const SNAP: f64 = 0.02;

/// A part, and what of the plane of symmetry has to do with it.
pub struct Faced {
    /// The part, its own image if there is an axis.
    pub mesh: TriangleMesh,
    /// Its edges that are marked, on both sides of each.
    pub marked: HalfedgeMap<bool>,
    /// The density at its vertices, where any is asked for.
    pub density: Option<VertexMap<f64>>,
    /// The axis across the plane.
    pub axis: Option<usize>,
    /// What is known already of what the report will say.
    pub refused: Option<Mirrored>,
}

/// Makes a part its own image, from the positive side, where that is its role and can be.
///
/// One that is nearly its own image already stays what it is.
pub fn face(
    (part, marked, density): (TriangleMesh, HalfedgeMap<bool>, Option<VertexMap<f64>>),
    (role, plane): (&Role, Option<Plane>),
) -> Faced {
    let reason = match (role, plane) {
        (Role::Whole, Some(plane)) if plane.was_symmetric => {
            return Faced {
                mesh: part,
                marked,
                density,
                axis: Some(plane.axis),
                refused: None,
            };
        }
        (Role::Whole, Some(plane)) => match double(&part, plane.axis, SNAP) {
            Ok(doubled) => {
                return Faced {
                    marked: doubled.carried(&part, &marked),
                    density: density.map(|values| doubled.carried_values(&part, &values)),
                    mesh: doubled.into_mesh(),
                    axis: Some(plane.axis),
                    refused: None,
                };
            }
            Err(error) => Some(error.to_string()),
        },
        (Role::Alone(reason), _) => reason.clone(),
        _ => None,
    };
    Faced {
        mesh: part,
        marked,
        density,
        axis: None,
        refused: reason.map(|reason| Mirrored::Refused { reason }),
    }
}

/// The positive side of a mesh and its image.
pub fn doubled(mesh: &TriangleMesh, axis: usize) -> Result<TriangleMesh, String> {
    let doubled = double(mesh, axis, SNAP).map_err(|error| error.to_string())?;
    Ok(doubled.into_mesh())
}
