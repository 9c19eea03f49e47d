//! A surface with short edges: long ones are cut in halves until none is longer than wanted.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use glam::DVec3;

use crate::measure::area_vector;
use crate::mesh::{HalfedgeMap, Id, TriangleMesh, VertexId};

/// The same surface in more triangles.
pub(super) struct Fine {
    pub mesh: TriangleMesh,
    /// Its sharp edges, on both sides of each.
    pub sharp: HalfedgeMap<bool>,
}

/// Neither triangle of another diagonal is smaller than this share of both.
const LEAST_SHARE: f64 = 0.01;
/// Another diagonal is shorter by this share at least.
const TURNED: f64 = 0.98;
/// More triangles than this are given up.
const MOST_FACES: usize = 400_000;

impl Fine {
    /// Cuts the longest edge, again and again: first the surface's own edges, then those within its
    /// faces, which are turned instead where the other diagonal is shorter. Were all cut by length
    /// alone, a face a thousand times as long as wide would end in a million pieces.
    ///
    /// None where the mesh is not closed or there would be too many triangles.
    pub fn new(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>, longest: f64) -> Option<Self> {
        let mut cutting = Cutting::new(mesh, sharp, longest);
        for edge in edges(mesh) {
            cutting.push(edge, Kind::Own);
        }
        while let Some((_, Reverse(edge))) = cutting.own.pop() {
            cutting.cut(edge, Kind::Own)?;
        }
        while let Some((_, Reverse(edge))) = cutting.within.pop() {
            if cutting.left.contains_key(&edge) && !cutting.turn(edge)? {
                cutting.cut(edge, Kind::Within)?;
            }
            if cutting.faces.len() > MOST_FACES {
                return None;
            }
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

/// Whether an edge is part of one of the surface's or lies within one of its faces.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Own,
    Within,
}

/// Edges that are too long, by the bits of their lengths.
type Queue = BinaryHeap<(u64, Reverse<[u32; 2]>)>;

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
    own: Queue,
    within: Queue,
    longest: f64,
}

impl Cutting {
    fn new(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>, longest: f64) -> Self {
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
            own: BinaryHeap::new(),
            within: BinaryHeap::new(),
            longest,
        }
    }

    fn length(&self, [a, b]: [u32; 2]) -> f64 {
        self.positions[a as usize].distance(self.positions[b as usize])
    }

    fn push(&mut self, [a, b]: [u32; 2], kind: Kind) {
        let length = self.length([a, b]);
        if length > self.longest {
            let queue = match kind {
                Kind::Own => &mut self.own,
                Kind::Within => &mut self.within,
            };
            queue.push((length.to_bits(), Reverse([a.min(b), a.max(b)])));
        }
    }

    /// The faces on both sides of an edge, and the corner of each across from it.
    fn sides(&self, [a, b]: [u32; 2]) -> Option<[(u32, u32); 2]> {
        let side = |side: [u32; 2]| {
            let face = *self.left.get(&side)?;
            let corners = self.faces[face as usize];
            let top = corners.into_iter().find(|v| !side.contains(v))?;
            Some((face, top))
        };
        Some([side([a, b])?, side([b, a])?])
    }

    /// Replaces a face.
    fn set(&mut self, face: u32, corners: [u32; 3]) {
        let [a, b, c] = corners;
        if face as usize == self.faces.len() {
            self.faces.push(corners);
        } else {
            self.faces[face as usize] = corners;
        }
        self.left
            .extend([[a, b], [b, c], [c, a]].map(|side| (side, face)));
    }

    fn cut(&mut self, [a, b]: [u32; 2], kind: Kind) -> Option<()> {
        let faces = self.sides([a, b])?;
        let middle = self.positions.len() as u32;
        let [p, q] = [a, b].map(|v| self.positions[v as usize]);
        self.positions.push(p.midpoint(q));
        for ([from, to], (face, top)) in [[a, b], [b, a]].into_iter().zip(faces) {
            self.left.remove(&[from, to]);
            self.set(face, [from, middle, top]);
            self.set(self.faces.len() as u32, [middle, to, top]);
            self.push([middle, top], Kind::Within);
        }
        if self.sharp.remove(&[a.min(b), a.max(b)]) {
            self.sharp.extend([[a, middle], [b, middle]]);
        }
        self.push([a, middle], kind);
        self.push([middle, b], kind);
        Some(())
    }

    /// Takes the other diagonal of the two triangles at an edge, which lie in a plane, if it is
    /// shorter and both stay whole; false if not.
    fn turn(&mut self, [a, b]: [u32; 2]) -> Option<bool> {
        let [(near, c), (far, d)] = self.sides([a, b])?;
        let area = |corners: [u32; 3]| {
            let [p, q, r] = corners.map(|v| self.positions[v as usize]);
            area_vector([p, q, r])
        };
        let [now, then] = [[[a, b, c], [b, a, d]], [[a, d, c], [d, b, c]]].map(|t| t.map(area));
        let whole = now[0] + now[1];
        let least = LEAST_SHARE * whole.length_squared();
        let is_whole = then.iter().all(|area| area.dot(whole) > least);
        if !is_whole || self.length([c, d]) >= TURNED * self.length([a, b]) {
            return Some(false);
        }
        if self.left.contains_key(&[c, d]) || self.left.contains_key(&[d, c]) {
            return Some(false);
        }
        self.left.remove(&[a, b]);
        self.left.remove(&[b, a]);
        self.set(near, [a, d, c]);
        self.set(far, [d, b, c]);
        self.push([c, d], Kind::Within);
        Some(true)
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
        let all = || fine.mesh.halfedge_ids();
        let ends = |h| [fine.mesh.origin(h), fine.mesh.target(h)];
        assert!(all().all(|h| length(&fine.mesh, ends(h)) <= 0.1));
        let marked: f64 = all()
            .filter(|&h| fine.sharp[h])
            .map(|h| length(&fine.mesh, ends(h)))
            .sum();
        // Four edges of each length, both sides of each.
        assert!((marked - 8.0 * 2.4).abs() < 1e-9, "{marked}");
    }

    #[test]
    fn faces_a_thousand_times_as_long_as_wide_need_few_pieces() {
        let long = shapes::mapped_cube(1, |p| p * DVec3::new(100.0, 0.1, 0.1));
        let sharp = HalfedgeMap::filled(3 * long.n_faces(), false);
        let fine = Fine::new(&long, &sharp, 0.25).unwrap();
        let n = fine.mesh.n_faces();
        assert!(n < 25_000, "{n}");
    }
}
