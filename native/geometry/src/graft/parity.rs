//! Strips of quads that make up for odd edges.
//!
//! A sheet of quads has an even number of border edges. Where a loop has one too many or too few for
//! its line, and another loop too, or one along which nothing stays, a strip of quads that leads from
//! one to the other is doubled: both get an edge.

use std::collections::{BTreeSet, HashMap};

use super::sheet::Sheet;
use super::{Border, Grafting};
use crate::mesh::{Id, VertexId};

/// A side of a face by its ends.
type Side = [VertexId; 2];

/// Quads side by side from one border to another: the side at which each is entered, and at last the
/// one that is left.
struct Strip {
    faces: Vec<usize>,
    sides: Vec<Side>,
}

/// The same borders with loops that have as many edges as the borders but for an even number, as far
/// as there are strips for that.
pub fn evened<'a>(
    grafting: &mut Grafting,
    sheet: &mut Sheet,
    mut pairs: Vec<(&'a Border, Vec<VertexId>)>,
) -> Vec<(&'a Border, Vec<VertexId>)> {
    if sheet.faces.iter().any(|face| face.len() != 4) {
        return pairs;
    }
    while let Some(strip) = shortest(sheet, &pairs) {
        let new = strip.doubled(grafting, sheet);
        for ([a, b], middle) in new {
            for (_, made) in &mut pairs {
                let n = made.len();
                let at = (0..n).find(|&i| made[i] == a && made[(i + 1) % n] == b);
                if let Some(at) = at {
                    made.insert(at + 1, middle);
                }
            }
        }
    }
    pairs
}

impl Border {
    /// Whether a loop of so many edges cannot meet it with quads alone.
    fn is_odd(&self, n: usize) -> bool {
        self.is_held.iter().all(|&held| held) && n % 2 != self.points.len() % 2
    }
}

/// The shortest strip from an odd loop to another, or to one that may have any number of edges.
fn shortest(sheet: &Sheet, pairs: &[(&Border, Vec<VertexId>)]) -> Option<Strip> {
    let mut loop_of = HashMap::new();
    for (k, (_, made)) in pairs.iter().enumerate() {
        let next = made.iter().cycle().skip(1);
        loop_of.extend(made.iter().zip(next).map(|(&a, &b)| ([a, b], k)));
    }
    let is_odd = |k: usize| pairs[k].0.is_odd(pairs[k].1.len());
    let is_loose = |k: usize| pairs[k].0.is_held.iter().any(|held| !held);
    let mut best: Option<(bool, Strip)> = None;
    for (k, (_, made)) in pairs.iter().enumerate().filter(|(k, _)| is_odd(*k)) {
        let next = made.iter().cycle().skip(1);
        for side in made.iter().zip(next).map(|(&a, &b)| [a, b]) {
            let Some((strip, end)) = Strip::from(sheet, side) else {
                continue;
            };
            let Some(&to) = loop_of.get(&end).filter(|&&to| to != k) else {
                continue;
            };
            let is_half = !is_odd(to);
            let key = (is_half, strip.faces.len());
            let is_better = |best: &(bool, Strip)| key < (best.0, best.1.faces.len());
            if (!is_half || is_loose(to)) && best.as_ref().is_none_or(is_better) {
                best = Some((is_half, strip));
            }
        }
    }
    best.map(|(_, strip)| strip)
}

impl Strip {
    /// The strip from a side of the border and the side at which it ends; none that comes to a quad
    /// twice.
    fn from(sheet: &Sheet, first: Side) -> Option<(Self, Side)> {
        let mut strip = Self {
            faces: Vec::new(),
            sides: vec![first],
        };
        let mut seen = BTreeSet::new();
        let mut side = first;
        while let Some(face) = sheet.left(side) {
            if !seen.insert(face) {
                return None;
            }
            let corners = &sheet.faces[face];
            let at = corners.iter().position(|&v| v == side[0])?;
            let out = [2, 3].map(|k| corners[(at + k) % 4]);
            strip.faces.push(face);
            side = [out[1], out[0]];
            strip.sides.push(side);
        }
        let [a, b] = side;
        Some((strip, [b, a]))
    }

    /// Cuts its quads along it; the sides of the border that were cut, and where.
    fn doubled(&self, grafting: &mut Grafting, sheet: &mut Sheet) -> [(Side, VertexId); 2] {
        let place = |grafting: &Grafting, v: VertexId| grafting.positions[v.index()];
        let middles: Vec<VertexId> = self
            .sides
            .iter()
            .map(|&[a, b]| {
                let middle = place(grafting, a).midpoint(place(grafting, b));
                grafting.add(middle, [a, b])
            })
            .collect();
        for (i, &face) in self.faces.iter().enumerate() {
            let ([a, b], [d, c]) = (self.sides[i], self.sides[i + 1]);
            let [m, n] = [middles[i], middles[i + 1]];
            sheet.replace(face, vec![a, m, n, d]);
            sheet.push(vec![m, b, c, n]);
        }
        let last = self.sides.len() - 1;
        let [d, c] = self.sides[last];
        [(self.sides[0], middles[0]), ([c, d], middles[last])]
    }
}
