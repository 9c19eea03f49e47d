//! Patches of vertices, between which heat flows where single vertices would be too many.

use glam::DVec3;

use super::heat::{Conduction, Heat};
use super::{Surface, Value};
use crate::mesh::{Id, VertexId};
use crate::sparse::NotPositiveDefinite;

/// How far from its first vertex a patch reaches, as a share of the scale. Below, there are more
/// patches than save time; at this, edges lie as near to the directions as on all vertices, to a
/// hundredth of a degree or two.
const SHARE: f64 = 0.15;
/// A place asks the patches around whose centres are nearer than this many times that.
const REACH: f64 = 2.5;

const NONE: u32 = u32::MAX;

/// Connected vertices near each other, as one.
#[derive(Clone, Debug)]
pub(super) struct Patches {
    /// The patch of each vertex.
    of: Vec<u32>,
    centres: Vec<DVec3>,
    areas: Vec<f64>,
    /// The patches that heat flows between, the smaller one first, in order, and how well.
    sides: Vec<([usize; 2], f64)>,
    /// The area of each vertex.
    mass: Vec<f64>,
    /// Where the neighbours of each patch start.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    reach: f64,
}

impl Patches {
    /// Gathers the vertices of a surface.
    pub fn new(surface: &Surface, scale: f64) -> Self {
        let Conduction { mass, sides } = Conduction::new(surface);
        let (of, firsts) = grow(surface, SHARE * scale);
        let mut areas = vec![0.0; firsts.len()];
        let mut centres = vec![DVec3::ZERO; firsts.len()];
        for ((&patch, &mass), &p) in of.iter().zip(&mass).zip(surface.positions) {
            areas[patch as usize] += mass;
            centres[patch as usize] += p * mass;
        }
        for ((centre, &area), &first) in centres.iter_mut().zip(&areas).zip(&firsts) {
            *centre = if area > 0.0 {
                *centre / area
            } else {
                surface.positions[first]
            };
        }
        let sides = between(surface, (&of, &centres), &sides);
        let (starts, neighbours) = neighbours(&sides, firsts.len());
        Self {
            of,
            centres,
            areas,
            sides,
            mass,
            starts,
            neighbours,
            reach: REACH * SHARE * scale,
        }
    }

    /// The mean of the values of each patch's vertices, by area.
    pub fn means(&self, values: &[Value]) -> Vec<Value> {
        let mut means = vec![Value::default(); self.areas.len()];
        for ((&patch, &mass), value) in self.of.iter().zip(&self.mass).zip(values) {
            let area = self.areas[patch as usize];
            means[patch as usize].add(*value, mass / area.max(1e-300));
        }
        means
    }

    /// The heat equation between patches.
    pub fn heat(&self, scale: f64) -> Result<Heat, NotPositiveDefinite> {
        Heat::new(self.areas.clone(), &self.sides, scale)
    }

    /// The patches around a place of a triangle and their weights, which sum to 1.
    pub fn around(&self, triangle: [VertexId; 3], place: DVec3) -> Vec<(usize, f64)> {
        let own = triangle.map(|v| self.of[v.index()]);
        let ring = |p: u32| {
            let [from, to] = [0, 1].map(|i| self.starts[p as usize + i] as usize);
            self.neighbours[from..to].iter().copied()
        };
        let mut patches: Vec<u32> = own
            .into_iter()
            .chain(own.into_iter().flat_map(ring))
            .collect();
        patches.sort_unstable();
        patches.dedup();
        let weight = |p: usize| {
            let far = place.distance(self.centres[p]) / self.reach;
            self.areas[p] * (1.0 - far * far).max(0.0).powi(2)
        };
        let weighted = patches
            .into_iter()
            .map(|p| (p as usize, weight(p as usize)));
        let weighted: Vec<_> = weighted.filter(|(_, weight)| *weight > 0.0).collect();
        if weighted.is_empty() {
            return vec![(own[0] as usize, 1.0)];
        }
        let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
        let share = |(patch, weight)| (patch, weight / total);
        weighted.into_iter().map(share).collect()
    }
}

/// The patch of each vertex, and the first vertex of each patch, from which it grows along the
/// surface as far as a radius.
fn grow(surface: &Surface, radius: f64) -> (Vec<u32>, Vec<usize>) {
    let (starts, around) = around(surface);
    let at = |v: usize| surface.positions[v];
    let mut of = vec![NONE; surface.positions.len()];
    let mut firsts = Vec::new();
    let mut open = Vec::new();
    for first in 0..of.len() {
        if of[first] != NONE {
            continue;
        }
        let patch = firsts.len() as u32;
        firsts.push(first);
        of[first] = patch;
        open.push(first);
        while let Some(v) = open.pop() {
            for &w in &around[starts[v] as usize..starts[v + 1] as usize] {
                let w = w as usize;
                if of[w] == NONE && at(w).distance_squared(at(first)) <= radius * radius {
                    of[w] = patch;
                    open.push(w);
                }
            }
        }
    }
    (of, firsts)
}

/// The other corners of the triangles at each vertex, and where those of each vertex start.
fn around(surface: &Surface) -> (Vec<u32>, Vec<u32>) {
    let n = surface.positions.len();
    let mut starts = vec![0_u32; n + 2];
    for v in surface.triangles.iter().flatten() {
        starts[v.index() + 2] += 2;
    }
    for v in 2..starts.len() {
        starts[v] += starts[v - 1];
    }
    let mut around = vec![0; 6 * surface.triangles.len()];
    // Each start moves on to its end, where the next vertex starts.
    for &[a, b, c] in surface.triangles {
        for [v, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
            let place = &mut starts[v.index() + 1];
            around[*place as usize] = next.0;
            around[*place as usize + 1] = last.0;
            *place += 2;
        }
    }
    starts.pop();
    (starts, around)
}

/// How well heat flows between patches: what a linear field along the line between their centres
/// would let through the sides that cross from one to the other.
fn between(
    surface: &Surface,
    (of, centres): (&[u32], &[DVec3]),
    sides: &[([usize; 2], f64)],
) -> Vec<([usize; 2], f64)> {
    let crossing = |&([a, b], conductance): &([usize; 2], f64)| {
        let [a, b] = if of[a] < of[b] { [a, b] } else { [b, a] };
        let pair = [of[a] as usize, of[b] as usize];
        let way = centres[pair[1]] - centres[pair[0]];
        let step = (surface.positions[b] - surface.positions[a]).dot(way);
        let share = (step / way.length_squared().max(1e-300)).max(0.0);
        (pair[0] != pair[1]).then_some((pair, conductance * share))
    };
    let mut crossing: Vec<_> = sides.iter().filter_map(crossing).collect();
    crossing.sort_by_key(|(pair, _)| *pair);
    let runs = crossing.chunk_by(|a, b| a.0 == b.0);
    runs.map(|run| (run[0].0, run.iter().map(|side| side.1).sum()))
        .collect()
}

/// The patches that share a side with each, and where those of each start.
fn neighbours(sides: &[([usize; 2], f64)], n: usize) -> (Vec<u32>, Vec<u32>) {
    let both = sides.iter().flat_map(|&([a, b], _)| [[a, b], [b, a]]);
    let mut both: Vec<[usize; 2]> = both.collect();
    both.sort_unstable();
    let mut starts = vec![0; n + 1];
    for [a, _] in &both {
        starts[a + 1] += 1;
    }
    for a in 0..n {
        starts[a + 1] += starts[a];
    }
    (starts, both.into_iter().map(|[_, b]| b as u32).collect())
}
