//! Edges at which a surface turns sharply.

use glam::DVec3;

use super::face_normals;
use crate::elementary::cos;
use crate::mesh::{HalfedgeMap, TriangleMesh};

/// The edges at which the normals of the two faces differ by more than `angle` radians, on both
/// sides of each; none for an angle of π or more.
///
/// Borders are not sharp, nor is an edge of a face without area: it has no normal to turn. O(n).
pub fn sharp_edges(mesh: &TriangleMesh, angle: f64) -> HalfedgeMap<bool> {
    let normals = face_normals(mesh);
    let cosine = if angle < std::f64::consts::PI {
        cos(angle)
    } else {
        f64::NEG_INFINITY
    };
    let is_sharp = |h| {
        let Some(twin) = mesh.twin(h) else {
            return false;
        };
        let [m, n] = [normals[h.face()], normals[twin.face()]];
        m != DVec3::ZERO && n != DVec3::ZERO && m.dot(n) < cosine
    };
    mesh.halfedge_ids().map(is_sharp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn a_box_has_twelve_sharp_edges_up_to_a_right_angle() {
        let mesh = shapes::cuboid(1);
        for (degrees, n_edges) in [(40.0, 12), (89.0, 12), (91.0, 0), (180.0, 0), (400.0, 0)] {
            let sharp = sharp_edges(&mesh, f64::to_radians(degrees));
            let n_sides = sharp.iter().filter(|&&is_sharp| is_sharp).count();
            assert_eq!(n_sides, 2 * n_edges, "{degrees}");
        }
    }
}
