//! Quarter turns between the frames of neighbouring faces, and the singularities they make.

use std::f64::consts::FRAC_PI_2;

use super::charts::Charts;
use crate::elementary::argument;
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh, VertexMap};

/// The turns across all halfedges, and the residuals in quarters, from the angles of the crosses
/// in their charts.
///
/// A halfedge's vector is w in the frame of its face and −i^r w in that of its twin's. The angle
/// between the two crosses is split into the nearest number of quarters, −r, and a residual.
pub fn match_crosses(
    mesh: &TriangleMesh,
    charts: &Charts,
    angles: &FaceMap<f64>,
) -> (HalfedgeMap<u8>, HalfedgeMap<f64>) {
    let n_halfedges = 3 * mesh.n_faces();
    let mut turns = HalfedgeMap::filled(n_halfedges, 0);
    let mut residuals = HalfedgeMap::filled(n_halfedges, 0.0);
    for h in mesh.halfedge_ids() {
        let Some(twin) = mesh.twin(h).filter(|twin| h < *twin) else {
            continue;
        };
        let carry = argument(charts.carry(h, twin));
        let between = (angles[twin.face()] - angles[h.face()] - carry) / FRAC_PI_2;
        let quarters = between.round();
        residuals[h] = between - quarters;
        residuals[twin] = quarters - between;
        turns[h] = (-(quarters as i64)).rem_euclid(4) as u8;
        turns[twin] = (4 - turns[h]) % 4;
    }
    (turns, residuals)
}

/// The index of every vertex: around it, the residuals and the missing angle make a whole number
/// of quarters.
pub fn indices(
    mesh: &TriangleMesh,
    charts: &Charts,
    residuals: &HalfedgeMap<f64>,
) -> VertexMap<i32> {
    let mut quarters = VertexMap::filled(mesh.n_vertices(), 4.0);
    for h in mesh.halfedge_ids() {
        quarters[mesh.origin(h)] += residuals[h.prev()] - charts.angle(h) / FRAC_PI_2;
    }
    quarters.iter().map(|q: &f64| q.round() as i32).collect()
}
