//! What is seen from a corner: triangles unfolded into the plane of the first.

use glam::DVec2;

use crate::flow::complex::{Complex, Turn};
use crate::mesh::{HalfedgeId, Id};

/// The least sine of an interval of directions that is worth following.
const NARROW: f64 = 1e-9;
/// No parent: the first triangle.
const NONE: u32 = u32::MAX;

/// A triangle entered through an edge, with the directions in which it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// The halfedge of this triangle through which it was entered, from `left` to `right`.
    pub entered: HalfedgeId,
    /// Quarter turns from this triangle's frame to the first's.
    pub turns: u8,
    pub left: DVec2,
    pub right: DVec2,
    /// The directions, from right to left.
    pub low: DVec2,
    pub high: DVec2,
    parent: u32,
    n_crossed: u32,
}

/// Where to stop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub longest: f64,
    pub n_crossed: usize,
    /// Only directions this near to an axis, as the direction so far from the x axis.
    pub cone: DVec2,
}

/// All triangles seen from one corner so far.
pub(super) struct Sights<'a> {
    complex: &'a Complex,
    limits: Limits,
    seen: Vec<Sight>,
    waiting: Vec<u32>,
}

impl<'a> Sights<'a> {
    pub fn new(complex: &'a Complex, limits: Limits) -> Self {
        Self {
            complex,
            limits,
            seen: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// Starts at the corner that `h` leaves.
    pub fn begin(&mut self, h: HalfedgeId) {
        let right = self.complex.start[h];
        self.seen.clear();
        self.seen.push(Sight {
            entered: h,
            turns: 0,
            left: DVec2::ZERO,
            right,
            low: right,
            high: -self.complex.start[h.prev()],
            parent: NONE,
            n_crossed: 0,
        });
        self.waiting.clear();
        self.waiting.push(0);
    }

    /// The next triangle: its place in the list and its third corner.
    pub fn next(&mut self) -> Option<(usize, DVec2)> {
        let i = self.waiting.pop()?;
        let sight = self.seen[i as usize];
        let side = self.complex.start[sight.entered.next()];
        let apex = sight.right + side.turned(sight.turns);
        if (sight.n_crossed as usize) < self.limits.n_crossed {
            self.pass(i, apex);
        }
        Some((i as usize, apex))
    }

    pub fn sight(&self, i: usize) -> &Sight {
        &self.seen[i]
    }

    /// The triangles from the i-th back to the first.
    pub fn back_from(&self, i: usize) -> impl Iterator<Item = &Sight> {
        let mut next = Some(i as u32);
        std::iter::from_fn(move || {
            let sight = &self.seen[next.filter(|&i| i != NONE)? as usize];
            next = Some(sight.parent);
            Some(sight)
        })
    }

    /// The halfedges entered on the way to the i-th triangle.
    pub fn entered_to(&self, i: usize) -> Vec<HalfedgeId> {
        let inner = self.back_from(i).filter(|s| s.parent != NONE);
        let mut entered: Vec<HalfedgeId> = inner.map(|s| s.entered).collect();
        entered.reverse();
        entered
    }

    /// Looks past the third corner of a triangle on both sides.
    fn pass(&mut self, i: u32, apex: DVec2) {
        let sight = self.seen[i as usize];
        let higher = |a: DVec2, b: DVec2| if a.perp_dot(b) > 0.0 { b } else { a };
        let lower = |a: DVec2, b: DVec2| if a.perp_dot(b) > 0.0 { a } else { b };
        let right = Sight {
            entered: sight.entered.next(),
            left: apex,
            high: lower(apex, sight.high),
            ..sight
        };
        let left = Sight {
            entered: sight.entered.prev(),
            right: apex,
            low: higher(sight.low, apex),
            ..sight
        };
        self.cross(i, right);
        if sight.parent != NONE {
            self.cross(i, left);
        }
    }

    /// Crosses the edge that `entered` names, seen from this side, if enough is seen through it.
    fn cross(&mut self, parent: u32, seen: Sight) {
        let Sight { low, high, .. } = seen;
        let sine = low.perp_dot(high);
        let is_open = sine > NARROW * low.length() * high.length();
        if !is_open
            || distance_to_segment(seen.left, seen.right) > self.limits.longest
            || !nears_axis(low, high, self.limits.cone)
        {
            return;
        }
        let edge = seen.entered;
        self.waiting.push(self.seen.len() as u32);
        self.seen.push(Sight {
            entered: self.complex.twins[edge],
            turns: (seen.turns + 4 - self.complex.turns[edge]) % 4,
            parent,
            n_crossed: seen.n_crossed + 1,
            ..seen
        });
        debug_assert!(edge.index() < self.complex.twins.len());
    }
}

/// How far the origin is from a segment.
fn distance_to_segment(a: DVec2, b: DVec2) -> f64 {
    let side = b - a;
    let square = side.length_squared();
    if square < 1e-18 {
        return a.length();
    }
    (a - side * (a.dot(side) / square).clamp(0.0, 1.0)).length()
}

/// Whether an interval of directions less than half a turn wide meets a cone round
/// an axis, of which `cone` is the side next to the x axis.
pub(super) fn nears_axis(low: DVec2, high: DVec2, cone: DVec2) -> bool {
    let is_between = |a: DVec2, x: DVec2, b: DVec2| a.perp_dot(x) >= 0.0 && x.perp_dot(b) >= 0.0;
    let mirrored = DVec2::new(cone.x, -cone.y);
    (0..4u8).any(|quarter| {
        let [right, left] = [mirrored, cone].map(|side| side.turned(quarter));
        is_between(low, right, high)
            || is_between(low, left, high)
            || is_between(right, low, left)
            || is_between(right, high, left)
    })
}
