//! Every triangle laid flat, from edge lengths that no sliver can spoil.

use glam::DVec2;

use crate::elementary::angle_to;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, TriangleMesh};

/// The triangles of a closed mesh in the plane, each in a chart of its own.
///
/// Halfedge 0 of a face runs along x and the face lies on its left. The lengths are those of the
/// mesh, all longer by the least amount that lets every triangle inequality hold by 2 % of the
/// mean edge (Sharp & Crane 2020): angles stay away from 0 and 180°, degenerate faces included.
#[derive(Clone, Debug)]
pub struct Charts {
    edges: HalfedgeMap<DVec2>,
}

impl Charts {
    /// Lays the triangles of a closed mesh.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let lengths = mollified_lengths(mesh);
        let mut edges = HalfedgeMap::filled(lengths.len(), DVec2::ZERO);
        for face in mesh.face_ids() {
            let [h, next, prev] = halfedges(face);
            let [base, side, other] = [h, next, prev].map(|h| lengths[h]);
            let x = (base * base + other * other - side * side) / (2.0 * base);
            let apex = DVec2::new(x, (other * other - x * x).max(0.0).sqrt());
            edges[h] = DVec2::new(base, 0.0);
            edges[next] = apex - edges[h];
            edges[prev] = -apex;
        }
        Self { edges }
    }

    /// The vector of a halfedge in the chart of its face.
    pub fn edge(&self, h: HalfedgeId) -> DVec2 {
        self.edges[h]
    }

    /// The angle of the corner that a halfedge leaves.
    pub fn angle(&self, h: HalfedgeId) -> f64 {
        angle_to(self.edges[h], -self.edges[h.prev()])
    }

    /// The cotangent of the angle opposite to a halfedge.
    pub fn cotangent(&self, h: HalfedgeId) -> f64 {
        // From the apex to the two ends of the halfedge.
        let [to_origin, to_target] = [self.edges[h.prev()], -self.edges[h.next()]];
        to_origin.dot(to_target) / to_origin.perp_dot(to_target)
    }

    /// The rotation that carries a vector from the chart of a halfedge's face into the chart of
    /// its twin's, unfolding the edge between.
    pub fn carry(&self, h: HalfedgeId, twin: HalfedgeId) -> DVec2 {
        let back = DVec2::new(self.edges[h].x, -self.edges[h].y);
        (-self.edges[twin]).rotate(back).normalize_or(DVec2::X)
    }
}

/// The three halfedges of a face.
pub fn halfedges(face: FaceId) -> [HalfedgeId; 3] {
    [0, 1, 2].map(|i| HalfedgeId(3 * face.0 + i))
}

fn mollified_lengths(mesh: &TriangleMesh) -> HalfedgeMap<f64> {
    let mut lengths: HalfedgeMap<f64> = mesh
        .halfedge_ids()
        .map(|h| {
            // From the smaller end, so that twins agree to the last bit.
            let ends = [mesh.origin(h), mesh.target(h)];
            let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            mesh.position(a).distance(mesh.position(b))
        })
        .collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let excess = |h: HalfedgeId| lengths[h.next()] + lengths[h.prev()] - lengths[h];
    let least = lengths.ids().map(excess).fold(f64::INFINITY, f64::min);
    let add = (0.02 * mean - least).max(0.0);
    for length in lengths.as_mut_slice() {
        *length += add;
    }
    lengths
}
