//! Where finer quads lie on a part, and on its sphere.

use std::collections::HashMap;

use glam::DVec3;

use crate::embed::{self, Embedded};
use crate::mesh::{FaceId, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::nearest::closest_on_triangle;
use crate::pair::Cut;
use crate::pipeline::Error;
use crate::progress::Progress;
use crate::sphere_map::SurfacePoint;

/// A place of a mesh.
pub struct Place {
    on: SurfacePoint,
    pub position: DVec3,
}

/// The place of each vertex of finer quads on the two triangles that its quad was made of.
pub fn places(mesh: &TriangleMesh, (coarse, cut): (&PolygonMesh, &Cut)) -> Vec<Place> {
    let mut faces: HashMap<[VertexId; 3], FaceId> = HashMap::with_capacity(mesh.n_faces());
    for face in mesh.face_ids() {
        let mut corners = mesh.face(face);
        corners.sort_unstable();
        faces.insert(corners, face);
    }
    let halves = |quad: &[VertexId]| -> Vec<FaceId> {
        let without = (0..4).map(|i| [1, 2, 3].map(|k| quad[(i + k) % 4]));
        let named = without.filter_map(|mut corners| {
            corners.sort_unstable();
            faces.get(&corners).copied()
        });
        named.collect()
    };
    let place = |p: DVec3, quad: &[FaceId]| {
        let closest = quad
            .iter()
            .map(|&face| closest_on_triangle(p, mesh.triangle(face)).of(face));
        let closest = closest.min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared));
        let closest = closest.expect("a quad is two triangles");
        Place {
            on: SurfacePoint {
                face: closest.face,
                weights: closest.weights,
            },
            position: closest.position,
        }
    };
    let halves: Vec<Vec<FaceId>> = coarse.faces().map(halves).collect();
    let each = cut.mesh.positions().iter().zip(&cut.quads);
    let mut places: Vec<Place> = each
        .map(|(&p, quad)| place(p, &halves[quad.index()]))
        .collect();
    // The coarse vertices are the first, and stay to the last bit.
    for (place, &position) in places.iter_mut().zip(coarse.positions()) {
        place.position = position;
    }
    places
}

/// The points of finer quads on the sphere of a part that is closed, the origin else; none where they
/// cannot cover it.
pub fn sphere(
    closed: Option<&Embedded>,
    quads: &PolygonMesh,
    places: &[Place],
    progress: &Progress<'_>,
) -> Result<Option<Vec<DVec3>>, Error> {
    let Some(embedded) = closed else {
        return Ok(Some(vec![DVec3::ZERO; quads.n_vertices()]));
    };
    let points = places
        .iter()
        .map(|place| embedded.map.sphere_position(place.on));
    let points: Vec<DVec3> = points.collect();
    match embed::cover(quads, &points, progress) {
        Ok(covered) => Ok(Some(covered.sphere)),
        Err(embed::CoverError::Cancelled(cancelled)) => Err(cancelled.into()),
        Err(_) => Ok(None),
    }
}
