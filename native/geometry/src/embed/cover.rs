//! A sphere of triangles and quads laid on the unit sphere from a rough proposal.
//!
//! Each quad is cut along a diagonal, and the folds of the triangles are repaired as those of any
//! proposal. What is left in place stays exactly where it was proposed.

use std::collections::HashSet;

use glam::DVec3;
use serde::Serialize;
use thiserror::Error;

use super::growth::Limits;
use super::repair::{Repaired, repair};
use super::settle;
use crate::mesh::{FaceId, PolygonMesh, TriangleMesh, TriangleMeshError, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{NotACover, check_cover, folded_faces, is_positive};

/// No sweep over all vertices: it would move those that were well proposed.
const NO_SMOOTHING: Limits = Limits {
    max_sweeps: 0,
    tolerance: 0.0,
};

/// A mesh that covers the sphere once.
#[derive(Clone, PartialEq, Debug)]
pub struct Covered {
    /// The point of every vertex.
    pub sphere: Vec<DVec3>,
    /// What was done.
    pub report: CoverReport,
}

/// What was done to a proposed cover.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
pub struct CoverReport {
    /// How many triangles, two a quad, were folded in the proposal.
    pub n_folds: usize,
    /// How many vertices were taken out and put back.
    pub n_moved: usize,
}

/// Why a proposal could not be made a cover.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum CoverError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A face that is neither a triangle nor a quad.
    #[error("face {face} has {n_corners} corners; only triangles and quads can be covered with")]
    Corners {
        /// The first such face.
        face: FaceId,
        /// How many corners it has.
        n_corners: usize,
    },
    /// A quad both of whose diagonals join vertices that are joined already.
    #[error("both diagonals of face {face} join vertices that are joined already")]
    Doubled {
        /// The first such face.
        face: FaceId,
    },
    /// The faces, cut into triangles, are no closed surface.
    #[error("the faces are no surface: {0}")]
    NotASurface(#[from] TriangleMeshError),
    /// The surface is not a sphere.
    #[error("the faces are no sphere: {n_loops} border loops, Euler number {euler}")]
    NotASphere {
        /// How many border loops there are.
        n_loops: usize,
        /// The Euler number; 2 for a sphere.
        euler: i64,
    },
    /// Too many vertices of the proposal are wrong.
    #[error("{n_folds} of {n_triangles} triangles of the proposal are folded, too many to repair")]
    BeyondRepair {
        /// How many there are.
        n_folds: usize,
        /// How many triangles there are.
        n_triangles: usize,
    },
    /// What came out of the repair is no cover.
    #[error("the repaired proposal is no cover: {0}")]
    NotACover(#[from] NotACover),
}

/// Repairs points proposed for the vertices of a sphere of triangles and quads, until every quad
/// is two positive spherical triangles and the sphere is covered once.
///
/// `mesh` holds the positions in space whose shape the repaired parts take. A proposed point of
/// length zero counts as missing. Vertices away from folds keep their points, and those that the
/// repair moved go back to where they were proposed as far as nothing folds.
///
/// # Errors
/// [`CoverError`].
pub fn cover(
    mesh: &PolygonMesh,
    proposed: &[DVec3],
    progress: &Progress,
) -> Result<Covered, CoverError> {
    let sphere: VertexMap<DVec3> = proposed
        .iter()
        .map(|p| {
            if p.is_finite() {
                p.normalize_or_zero()
            } else {
                DVec3::ZERO
            }
        })
        .collect();
    let triangles = cut(mesh, &sphere)?;
    let triangles = TriangleMesh::new(mesh.positions().to_vec(), triangles)?;
    let [n_loops, euler] = [
        triangles.border_loops().len() as i64,
        triangles.euler_number(),
    ];
    if n_loops > 0 || euler != 2 {
        return Err(CoverError::NotASphere {
            n_loops: n_loops as usize,
            euler,
        });
    }
    let n_folds = folded_faces(triangles.faces(), &sphere).len();
    if n_folds == 0 && check_cover(mesh, sphere.as_slice()).is_ok() {
        let report = CoverReport::default();
        return Ok(Covered {
            sphere: sphere.into_vec(),
            report,
        });
    }
    let proposals = sphere.clone();
    let Some(Repaired {
        mut sphere,
        n_moved,
        ..
    }) = repair(&triangles, sphere, NO_SMOOTHING, progress)?
    else {
        return Err(CoverError::BeyondRepair {
            n_folds,
            n_triangles: triangles.n_faces(),
        });
    };
    settle::settle(mesh, &mut sphere, &proposals, progress)?;
    check_cover(mesh, sphere.as_slice())?;
    Ok(Covered {
        sphere: sphere.into_vec(),
        report: CoverReport { n_folds, n_moved },
    })
}

/// Cuts quads along the diagonal with fewer folds, the shorter one of equals, if no edge and no
/// other diagonal joins the same vertices.
fn cut(mesh: &PolygonMesh, sphere: &VertexMap<DVec3>) -> Result<Vec<[VertexId; 3]>, CoverError> {
    let key = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
    let mut joined: HashSet<[VertexId; 2]> = HashSet::new();
    for face in mesh.faces() {
        joined.extend((0..face.len()).map(|i| key(face[i], face[(i + 1) % face.len()])));
    }
    let mut triangles = Vec::with_capacity(2 * mesh.n_faces());
    for id in mesh.face_ids() {
        match *mesh.face(id) {
            [a, b, c] => triangles.push([a, b, c]),
            [a, b, c, d] => {
                let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
                let cost = |way: usize| {
                    let folds = ways[way].iter().filter(|t| {
                        let [p, q, r] = t.map(|v| sphere[v]);
                        !is_positive(p, q, r)
                    });
                    let [p, q] = [ways[way][0][0], ways[way][0][2]].map(|v| mesh.position(v));
                    (folds.count(), p.distance_squared(q))
                };
                let [first, second] = [cost(0), cost(1)];
                let better = usize::from(second < first);
                let diagonal = |way: usize| key(ways[way][0][0], ways[way][0][2]);
                let way = [better, 1 - better]
                    .into_iter()
                    .find(|&way| joined.insert(diagonal(way)));
                triangles.extend(ways[way.ok_or(CoverError::Doubled { face: id })?]);
            }
            ref corners => {
                return Err(CoverError::Corners {
                    face: id,
                    n_corners: corners.len(),
                });
            }
        }
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::CancelToken;
    use crate::random::Random;
    use crate::sphere::quad_sphere;

    /// A quad sphere some of whose points are thrown about.
    fn spoiled(seed: u64, share: f64, reach: f64) -> (PolygonMesh, Vec<DVec3>) {
        let mesh = quad_sphere([9, 9, 9]);
        let mut random = Random::new(seed);
        let points = mesh.positions().iter().map(|&p| {
            let mut coordinate = || random.unit() * 2.0 - 1.0;
            let step = DVec3::new(coordinate(), coordinate(), coordinate()) * reach;
            if random.unit() < share { p + step } else { p }
        });
        let points = points.collect();
        (mesh, points)
    }

    fn run(mesh: &PolygonMesh, points: &[DVec3]) -> Result<Covered, CoverError> {
        cover(mesh, points, &Progress::none())
    }

    #[test]
    fn what_is_a_cover_stays_as_it_is() {
        let mesh = quad_sphere([5, 6, 7]);
        let covered = run(&mesh, mesh.positions()).unwrap();
        assert_eq!(covered.report, CoverReport::default());
        for (p, q) in covered.sphere.iter().zip(mesh.positions()) {
            assert!(p.distance(*q) < 1e-15);
        }
    }

    #[test]
    fn folds_are_repaired_and_the_rest_stays() {
        for seed in 0..20 {
            let (mesh, points) = spoiled(seed, 0.03, 0.4);
            let covered = run(&mesh, &points).unwrap();
            assert_eq!(check_cover(&mesh, &covered.sphere), Ok(()));
            assert!(covered.report.n_folds > 0);
            let stayed = points.iter().zip(&covered.sphere);
            let n_stayed = stayed.filter(|(p, q)| p.normalize_or_zero() == **q).count();
            assert!(2 * n_stayed > points.len(), "{n_stayed}");
        }
    }

    #[test]
    fn few_vertices_are_left_away_from_their_proposals() {
        for seed in 0..20 {
            let (mesh, points) = spoiled(seed, 0.01, 0.4);
            let covered = run(&mesh, &points).unwrap();
            let moved = points.iter().zip(&covered.sphere);
            let n_moved = moved.filter(|(p, q)| p.normalize_or_zero() != **q).count();
            assert!(20 * n_moved < points.len(), "{n_moved} of {}", points.len());
        }
    }

    #[test]
    fn missing_points_are_found() {
        let (mesh, mut points) = spoiled(0, 0.0, 0.0);
        for i in (0..points.len()).step_by(23) {
            points[i] = [DVec3::ZERO, DVec3::NAN][i % 2];
        }
        let covered = run(&mesh, &points).unwrap();
        assert_eq!(check_cover(&mesh, &covered.sphere), Ok(()));
    }

    #[test]
    fn what_cannot_be_covered_is_refused_with_the_reason() {
        let (mesh, _) = spoiled(0, 0.0, 0.0);
        let error = run(&mesh, &vec![DVec3::ZERO; mesh.n_vertices()]).unwrap_err();
        assert!(matches!(error, CoverError::BeyondRepair { .. }), "{error}");
        let faces: Vec<Vec<u32>> = mesh
            .faces()
            .skip(1)
            .map(|f| f.iter().map(|v| v.0).collect())
            .collect();
        let open = PolygonMesh::from_faces(mesh.positions().to_vec(), &faces).unwrap();
        let error = run(&open, mesh.positions()).unwrap_err();
        assert!(matches!(error, CoverError::NotASphere { .. }), "{error}");
        let token = CancelToken::new();
        token.cancel();
        let (mesh, points) = spoiled(1, 0.1, 0.5);
        let error = cover(&mesh, &points, &Progress::silent(token)).unwrap_err();
        assert_eq!(error, CoverError::Cancelled(Cancelled));
    }
}
