//! Point location on a triangulated sphere: a grid of hints, then a walk from face to face.

use glam::DVec3;

use super::{SphereMap, SurfacePoint, triple_product};
use crate::mesh::{FaceId, HalfedgeId, Id, VertexId, VertexMap};

/// A face near each cell of a cube map.
#[derive(Clone, Debug)]
pub struct HintGrid {
    resolution: usize,
    faces: Vec<FaceId>,
}

impl HintGrid {
    /// Puts each face into the cell of its middle; empty cells take the face before them.
    pub fn new(faces: &[[VertexId; 3]], sphere: &VertexMap<DVec3>) -> Self {
        // Two faces per cell: finer grids cost more to fill than the shorter walks give back.
        let resolution = ((faces.len() as f64 / 12.0).sqrt() as usize).clamp(1, 512);
        let mut grid = Self {
            resolution,
            faces: vec![FaceId(u32::MAX); 6 * resolution.pow(2)],
        };
        for (i, f) in faces.iter().enumerate() {
            let cell = grid.cell(sphere[f[0]] + sphere[f[1]] + sphere[f[2]]);
            grid.faces[cell] = FaceId::from_index(i);
        }
        let mut last = FaceId(0);
        for face in &mut grid.faces {
            if face.0 == u32::MAX {
                *face = last;
            }
            last = *face;
        }
        grid
    }

    /// A face near a direction.
    pub fn start(&self, direction: DVec3) -> FaceId {
        self.faces[self.cell(direction)]
    }

    fn cell(&self, direction: DVec3) -> usize {
        let size = direction.abs();
        let axis = size.max_position();
        let [u, v] = [direction[(axis + 1) % 3], direction[(axis + 2) % 3]];
        let scale = size[axis].max(f64::MIN_POSITIVE);
        let index = |t: f64| {
            let share = f64::midpoint(t / scale, 1.0);
            ((share * self.resolution as f64) as usize).min(self.resolution - 1)
        };
        let side = 2 * axis + usize::from(direction[axis] < 0.0);
        (side * self.resolution + index(u)) * self.resolution + index(v)
    }
}

/// Walks from face to face, through the edge that the direction lies farthest beyond.
pub fn walk(map: &SphereMap, direction: DVec3, start: FaceId) -> SurfacePoint {
    let mut face = start;
    let mut came_from = None;
    // A walk visits O(√F) faces; on triangulations that are not Delaunay it can cycle.
    for _ in 0..4 * (map.mesh.n_faces() as f64).sqrt() as usize + 64 {
        let beyond = products(map, direction, face);
        let worst = (0..3).filter(|&i| Some(i) != came_from).min_by(|&i, &j| {
            let length = |i: usize| edge_normal_length(map, face, i);
            (beyond[i] / length(i)).total_cmp(&(beyond[j] / length(j)))
        });
        let worst = worst.expect("two edges are left");
        if beyond[worst] >= 0.0 {
            if beyond.iter().all(|&b| b >= 0.0) {
                return at(face, beyond);
            }
            break;
        }
        let twin = map.mesh.twin(HalfedgeId(face.0 * 3 + worst as u32));
        let twin = twin.expect("a sphere map has no border");
        face = twin.face();
        came_from = Some(twin.corner());
    }
    scan(map, direction)
}

/// Looks at every face: the one in which the smallest weight is largest.
fn scan(map: &SphereMap, direction: DVec3) -> SurfacePoint {
    let smallest = |face: FaceId| {
        let [a, b, c] = map.sphere_triangle(face);
        let seen = (a + b + c).dot(direction) > 0.0;
        let products = products(map, direction, face);
        let total: f64 = products.iter().sum();
        let least = products.into_iter().fold(f64::INFINITY, f64::min);
        if seen && total > 0.0 {
            least / total
        } else {
            f64::NEG_INFINITY
        }
    };
    let best = map.mesh.face_ids().map(|face| (smallest(face), face));
    let (_, face) = best
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .expect("a sphere map has faces");
    at(face, products(map, direction, face))
}

/// For each edge i → i + 1 of a face, the triple product of its ends and the direction: positive
/// inside. The product of edge i is the unscaled weight of corner i + 2.
fn products(map: &SphereMap, direction: DVec3, face: FaceId) -> [f64; 3] {
    let [a, b, c] = map.sphere_triangle(face);
    [
        triple_product(a, b, direction),
        triple_product(b, c, direction),
        triple_product(c, a, direction),
    ]
}

fn edge_normal_length(map: &SphereMap, face: FaceId, edge: usize) -> f64 {
    let s = map.sphere_triangle(face);
    s[edge]
        .cross(s[(edge + 1) % 3])
        .length()
        .max(f64::MIN_POSITIVE)
}

fn at(face: FaceId, [ab, bc, ca]: [f64; 3]) -> SurfacePoint {
    let weights = [bc, ca, ab].map(|w| w.max(0.0));
    let total: f64 = weights.iter().sum();
    if total > 0.0 {
        return SurfacePoint {
            face,
            weights: weights.map(|w| w / total),
        };
    }
    SurfacePoint {
        face,
        weights: [1.0 / 3.0; 3],
    }
}
