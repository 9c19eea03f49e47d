//! A proven bijection between a surface and the unit sphere.
//!
//! Every vertex x of a closed mesh has a point s on the unit sphere. The map is linear on each
//! triangle in the gnomonic sense: the sphere point along w₁s₁ + w₂s₂ + w₃s₃ belongs to the surface
//! point w₁x₁ + w₂x₂ + w₃x₃, so that *sphere point + offset = surface point* holds everywhere for
//! offsets x − s interpolated with the same weights. It is a bijection exactly if every spherical
//! triangle is positively oriented, det(s₁, s₂, s₃) > 0, and together they cover the sphere once.

mod cover;
mod locate;
mod travel;

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};
use thiserror::Error;

use crate::elementary::atan2;
use crate::mesh::{FaceId, Id, TriangleMesh, VertexId, VertexMap};
pub use cover::{NotACover, check_cover, is_unfolded, stays_cover};
use locate::HintGrid;
pub use travel::walk_along;

/// A closed mesh with a point of the unit sphere for every vertex, proven to be a bijection.
#[derive(Clone, Debug)]
pub struct SphereMap {
    mesh: TriangleMesh,
    sphere: VertexMap<DVec3>,
    hints: HintGrid,
}

/// Why points do not make a [`SphereMap`].
#[derive(Clone, PartialEq, Debug, Error)]
pub enum NotABijection {
    /// Not one unit vector per vertex.
    #[error("vertex {vertex} has no point on the unit sphere (its length is {length})")]
    NotOnSphere {
        /// The first such vertex.
        vertex: VertexId,
        /// The length of what it has.
        length: f64,
    },
    /// Not as many points as vertices.
    #[error("{n_points} sphere points for {n_vertices} vertices")]
    WrongNumber {
        /// How many points were given.
        n_points: usize,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// The mesh has a border.
    #[error("the mesh has a border and cannot cover the sphere")]
    Open,
    /// Spherical triangles that are not positively oriented.
    #[error("{n_folds} of {n_faces} spherical triangles are folded, the first is face {first}")]
    Folded {
        /// How many there are.
        n_folds: usize,
        /// How many faces there are.
        n_faces: usize,
        /// The first of them.
        first: FaceId,
    },
    /// The sphere is covered another number of times than once.
    #[error("the sphere is covered {degree} times instead of once")]
    Degree {
        /// How many times.
        degree: i64,
    },
}

/// A place on the surface: a face and the weights of its three corners, which sum to 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SurfacePoint {
    /// The face.
    pub face: FaceId,
    /// The weights of its corners.
    pub weights: [f64; 3],
}

impl SphereMap {
    /// Proves that the sphere points make a bijection, by an exact predicate for every triangle
    /// and the sum of the solid angles.
    ///
    /// # Errors
    /// What stands against it.
    pub fn prove(mesh: TriangleMesh, sphere: VertexMap<DVec3>) -> Result<Self, NotABijection> {
        let [n_points, n_vertices] = [sphere.len(), mesh.n_vertices()];
        if n_points != n_vertices {
            return Err(NotABijection::WrongNumber {
                n_points,
                n_vertices,
            });
        }
        if !mesh.is_closed() {
            return Err(NotABijection::Open);
        }
        let off = |p: &DVec3| p.is_nan() || (p.length_squared() - 1.0).abs() >= 1e-9;
        if let Some((vertex, p)) = sphere.iter_ids().find(|(_, p)| off(p)) {
            return Err(NotABijection::NotOnSphere {
                vertex,
                length: p.length(),
            });
        }
        let folds = folded_faces(mesh.faces(), &sphere);
        if let Some(&first) = folds.first() {
            let [n_folds, n_faces] = [folds.len(), mesh.n_faces()];
            return Err(NotABijection::Folded {
                n_folds,
                n_faces,
                first,
            });
        }
        match degree(mesh.faces(), &sphere) {
            1 => {
                let hints = HintGrid::new(mesh.faces(), &sphere);
                Ok(Self {
                    mesh,
                    sphere,
                    hints,
                })
            }
            degree => Err(NotABijection::Degree { degree }),
        }
    }

    /// The surface.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The sphere point of every vertex.
    pub fn sphere(&self) -> &VertexMap<DVec3> {
        &self.sphere
    }

    /// The offset x − s of every vertex.
    pub fn offsets(&self) -> VertexMap<DVec3> {
        let pairs = self.mesh.positions().iter().zip(self.sphere.iter());
        pairs.map(|(&x, &s)| x - s).collect()
    }

    /// Finds where on the surface a point of the sphere belongs; any direction will do.
    pub fn locate(&self, direction: DVec3) -> SurfacePoint {
        locate::walk(self, direction, self.hints.start(direction))
    }

    /// The same, starting the search at a face that is known to be near.
    pub fn locate_near(&self, direction: DVec3, start: FaceId) -> SurfacePoint {
        locate::walk(self, direction, start)
    }

    /// The position of a place on the surface.
    pub fn surface_position(&self, at: SurfacePoint) -> DVec3 {
        weighted(self.mesh.triangle(at.face), at.weights)
    }

    /// The unit vector of a place on the surface.
    pub fn sphere_position(&self, at: SurfacePoint) -> DVec3 {
        weighted(self.sphere_triangle(at.face), at.weights).normalize_or(DVec3::Z)
    }

    /// The three sphere points of a face.
    pub fn sphere_triangle(&self, face: FaceId) -> [DVec3; 3] {
        self.mesh.face(face).map(|v| self.sphere[v])
    }
}

fn weighted([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    a * u + b * v + c * w
}

/// The triple product a · (b × c): six times the volume under a triangle seen from the centre.
pub fn triple_product(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    a.dot(b.cross(c))
}

/// Whether a spherical triangle is positively oriented, decided exactly for the given numbers.
pub fn is_positive(a: DVec3, b: DVec3, c: DVec3) -> bool {
    // Far from zero the rounded product already has the right sign: its error is below 1e-15.
    let rounded = triple_product(a, b, c);
    if rounded.abs() > 1e-14 {
        return rounded > 0.0;
    }
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    // orient3d(a, b, c, d) is det(a − d, b − d, c − d).
    orient3d(coord(a), coord(b), coord(c), coord(DVec3::ZERO)) > 0.0
}

/// How many faces a thread looks at at once; sums are made per chunk, whatever the threads.
const CHUNK: usize = 512;

/// The faces whose spherical triangle is not positively oriented.
pub fn folded_faces(faces: &[[VertexId; 3]], sphere: &VertexMap<DVec3>) -> Vec<FaceId> {
    let folded = |f: &[VertexId; 3]| !is_positive(sphere[f[0]], sphere[f[1]], sphere[f[2]]);
    let numbered = faces.par_iter().with_min_len(CHUNK).enumerate();
    numbered
        .filter(|(_, f)| folded(f))
        .map(|(i, _)| FaceId::from_index(i))
        .collect()
}

/// How often the sphere is covered: the sum of the signed solid angles over 4π, rounded.
pub fn degree(faces: &[[VertexId; 3]], sphere: &VertexMap<DVec3>) -> i64 {
    let angle = |f: &[VertexId; 3]| solid_angle(sphere[f[0]], sphere[f[1]], sphere[f[2]]);
    let chunks = faces.par_chunks(CHUNK);
    let angles: Vec<f64> = chunks.map(|faces| faces.iter().map(angle).sum()).collect();
    (angles.iter().sum::<f64>() / (4.0 * PI)).round() as i64
}

fn degree_of(triangles: impl Iterator<Item = [DVec3; 3]>) -> i64 {
    let angles = triangles.map(|[a, b, c]| solid_angle(a, b, c));
    (angles.sum::<f64>() / (4.0 * PI)).round() as i64
}

/// The signed solid angle of a spherical triangle (Van Oosterom & Strackee 1983).
pub fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    2.0 * atan2(
        triple_product(a, b, c),
        1.0 + a.dot(b) + b.dot(c) + c.dot(a),
    )
}

#[cfg(test)]
mod tests;
