//! Seams that are not quite closed: borders that lie on each other within a distance.
//!
//! Two border edges lie on each other if both ends of one are near ends of the other: no farther
//! than the weld distance, and no farther than a quarter of the shorter edge. The second bound is
//! what keeps a small hole open, whatever its size: around a hole that is round, points are no
//! nearer to each other than the edges between them are long. A slit closes, for its sides run
//! along each other over edges that are long beside the gap. Two corners of one face never become
//! one, so that no face goes.

use std::collections::HashMap;

use glam::DVec3;

use super::Apart;
use super::scale::Scale;
use super::weld::bits;
use crate::mesh::{FaceId, HalfedgeId, Id, PolygonMesh, bounds};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Borders are welded up to this share of the diagonal unless said otherwise: coordinates written
/// with six digits are off by 1e-6, and what is modelled as a gap is larger than 1e-4.
pub const WELD: f64 = 1e-5;
/// The gap is no more than this share of the edges along it: at a half a triangle of edges that
/// differ as 1 to 2 would close, at a tenth seams over short edges stay open.
const OF_EDGE: f64 = 0.25;

/// The input's positions with seams closed.
pub(super) struct Closed {
    pub(super) positions: Vec<DVec3>,
    /// How many points went to others.
    pub(super) n_welded: usize,
    /// The largest gap that was closed.
    pub(super) gap: f64,
}

/// The weld distance of a mesh, a share of its diagonal, in its own units.
pub fn distance(input: &PolygonMesh, share: f64) -> f64 {
    let corners = input.corners().iter();
    let corners: Vec<DVec3> = corners.map(|&v| input.position(v)).collect();
    let scale = Scale::of(&corners);
    let [low, high] = bounds(&corners).map(|p| scale.point(p));
    scale.length(share * low.distance(high))
}

/// Closes the seams of what was taken apart; none where there are none.
///
/// # Errors
/// When cancelled.
pub(super) fn close(
    input: &PolygonMesh,
    apart: &Apart,
    distance: f64,
    progress: &Progress,
) -> Result<Option<Closed>, Cancelled> {
    let scale = Scale::of(input.positions());
    let mut borders = Borders::new(input, apart, scale);
    if borders.edges.len() < 2 {
        return Ok(None);
    }
    progress.check()?;
    let reach = scale.factor(distance);
    let pairs = borders.pairs(reach, progress)?;
    let mut gap = 0.0f64;
    for pair in pairs {
        if borders.weld(&pair) {
            gap = gap.max(pair.gap);
        }
    }
    let (moved, n_welded) = borders.moved();
    let place = |p: &DVec3| moved.get(&p.to_array().map(bits)).copied().unwrap_or(*p);
    Ok((n_welded > 0).then(|| Closed {
        positions: input.positions().iter().map(place).collect(),
        n_welded,
        gap: scale.length(gap),
    }))
}

/// The points and edges of all borders. Edges name points by their places.
struct Borders {
    /// The points as they are, each once.
    points: Vec<DVec3>,
    /// The same in a scale in which products are safe.
    scaled: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
    is_used: Vec<bool>,
    /// The point that stands for each; itself if it stays.
    first: Vec<u32>,
    /// The faces at all points that each stands for, in order.
    faces: Vec<Vec<FaceId>>,
}

/// Two edges that lie on each other.
struct Pair {
    gap: f64,
    edges: [u32; 2],
    /// Which ends lie on which.
    ends: [[u32; 2]; 2],
}

impl Borders {
    fn new(input: &PolygonMesh, apart: &Apart, scale: Scale) -> Self {
        let (mesh, origin) = (&apart.mesh, &apart.origin);
        let is_border = |h: &HalfedgeId| mesh.twin(*h).is_none();
        let ends = |h| [mesh.origin(h), mesh.target(h)].map(|v| origin[v]);
        let edges = mesh.halfedge_ids().filter(is_border).map(ends);
        let tangled = apart.tangles.iter().flat_map(|tangle| &tangle.border);
        let edges: Vec<_> = edges.chain(tangled.copied()).collect();
        let mut names = HashMap::new();
        let mut points = Vec::new();
        for v in edges.iter().flatten() {
            let point = input.position(*v);
            names.entry(point.to_array().map(bits)).or_insert_with(|| {
                points.push(point);
                points.len() as u32 - 1
            });
        }
        let name = |p: DVec3| names.get(&p.to_array().map(bits)).copied();
        let mut faces = vec![Vec::new(); points.len()];
        if !points.is_empty() {
            for face in input.face_ids() {
                for &v in input.face(face) {
                    if let Some(point) = name(input.position(v)) {
                        faces[point as usize].push(face);
                    }
                }
            }
        }
        let edges = edges
            .iter()
            .map(|ends| ends.map(|v| name(input.position(v)).unwrap_or(0)));
        let edges: Vec<[u32; 2]> = edges.collect();
        Self {
            scaled: points.iter().map(|&p| scale.point(p)).collect(),
            first: (0..points.len() as u32).collect(),
            points,
            is_used: vec![false; edges.len()],
            edges,
            faces,
        }
    }

    fn at(&self, point: u32) -> DVec3 {
        self.scaled[point as usize]
    }

    /// All pairs of edges that lie on each other, the nearest first.
    fn pairs(&self, reach: f64, progress: &Progress) -> Result<Vec<Pair>, Cancelled> {
        let middle = |&[a, b]: &[u32; 2]| self.at(a).midpoint(self.at(b));
        let middles: Vec<DVec3> = self.edges.iter().map(middle).collect();
        let tree = Bvh::build_of_points(&middles, progress)?;
        let mut pairs = Vec::new();
        let box_reach = DVec3::splat(reach);
        for (i, &p) in middles.iter().enumerate() {
            progress.check()?;
            tree.visit_overlaps(p - box_reach, p + box_reach, |other| {
                if other.index() > i {
                    pairs.extend(self.pair([i as u32, other.0], reach));
                }
            });
        }
        pairs.sort_by(|a, b| a.gap.total_cmp(&b.gap).then(a.edges.cmp(&b.edges)));
        Ok(pairs)
    }

    fn pair(&self, edges: [u32; 2], reach: f64) -> Option<Pair> {
        let [[a, b], [c, d]] = edges.map(|edge| self.edges[edge as usize]);
        let apart = |p, q| self.at(p).distance(self.at(q));
        let reach = reach.min(OF_EDGE * apart(a, b).min(apart(c, d)));
        // Faces that agree run through a seam in opposite directions; they need not agree.
        let ways = [[[a, d], [b, c]], [[a, c], [b, d]]];
        let pair = ways.map(|ends| Pair {
            gap: f64::max(apart(ends[0][0], ends[0][1]), apart(ends[1][0], ends[1][1])),
            edges,
            ends,
        });
        let nearest = pair.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap))?;
        (nearest.gap <= reach).then_some(nearest)
    }

    /// Welds the ends of a pair, unless one of the edges is welded or a face would lose a corner.
    fn weld(&mut self, pair: &Pair) -> bool {
        if pair.edges.iter().any(|&edge| self.is_used[edge as usize]) {
            return false;
        }
        let ends = pair.ends.map(|ends| ends.map(|p| self.first[p as usize]));
        if !ends.iter().all(|&ends| self.may_weld(ends)) {
            return false;
        }
        for [p, q] in pair.ends {
            self.join([p, q].map(|p| self.first[p as usize]));
        }
        for edge in pair.edges {
            self.is_used[edge as usize] = true;
        }
        true
    }

    fn may_weld(&self, [p, q]: [u32; 2]) -> bool {
        let [of_p, of_q] = [p, q].map(|p| &self.faces[p as usize]);
        p == q || !of_p.iter().any(|face| of_q.binary_search(face).is_ok())
    }

    fn join(&mut self, [p, q]: [u32; 2]) {
        if p == q {
            return;
        }
        let [stays, goes] = [p.min(q), p.max(q)];
        let mut faces = std::mem::take(&mut self.faces[goes as usize]);
        faces.append(&mut self.faces[stays as usize]);
        faces.sort_unstable();
        self.faces[stays as usize] = faces;
        for first in self.first.iter_mut().filter(|first| **first == goes) {
            *first = stays;
        }
    }

    /// Where points go that do not stay, by their own places, and how many there are.
    fn moved(&self) -> (HashMap<[u64; 3], DVec3>, usize) {
        let all = self.points.iter().zip(&self.first).enumerate();
        let gone = all.filter(|(i, (_, first))| *i != **first as usize);
        let moved: HashMap<_, _> = gone
            .map(|(_, (p, &first))| (p.to_array().map(bits), self.points[first as usize]))
            .collect();
        let n = moved.len();
        (moved, n)
    }
}
