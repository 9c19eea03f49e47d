//! Building the tree: binned surface area heuristic, two binary splits for each node of four.

use glam::{DVec3, Vec3};

use super::Frame;
use crate::progress::{Cancelled, Progress};

/// Triangles in a leaf, at most. One makes the tree larger for nothing; four slow the search by a
/// tenth, since more triangles are tested in vain.
const LEAF: usize = 2;
/// Bins along the split axis.
const N_BINS: usize = 16;
/// Ranges up to this long are split in the middle: bins would cost more than they gain.
const SMALL: usize = 8;
/// The deepest binary level; the stack of the search is sized for it.
pub(super) const MAX_DEPTH: u32 = 40;
/// A child that is not there.
pub(super) const EMPTY: u32 = u32::MAX;
const LEAF_FLAG: u32 = 1 << 31;

/// Four boxes, side by side for the processor's sake, and what is in them.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub low: [[f32; 4]; 3],
    pub high: [[f32; 4]; 3],
    pub child: [Child; 4],
}

/// A node, a leaf or nothing, in 32 bits: a leaf keeps its length in the three bits below the flag.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Child(u32);

impl Child {
    pub const NONE: Self = Self(EMPTY);

    fn leaf(start: usize, len: usize) -> Self {
        Self(LEAF_FLAG | (len as u32 - 1) << 28 | start as u32)
    }

    pub fn is_none(self) -> bool {
        self.0 == EMPTY
    }

    /// The range of triangles of a leaf.
    pub fn as_leaf(self) -> Option<std::ops::Range<usize>> {
        let start = (self.0 & !(0b1111 << 28)) as usize;
        let len = (self.0 >> 28 & 0b111) as usize + 1;
        (self.0 & LEAF_FLAG != 0).then_some(start..start + len)
    }

    pub fn as_node(self) -> usize {
        self.0 as usize
    }
}

/// A triangle's box in the local frame, rounded outwards, and its id.
#[derive(Clone, Copy)]
struct Boxed {
    low: Vec3,
    high: Vec3,
    face: u32,
}

impl Boxed {
    /// Twice the middle.
    fn middle(&self) -> Vec3 {
        self.low + self.high
    }
}

#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    const NOTHING: Self = Self {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };

    fn with(self, low: Vec3, high: Vec3) -> Self {
        Self {
            low: self.low.min(low),
            high: self.high.max(high),
        }
    }

    fn half_surface(self) -> f32 {
        let d = self.high - self.low;
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

/// Nodes with fewer triangles are built without a look at the progress: a millisecond of work.
const LARGE: usize = 10_000;

/// The nodes, root first, and the triangles in the order of leaves.
pub(super) fn build(
    triangles: &[[DVec3; 3]],
    frame: Frame,
    progress: &Progress,
) -> Result<(Vec<Node>, Vec<u32>), Cancelled> {
    progress.check()?;
    let mut boxes: Vec<Boxed> = (0..)
        .zip(triangles)
        .map(|(face, t)| boxed(face, t, frame))
        .collect();
    let mut builder = Builder {
        nodes: Vec::with_capacity(triangles.len() / LEAF + 1),
        progress,
    };
    if !boxes.is_empty() {
        builder.add_node(&mut boxes, 0, 0)?;
    }
    let order = boxes.into_iter().map(|b| b.face).collect();
    Ok((builder.nodes, order))
}

struct Builder<'a> {
    nodes: Vec<Node>,
    progress: &'a Progress<'a>,
}

fn boxed(face: u32, &[a, b, c]: &[DVec3; 3], frame: Frame) -> Boxed {
    let [a, b, c] = [a, b, c].map(|p| frame.local(p));
    Boxed {
        low: round_down(a.min(b).min(c)),
        high: -round_down(-a.max(b).max(c)),
        face,
    }
}

pub(super) fn round_down(p: DVec3) -> Vec3 {
    // One step down is at least as much as rounding to nearest can have gone up.
    Vec3::from_array(p.as_vec3().to_array().map(f32::next_down))
}

impl Builder<'_> {
    fn add_node(
        &mut self,
        boxes: &mut [Boxed],
        start: usize,
        depth: u32,
    ) -> Result<u32, Cancelled> {
        if boxes.len() > LARGE {
            self.progress.check()?;
        }
        let index = self.nodes.len();
        self.nodes.push(Node {
            low: [[f32::INFINITY; 4]; 3],
            high: [[f32::NEG_INFINITY; 4]; 3],
            child: [Child::NONE; 4],
        });
        let middle = split(boxes, depth);
        let (left, right) = boxes.split_at_mut(middle);
        let mut lane = 0;
        let mut at = start;
        for half in [left, right] {
            let quarter = split(half, depth + 1);
            let (first, second) = half.split_at_mut(quarter);
            for part in [first, second] {
                if !part.is_empty() {
                    let child = if part.len() <= LEAF {
                        Child::leaf(at, part.len())
                    } else {
                        Child(self.add_node(part, at, depth + 2)?)
                    };
                    set_lane(&mut self.nodes[index], lane, part, child);
                    lane += 1;
                    at += part.len();
                }
            }
        }
        Ok(index as u32)
    }
}

fn set_lane(node: &mut Node, lane: usize, part: &[Boxed], child: Child) {
    let all = part
        .iter()
        .fold(Bounds::NOTHING, |all, b| all.with(b.low, b.high));
    for axis in 0..3 {
        node.low[axis][lane] = all.low[axis];
        node.high[axis][lane] = all.high[axis];
    }
    node.child[lane] = child;
}

/// Sorts the boxes into two parts and returns the length of the first: all of them when they fit
/// into a leaf.
fn split(boxes: &mut [Boxed], depth: u32) -> usize {
    let n = boxes.len();
    if n <= LEAF {
        return n;
    }
    let middles = boxes
        .iter()
        .fold(Bounds::NOTHING, |all, b| all.with(b.middle(), b.middle()));
    let axis = (middles.high - middles.low).max_position();
    let is_deep = depth + usize::BITS - n.leading_zeros() >= MAX_DEPTH;
    if n > SMALL && !is_deep && middles.high[axis] > middles.low[axis] {
        let n_first = split_by_bins(boxes, middles, axis);
        if 0 < n_first && n_first < n {
            return n_first;
        }
    }
    boxes.select_nth_unstable_by(n / 2, |a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
    n / 2
}

fn split_by_bins(boxes: &mut [Boxed], middles: Bounds, axis: usize) -> usize {
    let low = middles.low[axis];
    let per_length = N_BINS as f32 / (middles.high[axis] - low);
    let bin_of = |b: &Boxed| (((b.middle()[axis] - low) * per_length) as usize).min(N_BINS - 1);
    let mut bins = [(Bounds::NOTHING, 0u32); N_BINS];
    for b in boxes.iter() {
        let bin = &mut bins[bin_of(b)];
        *bin = (bin.0.with(b.low, b.high), bin.1 + 1);
    }
    let last_left = cheapest_border(&bins);
    partition(boxes, |b| bin_of(b) <= last_left)
}

/// The last bin left of the border at which count × surface, summed over both sides, is least.
fn cheapest_border(bins: &[(Bounds, u32); N_BINS]) -> usize {
    let grow = |sum: &mut (Bounds, u32), bin: &(Bounds, u32)| {
        *sum = (sum.0.with(bin.0.low, bin.0.high), sum.1 + bin.1);
        let cost = if sum.1 > 0 {
            sum.1 as f32 * sum.0.half_surface()
        } else {
            0.0
        };
        Some(cost)
    };
    let mut right = [0.0; N_BINS];
    let from_right = bins.iter().rev().scan((Bounds::NOTHING, 0), grow);
    for (slot, cost) in right.iter_mut().rev().zip(from_right) {
        *slot = cost;
    }
    let from_left = bins.iter().scan((Bounds::NOTHING, 0), grow);
    let costs = from_left.zip(&right[1..]).map(|(l, r)| l + r).enumerate();
    costs
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(i, _)| i)
}

/// Brings those that belong to the first part to the front and counts them.
fn partition(boxes: &mut [Boxed], is_first: impl Fn(&Boxed) -> bool) -> usize {
    let mut n_first = 0;
    for i in 0..boxes.len() {
        if is_first(&boxes[i]) {
            boxes.swap(i, n_first);
            n_first += 1;
        }
    }
    n_first
}
