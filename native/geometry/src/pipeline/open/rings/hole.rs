//! Quads that go together so that a border is where they were.

use std::collections::BTreeMap;

use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};

/// Quads that are added to make a ring straight are at most so many times those of the cap, and so
/// many more: of more the surface around would be drawn together.
const MOST_GROWTH: usize = 2;
const MORE: usize = 6;
/// Quads that go together.
pub struct Hole<'a> {
    mesh: &'a PolygonMesh,
    at: &'a [Vec<FaceId>],
    /// Which quads they are.
    pub is_in: Vec<bool>,
    n: usize,
}

impl<'a> Hole<'a> {
    /// The largest piece of some quads.
    pub fn new(mesh: &'a PolygonMesh, at: &'a [Vec<FaceId>], own: &[usize]) -> Self {
        let mut hole = Self {
            mesh,
            at,
            is_in: vec![false; mesh.n_faces()],
            n: 0,
        };
        let mut is_own = vec![false; mesh.n_faces()];
        for &face in own {
            is_own[face] = true;
        }
        let largest = hole
            .pieces(own, |f| is_own[f])
            .into_iter()
            .max_by_key(Vec::len);
        for face in largest.into_iter().flatten() {
            hole.add(face);
        }
        hole
    }

    pub fn add(&mut self, face: usize) {
        self.n += usize::from(!std::mem::replace(&mut self.is_in[face], true));
    }

    /// What of some faces hangs together over edges.
    fn pieces(&self, of: &[usize], is_one: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut is_seen = vec![false; self.mesh.n_faces()];
        let mut pieces = Vec::new();
        for &start in of {
            let mut piece = Vec::new();
            let mut open = vec![start];
            while let Some(face) = open.pop() {
                if std::mem::replace(&mut is_seen[face], true) {
                    continue;
                }
                piece.push(face);
                open.extend(
                    self.beyond(face)
                        .into_iter()
                        .flatten()
                        .filter(|&f| is_one(f)),
                );
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        pieces
    }

    /// The faces beyond the sides of one.
    fn beyond(&self, face: usize) -> Vec<Option<usize>> {
        let corners = self.mesh.face(FaceId::from_index(face));
        let next = corners.iter().cycle().skip(1);
        let sides = corners.iter().zip(next);
        let other = |(a, b): (&VertexId, &VertexId)| {
            let mut there = self.at[a.index()].iter().map(|f| f.index());
            there.find(|&f| f != face && self.at[b.index()].iter().any(|g| g.index() == f))
        };
        sides.map(other).collect()
    }

    /// Adds quads until its rim is one simple ring, and none beyond has two sides on it as far as there
    /// is room; or why it cannot be.
    pub fn grow(&mut self, is_free: impl Fn(usize) -> bool) -> Result<(), String> {
        let n_most = MOST_GROWTH * self.n + MORE;
        loop {
            let rim = self.rim();
            let pinched = rim.iter().find(|&&v| self.n_ends(v) > 2);
            let more: Vec<usize> = if let Some(v) = pinched {
                let there = self.at[v.index()].iter().map(|f| f.index());
                there.filter(|&f| !self.is_in[f]).collect()
            } else if let Some(inside) = self.enclosed() {
                inside
            } else if self.n < n_most {
                let between = |&v: &VertexId| {
                    let mut out = self.at[v.index()]
                        .iter()
                        .map(|f| f.index())
                        .filter(|&f| !self.is_in[f]);
                    let first = out.next()?;
                    (out.next().is_none() && is_free(first)).then_some(first)
                };
                rim.iter().find_map(between).into_iter().collect()
            } else {
                Vec::new()
            };
            if more.is_empty() {
                return Ok(());
            }
            if let Some(face) = more.iter().find(|&&f| !is_free(f)) {
                return Err(format!("there is no room for a ring at face {face}"));
            }
            for face in more {
                self.add(face);
            }
        }
    }

    /// The vertices on its rim, in order of their numbers.
    fn rim(&self) -> Vec<VertexId> {
        let inside = (0..self.is_in.len()).filter(|&f| self.is_in[f]);
        let corners = inside.flat_map(|f| self.mesh.face(FaceId::from_index(f)));
        let is_rim = |v: &&VertexId| self.at[v.index()].iter().any(|f| !self.is_in[f.index()]);
        let mut rim: Vec<VertexId> = corners.filter(is_rim).copied().collect();
        rim.sort_unstable();
        rim.dedup();
        rim
    }

    /// How many edges of the rim meet at a vertex.
    fn n_ends(&self, v: VertexId) -> usize {
        let mut ends: Vec<(VertexId, bool)> = Vec::new();
        for face in &self.at[v.index()] {
            let corners = self.mesh.face(*face);
            let i = corners.iter().position(|&u| u == v).unwrap_or(0);
            let n = corners.len();
            for u in [corners[(i + 1) % n], corners[(i + n - 1) % n]] {
                ends.push((u, self.is_in[face.index()]));
            }
        }
        ends.sort_unstable();
        ends.chunk_by(|a, b| a.0 == b.0)
            .filter(|sides| sides.iter().any(|s| s.1) && sides.iter().any(|s| !s.1))
            .count()
    }

    /// Faces that it goes all round, the smaller pieces of what is not in it.
    fn enclosed(&self) -> Option<Vec<usize>> {
        let out: Vec<usize> = (0..self.is_in.len()).filter(|&f| !self.is_in[f]).collect();
        let mut pieces = self.pieces(&out, |f| !self.is_in[f]);
        pieces.sort_by_key(Vec::len);
        pieces.pop();
        (!pieces.is_empty()).then(|| pieces.concat())
    }

    /// The vertices round it, it on the left.
    pub fn ring(&self) -> Result<Vec<VertexId>, String> {
        let mut ahead = BTreeMap::new();
        for face in (0..self.is_in.len()).filter(|&f| self.is_in[f]) {
            let corners = self.mesh.face(FaceId::from_index(face));
            for (i, beyond) in self.beyond(face).into_iter().enumerate() {
                if beyond.is_none_or(|f| !self.is_in[f]) {
                    ahead.insert(corners[i], corners[(i + 1) % corners.len()]);
                }
            }
        }
        let Some((&first, _)) = ahead.first_key_value() else {
            return Err("a ring has no edges".to_owned());
        };
        let mut ring = vec![first];
        while let Some(&next) = ahead.get(&ring[ring.len() - 1]) {
            if next == first || ring.len() > ahead.len() {
                break;
            }
            ring.push(next);
        }
        if ring.len() != ahead.len() {
            return Err(format!(
                "{} edges are round a cap, {} in a row",
                ahead.len(),
                ring.len()
            ));
        }
        Ok(ring)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::measure::angle_between;
    use crate::pipeline::open::mend::around;
    use crate::sphere::quad_sphere;

    /// What goes of a ball of quads where some quads at a corner of four are a cap.
    fn hole_of(
        n_own: usize,
        is_free: impl Fn(usize) -> bool,
    ) -> Result<(usize, Vec<VertexId>), String> {
        let mesh = quad_sphere([8, 8, 8]);
        let at = around(&mesh);
        // The middle of a side.
        let v = at.iter().enumerate().filter(|(_, faces)| faces.len() == 4);
        let off = |v: &usize| angle_between(mesh.positions()[*v], DVec3::Z);
        let v = v
            .map(|(v, _)| v)
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap();
        let own: Vec<usize> = at[v].iter().take(n_own).map(|f| f.index()).collect();
        let mut hole = Hole::new(&mesh, &at, &own);
        hole.grow(is_free)?;
        Ok((hole.n, hole.ring()?))
    }

    #[test]
    fn a_hole_grows_until_no_quad_has_two_sides_on_its_ring() {
        for (n_own, n_gone, n_round) in [(1, 1, 4), (3, 4, 8), (4, 4, 8)] {
            let (n, ring) = hole_of(n_own, |_| true).unwrap();
            assert_eq!((n, ring.len()), (n_gone, n_round), "{n_own}");
        }
    }

    #[test]
    fn where_there_is_no_room_a_ring_keeps_its_bends() {
        let (n, ring) = hole_of(3, |_| false).unwrap();
        assert_eq!((n, ring.len()), (3, 8));
    }
}
