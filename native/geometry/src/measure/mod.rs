//! Sizes and directions: areas, normals, angles, volume, topology and curvature.
//!
//! Everything here reads a mesh and changes nothing. Faces without area have the normal zero, so
//! that they drop out of sums instead of poisoning them.

mod curvature;
mod ears;
mod features;
mod polygon_edges;
mod polyline;
mod sharp;
mod topology;

use glam::DVec3;

use crate::elementary::atan2;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, TriangleMesh, VertexMap};

pub use curvature::{Curvature, CurvatureField, principal_curvatures};
pub use ears::{clip_ears, cut_polygon};
pub use features::{FeatureLine, feature_lines, loose_share};
pub use polygon_edges::PolygonEdges;
pub use polyline::{Polyline, Seam};
pub use sharp::sharp_edges;
pub use topology::{Topology, topology, topology_of, topology_of_triangles};

/// The area of every face.
pub fn face_areas(mesh: &TriangleMesh) -> FaceMap<f64> {
    mesh.face_ids()
        .map(|face| area_vector(mesh.triangle(face)).length())
        .collect()
}

/// The sum of the areas of all faces.
pub fn total_area(mesh: &TriangleMesh) -> f64 {
    mesh.face_ids()
        .map(|face| area_vector(mesh.triangle(face)).length())
        .sum()
}

/// The enclosed volume of a closed mesh, negative when it is inside out.
///
/// Of an open mesh, the volume of the cone from its first vertex.
pub fn volume(mesh: &TriangleMesh) -> f64 {
    let Some(&apex) = mesh.positions().first() else {
        return 0.0;
    };
    let under = |face| {
        let [a, b, c] = mesh.triangle(face).map(|p| p - apex);
        a.dot(b.cross(c)) / 6.0
    };
    mesh.face_ids().map(under).sum()
}

/// The unit normal of every face; zero for faces without area.
pub fn face_normals(mesh: &TriangleMesh) -> FaceMap<DVec3> {
    mesh.face_ids()
        .map(|face| face_normal(mesh, face))
        .collect()
}

/// The unit normal of one face; zero for a face without area.
pub fn face_normal(mesh: &TriangleMesh, face: FaceId) -> DVec3 {
    area_vector(mesh.triangle(face)).normalize_or_zero()
}

/// The unit normal of every vertex: the mean of its faces' normals weighted by their angles there,
/// which does not depend on how the surface is cut into triangles; zero where they cancel out.
pub fn vertex_normals(mesh: &TriangleMesh) -> VertexMap<DVec3> {
    let mut sums = VertexMap::filled(mesh.n_vertices(), DVec3::ZERO);
    for face in mesh.face_ids() {
        let normal = face_normal(mesh, face);
        let corners = mesh.triangle(face);
        for (i, vertex) in mesh.face(face).into_iter().enumerate() {
            sums[vertex] += normal * corner_angle(corners, i);
        }
    }
    sums.iter().map(|sum| sum.normalize_or_zero()).collect()
}

/// The angle between the normals of the two faces at an edge, in 0..=π; zero at a border and
/// where a face has no area.
pub fn dihedral_angle(mesh: &TriangleMesh, h: HalfedgeId) -> f64 {
    let Some(twin) = mesh.twin(h) else {
        return 0.0;
    };
    let [a, b] = [h, twin].map(|h| face_normal(mesh, h.face()));
    angle_between(a, b)
}

/// The mean length of all edges; zero when there is none.
pub fn mean_edge_length(mesh: &TriangleMesh) -> f64 {
    let is_first = |&h: &HalfedgeId| mesh.twin(h).is_none_or(|twin| h < twin);
    let length = |h| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.target(h)))
    };
    let total: f64 = mesh.halfedge_ids().filter(is_first).map(length).sum();
    total / mesh.n_edges().max(1) as f64
}

/// A vector along the normal of a triangle, as long as its area.
pub fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a) * 0.5
}

/// The angle of a triangle at one of its corners, in 0..=π.
pub fn corner_angle(triangle: [DVec3; 3], corner: usize) -> f64 {
    let at = triangle[corner];
    angle_between(
        triangle[(corner + 1) % 3] - at,
        triangle[(corner + 2) % 3] - at,
    )
}

/// The angle between two vectors, in 0..=π, exact for small angles too; zero if one is zero.
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    atan2(a.cross(b).length(), a.dot(b))
}

#[cfg(test)]
mod tests;
