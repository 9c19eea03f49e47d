//! Normals of a new mesh: smooth but where those of the scene break.

use glam::DVec3;
use orbflow_geometry::mesh::{PolygonMesh, VertexId};

use crate::carry::is_untouched;
use crate::scene::{Made, Scene};

/// Normals of the scene at one vertex that differ by more, told from two faces, part these: below,
/// faces that look for their places on different triangles part; above, bevels look soft.
const BREAK: f64 = 1.0 / 16.0;

/// The normal of every corner in the scene's space.
///
/// Corners of a vertex that no break parts have the same; those of faces that stayed have their own.
pub fn of_corners(scene: &Scene, made: Made<'_>, set: usize) -> Vec<DVec3> {
    let given = given(scene, made, set);
    let mut parts = Parts::new(given.len());
    for [one, other] in beside(made.mesh) {
        for (a, b) in one.into_iter().zip(other) {
            let breaks = match (given[a], given[b]) {
                (Some(a), Some(b)) => (a - b).abs().max_element() > BREAK,
                _ => false,
            };
            if !breaks {
                parts.join(a, b);
            }
        }
    }
    let mut sums = vec![DVec3::ZERO; given.len()];
    for (corner, normal) in turned(made.mesh).into_iter().enumerate() {
        sums[parts.first(corner)] += normal;
    }
    let normal = |corner: usize| {
        let given = given[corner];
        match given {
            Some(given) if is_untouched(&made.origins.corners[set][corner]) => given,
            _ => {
                let sum = sums[parts.first(corner)];
                sum.normalize_or(given.unwrap_or(DVec3::Z))
            }
        }
    };
    (0..given.len()).map(normal).collect()
}

/// The normals of the scene at every corner, where it has any there.
fn given(scene: &Scene, made: Made<'_>, set: usize) -> Vec<Option<DVec3>> {
    let origins = made.origins.corners[set].iter();
    let normal = origins.map(|origin| {
        let mut sum = DVec3::ZERO;
        for (&corner, share) in origin.corners.iter().zip(origin.weights) {
            let (group, vertex) = scene.at(corner as usize);
            sum += group.normals.as_ref()?[vertex] * share;
        }
        Some(sum.normalize_or_zero()).filter(|sum| *sum != DVec3::ZERO)
    });
    normal.collect()
}

/// The corners of two faces at the ends of an edge that only these two have, end by end.
fn beside(mesh: &PolygonMesh) -> Vec<[[usize; 2]; 2]> {
    let mut sides: Vec<([VertexId; 2], [usize; 2])> = Vec::with_capacity(mesh.corners().len());
    for face in mesh.starts().windows(2) {
        let range = face[0] as usize..face[1] as usize;
        for a in range.clone() {
            let b = if a + 1 == range.end {
                range.start
            } else {
                a + 1
            };
            let ends = [a, b].map(|corner| mesh.corners()[corner]);
            let is_sorted = ends[0] <= ends[1];
            sides.push(if is_sorted {
                (ends, [a, b])
            } else {
                ([ends[1], ends[0]], [b, a])
            });
        }
    }
    sides.sort_unstable();
    let runs = sides.chunk_by(|a, b| a.0 == b.0);
    let pairs = runs.filter(|run| run.len() == 2);
    pairs.map(|run| [run[0].1, run[1].1]).collect()
}

/// The normal of every corner by its two sides, as long as suits their lengths: on a sphere, the sum of
/// those at a vertex is exact.
fn turned(mesh: &PolygonMesh) -> Vec<DVec3> {
    let mut normals = Vec::with_capacity(mesh.corners().len());
    for face in mesh.faces() {
        let n = face.len();
        for i in 0..n {
            let [before, at, after] = [i + n - 1, i, i + 1].map(|i| mesh.position(face[i % n]));
            let (one, other) = (after - at, before - at);
            let lengths = one.length_squared() * other.length_squared();
            let cross = one.cross(other);
            normals.push(if lengths > 0.0 {
                cross / lengths
            } else {
                DVec3::ZERO
            });
        }
    }
    normals
}

/// Corners that belong together.
struct Parts(Vec<usize>);

impl Parts {
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    fn first(&self, mut of: usize) -> usize {
        while self.0[of] != of {
            of = self.0[of];
        }
        of
    }

    fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [a, b].map(|corner| self.first(corner));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_two_faces_at_an_edge_are_paired_end_by_end() {
        let positions = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (0.0, 1.0),
            (1.0, 1.0),
            (2.0, 1.0),
        ];
        let positions = positions.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let mesh = PolygonMesh::from_faces(positions, &[[0, 1, 4, 3], [1, 2, 5, 4]]).unwrap();
        assert_eq!(beside(&mesh), [[[1, 2], [4, 7]]]);
        assert!(turned(&mesh).iter().all(|n| n.distance(DVec3::Z) < 1e-12));
    }

    #[test]
    fn parts_that_are_joined_have_one_first() {
        let mut parts = Parts::new(5);
        parts.join(3, 4);
        parts.join(1, 4);
        let firsts: Vec<_> = (0..5).map(|i| parts.first(i)).collect();
        assert_eq!(firsts, [0, 1, 2, 1, 1]);
    }
}
