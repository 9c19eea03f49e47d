//! A mesh with everything that more than one figure needs.

use glam::DVec3;

use crate::measure::{PolygonEdges, area_vector, cut_polygon};
use crate::mesh::{Id, PolygonMesh, VertexId, bounds};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::random::Random;

/// A polygon mesh, its edges, its triangles and their tree.
pub struct Surface<'a> {
    pub mesh: &'a PolygonMesh,
    pub edges: PolygonEdges,
    pub edge_lengths: Vec<f64>,
    pub triangles: Vec<[VertexId; 3]>,
    /// Normals as long as the area.
    pub area_vectors: Vec<DVec3>,
    pub area: f64,
    pub tree: Bvh,
    /// The positions of the vertices in use.
    pub used: Vec<DVec3>,
    /// The bounding box of the vertices in use.
    pub bounds: [DVec3; 2],
}

/// A point of a surface.
#[derive(Clone, Copy)]
pub struct Sample {
    pub position: DVec3,
    pub triangle: u32,
}

impl<'a> Surface<'a> {
    /// None if no face has an area.
    pub fn new(mesh: &'a PolygonMesh, progress: &Progress) -> Result<Option<Self>, Cancelled> {
        progress.at(0.0)?;
        let mut triangles = Vec::with_capacity(mesh.corners().len());
        for face in mesh.faces() {
            cut_polygon(mesh, face, &mut triangles);
        }
        progress.check()?;
        let corners: Vec<[DVec3; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| mesh.position(v)))
            .collect();
        progress.check()?;
        let area_vectors: Vec<DVec3> = corners.iter().map(|&t| area_vector(t)).collect();
        progress.check()?;
        let area: f64 = area_vectors.iter().map(|a| a.length()).sum();
        if area <= 0.0 || !area.is_finite() {
            return Ok(None);
        }
        progress.at(0.3)?;
        let edges = PolygonEdges::new(mesh, progress)?;
        progress.at(0.6)?;
        let length = |[a, b]: &[VertexId; 2]| mesh.position(*a).distance(mesh.position(*b));
        let edge_lengths = edges.ends.iter().map(length).collect();
        progress.check()?;
        let used = used_positions(mesh);
        progress.check()?;
        Ok(Some(Self {
            mesh,
            edge_lengths,
            edges,
            area_vectors,
            area,
            tree: Bvh::build(&corners, progress)?,
            bounds: bounds(&used),
            used,
            triangles,
        }))
    }

    /// The length of the diagonal of the bounding box.
    pub fn diagonal(&self) -> f64 {
        self.bounds[0].distance(self.bounds[1])
    }

    /// The unit normal of a triangle; zero without area.
    pub fn normal(&self, triangle: usize) -> DVec3 {
        self.area_vectors[triangle].normalize_or_zero()
    }

    /// `n` points spread evenly by area: one at random in each n-th of the running area.
    pub fn sample(&self, n: usize, seed: u64) -> Vec<Sample> {
        let mut random = Random::new(seed);
        let areas = self.area_vectors.iter().map(|a| a.length());
        let running: Vec<f64> = areas
            .scan(0.0, |sum, area| {
                *sum += area;
                Some(*sum)
            })
            .collect();
        let mut triangle = 0;
        let take = |i| {
            let at = (i as f64 + random.unit()) / n as f64 * self.area;
            while running[triangle] <= at && triangle + 1 < running.len() {
                triangle += 1;
            }
            let [u, v] = [random.unit(), random.unit()];
            let [u, v] = if u + v > 1.0 {
                [1.0 - u, 1.0 - v]
            } else {
                [u, v]
            };
            let [a, b, c] = self.triangles[triangle].map(|v| self.mesh.position(v));
            let position = a + (b - a) * u + (c - a) * v;
            Sample {
                position,
                triangle: triangle as u32,
            }
        };
        (0..n).map(take).collect()
    }
}

fn used_positions(mesh: &PolygonMesh) -> Vec<DVec3> {
    let mut is_used = vec![false; mesh.n_vertices()];
    for v in mesh.corners() {
        is_used[v.index()] = true;
    }
    let all = mesh.positions().iter().zip(is_used);
    all.filter(|(_, used)| *used).map(|(&p, _)| p).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(mesh: &PolygonMesh) -> Surface<'_> {
        Surface::new(mesh, &Progress::none()).unwrap().unwrap()
    }

    #[test]
    fn samples_are_even_by_area_and_skip_what_has_none() {
        let positions = [0.0, 1.0, 4.0].map(|x| DVec3::X * x);
        let positions: Vec<_> = positions.into_iter().chain([DVec3::Y]).collect();
        let faces = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [3, 3, 1]];
        let mesh = PolygonMesh::from_faces(positions, &faces).unwrap();
        let samples = surface(&mesh).sample(400, 1);
        let count = |t| samples.iter().filter(|s| s.triangle == t).count();
        assert_eq!([0, 1, 2, 3].map(count), [0, 100, 300, 0]);
    }
}
