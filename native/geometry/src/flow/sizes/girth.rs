//! How far it is round a limb: the shortest way round through a place.

use glam::DVec3;

use crate::elementary::sin_cos;
use crate::measure::face_normal;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};

/// In how many directions a section is made, over half a turn: at 4 a limb seems at most 8 %
/// thicker than it is.
const N_WAYS: u32 = 4;

/// The length of the shortest closed normal section through every vertex, where that is shorter
/// than `limit`; else infinity.
///
/// A plane through a face's middle and normal meets the surface in a closed line. Round a limb the
/// shortest of these lines is the girth; over a bump, a ridge or a plate every line is long.
/// A vertex takes the mean of what its faces have to say. Linear in the number of faces, and in the
/// number of triangles that `limit` spans.
pub fn girths(
    mesh: &TriangleMesh,
    limit: f64,
    progress: &Progress,
) -> Result<VertexMap<f64>, Cancelled> {
    let mut girths = FaceMap::filled(mesh.n_faces(), limit);
    for face in mesh.face_ids() {
        if face.0 % 4096 == 0 {
            progress.at(f64::from(face.0) / mesh.n_faces() as f64)?;
        }
        girths[face] = girth(mesh, face, limit);
    }
    let mean = |v| {
        let (mut sum, mut n) = (0.0, 0.0);
        for h in mesh.outgoing(v) {
            sum += girths[h.face()];
            n += 1.0;
        }
        let mean = sum / f64::max(n, 1.0);
        // The mean of many limits may fall short of the limit by its last bits.
        if mean < limit * (1.0 - 1e-9) {
            mean
        } else {
            f64::INFINITY
        }
    };
    Ok(mesh.vertex_ids().map(mean).collect())
}

/// The shortest closed normal section through the middle of a face, `limit` at most.
fn girth(mesh: &TriangleMesh, face: FaceId, limit: f64) -> f64 {
    let normal = face_normal(mesh, face);
    let [a, b, c] = mesh.triangle(face);
    let middle = (a + b + c) / 3.0;
    let (x, y) = normal.any_orthonormal_pair();
    let ways = (0..N_WAYS).map(|i| {
        let (sin, cos) = sin_cos(f64::from(i) * std::f64::consts::PI / f64::from(N_WAYS));
        x * cos + y * sin
    });
    ways.fold(limit, |shortest, across| {
        section(mesh, (face, middle, across), shortest)
    })
}

/// The length of the line in which a plane through a place of a face, at right angles to `across`,
/// meets the surface; `limit` where it is longer.
fn section(mesh: &TriangleMesh, (face, place, across): (FaceId, DVec3, DVec3), limit: f64) -> f64 {
    let height = |h: HalfedgeId| across.dot(mesh.position(mesh.origin(h)) - place);
    // The line leaves a face over the halfedge that climbs through the plane.
    let climbs = |h: &HalfedgeId| height(*h) < 0.0 && height(h.next()) >= 0.0;
    let crossing = |h: HalfedgeId| {
        let [low, high] = [height(h), height(h.next())];
        let ends = [h, h.next()].map(|h| mesh.position(mesh.origin(h)));
        ends[0].lerp(ends[1], low / (low - high))
    };
    let first = mesh.halfedge(face);
    let Some(mut h) = [first, first.next(), first.prev()].into_iter().find(climbs) else {
        return limit;
    };
    let mut at = crossing(h);
    let mut length = 0.0;
    loop {
        let Some(twin) = mesh.twin(h) else {
            return limit;
        };
        // The twin falls; of the two others one climbs.
        h = if climbs(&twin.next()) {
            twin.next()
        } else {
            twin.prev()
        };
        let to = crossing(h);
        length += at.distance(to);
        at = to;
        if length >= limit || !climbs(&h) {
            return limit;
        }
        if h.face() == face {
            return length;
        }
    }
}
