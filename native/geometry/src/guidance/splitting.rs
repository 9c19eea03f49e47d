//! Triangles that are split, with what their halfedges come from.

use glam::DVec3;

use super::Strength;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId};

const NONE: u32 = u32::MAX;

/// A closed mesh on its way: only ever split, so that old vertices and faces keep their numbers.
pub struct Splitting {
    pub positions: Vec<DVec3>,
    /// The vertex at which each halfedge begins; three of them are a face.
    origins: Vec<u32>,
    twins: Vec<u32>,
    /// A halfedge that leaves each vertex.
    leaving: Vec<u32>,
    /// The halfedge of the old mesh that each is a piece of.
    pub sides: Vec<Option<HalfedgeId>>,
    /// The strokes along each.
    pub on: Vec<Option<Strength>>,
    /// Of each new vertex the corners it was made between, and their shares.
    pub parents: Vec<[(VertexId, f64); 3]>,
    /// Of each old face what it was split into, itself first; empty where it was not.
    pieces: Vec<Vec<u32>>,
    /// The old face of every face.
    wholes: Vec<u32>,
}

pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

pub fn prev(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

impl Splitting {
    pub fn new(mesh: &TriangleMesh) -> Self {
        let halfedges = || mesh.halfedge_ids();
        let mut leaving = vec![NONE; mesh.n_vertices()];
        for h in halfedges() {
            leaving[mesh.origin(h).index()] = h.0;
        }
        Self {
            positions: mesh.positions().to_vec(),
            origins: halfedges().map(|h| mesh.origin(h).0).collect(),
            twins: halfedges()
                .map(|h| mesh.twin(h).map_or(NONE, |twin| twin.0))
                .collect(),
            leaving,
            sides: halfedges().map(Some).collect(),
            on: vec![None; 3 * mesh.n_faces()],
            parents: Vec::new(),
            pieces: vec![Vec::new(); mesh.n_faces()],
            wholes: (0..mesh.n_faces() as u32).collect(),
        }
    }

    pub fn origin(&self, h: u32) -> u32 {
        self.origins[h as usize]
    }

    pub fn target(&self, h: u32) -> u32 {
        self.origin(next(h))
    }

    pub fn position(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    pub fn triangle(&self, face: u32) -> [DVec3; 3] {
        [0, 1, 2].map(|i| self.position(self.origin(3 * face + i)))
    }

    /// The halfedges that leave a vertex.
    pub fn around(&self, v: u32) -> Vec<u32> {
        let first = self.leaving[v as usize];
        let mut around = Vec::with_capacity(8);
        if first == NONE {
            return around;
        }
        around.push(first);
        loop {
            let at = self.twins[prev(around[around.len() - 1]) as usize];
            if at == NONE || at == first {
                return around;
            }
            around.push(at);
        }
    }

    /// What an old face was split into.
    pub fn pieces(&self, whole: u32) -> Vec<u32> {
        let pieces = &self.pieces[whole as usize];
        if pieces.is_empty() {
            vec![whole]
        } else {
            pieces.clone()
        }
    }

    /// Says of an edge that a stroke runs along it.
    pub fn draw(&mut self, h: u32, strength: Strength) {
        let twin = self.twins[h as usize];
        for h in [h, twin].into_iter().filter(|&h| h != NONE) {
            let on = &mut self.on[h as usize];
            *on = Some(on.map_or(strength, |before| before.max(strength)));
        }
    }

    /// Splits an edge where some share of it is passed; the new vertex is at `place`.
    pub fn split_edge(&mut self, h: u32, share: f64, place: DVec3) -> u32 {
        let [a, b] = [self.origin(h), self.target(h)].map(VertexId);
        let m = self.add([(a, 1.0 - share), (b, share), (b, 0.0)], place);
        let twin = self.twins[h as usize];
        let half = self.halve(h, m);
        if twin == NONE {
            self.leaving[m as usize] = half;
            return m;
        }
        let other = self.halve(twin, m);
        self.join(h, other);
        self.join(half, twin);
        self.leaving[m as usize] = half;
        m
    }

    /// Splits a face in three at a place inside it.
    pub fn split_face(&mut self, face: u32, shares: [f64; 3], place: DVec3) -> u32 {
        let h = 3 * face;
        let corners = [0, 1, 2].map(|i| self.origin(h + i));
        let parents = [0, 1, 2].map(|i| (VertexId(corners[i]), shares[i]));
        let m = self.add(parents, place);
        let old = [0, 1, 2].map(|i| (self.twins[h as usize + i], self.sides[h as usize + i]));
        let on = [0, 1, 2].map(|i| self.on[h as usize + i]);
        let second = self.add_face(face);
        let third = self.add_face(face);
        let firsts = [h, 3 * second, 3 * third];
        for i in 0..3 {
            let first = firsts[i];
            self.origins[first as usize] = corners[i];
            self.origins[first as usize + 1] = corners[(i + 1) % 3];
            self.origins[first as usize + 2] = m;
            (self.sides[first as usize], self.on[first as usize]) = (old[i].1, on[i]);
            self.join(first, old[i].0);
            self.leaving[corners[i] as usize] = first;
        }
        for i in 0..3 {
            self.join(firsts[i] + 1, firsts[(i + 1) % 3] + 2);
            for inner in [firsts[i] + 1, firsts[i] + 2] {
                (self.sides[inner as usize], self.on[inner as usize]) = (None, None);
            }
        }
        self.leaving[m as usize] = h + 2;
        m
    }

    /// Cuts the face of a halfedge from a vertex on that to the opposite corner; returns the second
    /// half of it.
    fn halve(&mut self, h: u32, m: u32) -> u32 {
        let n = next(h);
        let [b, c] = [self.origin(n), self.origin(prev(h))];
        let first = 3 * self.add_face(h / 3);
        for (i, v) in [m, b, c].into_iter().enumerate() {
            self.origins[first as usize + i] = v;
        }
        (self.sides[first as usize], self.on[first as usize]) =
            (self.sides[h as usize], self.on[h as usize]);
        (self.sides[first as usize + 1], self.on[first as usize + 1]) =
            (self.sides[n as usize], self.on[n as usize]);
        self.join(first + 1, self.twins[n as usize]);
        (self.sides[n as usize], self.on[n as usize]) = (None, None);
        self.origins[n as usize] = m;
        self.join(n, first + 2);
        self.leaving[b as usize] = first + 1;
        self.leaving[c as usize] = first + 2;
        first
    }

    fn join(&mut self, h: u32, twin: u32) {
        self.twins[h as usize] = twin;
        if twin != NONE {
            self.twins[twin as usize] = h;
        }
    }

    fn add(&mut self, parents: [(VertexId, f64); 3], place: DVec3) -> u32 {
        self.positions.push(place);
        self.leaving.push(NONE);
        self.parents.push(parents);
        self.positions.len() as u32 - 1
    }

    fn add_face(&mut self, of: u32) -> u32 {
        let face = self.wholes.len() as u32;
        let whole = self.wholes[of as usize];
        self.wholes.push(whole);
        let pieces = &mut self.pieces[whole as usize];
        if pieces.is_empty() {
            pieces.push(whole);
        }
        pieces.push(face);
        self.origins.extend([NONE; 3]);
        self.twins.extend([NONE; 3]);
        self.sides.extend([None; 3]);
        self.on.extend([None; 3]);
        face
    }

    /// The faces, by their corners.
    pub fn faces(&self) -> Vec<[VertexId; 3]> {
        let faces = self.origins.chunks_exact(3);
        faces.map(|f| [f[0], f[1], f[2]].map(VertexId)).collect()
    }
}
