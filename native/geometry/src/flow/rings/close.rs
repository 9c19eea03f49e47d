//! Closes a cylinder whose border was seen to come back, and checks that it is one.

use std::collections::BTreeMap;

use glam::{DVec2, IVec2};

use super::Cylinder;
use super::sight::Sights;
use crate::flow::complex::{Complex, Turn};
use crate::mesh::{FaceId, HalfedgeId};

/// How far a left border may reach over the line through the cone: rounding.
const OVER: f64 = 1e-7;
/// The sine within which two directions are one.
const SAME: f64 = 1e-9;
/// More edges than this do not meet at one cone.
const MOST_TURNS: usize = 200;

/// The cylinder on the right of the line from the first corner to the third of the i-th sight.
///
/// There the line goes on through the same cone: turning round it on the right has to lead back
/// to the first corner, in the same frame, after half a turn.
pub(super) fn close(
    complex: &Complex,
    sights: &Sights,
    i: usize,
    narrowest: f64,
) -> Option<Cylinder> {
    let first = sights.sight(0).entered;
    let last = sights.sight(i);
    let period = last.right + complex.start[last.entered.next()].turned(last.turns);
    let along = period / period.length();
    if sights.back_from(i).any(|s| along.perp_dot(s.left) < -OVER) {
        return None;
    }
    let widths = sights.back_from(i).map(|s| -along.perp_dot(s.right));
    let mut width = widths.fold(f64::INFINITY, f64::min);
    let mut entered = sights.entered_to(i);
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
            let [coefficients, _] = coefficients_to(complex, first, &entered);
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

/// The places of the left and right ends of the last entered edge over the free periods.
pub(super) fn coefficients_to(
    complex: &Complex,
    first: HalfedgeId,
    entered: &[HalfedgeId],
) -> [Vec<IVec2>; 2] {
    let rows = &complex.coefficients;
    let mut left = vec![IVec2::ZERO; rows.n_columns()];
    let mut right = rows.row(first).to_vec();
    let (mut own, mut turns) = (first, 0);
    for &next in entered {
        let apex = apex_row(complex, own, turns, &right);
        let edge = complex.twins[next];
        if edge == own.next() {
            left = apex;
        } else {
            right = apex;
        }
        turns = (turns + 4 - complex.turns[edge]) % 4;
        own = next;
    }
    [left, right]
}

/// The place of the third corner of a triangle over the free periods.
pub(super) fn apex_row(
    complex: &Complex,
    entered: HalfedgeId,
    turns: u8,
    right: &[IVec2],
) -> Vec<IVec2> {
    let side = complex.coefficients.row(entered.next());
    (right.iter().zip(side))
        .map(|(&r, s)| r + s.turned(turns))
        .collect()
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
        let (mut own, mut turns) = (first, 0);
        let mut shares = Vec::with_capacity(self.entered.len());
        for &next in &self.entered {
            let apex = right + complex.start[own.next()].turned(turns);
            let edge = complex.twins[next];
            if edge == own.next() {
                left = apex;
            } else {
                right = apex;
            }
            turns = (turns + 4 - complex.turns[edge]) % 4;
            own = next;
            let [l, r] = [along.perp_dot(left), along.perp_dot(right)];
            shares.push(((l + 0.5 * self.width) / (l - r)).clamp(0.0, 1.0));
        }
        shares
    }
}
