//! A polygon around an edge of the grid, cut into triangles that stay in the wedges around it.

use glam::DVec3;

use crate::mesh::{Id, VertexId};

/// Volumes below this share of a cell count as none: far more than rounding.
const FLAT: f64 = 1e-9;

/// The vertices of the four cells around an edge, and points on the faces between one and the next.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    pub vertices: [VertexId; 4],
    pub points: [Option<VertexId>; 4],
}

impl Ring {
    /// Triangles from all sides of the polygon to a point of the edge.
    pub fn fan(&self, hub: VertexId) -> Vec<[VertexId; 3]> {
        let mut ring = Vec::with_capacity(8);
        for i in 0..4 {
            ring.push(self.vertices[i]);
            ring.extend(self.points[i]);
        }
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(&a, &b)| [hub, a, b]).collect()
    }
}

/// Two triangles, where they stay in the wedges: cut along the diagonal whose triangles look more
/// along the normal.
pub fn cut(
    ring: &Ring,
    (ends, normal): ([DVec3; 2], DVec3),
    positions: &[DVec3],
) -> Option<[[VertexId; 3]; 2]> {
    if ring.points.iter().any(Option::is_some) {
        return None;
    }
    let [a, b, c, d] = ring.vertices;
    let at = |v: VertexId| positions[v.index()];
    let off = |faces: &[[VertexId; 3]; 2]| {
        let off = |face: &[VertexId; 3]| {
            let [p, q, r] = face.map(at);
            1.0 - (q - p).cross(r - p).normalize_or_zero().dot(normal)
        };
        off(&faces[0]).max(off(&faces[1]))
    };
    let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
    let stay = |faces: &&[[VertexId; 3]; 2]| {
        // Along a diagonal a c with b on one side: faces a b c and a c d, or the other way round.
        let [[p, q, r], [_, _, s]] = faces.map(|face| face.map(at));
        stays(ends, [p, q, r, s]) || stays(ends, [r, s, p, q])
    };
    let fit = ways.iter().filter(stay);
    fit.min_by(|x, y| off(x).total_cmp(&off(y))).copied()
}

/// Whether the triangles a b c and a c d lie in the wedges around an edge, which passes the second.
fn stays(ends: [DVec3; 2], [a, b, c, d]: [DVec3; 4]) -> bool {
    passes([a, c], [ends[0], ends[1], b]) && passes(ends, [a, c, d])
}

/// Whether a segment passes the inside of a triangle.
fn passes([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let [above, below] = [volume(a, b, c, p), volume(a, b, c, q)];
    if above.min(below) > -FLAT || above.max(below) < FLAT {
        return false;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    around.iter().all(|&v| v > FLAT) || around.iter().all(|&v| v < -FLAT)
}

fn volume(u: DVec3, v: DVec3, w: DVec3, x: DVec3) -> f64 {
    (v - u).cross(w - u).dot(x - u)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDS: [DVec3; 2] = [DVec3::ZERO, DVec3::Z];

    fn cut_of(corners: [[f64; 3]; 4]) -> Option<[[u32; 3]; 2]> {
        let positions = corners.map(DVec3::from_array);
        let ring = Ring {
            vertices: [0, 1, 2, 3].map(VertexId),
            points: [None; 4],
        };
        let faces = cut(&ring, (ENDS, DVec3::Z), &positions)?;
        Some(faces.map(|face| face.map(|v| v.0)))
    }

    #[test]
    fn a_flat_polygon_is_cut_in_two() {
        let flat = [
            [0.5, 0.5, 0.5],
            [-0.5, 0.4, 0.5],
            [-0.5, -0.5, 0.5],
            [0.4, -0.5, 0.5],
        ];
        assert!(cut_of(flat).is_some());
    }

    #[test]
    fn a_dart_is_cut_through_its_inner_corner_alone() {
        // Corner 1 lies near the edge, on its side of the line from corner 0 to corner 2.
        let dart = [
            [0.1, 0.9, 0.5],
            [-0.05, 0.08, 0.5],
            [-0.9, -0.1, 0.5],
            [0.9, -0.9, 0.5],
        ];
        assert_eq!(cut_of(dart), Some([[1, 2, 3], [1, 3, 0]]));
    }

    #[test]
    fn a_polygon_that_leaves_the_edge_is_not_cut() {
        let steep = [
            [0.5, 0.5, 0.9],
            [-0.5, 0.4, 0.1],
            [-0.4, -0.5, 0.9],
            [0.5, -0.5, 0.1],
        ];
        // Along both diagonals the edge is met at its ends' heights or within: raise it all.
        let raised = steep.map(|[x, y, z]| [x, y, z + 1.0]);
        assert!(cut_of(steep).is_some());
        assert!(cut_of(raised).is_none());
    }

    #[test]
    fn a_fan_has_a_triangle_for_every_side() {
        let ring = Ring {
            vertices: [0, 1, 2, 3].map(VertexId),
            points: [None, Some(VertexId(4)), None, None],
        };
        let fan = ring.fan(VertexId(5));
        assert_eq!(fan.len(), 5);
        assert!(fan.contains(&[5, 1, 4].map(VertexId)));
    }
}
