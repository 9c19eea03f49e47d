//! The faces of a part while it is grafted.
//!
//! ```text
//! d ─────────── c      d ─────────── c          q   r                q ─ r
//! │             │      │ ╲         ╱ │         ╱     ╲      →       ╱     ╲
//! │             │  →   │   g ─── h   │       p         s          p ─────── s   a quad in front
//! │             │      │  ╱       ╲  │
//! a ─────────── b      a ── e ── f ─ b
//! ```

use std::collections::HashMap;

use glam::DVec3;

use super::{Counts, Grafting, INWARD};
use crate::mesh::{Id, VertexId};

/// How far from an edge the new vertices are, as a share of the quad.
const DEPTH: f64 = 0.4;

/// Faces, and where each of their sides is.
pub struct Sheet {
    pub faces: Vec<Vec<VertexId>>,
    /// The face on the left of each side.
    sides: HashMap<[VertexId; 2], usize>,
    n_at: HashMap<VertexId, usize>,
}

impl Sheet {
    pub fn new(faces: Vec<Vec<VertexId>>) -> Self {
        let mut sheet = Self {
            faces: Vec::with_capacity(faces.len()),
            sides: HashMap::new(),
            n_at: HashMap::new(),
        };
        for face in faces {
            sheet.push(face);
        }
        sheet
    }

    /// How many faces a vertex has.
    pub fn n_at(&self, v: VertexId) -> usize {
        self.n_at.get(&v).copied().unwrap_or(0)
    }

    /// Whether no face has three corners.
    pub fn has_quads(&self) -> bool {
        self.faces.iter().any(|face| face.len() > 3)
    }

    /// Whether two vertices are the ends of an edge.
    pub fn is_edge(&self, [a, b]: [VertexId; 2]) -> bool {
        self.sides.contains_key(&[a, b]) || self.sides.contains_key(&[b, a])
    }

    /// The face on the left of a side.
    pub fn left(&self, side: [VertexId; 2]) -> Option<usize> {
        self.sides.get(&side).copied()
    }

    pub fn push(&mut self, face: Vec<VertexId>) {
        let at = self.faces.len();
        self.faces.push(face);
        self.enter(at);
    }

    pub fn replace(&mut self, at: usize, face: Vec<VertexId>) {
        for side in sides(&self.faces[at]) {
            self.sides.remove(&side);
            *self.n_at.entry(side[0]).or_default() -= 1;
        }
        self.faces[at] = face;
        self.enter(at);
    }

    fn enter(&mut self, at: usize) {
        for side in sides(&self.faces[at]) {
            self.sides.insert(side, at);
            *self.n_at.entry(side[0]).or_default() += 1;
        }
    }

    /// The loops of its border, the faces on the left.
    pub fn loops(&self) -> Vec<Vec<VertexId>> {
        let mut is_seen: HashMap<[VertexId; 2], bool> = HashMap::new();
        let mut loops = Vec::new();
        for side in self.faces.iter().flat_map(|face| sides(face)) {
            let mut border = Vec::new();
            let mut at = side;
            while !self.sides.contains_key(&[at[1], at[0]]) && is_seen.insert(at, true).is_none() {
                border.push(at[0]);
                at = self.next_on_border(at);
            }
            if !border.is_empty() {
                loops.push(border);
            }
        }
        loops
    }

    /// The side of a border that follows one.
    fn next_on_border(&self, [a, b]: [VertexId; 2]) -> [VertexId; 2] {
        let mut side = [a, b];
        loop {
            let face = &self.faces[self.sides[&side]];
            let at = face
                .iter()
                .position(|&v| v == b)
                .expect("an end of a side of the face");
            let next = [b, face[(at + 1) % face.len()]];
            if !self.sides.contains_key(&[next[1], b]) {
                return next;
            }
            side = [next[1], b];
        }
    }
}

/// The sides of a face.
fn sides(face: &[VertexId]) -> impl Iterator<Item = [VertexId; 2]> {
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).map(|(&a, &b)| [a, b])
}

impl Grafting {
    fn place(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }

    /// Cuts a side of the border into some; all vertices along it.
    pub(super) fn cut(
        &mut self,
        sheet: &mut Sheet,
        [a, b]: [VertexId; 2],
        n: usize,
        counts: &mut Counts,
    ) -> Vec<VertexId> {
        let mut along = vec![a, b];
        while along.len() - 1 < n {
            // The longest first; a face of its own for each.
            let length = |i: &usize| self.place(along[*i]).distance(self.place(along[*i + 1]));
            let first = (0..along.len() - 1)
                .rev()
                .max_by(|i, k| length(i).total_cmp(&length(k)));
            let at = first.unwrap_or(0);
            let side = [along[at], along[at + 1]];
            let Some(face) = sheet.left(side) else {
                break;
            };
            let is_quad = sheet.faces[face].len() == 4;
            let new = if is_quad && n + 1 >= along.len() + 2 {
                self.cut_in_three(sheet, face, side)
            } else {
                counts.n_triangles += usize::from(is_quad);
                self.cut_in_two(sheet, face, side)
            };
            let rest = along.split_off(at + 1);
            along.extend(new);
            along.extend(rest);
        }
        along
    }

    fn cut_in_three(
        &mut self,
        sheet: &mut Sheet,
        face: usize,
        [a, b]: [VertexId; 2],
    ) -> Vec<VertexId> {
        let [p, q, r, s] = turned(&sheet.faces[face], a);
        debug_assert_eq!((p, q), (a, b));
        let [low, high] = [[p, q], [s, r]].map(|ends| ends.map(|v| self.place(v)));
        let on = |share: f64| low[0].lerp(low[1], share);
        let inner = |share: f64| on(share).lerp(high[0].lerp(high[1], share), DEPTH);
        let e = self.add(on(1.0 / 3.0), [p, q]);
        let f = self.add(on(2.0 / 3.0), [q, p]);
        let g = self.add(inner(1.0 / 3.0), [p, s]);
        let h = self.add(inner(2.0 / 3.0), [q, r]);
        sheet.replace(face, vec![p, e, g, s]);
        for more in [[e, f, h, g], [f, q, r, h], [g, h, r, s]] {
            sheet.push(more.to_vec());
        }
        vec![e, f]
    }

    /// A triangle at the first half.
    fn cut_in_two(
        &mut self,
        sheet: &mut Sheet,
        face: usize,
        [a, b]: [VertexId; 2],
    ) -> Vec<VertexId> {
        let middle = self.add(self.place(a).midpoint(self.place(b)), [a, b]);
        let mut corners = sheet.faces[face].clone();
        let at = corners.iter().position(|&v| v == a).unwrap_or(0);
        corners.rotate_left(at);
        let last = corners[corners.len() - 1];
        corners[0] = middle;
        sheet.replace(face, corners);
        sheet.push(vec![a, middle, last]);
        vec![middle]
    }

    /// Puts faces in front of some sides of the border, until there is one; its ends.
    pub(super) fn bridged(
        &mut self,
        sheet: &mut Sheet,
        own: &[VertexId],
        counts: &mut Counts,
    ) -> Vec<VertexId> {
        let are_quads = sheet.has_quads();
        let mut left = own.to_vec();
        while left.len() > 2 {
            let n = if are_quads && left.len() > 3 { 3 } else { 2 };
            counts.n_triangles += usize::from(are_quads && n == 2);
            let first = (left.len() - 1 - n) / 2;
            let inside = left[first + 1..first + n].to_vec();
            sheet.push(left[first..=first + n].iter().rev().copied().collect());
            for v in inside {
                self.loose.push(v);
                self.push_inside(sheet, v);
            }
            left.drain(first + 1..first + n);
        }
        left
    }

    /// Moves a vertex towards those beside it that are not on the line.
    fn push_inside(&mut self, sheet: &Sheet, v: VertexId) {
        let (mut sum, mut n) = (DVec3::ZERO, 0.0);
        for face in sheet.around(v) {
            let corners = &sheet.faces[face];
            for &u in corners.iter().filter(|&&u| u != v && sheet.is_edge([u, v])) {
                let is_inner =
                    sheet.sides.contains_key(&[u, v]) && sheet.sides.contains_key(&[v, u]);
                if is_inner {
                    sum += self.place(u);
                    n += 1.0;
                }
            }
        }
        if n > 0.0 {
            self.positions[v.index()] = self.place(v).lerp(sum / n, INWARD);
        }
    }
}

impl Sheet {
    /// The faces at a vertex.
    fn around(&self, v: VertexId) -> Vec<usize> {
        let faces = self.faces.iter().enumerate();
        let at = faces.filter(|(_, face)| face.contains(&v));
        at.map(|(i, _)| i).collect()
    }
}

/// The corners of a quad from one of them on.
fn turned(face: &[VertexId], first: VertexId) -> [VertexId; 4] {
    let at = face.iter().position(|&v| v == first).unwrap_or(0);
    [0, 1, 2, 3].map(|i| face[(at + i) % 4])
}
