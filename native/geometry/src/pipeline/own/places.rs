//! Where finer quads lie on a part, and on its sphere.

use std::collections::HashMap;

use glam::DVec3;

use super::{Before, Own};
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

impl Own {
    /// The place of each vertex of finer quads on the part: on the two triangles that its quad was made
    /// of, or, where strips were taken out, on those around it and on its line.
    pub fn places(&self, mesh: &TriangleMesh, cut: &Cut) -> Vec<Place> {
        let around = match &self.fewer {
            None => halves(mesh, &self.quads),
            Some(before) => before.around(mesh, &self.quads),
        };
        let each = cut.mesh.positions().iter().zip(&cut.quads);
        let place = |(&p, quad): (&DVec3, &FaceId)| place(mesh, p, &around[quad.index()]);
        let mut places: Vec<Place> = each.map(place).collect();
        if let Some(before) = &self.fewer {
            let lines = self.kept.iter().copied().chain(self.borders());
            for (v, p) in before.on_lines(mesh, cut, lines) {
                let quad = cut.quads[v];
                places[v] = place_at(mesh, p, &around[quad.index()]);
            }
        } else {
            // The coarse vertices are the first, and stay to the last bit.
            for (place, &position) in places.iter_mut().zip(self.quads.positions()) {
                place.position = position;
            }
        }
        places
    }

    /// The edges that one quad has alone, smaller end first, in order.
    fn borders(&self) -> Vec<[VertexId; 2]> {
        let mut sides: Vec<[VertexId; 2]> = Vec::with_capacity(4 * self.quads.n_faces());
        for face in self.quads.faces() {
            for i in 0..face.len() {
                let [a, b] = [face[i], face[(i + 1) % face.len()]];
                sides.push([a.min(b), a.max(b)]);
            }
        }
        sides.sort_unstable();
        let alone = sides.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
        alone.map(|same| same[0]).collect()
    }
}

/// The two triangles of each quad.
fn halves(mesh: &TriangleMesh, quads: &PolygonMesh) -> Vec<Vec<FaceId>> {
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
    quads.faces().map(halves).collect()
}

/// The closest place on some faces.
fn place(mesh: &TriangleMesh, p: DVec3, faces: &[FaceId]) -> Place {
    let closest = faces
        .iter()
        .map(|&face| closest_on_triangle(p, mesh.triangle(face)).of(face));
    let closest = closest.min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared));
    let closest = closest.expect("a quad lies on triangles");
    Place {
        on: SurfacePoint {
            face: closest.face,
            weights: closest.weights,
        },
        position: closest.position,
    }
}

/// The same for a point of the faces, which stays to the last bit.
fn place_at(mesh: &TriangleMesh, position: DVec3, faces: &[FaceId]) -> Place {
    Place {
        position,
        ..place(mesh, position, faces)
    }
}

impl Before {
    /// The triangles around all vertices that became the corners of each quad.
    fn around(&self, mesh: &TriangleMesh, quads: &PolygonMesh) -> Vec<Vec<FaceId>> {
        let mut around: Vec<Vec<FaceId>> = vec![Vec::new(); mesh.n_vertices()];
        for face in mesh.face_ids() {
            for v in mesh.face(face) {
                around[v.index()].push(face);
            }
        }
        let of_quad = |quad: &[VertexId]| {
            let members = quad.iter().flat_map(|v| &self.members[v.index()]);
            let mut faces: Vec<FaceId> =
                members.flat_map(|v| &around[v.index()]).copied().collect();
            faces.sort_unstable();
            faces.dedup();
            faces
        };
        quads.faces().map(of_quad).collect()
    }

    /// Where vertices of finer quads lie on lines: the vertex, and the closest place of its line.
    fn on_lines(
        &self,
        mesh: &TriangleMesh,
        cut: &Cut,
        lines: impl Iterator<Item = [VertexId; 2]>,
    ) -> Vec<(usize, DVec3)> {
        let open = mesh.halfedge_ids().filter(|&h| mesh.twin(h).is_none());
        let open = open.map(|h| [mesh.origin(h), mesh.target(h)]);
        let mut along: Vec<Vec<[VertexId; 2]>> = vec![Vec::new(); mesh.n_vertices()];
        for edge in self.kept.iter().copied().chain(open) {
            for v in edge {
                along[v.index()].push(edge);
            }
        }
        let mut placed = Vec::new();
        for ends in lines {
            let members = ends.iter().flat_map(|v| &self.members[v.index()]);
            let pieces: Vec<[VertexId; 2]> =
                members.flat_map(|v| &along[v.index()]).copied().collect();
            for v in cut.on(ends) {
                let p = cut.mesh.positions()[v];
                let on = pieces.iter().map(|piece| {
                    let [a, b] = piece.map(|v| mesh.position(v));
                    closest_on_triangle(p, [a, b, b]).of(FaceId(0)).position
                });
                let nearer =
                    |a: &DVec3, b: &DVec3| a.distance_squared(p).total_cmp(&b.distance_squared(p));
                placed.extend(on.min_by(nearer).map(|place| (v, place)));
            }
        }
        placed
    }
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
