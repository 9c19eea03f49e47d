//! The icosahedron with every triangle divided, blown up to the sphere.

use glam::DVec3;

use crate::elementary::{acos, cos, sin};
use crate::mesh::PolygonMesh;

/// The triangles of the icosahedron over the vertices of [`corners`].
const FACES: [[usize; 3]; 20] = [
    [0, 1, 2],
    [0, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
    [0, 5, 1],
    [1, 6, 2],
    [2, 7, 3],
    [3, 8, 4],
    [4, 9, 5],
    [5, 10, 1],
    [6, 7, 2],
    [7, 8, 3],
    [8, 9, 4],
    [9, 10, 5],
    [10, 6, 1],
    [11, 7, 6],
    [11, 8, 7],
    [11, 9, 8],
    [11, 10, 9],
    [11, 6, 10],
];

/// Builds the icosphere of a frequency: every edge of the icosahedron divided into so many parts,
/// 20 f² triangles, 12 vertices of valence 5, all others of valence 6.
///
/// A frequency of 0 is taken as 1. Points on an edge are evenly spaced in angle; inside, the
/// barycentric weights are bent the same way, which keeps the edges within a ratio of 1.3.
pub fn icosphere(frequency: u32) -> PolygonMesh {
    let f = frequency.max(1);
    let grid = Grid::new(f);
    let corners = corners();
    let mut positions = corners.to_vec();
    for &[a, b] in &grid.edges {
        positions.extend((1..f).map(|i| bent([corners[a], corners[b], corners[b]], [f - i, i, 0])));
    }
    let mut faces = Vec::with_capacity(20 * (f as usize).pow(2));
    for (index, corner) in FACES.iter().enumerate() {
        let points = corner.map(|v| corners[v]);
        for j in 1..f {
            positions.extend((1..f - j).map(|k| bent(points, [f - j - k, j, k])));
        }
        for j in 0..f {
            for k in 0..f - j {
                let at = |j, k| grid.vertex(index, j, k);
                faces.push([at(j, k), at(j + 1, k), at(j, k + 1)]);
                if j + k + 2 <= f {
                    faces.push([at(j + 1, k), at(j + 1, k + 1), at(j, k + 1)]);
                }
            }
        }
    }
    PolygonMesh::from_faces(positions, &faces).expect("the indices are those of the grid")
}

/// The frequency whose icosphere comes nearest to a number of faces.
pub fn icosphere_frequency(n_faces: usize) -> u32 {
    let below = ((n_faces as f64 / 20.0).sqrt() as usize).max(1);
    let miss = |f: usize| (20 * f * f).abs_diff(n_faces);
    let nearest = if miss(below + 1) < miss(below) {
        below + 1
    } else {
        below
    };
    nearest as u32
}

/// The twelve vertices of the icosahedron: two poles and two rings of five.
fn corners() -> [DVec3; 12] {
    let height = 0.2f64.sqrt();
    let ring = |i: usize| {
        let lower = i > 5;
        let turn = (i - 1) as f64 + if lower { 0.5 } else { 0.0 };
        let angle = turn * std::f64::consts::TAU / 5.0;
        let z = if lower { -height } else { height };
        DVec3::new(2.0 * height * cos(angle), 2.0 * height * sin(angle), z)
    };
    std::array::from_fn(|i| match i {
        0 => DVec3::Z,
        11 => DVec3::NEG_Z,
        _ => ring(i),
    })
}

/// The point with these whole-number weights between the corners of a face of the icosahedron.
fn bent(corners: [DVec3; 3], weights: [u32; 3]) -> DVec3 {
    // The angle of an edge of the icosahedron.
    let angle = acos(0.2f64.sqrt());
    let total = f64::from(weights.iter().sum::<u32>());
    let bend = |w: u32| sin(angle * f64::from(w) / total);
    let [a, b, c] = corners;
    let [u, v, w] = weights.map(bend);
    (a * u + b * v + c * w).normalize_or(DVec3::Z)
}

/// How the vertices are numbered: corners, then inner points of edges, then inner points of faces.
struct Grid {
    f: u32,
    edges: Vec<[usize; 2]>,
}

impl Grid {
    fn new(f: u32) -> Self {
        let mut edges = Vec::with_capacity(30);
        for face in FACES {
            for i in 0..3 {
                let [a, b] = [face[i], face[(i + 1) % 3]];
                if a < b {
                    edges.push([a, b]);
                }
            }
        }
        Self { f, edges }
    }

    /// The vertex of a face at the weights (f − j − k, j, k) / f.
    fn vertex(&self, face: usize, j: u32, k: u32) -> u32 {
        let [a, b, c] = FACES[face];
        let i = self.f - j - k;
        match [i, j, k] {
            [_, 0, 0] => a as u32,
            [0, _, 0] => b as u32,
            [0, 0, _] => c as u32,
            [_, _, 0] => self.on_edge(a, b, j),
            [0, _, _] => self.on_edge(b, c, k),
            [_, 0, _] => self.on_edge(c, a, i),
            _ => {
                let n_inner = (self.f - 1) * self.f.saturating_sub(2) / 2;
                let rows = (1..j).map(|row| self.f - 1 - row).sum::<u32>();
                12 + 30 * (self.f - 1) + face as u32 * n_inner + rows + k - 1
            }
        }
    }

    /// The inner point of an edge that lies `steps` after `a`.
    fn on_edge(&self, a: usize, b: usize, steps: u32) -> u32 {
        let [low, high] = [a.min(b), a.max(b)];
        let edge = self.edges.iter().position(|&e| e == [low, high]);
        let edge = edge.expect("every edge runs upwards in one of its faces") as u32;
        let steps = if a == low { steps } else { self.f - steps };
        12 + edge * (self.f - 1) + steps - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Id;
    use crate::sphere_map::check_cover;

    #[test]
    fn every_frequency_covers_the_sphere_with_twelve_irregular_vertices() {
        for f in [1, 2, 3, 4, 7, 12] {
            let mesh = icosphere(f);
            assert_eq!(mesh.n_faces(), 20 * (f as usize).pow(2));
            assert_eq!(mesh.n_vertices(), mesh.n_faces() / 2 + 2);
            assert_eq!(check_cover(&mesh, mesh.positions()), Ok(()));
            let mut valence = vec![0; mesh.n_vertices()];
            mesh.corners().iter().for_each(|v| valence[v.index()] += 1);
            assert_eq!(valence.iter().filter(|&&n| n == 5).count(), 12);
            assert!(valence.iter().all(|&n| n == 5 || n == 6));
        }
    }

    #[test]
    fn edges_are_even() {
        let mesh = icosphere(16);
        let lengths = mesh.faces().flat_map(|f| {
            [0, 1, 2].map(|i| mesh.position(f[i]).distance(mesh.position(f[(i + 1) % 3])))
        });
        let [low, high] = lengths.fold([f64::INFINITY, 0.0f64], |[l, h], x| [l.min(x), h.max(x)]);
        assert!(high / low < 1.3, "{}", high / low);
    }

    #[test]
    fn the_nearest_frequency_is_found() {
        let found = [0, 20, 49, 51, 500, 6000].map(icosphere_frequency);
        assert_eq!(found, [1, 1, 1, 2, 5, 17]);
        assert_eq!(icosphere(0), icosphere(1));
    }
}
