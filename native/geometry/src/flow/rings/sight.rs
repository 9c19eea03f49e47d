//! What is seen from a corner: triangles unfolded into the plane of the first.

use glam::DVec2;

use crate::flow::complex::{Complex, Turn};
use crate::mesh::HalfedgeId;

/// The least sine of an interval of directions that is worth following.
const NARROW: f64 = 1e-9;
/// The sine within which two directions are one.
pub(super) const SAME: f64 = 1e-9;
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
    /// More triangles than this are not unfolded.
    pub n_sights: usize,
    /// Only directions this near to an axis, as the direction so far from the x axis.
    pub cone: DVec2,
    /// And only ends that are off the axis by no more than this.
    pub aside: f64,
    /// How wide a strip on the right of the line of sight has to be free of corners.
    pub clear: f64,
}

/// All triangles on the way to the one that is seen last.
pub(super) struct Sights<'a> {
    complex: &'a Complex,
    limits: Limits,
    seen: Vec<Sight>,
    waiting: Vec<u32>,
}

impl<'a> Sights<'a> {
    /// Looks from every corner in turn: calls `see` with each triangle that is seen, as the last
    /// of the sights, and the place of its third corner.
    pub fn from_all_corners(
        complex: &'a Complex,
        limits: Limits,
        mut see: impl FnMut(&Self, DVec2),
    ) {
        let mut sights = Self {
            complex,
            limits,
            seen: Vec::new(),
            waiting: Vec::new(),
        };
        let mut n_sights = 0;
        for corner in complex.halfedge_ids() {
            sights.begin(corner);
            while let Some(apex) = sights.next() {
                n_sights += 1;
                if n_sights > limits.n_sights {
                    return;
                }
                see(&sights, apex);
                sights.pass(apex);
            }
        }
    }

    /// Starts at the corner that `h` leaves.
    fn begin(&mut self, h: HalfedgeId) {
        let right = self.complex.start[h];
        self.seen.clear();
        self.waiting.clear();
        let Some(low) = self.clear_of(right) else {
            return;
        };
        self.waiting.push(0);
        self.seen.push(Sight {
            entered: h,
            turns: 0,
            left: DVec2::ZERO,
            right,
            low,
            high: -self.complex.start[h.prev()],
            parent: NONE,
            n_crossed: 0,
        });
    }

    /// Goes on to the next triangle; its third corner.
    fn next(&mut self) -> Option<DVec2> {
        let i = self.waiting.pop()?;
        // What came after it was seen past its sibling.
        self.seen.truncate(i as usize + 1);
        let sight = self.last();
        let side = self.complex.start[sight.entered.next()];
        Some(sight.right + side.turned(sight.turns))
    }

    /// The first triangle, at the corner from which is looked.
    pub fn first(&self) -> &Sight {
        &self.seen[0]
    }

    /// The triangle that is seen now.
    pub fn last(&self) -> &Sight {
        &self.seen[self.seen.len() - 1]
    }

    /// Whether the last triangle is the first one.
    pub fn is_first(&self) -> bool {
        self.seen.len() == 1
    }

    /// Whether the way from the first corner to a place in the last triangle is open; it may
    /// touch corners on its left where `touches` says so.
    pub fn sees(&self, place: DVec2, touches: bool) -> bool {
        let sine = |a: DVec2, b: DVec2| a.perp_dot(b) / (a.length() * b.length());
        let least = if touches { -SAME } else { SAME };
        let Sight { low, high, .. } = *self.last();
        sine(low, place) > SAME && sine(place, high) > least
    }

    /// The triangles on the way, from the last back to the first.
    pub fn back(&self) -> impl Iterator<Item = &Sight> {
        let mut next = self.seen.len() - 1;
        std::iter::from_fn(move || {
            let sight = self.seen.get(next)?;
            next = sight.parent as usize;
            Some(sight)
        })
    }

    /// The halfedges entered on the way to the last triangle.
    pub fn entered(&self) -> Vec<HalfedgeId> {
        let inner = self.back().filter(|s| s.parent != NONE);
        let mut entered: Vec<HalfedgeId> = inner.map(|s| s.entered).collect();
        entered.reverse();
        entered
    }

    /// Looks past the third corner of the last triangle on both sides.
    fn pass(&mut self, apex: DVec2) {
        let sight = *self.last();
        if sight.n_crossed as usize >= self.limits.n_crossed {
            return;
        }
        let parent = self.seen.len() as u32 - 1;
        let higher = |a: DVec2, b: DVec2| if a.perp_dot(b) > 0.0 { b } else { a };
        let lower = |a: DVec2, b: DVec2| if a.perp_dot(b) > 0.0 { a } else { b };
        let right = Sight {
            entered: sight.entered.next(),
            left: apex,
            high: lower(apex, sight.high),
            ..sight
        };
        self.cross(parent, right);
        if sight.parent != NONE
            && let Some(low) = self.clear_of(apex)
        {
            let left = Sight {
                entered: sight.entered.prev(),
                right: apex,
                low: higher(higher(sight.low, apex), low),
                ..sight
            };
            self.cross(parent, left);
        }
    }

    /// The first direction that leaves a corner as far on the right as has to be clear.
    fn clear_of(&self, corner: DVec2) -> Option<DVec2> {
        let clear = self.limits.clear;
        let rest = corner.length_squared() - clear * clear;
        (rest >= 0.0).then(|| corner * rest.sqrt() + corner.perp() * clear)
    }

    /// Crosses the edge that `entered` names, seen from this side, if enough is seen through it.
    fn cross(&mut self, parent: u32, seen: Sight) {
        let Sight { low, high, .. } = seen;
        let sine = low.perp_dot(high);
        if sine <= 0.0
            || sine * sine <= NARROW * NARROW * low.length_squared() * high.length_squared()
        {
            return;
        }
        let square = square_to_segment(seen.left, seen.right);
        if square > self.limits.longest * self.limits.longest
            || !nears_axis(low, high, self.limits.cone_at(square))
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
    }
}

impl Limits {
    /// The side of the cone of directions to what lies at this squared distance or farther.
    fn cone_at(&self, square: f64) -> DVec2 {
        let rest = square - self.aside * self.aside;
        if rest <= 0.0 {
            return self.cone;
        }
        let narrower = DVec2::new(rest.sqrt(), self.aside);
        if narrower.perp_dot(self.cone) > 0.0 {
            narrower
        } else {
            self.cone
        }
    }
}

/// The squared distance of the origin from a segment.
fn square_to_segment(a: DVec2, b: DVec2) -> f64 {
    let side = b - a;
    let square = side.length_squared();
    if square < 1e-18 {
        return a.length_squared();
    }
    (a - side * (a.dot(side) / square).clamp(0.0, 1.0)).length_squared()
}

/// Whether an interval of directions less than half a turn wide meets a cone round
/// an axis, of which `cone` is the side next to the x axis.
pub(super) fn nears_axis(low: DVec2, high: DVec2, cone: DVec2) -> bool {
    let is_inside = |a: DVec2| {
        let [x, y] = [a.x.abs(), a.y.abs()];
        x.min(y) * cone.x <= x.max(y) * cone.y
    };
    let has_between = |axis: DVec2| low.perp_dot(axis) >= 0.0 && axis.perp_dot(high) >= 0.0;
    is_inside(low)
        || is_inside(high)
        || [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
            .into_iter()
            .any(has_between)
}
