//! Brings the two borders of a cut to as many edges: edges of the one that has fewer are cut in three.
//!
//! ```text
//! d ─────────── c      d ─────────── c
//! │             │      │ ╲         ╱ │
//! │             │  →   │   g ─── h   │      two edges more; all stays quads
//! │             │      │  ╱       ╲  │
//! a ─────────── b      a ── e ── f ─ b
//! ```

use glam::DVec3;

use super::Opening;
use super::rings::even_places;
use super::weld::{loops, two_along};
use crate::deform::Deformed;
use crate::mesh::{PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// How far inside the new vertices are, as a share of the quad.
const DEPTH: f64 = 0.4;

impl Opening {
    /// Quads with equally many edges along both borders of every cut, where each has two; an odd
    /// difference stays.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn leveled(
        &self,
        opened: Deformed,
        progress: &Progress<'_>,
    ) -> Result<Deformed, Cancelled> {
        if self.cuts.is_empty() {
            return Ok(opened);
        }
        let all = loops(&opened.mesh, progress)?;
        let mut longer = Longer::new(&opened);
        for cut in &self.cuts {
            let Some(twins) = two_along(&opened.mesh, &all, cut) else {
                continue;
            };
            let [one, other] = twins.each_ref().map(Vec::len);
            let short = &twins[usize::from(one > other)];
            let ring = longer.cut_in_three(short, one.abs_diff(other) / 2);
            if one != other {
                let now: Vec<DVec3> = ring.iter().map(|&v| longer.at(v)).collect();
                for (v, place) in ring.into_iter().zip(even_places(cut, &now)) {
                    longer.positions[v as usize] = place;
                }
            }
        }
        Ok(longer.done(opened))
    }
}

/// Quads some of whose edges are cut in three.
struct Longer {
    faces: Vec<Vec<u32>>,
    positions: Vec<DVec3>,
    sphere: Vec<DVec3>,
    n_before: usize,
}

impl Longer {
    fn new(opened: &Deformed) -> Self {
        let mesh = &opened.mesh;
        let corners = |face: &[VertexId]| face.iter().map(|v| v.0).collect();
        Self {
            faces: mesh.faces().map(corners).collect(),
            positions: mesh.positions().to_vec(),
            sphere: opened.sphere.clone(),
            n_before: mesh.n_vertices(),
        }
    }

    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    fn add(&mut self, place: DVec3, beside: u32) -> u32 {
        self.positions.push(place);
        self.sphere.push(self.sphere[beside as usize]);
        self.positions.len() as u32 - 1
    }

    /// Cuts so many edges of a ring, evenly along it; the ring with the new vertices.
    fn cut_in_three(&mut self, ring: &[VertexId], n_cuts: usize) -> Vec<u32> {
        let n = ring.len();
        let n_cuts = n_cuts.min(n);
        let mut is_cut = vec![false; n];
        for i in 0..n_cuts {
            is_cut[(2 * i + 1) * n / (2 * n_cuts)] = true;
        }
        let mut longer = Vec::with_capacity(n + 2 * n_cuts);
        for (i, is_cut) in is_cut.into_iter().enumerate() {
            let [a, b] = [ring[i].0, ring[(i + 1) % n].0];
            longer.push(a);
            if is_cut {
                longer.extend(self.cut_edge([a, b]).into_iter().flatten());
            }
        }
        longer
    }

    /// Cuts an edge of a border, and its quad in four; the new vertices from the first end on.
    fn cut_edge(&mut self, [a, b]: [u32; 2]) -> Option<[u32; 2]> {
        let side = |face: &Vec<u32>| {
            let ends = |i: usize| [face[i], face[(i + 1) % face.len()]];
            (0..face.len()).find(|&i| ends(i) == [a, b] || ends(i) == [b, a])
        };
        let (face, i) = (self.faces.iter().enumerate())
            .find_map(|(f, face)| Some((f, side(face).filter(|_| face.len() == 4)?)))?;
        let [p, q, r, s] = [0, 1, 2, 3].map(|k| self.faces[face][(i + k) % 4]);
        let along = |from: u32, to: u32, share: f64| self.at(from).lerp(self.at(to), share);
        let inner = |share: f64| along(p, q, share).lerp(along(s, r, share), DEPTH);
        let places = [1.0 / 3.0, 2.0 / 3.0];
        let [[e, g], [f, h]] = places.map(|share| [along(p, q, share), inner(share)]);
        let [e, g] = [e, g].map(|place| self.add(place, p));
        let [f, h] = [f, h].map(|place| self.add(place, q));
        self.faces[face] = vec![p, e, g, s];
        self.faces
            .extend([vec![e, f, h, g], vec![f, q, r, h], vec![g, h, r, s]]);
        Some(if p == a { [e, f] } else { [f, e] })
    }

    fn done(self, opened: Deformed) -> Deformed {
        if self.positions.len() == self.n_before {
            return opened;
        }
        let mesh = PolygonMesh::from_faces(self.positions, &self.faces);
        let mesh = mesh.expect("quads cut in four are a mesh");
        let positions = mesh.positions().to_vec();
        // An edge that was cut is none any more.
        let mut sides: Vec<[VertexId; 2]> = Vec::new();
        for face in mesh.faces() {
            let next = face.iter().cycle().skip(1);
            sides.extend(face.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)]));
        }
        sides.sort_unstable();
        let still = |edges: Vec<[VertexId; 2]>| {
            let is_edge = |ends: &[VertexId; 2]| sides.binary_search(ends).is_ok();
            edges.into_iter().filter(is_edge).collect()
        };
        let longer = Deformed {
            mesh,
            sphere: self.sphere,
            features: still(opened.features),
            led: still(opened.led),
            report: opened.report,
        };
        longer.moved(positions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::topology;

    #[test]
    fn edges_of_a_border_cut_in_three_leave_quads_and_the_shape_as_it_was() {
        let points =
            (0..4).flat_map(|y| (0..4).map(move |x| DVec3::new(f64::from(x), f64::from(y), 0.0)));
        let quads = (0..3_u32).flat_map(|y| (0..3).map(move |x| 4 * y + x));
        let quads: Vec<[u32; 4]> = quads.map(|v| [v, v + 1, v + 5, v + 4]).collect();
        let mesh = PolygonMesh::from_faces(points.collect(), &quads).unwrap();
        let sphere = vec![DVec3::Z; 16];
        let quiet = Progress::none();
        let opened = Deformed::in_space(mesh, sphere, vec![[VertexId(0), VertexId(1)]], &quiet);
        let opened = opened.unwrap();
        let ring = loops(&opened.mesh, &quiet).unwrap().remove(0);
        let mut longer = Longer::new(&opened);
        assert_eq!(longer.cut_in_three(&ring, 5).len(), 12 + 2 * 5);
        let done = longer.done(opened);
        let found = topology(&done.mesh, &quiet).unwrap();
        assert_eq!(
            (done.mesh.n_faces(), done.mesh.n_quads()),
            (9 + 3 * 5, 9 + 3 * 5)
        );
        assert_eq!(
            (found.n_borders, found.genus, found.n_components),
            (1, Some(0), 1)
        );
        assert_eq!(done.report.n_inverted, 0);
        assert_eq!(done.sphere.len(), done.mesh.n_vertices());
    }
}
