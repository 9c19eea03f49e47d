//! The check that a polygon mesh covers the unit sphere exactly once.

use std::f64::consts::TAU;

use glam::DVec3;
use thiserror::Error;

use super::{degree_of, is_positive, solid_angle};
use crate::mesh::{FaceId, PolygonMesh, VertexId};

/// Why a polygon mesh does not cover the sphere once.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum NotACover {
    /// Not as many points as vertices.
    #[error("{n_points} sphere points for {n_vertices} vertices")]
    WrongNumber {
        /// How many points were given.
        n_points: usize,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// A point does not lie on the unit sphere.
    #[error("vertex {vertex} has no point on the unit sphere (its length is {length})")]
    NotOnSphere {
        /// The first such vertex.
        vertex: VertexId,
        /// The length of what it has.
        length: f64,
    },
    /// An edge without exactly one face on either side.
    #[error("the edge from vertex {a} to vertex {b} does not have one face on either side")]
    Open {
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// Faces that no fan splits into positive spherical triangles.
    #[error("{n_folds} of {n_faces} spherical faces are folded, the first is face {first}")]
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

/// Checks that a mesh, with these points of the unit sphere for its vertices, covers the sphere
/// exactly once: it is closed, every face splits into positive spherical triangles by the diagonals
/// from one of its corners (a quad by one of its two diagonals), and their solid angles sum to 4π.
///
/// Then the faces are a triangulated sphere and the points a homeomorphism: positive triangles
/// make a branched covering, and one of degree 1 has no branch and no vertex with two fans.
///
/// # Errors
/// What stands against it.
pub fn check_cover(mesh: &PolygonMesh, points: &[DVec3]) -> Result<(), NotACover> {
    let [n_points, n_vertices] = [points.len(), mesh.n_vertices()];
    if n_points != n_vertices {
        return Err(NotACover::WrongNumber {
            n_points,
            n_vertices,
        });
    }
    let on = |p: &DVec3| (p.length_squared() - 1.0).abs() < 1e-9;
    if let Some((i, p)) = points.iter().enumerate().find(|(_, p)| !on(p)) {
        return Err(NotACover::NotOnSphere {
            vertex: VertexId(i as u32),
            length: p.length(),
        });
    }
    check_edges(mesh)?;
    let fans: Vec<_> = mesh
        .faces()
        .map(|face| positive_fan(face, |v| points[v.0 as usize]))
        .collect();
    let mut folds = fans.iter().enumerate().filter(|(_, fan)| fan.is_none());
    if let Some((first, _)) = folds.next() {
        return Err(NotACover::Folded {
            n_folds: 1 + folds.count(),
            n_faces: mesh.n_faces(),
            first: FaceId(first as u32),
        });
    }
    let triangles = mesh.faces().zip(&fans).flat_map(|(face, fan)| {
        let apex = fan.expect("every face has a fan by now");
        fan_triangles(face, apex).map(|t| t.map(|v| points[v.0 as usize]))
    });
    match degree_of(triangles) {
        1 => Ok(()),
        degree => Err(NotACover::Degree { degree }),
    }
}

/// Whether a spherical face with its corners at some points is split into positive triangles by
/// the diagonals from one of its corners.
pub fn is_unfolded(face: &[VertexId], at: impl Fn(VertexId) -> DVec3) -> bool {
    positive_fan(face, at).is_some()
}

/// Whether a cover of the sphere stays one when a vertex goes to another point. `ring` holds the
/// faces at the vertex, `at` says where every vertex is now.
///
/// Positive faces are not enough: where they are as large as a hemisphere, the faces round a point
/// may all be positive and yet run round it twice. Then they cover 4π more than before.
pub fn stays_cover<'f>(
    ring: impl Iterator<Item = &'f [VertexId]> + Clone,
    (vertex, to): (VertexId, DVec3),
    at: impl Fn(VertexId) -> DVec3,
) -> bool {
    let moved = |v: VertexId| if v == vertex { to } else { at(v) };
    if !ring.clone().all(|face| is_unfolded(face, moved)) {
        return false;
    }
    let is_near = |&v: &VertexId| v == vertex || at(v).dot(to) > 0.0;
    let is_small = ring.clone().flatten().all(is_near);
    is_small || (area(ring.clone(), moved) - area(ring, at)).abs() < TAU
}

/// The solid angle that some unfolded faces cover together.
fn area<'f>(faces: impl Iterator<Item = &'f [VertexId]>, at: impl Fn(VertexId) -> DVec3) -> f64 {
    let area = |face: &[VertexId]| {
        let apex = positive_fan(face, &at).unwrap_or(0);
        let angles = fan_triangles(face, apex).map(|t| {
            let [a, b, c] = t.map(&at);
            solid_angle(a, b, c)
        });
        angles.sum::<f64>()
    };
    faces.map(area).sum()
}

/// The corner from which the diagonals split a face into positive spherical triangles only.
fn positive_fan(face: &[VertexId], at: impl Fn(VertexId) -> DVec3) -> Option<usize> {
    let positive = |t: [VertexId; 3]| {
        let [a, b, c] = t.map(&at);
        is_positive(a, b, c)
    };
    // Opposite corners of a quad give the same diagonal.
    let n_apexes = match face.len() {
        3 => 1,
        4 => 2,
        n => n,
    };
    (0..n_apexes).find(|&apex| fan_triangles(face, apex).all(positive))
}

fn fan_triangles(face: &[VertexId], apex: usize) -> impl Iterator<Item = [VertexId; 3]> + '_ {
    let n = face.len();
    let corner = move |i: usize| face[(apex + i) % n];
    (1..n - 1).map(move |i| [corner(0), corner(i), corner(i + 1)])
}

/// Checks that every edge is run through once in each direction.
fn check_edges(mesh: &PolygonMesh) -> Result<(), NotACover> {
    let key = |a: VertexId, b: VertexId| u64::from(a.0) << 32 | u64::from(b.0);
    let mut there = Vec::with_capacity(mesh.corners().len());
    let mut back = Vec::with_capacity(mesh.corners().len());
    for face in mesh.faces() {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            there.push(key(a, b));
            back.push(key(b, a));
        }
    }
    there.sort_unstable();
    back.sort_unstable();
    let twice = there.windows(2).find(|w| w[0] == w[1]).map(|w| w[0]);
    let alone = || there.iter().zip(&back).find(|(x, y)| x != y);
    match twice.or_else(|| alone().map(|(&x, &y)| x.min(y))) {
        None => Ok(()),
        Some(edge) => Err(NotACover::Open {
            a: VertexId((edge >> 32) as u32),
            b: VertexId(edge as u32),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::CUBE_QUADS;

    fn cube() -> (Vec<DVec3>, Vec<[u32; 4]>) {
        let corner = |i: u32| {
            let sign = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
            DVec3::new(sign(0), sign(1), sign(2)).normalize_or(DVec3::Z)
        };
        ((0..8).map(corner).collect(), CUBE_QUADS.to_vec())
    }

    fn check(points: &[DVec3], faces: &[[u32; 4]]) -> Result<(), NotACover> {
        let mesh = PolygonMesh::from_faces(points.to_vec(), faces).unwrap();
        check_cover(&mesh, points)
    }

    #[test]
    fn a_cube_covers_the_sphere_once() {
        let (points, faces) = cube();
        assert_eq!(check(&points, &faces), Ok(()));
    }

    #[test]
    fn a_quad_with_one_reflex_corner_still_counts() {
        let (mut points, faces) = cube();
        // Corner 7 passes the diagonal of the quad 4 5 7 6 but stays outside the opposite corner.
        points[7] = DVec3::new(-0.1, -0.1, 1.0).normalize_or(DVec3::Z);
        assert_eq!(check(&points, &faces), Ok(()));
    }

    #[test]
    fn what_is_not_a_cover_is_refused() {
        let (points, faces) = cube();
        let mut folded = points.clone();
        folded[7] = DVec3::NEG_Z;
        let error = check(&folded, &faces).unwrap_err();
        assert!(
            matches!(error, NotACover::Folded { n_faces: 6, .. }),
            "{error}"
        );
        let mirrored: Vec<_> = points.iter().map(|&p| -p).collect();
        let error = check(&mirrored, &faces).unwrap_err();
        assert!(
            matches!(error, NotACover::Folded { n_folds: 6, .. }),
            "{error}"
        );
        let error = check(&points, &faces[..5]).unwrap_err();
        assert!(matches!(error, NotACover::Open { .. }), "{error}");
        let mut nan = points.clone();
        nan[3] = DVec3::splat(0.5);
        let error = check(&nan, &faces).unwrap_err();
        assert!(
            matches!(
                error,
                NotACover::NotOnSphere {
                    vertex: VertexId(3),
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn two_spheres_cover_twice() {
        let (points, faces) = cube();
        let both = [points.clone(), points].concat();
        let more: Vec<_> = faces.iter().map(|f| f.map(|v| v + 8)).collect();
        let error = check(&both, &[faces, more].concat()).unwrap_err();
        assert_eq!(error, NotACover::Degree { degree: 2 });
    }
}
