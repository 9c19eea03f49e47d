//! One chord: its rungs, what it costs, and the quads without it.

use glam::DVec3;

use super::leaving::valences;
use super::mesh::{NONE, On, State, is_open, middles, twins};
use super::sorted;
use crate::groups::Groups;

/// More quads than this never meet at a vertex, nor at one of a border, unless they did before.
pub const MOST_VALENCE: usize = 6;
const MOST_AT_BORDER: usize = 4;
/// What a rung costs on flat ground, where 1 less the cosine is what its turn costs: without it flat
/// ground would lose its chords in any order.
const FLAT: f64 = 0.1;
/// How many times as dear it is to make one line of two.
const LINE_LOST: f64 = 3.0;
/// The sine of the worst corner of quads beside a rung that shrinks, unless they were worse before.
const LEAST_SQUARE: f64 = 0.1;
/// The cosine of the angle by which these turn at most.
const MOST_TURN: f64 = 0.2;

/// The quads that one cut through opposite edges crosses.
pub struct Chord {
    rungs: Vec<Rung>,
    pub n_quads: usize,
    /// What it costs to take it out, per quad.
    cost: f64,
}

/// An edge that a chord crosses.
#[derive(Clone, Copy)]
struct Rung {
    ends: [u32; 2],
    /// Whether it has one quad.
    is_border: bool,
}

impl Chord {
    /// All chords, the cheapest first; those that are each other's images count as one.
    pub fn all(state: &State) -> Vec<Self> {
        let (chord_of, n_chords) = chords(state);
        let normals = normals(&state.quads, &state.places);
        let empty = || Self {
            rungs: Vec::new(),
            n_quads: 0,
            cost: 0.0,
        };
        let mut chords: Vec<Self> = std::iter::repeat_with(empty).take(n_chords).collect();
        for q in 0..state.quads.len() {
            let [first, second] = [0, 1].map(|i| chord_of[4 * q + i] as usize);
            chords[first].n_quads += 1;
            chords[second].n_quads += usize::from(first != second);
            for h in 4 * q..4 * q + 4 {
                if h < state.twins[h] {
                    let rung = Rung {
                        ends: state.ends(h),
                        is_border: state.twins[h] == NONE,
                    };
                    let [a, b] = rung.ends.map(|v| v as usize);
                    let turn = 1.0 - normals[a].dot(normals[b]);
                    let chord = &mut chords[chord_of[h] as usize];
                    chord.rungs.push(rung);
                    let length = state.places[a].distance_squared(state.places[b]);
                    chord.cost += length * (turn + FLAT);
                }
            }
        }
        for chord in &mut chords {
            chord.cost /= chord.n_quads as f64;
            if chord.rungs.iter().any(|&rung| joins_lines(state, rung)) {
                chord.cost *= LINE_LOST;
            }
        }
        chords.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        chords
    }

    /// The quads without this chord's, if all that is to stay does.
    pub fn collapsed(&self, before: &State) -> Option<State> {
        if !self.rungs.iter().all(|&rung| may_shrink(before, rung)) {
            return None;
        }
        let mut groups = Groups::new(before.places.len());
        for rung in &self.rungs {
            let [a, b] = rung.ends.map(|v| v as usize);
            groups.link(a, b);
        }
        let (new, n) = groups.numbered();
        let named = |v: u32| new[v as usize];
        let moved = before.quads.iter().map(|quad| quad.map(named));
        let is_left = |quad: &[u32; 4]| (0..4).all(|i| quad[i] != quad[(i + 1) % 4]);
        let (kept, quads): (Vec<usize>, Vec<[u32; 4]>) =
            moved.enumerate().filter(|(_, quad)| is_left(quad)).unzip();
        let is_gone = before.quads.len() - quads.len() == self.n_quads;
        let is_pinched = quads.iter().any(|q| q[0] == q[2] || q[1] == q[3]);
        if !is_gone || is_pinched || quads.is_empty() {
            return None;
        }
        let ends = before.lines.iter().map(|edge| edge.map(named));
        let mut lines: Vec<[u32; 2]> = ends.filter(|[a, b]| a != b).map(sorted).collect();
        lines.sort_unstable();
        lines.dedup();
        let on = on(before, (&new, n), &lines)?;
        let twins = twins(&quads, n)?;
        let after = State {
            places: middles((&new, n), &before.weights(), &before.places),
            is_open: is_open(&quads, &twins, n),
            twins,
            images: before.images.as_ref().map(|images| {
                let mut after = vec![0; n];
                for (v, &image) in images.iter().enumerate() {
                    after[new[v] as usize] = named(image);
                }
                after
            }),
            vertex_of: before.vertex_of.iter().map(|&v| named(v)).collect(),
            first_weights: before.first_weights.clone(),
            quads,
            lines,
            on,
        };
        let is_sound = after.n_edges_less() == before.n_edges_less()
            && valences_stay(before, &after, &new)
            && shapes_stay(before, &after, &kept);
        is_sound.then_some(after)
    }
}

/// The chord that crosses each halfedge, and how many there are.
fn chords(state: &State) -> (Vec<u32>, usize) {
    let mut groups = Groups::new(state.twins.len());
    for (h, &twin) in state.twins.iter().enumerate() {
        groups.link(h, h / 4 * 4 + (h + 2) % 4);
        if twin != NONE {
            groups.link(h, twin);
        }
    }
    if let Some(images) = &state.images {
        let mut by_ends: Vec<([u32; 2], usize)> = (0..state.twins.len())
            .map(|h| (sorted(state.ends(h)), h))
            .collect();
        by_ends.sort_unstable();
        for &(ends, h) in &by_ends {
            let image = sorted(ends.map(|v| images[v as usize]));
            let at = by_ends.partition_point(|(ends, _)| *ends < image);
            if let Some((_, other)) = by_ends.get(at).filter(|(ends, _)| *ends == image) {
                groups.link(h, *other);
            }
        }
    }
    groups.numbered()
}

/// Whether the ends of a rung may become one vertex: not two that stay, nor two of borders but along
/// one; no border goes to a corner beside it, and no line to a pole.
fn may_shrink(state: &State, rung: Rung) -> bool {
    let [a, b] = rung.ends.map(|v| v as usize);
    let [least, most] = [state.on[a].min(state.on[b]), state.on[a].max(state.on[b])];
    let has_pole = most == On::Pole && least != On::Nothing;
    let is_inner_corner = |v: usize| state.on[v] == On::Corner && !state.is_open[v];
    let goes_inside =
        is_inner_corner(a) && state.is_open[b] || is_inner_corner(b) && state.is_open[a];
    let leaves_border = state.is_open[a] && state.is_open[b] && !rung.is_border;
    !least.stays() && !has_pole && !goes_inside && !leaves_border
}

/// Whether a rung goes from line to line.
fn joins_lines(state: &State, rung: Rung) -> bool {
    let are_on = rung
        .ends
        .iter()
        .all(|&v| state.on[v as usize] != On::Nothing);
    are_on && !state.is_line(rung.ends)
}

/// What the new vertices are on; none where two that stay became one.
fn on(before: &State, (new, n): (&[u32], usize), lines: &[[u32; 2]]) -> Option<Vec<On>> {
    let mut degree = vec![0; n];
    for &v in lines.iter().flatten() {
        degree[v as usize] += 1;
    }
    let by_degree = |&degree: &usize| match degree {
        0 => On::Nothing,
        2 => On::Line,
        _ => On::Corner,
    };
    let mut on: Vec<On> = degree.iter().map(by_degree).collect();
    let mut has_stayed = vec![false; n];
    for (v, &was) in before.on.iter().enumerate() {
        if was.stays() {
            let at = new[v] as usize;
            if has_stayed[at] {
                return None;
            }
            has_stayed[at] = true;
            on[at] = was;
        }
    }
    Some(on)
}

/// Whether every vertex has as many quads as it may.
fn valences_stay(before: &State, after: &State, new: &[u32]) -> bool {
    let [was, is] = [before, after].map(|state| valences(&state.quads, state.places.len()));
    let mut most_before = vec![0; is.len()];
    for (v, &at) in new.iter().enumerate() {
        most_before[at as usize] = most_before[at as usize].max(was[v]);
    }
    (0..is.len()).all(|v| {
        let (least, most) = if after.is_open[v] {
            (1, MOST_AT_BORDER)
        } else {
            (3, MOST_VALENCE)
        };
        let before = most_before[v];
        is[v] >= least.min(before) && is[v] <= most.max(before)
    })
}

/// Whether no quad that is left has turned over or become much worse.
fn shapes_stay(before: &State, after: &State, kept: &[usize]) -> bool {
    let corners = |state: &State, q: usize| state.quads[q].map(|v| state.places[v as usize]);
    kept.iter().enumerate().all(|(now, &then)| {
        let [was, is] = [corners(before, then), corners(after, now)];
        if was == is {
            return true;
        }
        let [(up, worst), (up_now, worst_now)] = [was, is].map(shape);
        up.dot(up_now) >= MOST_TURN && worst_now >= LEAST_SQUARE.min(worst)
    })
}

/// The normal of a quad, and the sine of its worst corner seen along it.
fn shape(p: [DVec3; 4]) -> (DVec3, f64) {
    let normal = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
    let edge = |i: usize| (p[(i + 1) % 4] - p[i % 4]).normalize_or_zero();
    let turns = (0..4).map(|i| edge(i).cross(edge(i + 1)).dot(normal));
    (normal, turns.fold(1.0, f64::min))
}

/// The normal at each vertex of quads, by their areas.
pub fn normals(quads: &[[u32; 4]], places: &[DVec3]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; places.len()];
    for quad in quads {
        let [a, b, c, d] = quad.map(|v| places[v as usize]);
        let area = (c - a).cross(d - b);
        for &v in quad {
            sums[v as usize] += area;
        }
    }
    sums.iter().map(|sum| sum.normalize_or_zero()).collect()
}
