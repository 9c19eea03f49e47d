//! Closes a cylinder whose border was seen to come back, and checks that it is one.

use std::collections::BTreeMap;

use glam::{DVec2, IVec2};

use super::Cylinder;
use super::sight::{SAME, Sights};
use crate::flow::complex::{Complex, Turn};
use crate::mesh::{FaceId, HalfedgeId};

/// How far a left border may reach over the line through the cone: rounding.
const OVER: f64 = 1e-7;
/// More edges than this do not meet at one cone.
const MOST_TURNS: usize = 200;

/// The cylinder on the right of the line from the first corner to `period`, the third of the last
/// triangle seen.
///
/// There the line goes on through the same cone: turning round it on the right has to lead back
/// to the first corner, in the same frame, after half a turn.
pub(super) fn close(
    complex: &Complex,
    sights: &Sights,
    period: DVec2,
    narrowest: f64,
) -> Option<Cylinder> {
    let first = sights.first().entered;
    let last = sights.last();
    let along = period / period.length();
    if sights.back().any(|s| along.perp_dot(s.left) < -OVER) {
        return None;
    }
    let widths = sights.back().map(|s| -along.perp_dot(s.right));
    let mut width = widths.fold(f64::INFINITY, f64::min);
    let mut entered = sights.entered();
    let (mut edge, mut turns) = (last.entered.next(), last.turns);
    for _ in 0..MOST_TURNS {
        let leaving = complex.twins[edge];
        turns = (turns + 4 - complex.turns[edge]) % 4;
        entered.push(leaving);
        let right = complex.start[leaving].turned(turns);
        let left = -complex.start[leaving.prev()].turned(turns);
        width = width.min(-along.perp_dot(right));
        if width < narrowest {
            return None;
        }
        let holds_line = right.perp_dot(along) > SAME * right.length()
            && along.perp_dot(left) >= -SAME * left.length();
        if holds_line {
            let is_back = leaving == first && turns == 0 && !is_repeated(&entered);
            if !is_back {
                return None;
            }
            let [coefficients, _] = places(complex, first, &entered);
            return Some(Cylinder {
                period,
                width,
                coefficients,
                entered,
            });
        }
        edge = leaving.prev();
    }
    None
}

/// Whether a list is a shorter one several times over: the cylinder was gone round more than once.
fn is_repeated(entered: &[HalfedgeId]) -> bool {
    let n = entered.len();
    let has_length = |p: usize| (0..n - p).all(|i| entered[i] == entered[i + p]);
    (1..n).any(|p| n.is_multiple_of(p) && has_length(p))
}

/// One triangle of a strip, on the way to the next.
struct Step {
    /// The halfedge through which the strip came.
    entered: HalfedgeId,
    /// Quarter turns from its frame to the first's.
    turns: u8,
    /// Whether its third corner is on the left of the strip.
    is_left: bool,
}

/// Follows a strip of triangles from the one of `first` through the given edges.
fn strip<'a>(
    complex: &'a Complex,
    first: HalfedgeId,
    entered: &'a [HalfedgeId],
) -> impl Iterator<Item = Step> + 'a {
    let (mut own, mut turns) = (first, 0);
    entered.iter().map(move |&next| {
        let edge = complex.twins[next];
        let step = Step {
            entered: own,
            turns,
            is_left: edge == own.next(),
        };
        turns = (turns + 4 - complex.turns[edge]) % 4;
        own = next;
        step
    })
}

/// The places of the left and right ends of the last entered edge over the free periods.
pub(super) fn places(
    complex: &Complex,
    first: HalfedgeId,
    entered: &[HalfedgeId],
) -> [Vec<IVec2>; 2] {
    let rows = &complex.coefficients;
    let mut left = vec![IVec2::ZERO; rows.n_columns()];
    let mut right = left.clone();
    rows.add_to(&mut right, first, 0);
    for step in strip(complex, first, entered) {
        // The third corner takes the place of one of the two.
        let own = if step.is_left {
            left.copy_from_slice(&right);
            &mut left
        } else {
            &mut right
        };
        rows.add_to(own, step.entered.next(), step.turns);
    }
    [left, right]
}

impl Cylinder {
    /// Whether its core line does not cross itself: no two of its chords of a triangle interlace.
    pub(super) fn is_simple(&self, complex: &Complex) -> bool {
        let shares = self.core_shares(complex);
        let n = self.entered.len();
        let mut chords: BTreeMap<FaceId, Vec<[f64; 2]>> = BTreeMap::new();
        for k in 0..n {
            let [own, next] = [self.entered[k], complex.twins[self.entered[(k + 1) % n]]];
            let a = own.corner() as f64 + shares[k];
            let b = next.corner() as f64 + 1.0 - shares[(k + 1) % n];
            let chord = [a.min(b), a.max(b)];
            let others = chords.entry(own.face()).or_default();
            let is_inside = |x: f64| x > chord[0] && x < chord[1];
            if others.iter().any(|o| is_inside(o[0]) != is_inside(o[1])) {
                return false;
            }
            others.push(chord);
        }
        true
    }

    /// Where the core line crosses each entered edge, as a share of the way from left to right.
    fn core_shares(&self, complex: &Complex) -> Vec<f64> {
        let along = self.period / self.period.length();
        let Some(&first) = self.entered.last() else {
            return Vec::new();
        };
        let [mut left, mut right] = [DVec2::ZERO, complex.start[first]];
        let share = |step: Step| {
            let apex = right + complex.start[step.entered.next()].turned(step.turns);
            *(if step.is_left { &mut left } else { &mut right }) = apex;
            let [l, r] = [along.perp_dot(left), along.perp_dot(right)];
            ((l + 0.5 * self.width) / (l - r)).clamp(0.0, 1.0)
        };
        strip(complex, first, &self.entered).map(share).collect()
    }
}
