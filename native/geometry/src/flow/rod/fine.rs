//! A surface with short edges: long ones are cut in halves until none is longer than wanted.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use glam::DVec3;

use crate::mesh::{HalfedgeMap, Id, TriangleMesh, VertexId};

/// The same surface in more triangles.
pub(super) struct Fine {
    pub mesh: TriangleMesh,
    /// Its sharp edges, on both sides of each.
    pub sharp: HalfedgeMap<bool>,
}

impl Fine {
    /// Cuts the longest edge of all, again and again: it is the longest of both its triangles, so that
    /// angles become no smaller than half of what they were. None where the mesh is not closed.
    pub fn new(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>, longest: f64) -> Option<Self> {
        let mut cutting = Cutting::new(mesh, sharp);
        for [a, b] in edges(mesh) {
            cutting.push(a, b, longest);
        }
        while let Some((_, Reverse([a, b]))) = cutting.queue.pop() {
            cutting.cut([a, b], longest)?;
        }
        let faces = cutting.faces.iter().map(|f| f.map(VertexId)).collect();
        let fine = TriangleMesh::new(cutting.positions, faces).ok()?;
        let is_sharp = |h| {
            let [a, b] = [fine.origin(h).0, fine.target(h).0];
            cutting.sharp.contains(&[a.min(b), a.max(b)])
        };
        let sharp = fine.halfedge_ids().map(is_sharp).collect();
        Some(Self { mesh: fine, sharp })
    }
}

/// Every edge once.
fn edges(mesh: &TriangleMesh) -> impl Iterator<Item = [u32; 2]> {
    mesh.halfedge_ids()
        .map(|h| [mesh.origin(h).0, mesh.target(h).0])
        .filter(|[a, b]| a < b)
}

struct Cutting {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// The face on the left of each side of an edge.
    left: HashMap<[u32; 2], u32>,
    sharp: HashSet<[u32; 2]>,
    /// The edges that are too long, by the bits of their lengths; no edge changes its length.
    queue: BinaryHeap<(u64, Reverse<[u32; 2]>)>,
}

impl Cutting {
    fn new(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>) -> Self {
        let faces: Vec<[u32; 3]> = mesh.faces().iter().map(|f| f.map(|v| v.0)).collect();
        let mut left = HashMap::with_capacity(3 * faces.len());
        for (f, [a, b, c]) in faces.iter().enumerate() {
            for side in [[*a, *b], [*b, *c], [*c, *a]] {
                left.insert(side, f as u32);
            }
        }
        let marked = mesh.halfedge_ids().filter(|&h| sharp[h]);
        let marked = marked.map(|h| {
            let [a, b] = [mesh.origin(h).0, mesh.target(h).0];
            [a.min(b), a.max(b)]
        });
        Self {
            positions: mesh.positions().to_vec(),
            faces,
            left,
            sharp: marked.collect(),
            queue: BinaryHeap::new(),
        }
    }

    fn push(&mut self, a: u32, b: u32, longest: f64) {
        let [p, q] = [a, b].map(|v| self.positions[v as usize]);
        let length = p.distance(q);
        if length > longest {
            self.queue
                .push((length.to_bits(), Reverse([a.min(b), a.max(b)])));
        }
    }

    fn cut(&mut self, [a, b]: [u32; 2], longest: f64) -> Option<()> {
        let sides = [[a, b], [b, a]];
        let [near, far] = sides.map(|side| self.left.get(&side).copied());
        let faces = [near?, far?];
        let middle = self.positions.len() as u32;
        let [p, q] = [a, b].map(|v| self.positions[v as usize]);
        self.positions.push(p.midpoint(q));
        for ([from, to], face) in sides.into_iter().zip(faces) {
            let corners = self.faces[face as usize];
            let top = corners.into_iter().find(|&v| v != from && v != to)?;
            let other = self.faces.len() as u32;
            self.faces[face as usize] = [from, middle, top];
            self.faces.push([middle, to, top]);
            self.left.remove(&[from, to]);
            self.left
                .extend([([from, middle], face), ([middle, top], face)]);
            self.left.extend([
                ([middle, to], other),
                ([to, top], other),
                ([top, middle], other),
            ]);
            self.push(middle, top, longest);
        }
        if self.sharp.remove(&[a.min(b), a.max(b)]) {
            self.sharp.extend([[a, middle], [b, middle]]);
        }
        self.push(a, middle, longest);
        self.push(b, middle, longest);
        Some(())
    }
}

/// How long the edge of a halfedge is.
pub(super) fn length(mesh: &TriangleMesh, [a, b]: [VertexId; 2]) -> f64 {
    mesh.positions()[a.index()].distance(mesh.positions()[b.index()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{sharp_edges, total_area, volume};
    use crate::shapes;

    #[test]
    fn edges_become_short_and_the_surface_and_its_sharp_edges_stay() {
        let mesh = shapes::cuboid(1);
        let sharp = sharp_edges(&mesh, 0.7);
        let fine = Fine::new(&mesh, &sharp, 0.1).unwrap();
        assert!((total_area(&fine.mesh) - total_area(&mesh)).abs() < 1e-9);
        assert!((volume(&fine.mesh) - volume(&mesh)).abs() < 1e-9);
        let all = fine.mesh.halfedge_ids();
        let ends = |h| [fine.mesh.origin(h), fine.mesh.target(h)];
        assert!(all.clone().all(|h| length(&fine.mesh, ends(h)) <= 0.1));
        let marked: f64 = all
            .filter(|&h| fine.sharp[h])
            .map(|h| length(&fine.mesh, ends(h)))
            .sum();
        // Four edges of each length, both sides of each.
        assert!((marked - 8.0 * 2.4).abs() < 1e-9, "{marked}");
    }
}
