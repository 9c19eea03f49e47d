//! Walking the tree.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use super::build::{Child, MAX_DEPTH, Node};
use super::{Bvh, Closest, closest_on_triangle};
use crate::mesh::FaceId;

/// A node leaves at most three children waiting for each level of four, that is two binary levels.
const STACK: usize = 3 * (MAX_DEPTH as usize / 2 + 1) + 1;

/// The squared distance, in the frame of the boxes, beyond which a box cannot hold anything closer.
///
/// Single precision moves the point by `f32::EPSILON` times its size and the squared distance by a
/// few of its units; the limit is that much wider, so nothing as close as the best is ever missed.
struct Limit {
    per_length: f64,
    slack: f64,
}

impl Limit {
    fn at(&self, distance_squared: f64) -> f32 {
        let far = distance_squared.sqrt() * self.per_length + self.slack;
        (far * far * (1.0 + 1e-6)) as f32
    }
}

pub(super) fn closest(
    tree: &Bvh,
    p: DVec3,
    start: Closest,
    accept: &impl Fn(FaceId) -> bool,
) -> Closest {
    let local = tree.frame.local(p);
    let slack = f64::from(f32::EPSILON) * local.abs().max_element();
    let limit = Limit {
        per_length: tree.frame.per_length,
        slack,
    };
    let point = local.as_vec3();
    let mut best = start;
    let mut bound = limit.at(best.distance_squared);
    let mut stack = [(0.0f32, Child::NONE); STACK];
    let mut top = 0;
    if !tree.nodes.is_empty() {
        top = push_children(&tree.nodes[0], point, bound, &mut stack, 0);
    }
    while top > 0 {
        top -= 1;
        let (far, child) = stack[top];
        if far > bound {
            continue;
        }
        let Some(leaf) = child.as_leaf() else {
            top = push_children(&tree.nodes[child.as_node()], point, bound, &mut stack, top);
            continue;
        };
        for (triangle, &face) in tree.triangles[leaf.clone()].iter().zip(&tree.faces[leaf]) {
            let found = closest_on_triangle(p, *triangle);
            let is_closer = match found.distance_squared.total_cmp(&best.distance_squared) {
                Ordering::Less => true,
                Ordering::Equal => face < best.face,
                Ordering::Greater => false,
            };
            if is_closer && accept(face) {
                best = found.of(face);
                bound = limit.at(best.distance_squared);
            }
        }
    }
    best
}

/// Puts the children within the bound on the stack, the nearest on top.
fn push_children(
    node: &Node,
    p: Vec3,
    bound: f32,
    stack: &mut [(f32, Child); STACK],
    mut top: usize,
) -> usize {
    let bottom = top;
    let far = distances_squared(node, p);
    for (&far, &child) in far.iter().zip(&node.child) {
        if child.is_none() || far > bound {
            continue;
        }
        let mut at = top;
        while at > bottom && stack[at - 1].0 < far {
            stack[at] = stack[at - 1];
            at -= 1;
        }
        stack[at] = (far, child);
        top += 1;
    }
    top
}

fn distances_squared(node: &Node, p: Vec3) -> [f32; 4] {
    let mut total = [0.0; 4];
    for (axis, x) in p.to_array().into_iter().enumerate() {
        for ((total, low), high) in total.iter_mut().zip(node.low[axis]).zip(node.high[axis]) {
            let far = (low - x).max(x - high).max(0.0);
            *total += far * far;
        }
    }
    total
}

pub(super) fn overlaps(tree: &Bvh, [low, high]: [DVec3; 2], mut visit: impl FnMut(FaceId)) {
    let slack = f64::from(f32::EPSILON);
    let widen = |p: DVec3, by: f64| (p + p.abs() * by).as_vec3();
    let [from, to] = [
        widen(tree.frame.local(low), -slack),
        widen(tree.frame.local(high), slack),
    ];
    let mut stack: Vec<usize> = if tree.nodes.is_empty() {
        Vec::new()
    } else {
        vec![0]
    };
    while let Some(index) = stack.pop() {
        let node = &tree.nodes[index];
        for lane in 0..4 {
            let child = node.child[lane];
            let touches = (0..3).all(|axis| {
                node.low[axis][lane] <= to[axis] && node.high[axis][lane] >= from[axis]
            });
            if child.is_none() || !touches {
                continue;
            }
            let Some(leaf) = child.as_leaf() else {
                stack.push(child.as_node());
                continue;
            };
            for slot in leaf {
                let [a, b, c] = tree.triangles[slot];
                let touches = a.min(b).min(c).cmple(high).all() && a.max(b).max(c).cmpge(low).all();
                if touches {
                    visit(tree.faces[slot]);
                }
            }
        }
    }
}
