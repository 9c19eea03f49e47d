//! Sharp edges and corners: vertices are led onto the target's feature lines and stay there.
//!
//! Each corner takes the nearest vertex, each line between two corners the cheapest path over the
//! sheet's edges, whose vertices go to even arc lengths along it. They walk there in steps, while
//! the free vertices make room, and nothing folds on the sphere on the way. A vertex that arrives
//! is pinned; one that does not is free again.

use std::collections::HashMap;

use glam::DVec3;

use super::cover::Cover;
use super::project::lift_towards;
use super::relax::relax;
use super::route::Router;
use super::sheet::Sheet;
use super::target::Target;
use super::{Lines, Settings};
use crate::measure::FeatureLine;
use crate::mesh::{FaceId, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Lines shorter than this many edges are left to the faces: a chamfer, noise of a scan.
const SHORTEST: f64 = 2.5;
/// A corner takes a vertex no farther away than this many edges.
const GRASP: f64 = 1.5;
/// Steps in which vertices walk to their lines.
const N_STEPS: usize = 6;
/// A walk counts as arrived within this share of an edge.
const ARRIVED: f64 = 0.05;
/// Quality that pinning a vertex may not spoil unless the face is worse already.
const LEAST_QUALITY: f64 = 0.1;

/// Where a vertex is to go.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Goal {
    vertex: VertexId,
    position: DVec3,
}

/// Pins vertices to the target's feature lines; returns how many were to be and how many are.
pub(super) fn snap(
    sheet: &mut Sheet,
    mut cover: Option<&mut Cover>,
    (target, settings): (&Target, &Settings),
    progress: &Progress,
) -> Result<[usize; 2], Cancelled> {
    let edge = sheet.mean_edge();
    let shortest = if settings.lines == Lines::Sought {
        SHORTEST * edge
    } else {
        0.0
    };
    let lines = target.features().iter();
    let lines = lines.filter(|line| line.length() > shortest);
    let mut plan = Plan::new(sheet, edge);
    for line in lines {
        progress.check()?;
        plan.add(sheet, target, line);
    }
    let Plan { goals, edges, .. } = plan;
    for goal in &goals {
        sheet.pin(goal.vertex);
    }
    for [a, b] in edges {
        sheet.keep_edge(a, b);
    }
    for step in 0..N_STEPS {
        let share = 1.0 / (N_STEPS - step) as f64;
        for goal in &goals {
            walk(sheet, goal, share);
        }
        relax(
            sheet,
            cover.as_deref_mut(),
            (1, settings.sizes),
            &progress.part("", step as f64 / N_STEPS as f64, 1.0),
        )?;
    }
    let n_pinned = goals
        .iter()
        .filter(|goal| arrive(sheet, goal, ARRIVED * edge))
        .count();
    Ok([goals.len(), n_pinned])
}

/// Goals and kept edges as they are found, line by line.
struct Plan {
    edge: f64,
    vertices: Bvh,
    router: Router,
    taken: VertexMap<bool>,
    /// Which vertex stands at a corner of the target.
    corners: HashMap<VertexId, VertexId>,
    goals: Vec<Goal>,
    edges: Vec<[VertexId; 2]>,
}

impl Plan {
    fn new(sheet: &Sheet, edge: f64) -> Self {
        let n = sheet.n_vertices();
        let points: Vec<_> = sheet.vertex_ids().map(|v| sheet.position(v)).collect();
        Self {
            edge,
            vertices: Bvh::of_points(&points),
            router: Router::new(n, edge),
            taken: sheet.vertex_ids().map(|v| sheet.is_pinned(v)).collect(),
            corners: HashMap::new(),
            goals: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Plans one line: all of it or nothing but its corners.
    fn add(&mut self, sheet: &Sheet, target: &Target, line: &FeatureLine) {
        let stops: &[f64] = if line.is_closed() {
            &[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]
        } else {
            &[0.0, 1.0]
        };
        let stops: Vec<_> = stops.iter().map(|share| share * line.length()).collect();
        let ends: Vec<_> = stops
            .iter()
            .map(|&at| self.corner(sheet, target, line, at))
            .collect();
        for (pair, span) in ends.windows(2).zip(stops.windows(2)) {
            let (Some(first), Some(last)) = (pair[0], pair[1]) else {
                continue;
            };
            let taken = &self.taken;
            let path = self.router.path(sheet, [first, last], line, |v| !taken[v]);
            if let Some(path) = path.filter(|path| first != last && self.is_direct(path, span)) {
                self.take(line, &path, [span[0], span[1]]);
            }
        }
    }

    /// The vertex that stands at a point of the line, if there is one near enough.
    fn corner(
        &mut self,
        sheet: &Sheet,
        target: &Target,
        line: &FeatureLine,
        at: f64,
    ) -> Option<VertexId> {
        let (position, before) = line.at(at);
        let end = if at >= line.length() {
            *line.vertices.last()?
        } else {
            before
        };
        if let Some(&vertex) = self.corners.get(&end) {
            return Some(vertex);
        }
        let normal = target.vertex_normal(end);
        let reach = (GRASP * self.edge).powi(2);
        let fits = |face: FaceId| {
            let v = VertexId(face.0);
            let own = sheet.point(v).normal;
            // Where two sides lie on each other their rim looks no way.
            let looks_away = own != DVec3::ZERO && normal != DVec3::ZERO && own.dot(normal) <= 0.0;
            !self.taken[v] && !looks_away
        };
        let vertex = VertexId(self.vertices.closest_where(position, reach, fits)?.face.0);
        self.taken[vertex] = true;
        self.corners.insert(end, vertex);
        self.goals.push(Goal { vertex, position });
        Some(vertex)
    }

    /// Whether a path has about as many edges as its line is long.
    fn is_direct(&self, path: &[VertexId], span: &[f64]) -> bool {
        (path.len() - 1) as f64 <= 1.0 + 1.8 * (span[1] - span[0]) / self.edge
    }

    fn take(&mut self, line: &FeatureLine, path: &[VertexId], [from, to]: [f64; 2]) {
        let n = path.len() - 1;
        for (i, &vertex) in path.iter().enumerate().take(n).skip(1) {
            let position = line.at(from + (to - from) * i as f64 / n as f64).0;
            self.taken[vertex] = true;
            self.goals.push(Goal { vertex, position });
        }
        self.edges
            .extend(path.windows(2).map(|pair| [pair[0], pair[1]]));
    }
}

/// Walks a share of the way to a goal, or half of that, if nothing folds.
fn walk(sheet: &mut Sheet, goal: &Goal, share: f64) {
    for share in [share, share / 2.0] {
        let wanted = sheet.position(goal.vertex).lerp(goal.position, share);
        let there = sheet.walked(goal.vertex, wanted);
        if sheet.try_move(goal.vertex, there) {
            break;
        }
    }
}

/// Puts a vertex exactly to its goal if it has come near, and frees it otherwise.
fn arrive(sheet: &mut Sheet, goal: &Goal, near: f64) -> bool {
    let is_near = sheet.position(goal.vertex).distance(goal.position) <= near;
    let arrived =
        is_near && lift_towards(sheet, goal.vertex, goal.position, LEAST_QUALITY) == Some(0);
    if !arrived {
        sheet.unpin(goal.vertex);
    }
    arrived
}
