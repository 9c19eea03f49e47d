//! Lines in the grid: its edges that belong on a sharp line, and where along it.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::Line;
use crate::flow::complex::Complex;
use crate::measure::{Polyline, Seam};
use crate::mesh::{HalfedgeMap, Id, TriangleMesh, VertexId};

/// How far a line's span may be off an axis for its walk to arrive: rounding.
const ON_AXIS: f64 = 1e-6;

/// A seam farther than this many of its edges from its line is none: quads would be squeezed
/// between the two.
const FARTHEST: f64 = 2.2;
/// How often vertices move along their line to where first positions have them.
const N_ROUNDS: usize = 60;
/// Share of the way there at once, while they go half of the way between their neighbours: small,
/// so that distances change little from one to the next.
const PULL: f64 = 0.1;
/// Share of the distance between two of them that is kept in one round.
const LEAST_GAP: f64 = 0.3;

/// The seam of every line; none where it does not run along an axis of a whole metric. It may touch
/// singularities.
///
/// `drawn` are edges of strokes, `lines` are those of `complex.chains` as they were on the mesh, `positions` first ones of the
/// quads' vertices. Of the ways that arrive the nearest is taken; firm lines need not be near. A
/// vertex inside one seam is in no other.
pub fn seams(
    (mesh, drawn): (&TriangleMesh, Option<&HalfedgeMap<bool>>),
    lines: &[&Line],
    complex: &Complex,
    (quads, positions): (&[[u32; 4]], &[DVec3]),
) -> Vec<Option<Seam>> {
    let firm = complex.chains.firm.iter().map(|firm| firm.ends);
    let walker = Walker::new(quads, positions.len()).stopping_at(firm);
    let mut is_taken = vec![false; positions.len()];
    let mut seams = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let is_firm = line.is_firm;
        let span = complex.sum_along(i, &complex.start);
        let walks = walker.along(span, line.kept_ends(complex)).into_iter();
        let is_drawn = drawn.is_some_and(|drawn| drawn[line.halfedges[0]]);
        let line = polyline(mesh, line);
        let laid = walks.map(|walk| match walk.len() - 1 {
            n if is_drawn => lay(&line.balanced(line.length() / n as f64), &walk, positions),
            _ => lay(&line, &walk, positions),
        });
        let best = laid.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let near = best.filter(|(miss, seam)| is_firm || is_near(seam, *miss));
        let seam = near.map(|(_, seam)| seam).filter(|seam| {
            let mut inner = seam.vertices[1..seam.vertices.len() - 1].iter();
            !inner.any(|v| is_taken[v.index()])
        });
        for v in seam
            .iter()
            .flat_map(|s| &s.vertices[1..s.vertices.len() - 1])
        {
            is_taken[v.index()] = true;
        }
        seams.push(seam);
    }
    seams
}

/// On which side of a walk a singularity on it leaves half a turn.
#[derive(Clone, Copy)]
enum Hand {
    Left,
    Right,
}

pub(super) struct Walker {
    /// The vertex after an edge in the quad on its left.
    ahead: HashMap<[u32; 2], u32>,
    valences: Vec<u8>,
    outgoing: Vec<u32>,
    /// Vertices that no walk passes.
    is_stop: Vec<bool>,
}

impl Walker {
    pub fn new(quads: &[[u32; 4]], n_vertices: usize) -> Self {
        let mut walker = Self {
            ahead: HashMap::with_capacity(4 * quads.len()),
            valences: vec![0; n_vertices],
            outgoing: vec![0; n_vertices],
            is_stop: vec![false; n_vertices],
        };
        for quad in quads {
            for i in 0..4 {
                let [a, b, c] = [0, 1, 2].map(|step| quad[(i + step) % 4]);
                walker.ahead.insert([a, b], c);
                walker.valences[a as usize] += 1;
                walker.outgoing[a as usize] = b;
            }
        }
        walker
    }

    /// The same with vertices that no walk passes: the ends of lines.
    pub fn stopping_at(mut self, ends: impl Iterator<Item = [u32; 2]>) -> Self {
        for end in ends.flatten() {
            self.is_stop[end as usize] = true;
        }
        self
    }

    /// All straight walks as long as a line's span and from its first end to its last.
    pub fn along(&self, span: DVec2, [first, last]: [u32; 2]) -> Vec<Vec<u32>> {
        let n = span.length().round() as usize;
        if span.abs().min_element() > ON_AXIS || n == 0 {
            return Vec::new();
        }
        let ways = self.neighbours(first).into_iter();
        let ways = ways.flat_map(|next| [Hand::Left, Hand::Right].map(|hand| (next, hand)));
        let walks = ways.filter_map(|(next, hand)| self.straight([first, next], n, hand));
        walks.filter(|walk| walk.last() == Some(&last)).collect()
    }

    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut around = vec![self.outgoing[v as usize]];
        for _ in 1..self.valences[v as usize] {
            // From a neighbour to v: what comes next in the quad on the left is the next one.
            let Some(&next) = self.ahead.get(&[around[around.len() - 1], v]) else {
                break;
            };
            around.push(next);
        }
        around
    }

    /// So many edges straight on; at irregular vertices two quads are left on one hand.
    fn straight(&self, [first, next]: [u32; 2], n: usize, hand: Hand) -> Option<Vec<u32>> {
        let mut walk = vec![first, next];
        while walk.len() <= n {
            let [from, at] = [walk[walk.len() - 2], walk[walk.len() - 1]];
            if self.is_stop[at as usize] {
                return None;
            }
            let n_turns = match hand {
                Hand::Left => 2,
                Hand::Right => self.valences[at as usize] - 2,
            };
            let mut to = from;
            for _ in 0..n_turns {
                to = *self.ahead.get(&[to, at])?;
            }
            walk.push(to);
        }
        Some(walk)
    }
}

impl Line {
    /// The vertices of the grid at its ends: a complex keeps the order of those it keeps.
    pub fn kept_ends(&self, complex: &Complex) -> [u32; 2] {
        self.ends.map(|end| {
            let at = complex.original.binary_search(&end);
            at.expect("the ends of lines are kept") as u32
        })
    }
}

/// The line on the surface.
fn polyline(mesh: &TriangleMesh, line: &Line) -> Polyline {
    let targets = line
        .halfedges
        .iter()
        .map(|&h| mesh.position(mesh.target(h)));
    let points = [mesh.position(line.ends[0])].into_iter().chain(targets);
    Polyline::new(points.collect(), line.ends[0] == line.ends[1])
}

/// Lays a walk along a line, near to first positions; returns how far its vertices are from there, squared.
fn lay(line: &Polyline, walk: &[u32], positions: &[DVec3]) -> (f64, Seam) {
    let whole = line.length();
    let step = whole / (walk.len() - 1) as f64;
    let mut at: Vec<f64> = (0..walk.len()).map(|i| i as f64 * step).collect();
    if line.is_closed() {
        // A closed line has no fixed vertex: the whole of it is shifted to where it lies.
        let shifts = walk.iter().zip(&at).map(|(&v, &at)| {
            let off = line.nearest_corner(positions[v as usize]) - at;
            let half = whole / 2.0;
            (off + half).rem_euclid(whole) - half
        });
        let shift = shifts.sum::<f64>() / walk.len() as f64;
        for at in &mut at {
            *at += shift;
        }
    }
    for _ in 0..N_ROUNDS {
        settle(line, walk, &mut at, positions);
    }
    let distances = (walk.iter().zip(&at))
        .map(|(&v, &at)| positions[v as usize].distance_squared(line.point(at)));
    let miss = distances.sum::<f64>() / walk.len() as f64;
    let seam = Seam {
        vertices: walk.iter().map(|&v| VertexId(v)).collect(),
        at,
        line: line.clone(),
    };
    (miss, seam)
}

/// Moves each vertex that is not at an end of an open line along it towards its position.
fn settle(line: &Polyline, walk: &[u32], at: &mut [f64], positions: &[DVec3]) {
    let n = walk.len() - 1;
    let whole = line.length();
    let step = whole / n as f64;
    for i in usize::from(!line.is_closed())..n {
        let before = if i == 0 { at[n - 1] - whole } else { at[i - 1] };
        let now = at[i];
        let tangent = line.point(now + 0.5 * step) - line.point(now - 0.5 * step);
        let miss = positions[walk[i] as usize] - line.point(now);
        let pull = miss.dot(tangent.normalize_or_zero());
        let [low, high] = [before, at[i + 1]].map(|x| x + (now - x) * LEAST_GAP);
        let even = 0.5 * (before + at[i + 1]) - now;
        at[i] = (now + PULL * pull + 0.5 * even).clamp(low.min(high), high.max(low));
        if i == 0 {
            at[n] = at[0] + whole;
        }
    }
}

/// Whether a mean squared miss is small beside the edges of a seam.
fn is_near(seam: &Seam, miss: f64) -> bool {
    let edge = seam.line.length() / (seam.vertices.len() - 1) as f64;
    miss < (FARTHEST * edge).powi(2)
}

/// The vertices of a seam, each with the place on the line where it belongs.
pub fn goals(seam: &Seam) -> Vec<(u32, DVec3)> {
    let mut goals: Vec<(u32, DVec3)> = (seam.vertices.iter().zip(&seam.at))
        .map(|(&v, &at)| (v.0, seam.line.point(at)))
        .collect();
    if seam.line.is_closed() {
        goals.pop();
    }
    goals
}
