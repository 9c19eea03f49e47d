//! Room beside lines: vertices next to those that were joined move, where faces are flat or folded.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::joining::Joining;
use super::{Edge, sorted};
use crate::mesh::{FaceId, Id, VertexId};

/// Rounds of moves.
const N_ROUNDS: usize = 10;
/// Faces are left alone whose corners all have a larger sine: 23 degrees.
const FLAT: f64 = 0.4;

/// The surroundings of what was joined.
struct Room {
    /// Vertices that stay: on lines, borders and features.
    bound: BTreeSet<usize>,
    /// Where each face looks, as its surroundings did before.
    normals: BTreeMap<FaceId, DVec3>,
    /// The faces of two rings.
    near: Vec<FaceId>,
}

impl Joining<'_> {
    /// Moves free vertices to the middle of their neighbours, where that makes the flattest corner
    /// around them less flat.
    pub(super) fn make_room(&mut self, features: &[Edge]) {
        let room = self.room(features);
        for _ in 0..N_ROUNDS {
            let flat = room.near.iter().filter(|&&f| self.sine(&room, f) < FLAT);
            let flat: Vec<FaceId> = flat.copied().collect();
            let mut free: Vec<usize> = Vec::new();
            for v in flat.iter().flat_map(|&face| self.mesh.face(face)) {
                let root = self.groups.root(v.index());
                free.extend(Some(root).filter(|root| !room.bound.contains(root)));
            }
            free.sort_unstable();
            free.dedup();
            let moved = free.iter().filter(|&&v| self.relax(&room, v)).count();
            if moved == 0 {
                break;
            }
        }
    }

    fn room(&mut self, features: &[Edge]) -> Room {
        let mesh = self.mesh;
        let mut near: Vec<FaceId> = Vec::new();
        let mut at: BTreeSet<usize> = self.joined.clone();
        for _ in 0..2 {
            near = at.iter().flat_map(|&v| self.faces[v].clone()).collect();
            for v in near.iter().flat_map(|&face| mesh.face(face)) {
                let root = self.groups.root(v.index());
                at.insert(root);
            }
        }
        near.sort_unstable();
        near.dedup();
        let around: BTreeSet<FaceId> = at.iter().flat_map(|&v| self.faces[v].clone()).collect();
        let mut edges: BTreeMap<Edge, usize> = BTreeMap::new();
        let mut normals: BTreeMap<VertexId, DVec3> = BTreeMap::new();
        for &face in &around {
            let corners = mesh.face(face);
            let places: Vec<DVec3> = corners.iter().map(|&v| mesh.position(v)).collect();
            let area = super::area(&places);
            let next = corners.iter().cycle().skip(1);
            for (&a, &b) in corners.iter().zip(next) {
                *edges.entry(sorted([a, b])).or_default() += 1;
                *normals.entry(a).or_default() += area;
            }
        }
        let border = edges.iter().filter(|(_, n)| **n == 1).map(|(edge, _)| edge);
        let mut bound = self.joined.clone();
        for v in border.chain(features).flatten() {
            let root = self.groups.root(v.index());
            bound.insert(root);
        }
        let looks = |&face: &FaceId| {
            let corners = mesh.face(face).iter();
            let normal: DVec3 = corners.map(|v| normals[v].normalize_or_zero()).sum();
            (face, normal.normalize_or_zero())
        };
        Room {
            bound,
            normals: around.iter().map(looks).collect(),
            near,
        }
    }

    /// The least sine of a corner of a face, less than zero if it turns the wrong way.
    fn sine(&mut self, room: &Room, face: FaceId) -> f64 {
        let corners = self.mesh.face(face).iter();
        let roots: Vec<usize> = corners.map(|v| self.groups.root(v.index())).collect();
        let places: Vec<DVec3> = roots.iter().map(|&root| self.places[root]).collect();
        let n = places.len();
        let sine = |i: usize| {
            let [a, b, c] = [i, i + 1, i + 2].map(|i| places[i % n]);
            let sides = [b - a, c - b].map(DVec3::normalize_or_zero);
            sides[0].cross(sides[1]).dot(room.normals[&face])
        };
        (0..n).map(sine).fold(f64::INFINITY, f64::min)
    }

    /// Moves a vertex towards the middle of its neighbours, along the surface, if that is better.
    fn relax(&mut self, room: &Room, v: usize) -> bool {
        let faces = self.faces[v].clone();
        if faces.iter().any(|face| !room.normals.contains_key(face)) {
            return false;
        }
        let (mut middle, mut n_neighbours, mut normal) = (DVec3::ZERO, 0.0, DVec3::ZERO);
        for &face in &faces {
            let corners = self.mesh.face(face).iter();
            let roots: Vec<usize> = corners.map(|c| self.groups.root(c.index())).collect();
            let n = roots.len();
            normal += room.normals[&face];
            for i in (0..n).filter(|&i| roots[i] == v) {
                middle += self.places[roots[(i + 1) % n]] + self.places[roots[(i + n - 1) % n]];
                n_neighbours += 2.0;
            }
        }
        let worst = |joining: &mut Self| {
            let sines = faces.iter().map(|&face| joining.sine(room, face));
            sines.fold(f64::INFINITY, f64::min)
        };
        let (before, place) = (worst(self), self.places[v]);
        let way = middle / f64::max(n_neighbours, 1.0) - place;
        let normal = normal.normalize_or_zero();
        let way = way - normal * way.dot(normal);
        for share in [1.0, 0.5] {
            self.places[v] = place + way * share;
            if worst(self) > before {
                return true;
            }
        }
        self.places[v] = place;
        false
    }
}
