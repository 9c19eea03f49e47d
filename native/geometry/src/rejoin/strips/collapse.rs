//! Takes a strip of quads out of a sheet.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::{Leveling, Sides, Strip};
use crate::mesh::{Id, VertexId};
use crate::rejoin::chain::Chain;
use crate::rejoin::{Edge, area, n_turned, sorted};

/// A border turns by so much at a corner: the cosine.
const CORNER: f64 = 0.77;

impl Leveling {
    /// Shrinks each rung of a strip to a point; whether that could be.
    pub(super) fn collapse(&mut self, strip: &Strip) -> bool {
        let sides = self.sides(strip.sheet);
        let holds = self.holds(strip.sheet, &sides);
        let hold = |v: VertexId| holds.get(&v).copied().unwrap_or(0);
        let mut goes: BTreeMap<VertexId, VertexId> = BTreeMap::new();
        let mut moved: BTreeMap<VertexId, DVec3> = BTreeMap::new();
        for &[a, b] in &strip.rungs {
            let [keep, gone] = if hold(b) > hold(a) { [b, a] } else { [a, b] };
            let are_alike = hold(a) == hold(b);
            let is_along = self.features.contains(&[a, b])
                || sides[&[a, b]].len() == 1
                || self.is_on_chain([a, b]);
            if are_alike && (hold(a) == 2 || hold(a) == 1 && !is_along) {
                return false;
            }
            if are_alike {
                moved.insert(
                    keep,
                    self.places[a.index()].midpoint(self.places[b.index()]),
                );
            }
            goes.insert(gone, keep);
        }
        if !self.stays_sound(strip, (&goes, &moved)) {
            return false;
        }
        let named = |v: VertexId| goes.get(&v).copied().unwrap_or(v);
        for (&keep, &place) in &moved {
            self.places[keep.index()] = place;
        }
        let mut gone = strip.faces.clone();
        gone.sort_unstable();
        let faces = self.faces[strip.sheet].iter().enumerate();
        let left = faces.filter(|(f, _)| gone.binary_search(f).is_err());
        self.faces[strip.sheet] = left
            .map(|(_, face)| face.iter().map(|&v| named(v)).collect())
            .collect();
        let features = self.features.iter().map(|edge| sorted(edge.map(named)));
        self.features = features.filter(|[a, b]| a != b).collect();
        for chain in self.chains.iter_mut().flatten() {
            chain.vertices.iter_mut().for_each(|v| *v = named(*v));
            let n_before = chain.vertices.len();
            chain.vertices.dedup();
            if chain.is_closed && chain.vertices.first() == chain.vertices.last() {
                chain.vertices.pop();
            }
            chain.is_changed |= chain.vertices.len() != n_before;
        }
        self.becomes.extend(goes);
        self.is_changed[strip.sheet] = true;
        true
    }

    fn is_on_chain(&self, edge: Edge) -> bool {
        self.chains
            .iter()
            .flatten()
            .any(|chain| chain.edges().contains(&edge))
    }

    /// How much holds each vertex: 1 on a line or border, 2 where these end or turn.
    fn holds(&self, sheet: usize, sides: &Sides) -> BTreeMap<VertexId, u8> {
        let mut lines: BTreeSet<Edge> = BTreeSet::new();
        lines.extend(
            sides
                .iter()
                .filter(|(_, sides)| sides.len() == 1)
                .map(|(&edge, _)| edge),
        );
        lines.extend(
            self.features
                .iter()
                .filter(|edge| sides.contains_key(*edge)),
        );
        let chains = || {
            self.chains
                .iter()
                .flatten()
                .filter(|chain| chain.sheet == sheet)
        };
        lines.extend(chains().flat_map(Chain::edges));
        let mut beside: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for &[a, b] in &lines {
            beside.entry(a).or_default().push(b);
            beside.entry(b).or_default().push(a);
        }
        let mut holds = BTreeMap::new();
        for (v, others) in beside {
            let is_straight = if let [a, b] = others[..] {
                let [a, v, b] = [a, v, b].map(|v| self.places[v.index()]);
                (v - a).normalize_or_zero().dot((b - v).normalize_or_zero()) > CORNER
            } else {
                false
            };
            holds.insert(v, if is_straight { 1 } else { 2 });
        }
        for chain in chains().filter(|chain| !chain.is_closed) {
            for v in [chain.vertices.first(), chain.vertices.last()]
                .into_iter()
                .flatten()
            {
                holds.insert(*v, 2);
            }
        }
        holds
    }

    /// Whether a sheet without a strip is made of faces as good as before.
    fn stays_sound(
        &self,
        strip: &Strip,
        (goes, moved): (&BTreeMap<VertexId, VertexId>, &BTreeMap<VertexId, DVec3>),
    ) -> bool {
        let is_hit = |v: &VertexId| goes.contains_key(v) || moved.contains_key(v);
        let named = |v: VertexId| goes.get(&v).copied().unwrap_or(v);
        let place = |v: VertexId| self.places[v.index()];
        let mut edges: BTreeMap<Edge, usize> = BTreeMap::new();
        let mut corners: BTreeMap<VertexId, [usize; 2]> = BTreeMap::new();
        for (f, face) in self.faces[strip.sheet].iter().enumerate() {
            if strip.faces.contains(&f) {
                continue;
            }
            let new: Vec<VertexId> = face.iter().map(|&v| named(v)).collect();
            for i in 0..4 {
                let edge = sorted([new[i], new[(i + 1) % 4]]);
                let n = edges.entry(edge).or_default();
                *n += 1;
                if edge[0] == edge[1] || *n > 2 || new[i] == new[(i + 2) % 4] {
                    return false;
                }
                corners.entry(new[i]).or_default()[0] += 1;
            }
            if face.iter().any(is_hit) {
                let before: Vec<DVec3> = face.iter().map(|&v| place(v)).collect();
                let to = |v: &VertexId| moved.get(v).copied().unwrap_or_else(|| place(*v));
                let after: Vec<DVec3> = new.iter().map(to).collect();
                let normal = area(&before);
                if n_turned(&after, normal) > n_turned(&before, normal) {
                    return false;
                }
            }
        }
        for v in edges
            .iter()
            .filter(|(_, n)| **n == 1)
            .flat_map(|(edge, _)| *edge)
        {
            corners.entry(v).or_default()[1] += 1;
        }
        // Inside at least three faces meet; a border goes through each vertex once.
        goes.values().all(|v| match corners.get(v) {
            Some(&[n, 0]) => n >= 3,
            Some(&[_, n_border]) => n_border == 2,
            None => false,
        })
    }
}
