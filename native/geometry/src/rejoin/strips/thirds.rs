//! Edges on lines cut in three, so that all sheets have as many there.
//!
//! ```text
//! d ─────────── c      d ─────────── c
//! │             │      │ ╲         ╱ │
//! │             │  →   │   q ─── r   │     two edges more, and no other edge of the quad is cut;
//! │             │      │  ╱       ╲  │     of a sheet that goes on both quads at the edge
//! a ─────────── b      a ── e ── f ─ b
//! ```
//!
//! In a sheet of other faces edges are cut in two, and its triangles too.

use glam::DVec3;

use super::Leveling;
use crate::mesh::VertexId;
use crate::progress::{Cancelled, Progress};
use crate::rejoin::chain::Chain;
use crate::rejoin::{Edge, Line, sorted};

/// How far from an edge the new vertices are, as a share of the quad.
const DEPTH: f64 = 0.4;
/// All cuts together make this share of the faces more at most. With less room, borders of few edges
/// are parted where they could be joined; with more, a board against a dense knob becomes all cuts.
const MOST_MORE: f64 = 0.5;
/// Or so many faces more: a few quads are joined whatever they meet.
const FEW_MORE: usize = 100;

impl Leveling {
    /// Cuts edges of the chains that have fewer than others of their line, unless that would make
    /// too many faces: then the line is left, and its sheets are parted there.
    pub(super) fn cut_in_thirds(
        &mut self,
        lines: &[Line],
        progress: &Progress<'_>,
    ) -> Result<(), Cancelled> {
        let share = (MOST_MORE * self.n_given as f64) as usize;
        let mut room = share.max(FEW_MORE);
        for (line, of) in lines.iter().enumerate() {
            progress.check()?;
            let n_more = self.n_more(line, of.fewest());
            if n_more > room {
                continue;
            }
            room -= n_more;
            for k in 0..self.chains[line].len() {
                while self.lengthened((line, of.fewest()), k) {}
            }
        }
        Ok(())
    }

    /// How many faces more a line takes.
    fn n_more(&self, line: usize, fewest: usize) -> usize {
        let chains = &self.chains[line];
        let most = chains.iter().map(|chain| chain.vertices.len()).max();
        let most = most.unwrap_or(0).max(fewest);
        let more = |chain: &Chain| {
            let n_sides = if chain.is_border { 1 } else { 2 };
            let n_edges = most - chain.vertices.len();
            // Three quads more for two edges, or a triangle for one.
            if self.are_quads[chain.sheet] {
                n_edges.div_ceil(2) * 3 * n_sides
            } else {
                n_edges * n_sides
            }
        };
        chains.iter().map(more).sum()
    }

    /// Makes a chain as long as the longest of its line, as far as each of its edges is cut once; whether any was.
    fn lengthened(&mut self, (line, fewest): (usize, usize), k: usize) -> bool {
        let lengths = self.chains[line].iter().map(|chain| chain.vertices.len());
        let mut most = lengths.max().unwrap_or(0);
        let chain = &self.chains[line][k];
        let n_more = fewest.saturating_sub(most);
        most += n_more + n_more % 2;
        let (sheet, sides) = (chain.sheet, chain.sides());
        let n_new = if self.are_quads[sheet] { 2 } else { 1 };
        let n_cuts = (most - chain.vertices.len()) / n_new;
        let n = sides.len();
        let n_cuts = n_cuts.min(n);
        if n_cuts == 0 {
            return false;
        }
        // Evenly along it.
        let which = (0..n_cuts).map(|i| (2 * i + 1) * n / (2 * n_cuts));
        let cut: Vec<Edge> = which.map(|i| sides[i]).collect();
        for side in cut {
            if self.are_quads[sheet] {
                self.cut_in_three(sheet, side);
            } else {
                self.cut_in_two(sheet, side);
            }
        }
        self.is_changed[sheet] = true;
        true
    }

    /// The faces of a sheet at an edge, and the place of the edge in each.
    fn at_edge(&self, sheet: usize, edge: Edge) -> Vec<(usize, usize)> {
        let edge = sorted(edge);
        let faces = self.faces[sheet].iter().enumerate();
        let sides = faces.filter_map(|(f, face)| {
            let is_it = |i: &usize| sorted([face[*i], face[(i + 1) % face.len()]]) == edge;
            (0..face.len()).find(is_it).map(|i| (f, i))
        });
        sides.collect()
    }

    fn cut_in_three(&mut self, sheet: usize, [a, b]: Edge) {
        let at = |leveling: &Self, share: f64| leveling.place(a).lerp(leveling.place(b), share);
        let [near, far] = [1.0 / 3.0, 2.0 / 3.0].map(|share| (at(self, share), share));
        let [e, f] = [near, far].map(|(place, _)| self.add(place, [a, b]));
        for (face, i) in self.at_edge(sheet, [a, b]) {
            let corners = &self.faces[sheet][face];
            let [p, q, r, s] = [0, 1, 2, 3].map(|k| corners[(i + k) % 4]);
            let [e, f] = if p == a { [e, f] } else { [f, e] };
            let [low, high] = [[p, q], [s, r]].map(|ends| ends.map(|v| self.place(v)));
            let inner = |share: f64| -> DVec3 {
                low[0]
                    .lerp(low[1], share)
                    .lerp(high[0].lerp(high[1], share), DEPTH)
            };
            let [g, h] = [inner(1.0 / 3.0), inner(2.0 / 3.0)];
            let [g, h] = [self.add(g, [p, s]), self.add(h, [q, r])];
            self.faces[sheet][face] = vec![p, e, g, s];
            self.faces[sheet].extend([vec![e, f, h, g], vec![f, q, r, h], vec![g, h, r, s]]);
        }
        self.insert(sheet, [a, b], &[e, f]);
    }

    fn cut_in_two(&mut self, sheet: usize, [a, b]: Edge) {
        let middle = self.add(self.place(a).midpoint(self.place(b)), [a, b]);
        for (face, i) in self.at_edge(sheet, [a, b]) {
            let mut corners = self.faces[sheet][face].clone();
            corners.rotate_left(i);
            if let [p, q, r] = corners[..] {
                self.faces[sheet][face] = vec![p, middle, r];
                self.faces[sheet].push(vec![middle, q, r]);
            } else {
                corners.insert(1, middle);
                self.faces[sheet][face] = corners;
            }
        }
        self.insert(sheet, [a, b], &[middle]);
    }

    /// Puts vertices on an edge, in the order from its first end.
    fn insert(&mut self, sheet: usize, [a, b]: Edge, new: &[VertexId]) {
        if self.features.remove(&sorted([a, b])) {
            let along: Vec<VertexId> = [&[a], new, &[b]].concat();
            let pieces = along.windows(2).map(|w| sorted([w[0], w[1]]));
            self.features.extend(pieces);
        }
        self.lengthen(sheet, |side| match side {
            side if side == [a, b] => new.to_vec(),
            side if side == [b, a] => new.iter().rev().copied().collect(),
            _ => Vec::new(),
        });
    }
}
