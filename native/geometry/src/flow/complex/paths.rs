//! Lines along edges that are found again after every flip.
//!
//! What counts of a line is the sum of the vectors along it, all turned into the frame of its
//! beginning. Each step holds how far its own frame is turned; an edge that is flipped away is
//! replaced by two sides of the triangle across it, of which it is the sum. So the sum stays what
//! it was, on whichever side of the cones the steps come to lie.

use std::ops::Add;

use glam::DVec2;

use super::{Complex, Turn};
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, VertexId};

/// A halfedge of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Step {
    /// Which halfedge.
    pub halfedge: HalfedgeId,
    /// Quarter turns from its face's frame to that of the line's beginning.
    pub turns: u8,
}

/// Lines from vertex to vertex, each step beginning where the one before ends.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Paths {
    lines: Vec<Vec<Step>>,
    /// Whether a halfedge is one of a line's: what most flips need to know.
    is_used: Vec<bool>,
}

/// New names of halfedges: from which to which.
type Moves = [(HalfedgeId, HalfedgeId)];

fn named(moves: &Moves, step: Step) -> Step {
    let halfedge = step.halfedge;
    let to = moves.iter().find(|m| m.0 == halfedge);
    Step {
        halfedge: to.map_or(halfedge, |m| m.1),
        ..step
    }
}

impl Paths {
    /// The lines, in the order in which they were given.
    pub fn lines(&self) -> &[Vec<Step>] {
        &self.lines
    }

    fn mark(&mut self) {
        for step in self.lines.iter().flatten() {
            self.is_used[step.halfedge.index()] = true;
        }
    }

    /// Changes every line that uses one of some halfedges.
    fn change(&mut self, touched: &[HalfedgeId], change: impl Fn(&[Step]) -> Vec<Step>) {
        let uses = |h: &HalfedgeId| self.is_used.get(h.index()) == Some(&true);
        if !touched.iter().any(uses) {
            return;
        }
        for line in &mut self.lines {
            if line.iter().any(|step| touched.contains(&step.halfedge)) {
                *line = change(line);
            }
        }
        for h in touched {
            self.is_used[h.index()] = false;
        }
        self.mark();
    }

    /// Notes that the vectors of a face are turned.
    pub(super) fn turn_face(&mut self, face: FaceId, turns: u8) {
        let first = HalfedgeId(3 * face.0);
        self.change(&[first, first.next(), first.prev()], |line| {
            let mut line = line.to_vec();
            for step in line.iter_mut().filter(|s| s.halfedge.face() == face) {
                step.turns = (step.turns + 4 - turns % 4) % 4;
            }
            line
        });
    }

    /// Leads lines round an edge between two faces of one frame that is about to be flipped, and
    /// gives the sides their new names.
    pub(super) fn detour(&mut self, [h, t]: [HalfedgeId; 2], moves: &Moves) {
        let round = |step: Step| {
            let across = match step.halfedge {
                e if e == h => t,
                e if e == t => h,
                _ => return [Some(step), None],
            };
            [across.next(), across.prev()].map(|halfedge| Some(Step { halfedge, ..step }))
        };
        self.change(&[h, t, h.next(), h.prev(), t.next(), t.prev()], |line| {
            let steps = line.iter().flat_map(|&step| round(step)).flatten();
            steps.map(|step| named(moves, step)).collect()
        });
    }

    /// Leads lines that go through a vertex of three faces of one frame along the sides of these.
    pub(super) fn bypass(&mut self, spokes: [HalfedgeId; 3], moves: &Moves) {
        // The three faces are in one frame, and what comes in beside a spoke is the one before's.
        let inward = [2, 0, 1].map(|i: usize| spokes[i].prev());
        let touched = [spokes, inward, spokes.map(HalfedgeId::next)].concat();
        self.change(&touched, |line| {
            let mut rest = line.iter().copied().peekable();
            let mut round = Vec::with_capacity(line.len());
            while let Some(step) = rest.next() {
                let Some(from) = inward.iter().position(|&h| h == step.halfedge) else {
                    round.push(named(moves, step));
                    continue;
                };
                let out = rest.next_if(|s| spokes.contains(&s.halfedge));
                let to = out.and_then(|out| spokes.iter().position(|&s| s == out.halfedge));
                let n_sides = to.map_or(0, |to| (to + 3 - from) % 3);
                let sides = (0..n_sides).map(|i| spokes[(from + i) % 3].next());
                round.extend(sides.map(|halfedge| named(moves, Step { halfedge, ..step })));
            }
            round
        });
    }

    /// Gives halfedges the names that they have once faces are renumbered to so many halfedges.
    pub(super) fn rename(&mut self, name: impl Fn(HalfedgeId) -> HalfedgeId, n: usize) {
        if self.lines.is_empty() {
            return;
        }
        for step in self.lines.iter_mut().flatten() {
            step.halfedge = name(step.halfedge);
        }
        self.is_used.clear();
        self.is_used.resize(n, false);
        self.mark();
    }
}

impl Complex {
    /// Follows lines from now on, each from vertex to vertex over halfedges that join; they pass
    /// the vertices between on the left.
    pub fn follow_lines(&mut self, lines: &[Vec<HalfedgeId>]) {
        self.paths = Paths {
            lines: lines.iter().map(|line| self.framed(line)).collect(),
            is_used: vec![false; self.twins.len()],
        };
        self.paths.mark();
    }

    fn framed(&self, line: &[HalfedgeId]) -> Vec<Step> {
        let mut turned = 0;
        let mut steps = Vec::with_capacity(line.len());
        for (i, &halfedge) in line.iter().enumerate() {
            let turns = (4 - turned) % 4;
            steps.push(Step { halfedge, turns });
            let mut e = halfedge.next();
            while line.get(i + 1).is_some_and(|&ahead| e != ahead) {
                turned = (turned + self.turns[e]) % 4;
                e = self.twins[e].next();
            }
        }
        steps
    }

    /// Takes needless steps out of the lines: two sides of a triangle, and ways there and back.
    pub fn shorten_paths(&mut self) {
        let mut paths = std::mem::take(&mut self.paths);
        for line in &mut paths.lines {
            while let Some((at, by)) = self.shortcut(line) {
                line.splice(at..at + 2, by);
            }
        }
        paths.is_used.fill(false);
        paths.mark();
        self.paths = paths;
    }

    /// Two steps of a line that can be one or none: where, and which.
    fn shortcut(&self, line: &[Step]) -> Option<(usize, Option<Step>)> {
        line.windows(2).enumerate().find_map(|(i, pair)| {
            let [a, b] = [pair[0], pair[1]];
            let across = |h: HalfedgeId, turns: u8| Step {
                halfedge: self.twins[h],
                turns: (turns + 4 - self.turns[h]) % 4,
            };
            if b.halfedge == a.halfedge.next() && b.turns == a.turns {
                return Some((i, Some(across(a.halfedge.prev(), a.turns))));
            }
            (b == across(a.halfedge, a.turns)).then_some((i, None))
        })
    }

    /// The sum of vectors along a line, in the frame of its beginning.
    pub fn sum_along(&self, line: &[Step], vectors: &HalfedgeMap<DVec2>) -> DVec2 {
        let turned = line.iter().map(|s| vectors[s.halfedge].turned(s.turns));
        turned.fold(DVec2::ZERO, DVec2::add)
    }

    /// The vertices at the ends of a line; none of a line without steps.
    pub fn ends(&self, line: &[Step]) -> Option<[VertexId; 2]> {
        let [first, last] = [line.first()?, line.last()?];
        Some([self.origins[first.halfedge], self.target(last.halfedge)])
    }
}
