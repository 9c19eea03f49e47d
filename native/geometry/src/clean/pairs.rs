//! Which face goes on into which at an edge.
//!
//! At an edge of two faces there is no choice. At an edge of more, solids touch: around it their
//! sides alternate, one that turns its inside to the next and one that turns it to the one before.
//! Each solid's two sides belong together; what lies between two solids is outside. Where the
//! sides do not alternate nothing is paired here: a wall inside a solid, for one, belongs to no side.
//! What is left so is for `sheets` to part.

use glam::DVec3;

use super::edges::{Edges, Twins};
use super::triangulate::Triangulated;
use crate::elementary::atan2;
use crate::mesh::{HalfedgeId, Id};

/// Faces whose angles around an edge differ by less, in radians, lie on each other: rounding makes
/// 1e-15, and no wall is modelled as thin as 1e-9.
const SAME: f64 = 1e-9;

/// The pairs of all edges.
pub(super) struct Pairing {
    pub(super) twins: Twins,
    /// The pairs at each edge where solids touch.
    pub(super) touching: Vec<Vec<[HalfedgeId; 2]>>,
    /// The halfedges of each edge of more than two faces that could not be paired.
    pub(super) shared: Vec<Vec<HalfedgeId>>,
}

impl Pairing {
    pub(super) fn new(edges: &Edges, triangulated: &Triangulated) -> Self {
        let mut twins = Twins::none(3 * triangulated.faces.len());
        let (mut touching, mut shared) = (Vec::new(), Vec::new());
        for run in edges.runs() {
            match *run {
                [_] => {}
                [g, h] => twins.link(g, h),
                _ => match solids(run, triangulated) {
                    Some(pairs) => {
                        for &[g, h] in &pairs {
                            twins.link(g, h);
                        }
                        touching.push(pairs);
                    }
                    None => shared.push(run.to_vec()),
                },
            }
        }
        Self {
            twins,
            touching,
            shared,
        }
    }
}

/// A face at an edge.
#[derive(Clone, Copy)]
struct Side {
    angle: f64,
    /// Whether it runs through the edge as the first face does; its inside is at smaller angles.
    is_along: bool,
    h: HalfedgeId,
}

/// The two sides of each solid at an edge, if all are sides of solids.
fn solids(run: &[HalfedgeId], triangulated: &Triangulated) -> Option<Vec<[HalfedgeId; 2]>> {
    if !run.len().is_multiple_of(2) {
        return None;
    }
    let clusters = clusters(sides(run, triangulated)?);
    let order = [true, false]
        .into_iter()
        .find_map(|first| alternating(&clusters, first))?;
    let next = order.iter().cycle().skip(1);
    let pairs = order.iter().zip(next).filter(|(side, _)| !side.is_along);
    Some(pairs.map(|(side, next)| [side.h, next.h]).collect())
}

/// The faces by their angle around the edge; none where one has no area.
fn sides(run: &[HalfedgeId], triangulated: &Triangulated) -> Option<Vec<Side>> {
    let corner = |h: HalfedgeId| triangulated.faces[h.face().index()][h.corner()];
    let start = corner(run[0]);
    let [from, to] = [start, corner(run[0].next())].map(|v| triangulated.scaled(v));
    let along = (to - from).try_normalize()?;
    let arm = |h: HalfedgeId| -> Option<DVec3> {
        let arm = triangulated.scaled(corner(h.prev())) - from;
        (arm - along * arm.dot(along)).try_normalize()
    };
    let x = arm(run[0])?;
    let y = along.cross(x);
    let side = |&h: &HalfedgeId| {
        let arm = arm(h)?;
        Some(Side {
            angle: atan2(arm.dot(y), arm.dot(x)),
            is_along: corner(h) == start,
            h,
        })
    };
    let mut sides: Vec<Side> = run.iter().map(side).collect::<Option<_>>()?;
    sides.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.h.cmp(&b.h)));
    Some(sides)
}

/// Faces that lie on each other together, going round once from the start of such a cluster.
fn clusters(mut sides: Vec<Side>) -> Vec<Vec<Side>> {
    const TURN: f64 = std::f64::consts::TAU;
    let gap_before = |i: usize| match i.checked_sub(1) {
        Some(before) => sides[i].angle - sides[before].angle,
        None => sides[0].angle + TURN - sides[sides.len() - 1].angle,
    };
    let start = (0..sides.len()).find(|&i| gap_before(i) > SAME);
    sides.rotate_left(start.unwrap_or(0));
    let is_same = |a: &Side, b: &Side| (b.angle - a.angle).rem_euclid(TURN) <= SAME;
    sides.chunk_by(is_same).map(<[Side]>::to_vec).collect()
}

/// The faces in such an order that sides alternate, beginning with one along the edge or against it.
fn alternating(clusters: &[Vec<Side>], first: bool) -> Option<Vec<Side>> {
    let mut order: Vec<Side> = Vec::new();
    for cluster in clusters {
        let mut left = cluster.clone();
        while !left.is_empty() {
            let wanted = order.last().map_or(first, |last| !last.is_along);
            let at = left.iter().position(|side| side.is_along == wanted)?;
            order.push(left.remove(at));
        }
    }
    let closes = order.first()?.is_along != order.last()?.is_along;
    closes.then_some(order)
}
