//! More triangles: the longest edges are cut in two.

use std::collections::{BinaryHeap, HashMap};

use glam::DVec3;

use crate::mesh::{TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// Cuts the longest edge of a mesh in two, again and again, until it has `n_faces` triangles
/// or one more. The surface stays as it is. O(n log n).
///
/// # Errors
/// [`Cancelled`].
pub fn refine(
    mesh: &TriangleMesh,
    n_faces: usize,
    progress: &Progress,
) -> Result<TriangleMesh, Cancelled> {
    let mut finer = Finer::new(mesh);
    while finer.faces.len() < n_faces {
        if finer.faces.len().is_multiple_of(4096) {
            progress.at(finer.faces.len() as f64 / n_faces as f64)?;
        }
        if !finer.cut_longest() {
            break;
        }
    }
    let finer = TriangleMesh::new(finer.positions, finer.faces);
    Ok(finer.expect("cutting edges in two keeps a surface"))
}

/// A mesh on its way to more triangles.
struct Finer {
    positions: Vec<DVec3>,
    faces: Vec<[VertexId; 3]>,
    /// The face on the left of every edge from one vertex to another.
    left: HashMap<[VertexId; 2], usize>,
    /// Edges by their squared length, as bits of a number that is not negative; some are gone.
    longest: BinaryHeap<(u64, [VertexId; 2])>,
}

impl Finer {
    fn new(mesh: &TriangleMesh) -> Self {
        let mut finer = Self {
            positions: mesh.positions().to_vec(),
            faces: mesh.faces().to_vec(),
            left: HashMap::new(),
            longest: BinaryHeap::new(),
        };
        for face in 0..finer.faces.len() {
            finer.enter(face, finer.faces[face]);
        }
        finer
    }

    fn enter(&mut self, id: usize, face: [VertexId; 3]) {
        self.faces[id] = face;
        for i in 0..3 {
            let [a, b] = [face[i], face[(i + 1) % 3]];
            self.left.insert([a, b], id);
            let [p, q] = [a, b].map(|v| self.positions[v.0 as usize]);
            let length = p.distance_squared(q).to_bits();
            self.longest.push((length, [a.min(b), a.max(b)]));
        }
    }

    /// The third corner of a face.
    fn apex(&self, id: usize, [a, b]: [VertexId; 2]) -> VertexId {
        let others = self.faces[id].into_iter();
        others
            .into_iter()
            .find(|&v| v != a && v != b)
            .expect("a triangle has three corners")
    }

    fn cut_longest(&mut self) -> bool {
        let Some((_, [a, b])) = self.longest.pop() else {
            return false;
        };
        // An edge is there once for each of its sides.
        let sides = [[a, b], [b, a]].map(|ends| (ends, self.left.remove(&ends)));
        let m = VertexId(self.positions.len() as u32);
        if sides.iter().any(|(_, face)| face.is_some()) {
            let [p, q] = [a, b].map(|v| self.positions[v.0 as usize]);
            self.positions.push(p.midpoint(q));
        }
        for ([a, b], face) in sides {
            let Some(face) = face else { continue };
            let apex = self.apex(face, [a, b]);
            let next = self.faces.len();
            self.faces.push([m; 3]);
            self.enter(face, [a, m, apex]);
            self.enter(next, [m, b, apex]);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::total_area;
    use crate::shapes;

    #[test]
    fn a_long_box_gets_even_edges_and_stays_as_it_is() {
        let long = |p: DVec3| p * DVec3::new(40.0, 1.0, 1.0);
        let mesh = shapes::mapped_cube(1, long);
        let finer = refine(&mesh, 400, &Progress::none()).unwrap();
        assert_eq!(finer.n_faces(), 400);
        assert!(finer.is_closed() && finer.euler_number() == 2);
        assert!((total_area(&finer) / total_area(&mesh) - 1.0).abs() < 1e-12);
        let lengths = finer.halfedge_ids().map(|h| {
            let [a, b] = [finer.origin(h), finer.target(h)].map(|v| finer.position(v));
            a.distance(b)
        });
        // Of edges 80 long.
        assert!(lengths.fold(0.0, f64::max) < 11.0);
    }

    #[test]
    fn enough_triangles_stay_as_they_are() {
        let mesh = shapes::sphere(3);
        assert_eq!(refine(&mesh, 10, &Progress::none()).unwrap(), mesh);
    }
}
