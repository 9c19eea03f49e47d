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
use crate::groups::Groups;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, bounds};
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
    let moved = borders.moved();
    let place = |p: &DVec3| moved.get(&p.to_array().map(bits)).copied().unwrap_or(*p);
    Ok((!moved.is_empty()).then(|| Closed {
        positions: input.positions().iter().map(place).collect(),
        n_welded: moved.len(),
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
    /// Points that became one; the first of them stays.
    groups: Groups,
    /// The faces at all points of the group of each first point, in order.
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
        let tangled = apart.tangles.iter().flat_map(|tangle| &tangle.border);
        let mut edges = apart.border();
        edges.extend(tangled);
        let mut names = HashMap::new();
        let mut points = Vec::new();
        for v in edges.iter().flatten() {
            let point = input.position(*v);
            names.entry(point.to_array().map(bits)).or_insert_with(|| {
                points.push(point);
                points.len() as u32 - 1
            });
        }
        let name = |p: &DVec3| names.get(&p.to_array().map(bits)).copied();
        let of_vertices: Vec<Option<u32>> = match points.len() {
            0 => Vec::new(),
            _ => input.positions().iter().map(name).collect(),
        };
        let mut faces = vec![Vec::new(); points.len()];
        for face in input.face_ids().filter(|_| !points.is_empty()) {
            for point in input
                .face(face)
                .iter()
                .filter_map(|v| of_vertices[v.index()])
            {
                faces[point as usize].push(face);
            }
        }
        let named = |v: VertexId| of_vertices[v.index()].expect("every end is a point");
        let edges: Vec<[u32; 2]> = edges.iter().map(|ends| ends.map(named)).collect();
        Self {
            scaled: points.iter().map(|&p| scale.point(p)).collect(),
            groups: Groups::new(points.len()),
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
        for (i, &p) in middles.iter().enumerate() {
            progress.check()?;
            let [a, b] = self.edges[i].map(|p| self.at(p));
            let reach = DVec3::splat(reach.min(OF_EDGE * a.distance(b)));
            tree.visit_overlaps(p - reach, p + reach, |other| {
                if other.index() > i {
                    pairs.extend(self.pair([i as u32, other.0], reach.x));
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
        if !pair.ends.into_iter().all(|ends| self.may_weld(ends)) {
            return false;
        }
        for ends in pair.ends {
            self.join(ends);
        }
        for edge in pair.edges {
            self.is_used[edge as usize] = true;
        }
        true
    }

    fn may_weld(&mut self, ends: [u32; 2]) -> bool {
        let [p, q] = ends.map(|p| self.groups.root(p as usize));
        let [of_p, of_q] = [p, q].map(|p| &self.faces[p]);
        p == q || !of_p.iter().any(|face| of_q.binary_search(face).is_ok())
    }

    fn join(&mut self, ends: [u32; 2]) {
        let [p, q] = ends.map(|p| self.groups.root(p as usize));
        if self.groups.link(p, q) {
            let goes = std::mem::take(&mut self.faces[p.max(q)]);
            let stays = &mut self.faces[p.min(q)];
            stays.extend(goes);
            stays.sort_unstable();
        }
    }

    /// Where points go that do not stay, by their own places.
    fn moved(&mut self) -> HashMap<[u64; 3], DVec3> {
        let mut moved = HashMap::new();
        for (i, p) in self.points.iter().enumerate() {
            let first = self.groups.root(i);
            if first != i {
                moved.insert(p.to_array().map(bits), self.points[first]);
            }
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clean::take_apart;
    use crate::elementary::direction;

    /// A ring of quads round a hole, from points of its rim to others outside.
    fn around(rim: &[DVec3], outside: impl Fn(DVec3) -> DVec3) -> PolygonMesh {
        let n = rim.len() as u32;
        let outer = rim.iter().map(|&p| outside(p));
        let positions = rim.iter().copied().chain(outer).collect();
        let quad = |i: u32| [i, (i + 1) % n, n + (i + 1) % n, n + i];
        let faces: Vec<[u32; 4]> = (0..n).map(quad).collect();
        PolygonMesh::from_faces(positions, &faces).unwrap()
    }

    /// How many points are welded where gaps of nearly the whole mesh would do.
    fn n_welded(mesh: &PolygonMesh, weld: f64) -> usize {
        let apart = take_apart(mesh, Some(weld), &Progress::none()).unwrap();
        apart.report.n_seam_welded
    }

    #[test]
    fn a_round_hole_stays_open_whatever_its_size() {
        for n in [3, 4, 5, 8, 40] {
            let corner = |i: i32| direction(f64::from(i) * std::f64::consts::TAU / f64::from(n));
            let rim: Vec<DVec3> = (0..n).map(|i| corner(i).extend(0.0)).collect();
            assert_eq!(
                n_welded(&around(&rim, |p| p * 2.0 + DVec3::Z), 1.0),
                0,
                "{n} corners"
            );
        }
    }

    #[test]
    fn a_slit_closes_along_its_length() {
        let side = |y: f64| (1..8).map(move |x| DVec3::new(f64::from(x), y, 0.0));
        let tips = [0.0, 8.0].map(|x| DVec3::new(x, 0.0, 0.0));
        let below = side(-1e-6);
        let above: Vec<DVec3> = side(1e-6).rev().collect();
        let rim: Vec<DVec3> = [tips[0]]
            .into_iter()
            .chain(below)
            .chain([tips[1]])
            .collect();
        let rim = [rim, above].concat();
        let mesh = around(&rim, |p| DVec3::new(p.x, p.y * 1e6, 1.0));
        assert_eq!((n_welded(&mesh, 1e-6), n_welded(&mesh, 1e-8)), (7, 0));
        let apart = take_apart(&mesh, Some(1e-6), &Progress::none()).unwrap();
        assert_eq!(apart.mesh.border_loops().len(), 1, "the outer rim is left");
        assert!((apart.report.weld_distance - 2e-6).abs() < 1e-9);
    }

    #[test]
    fn a_thin_ribbon_does_not_collapse() {
        let point = |i: u32| DVec3::new(f64::from(i / 2), f64::from(i % 2) * 1e-9, 0.0);
        let quads: Vec<[u32; 4]> = (0..4)
            .map(|i| [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1])
            .collect();
        let mesh = PolygonMesh::from_faces((0..10).map(point).collect(), &quads).unwrap();
        assert_eq!(n_welded(&mesh, 0.01), 0);
    }

    #[test]
    fn seams_close_at_any_size() {
        for exponent in [-990, -300, 0, 300, 990] {
            let size = 2_f64.powi(exponent);
            let bit = |i: u32, b: u32| f64::from(i >> b & 1);
            let corner = |i: u32| DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2));
            let quads = crate::shapes::CUBE_QUADS;
            let positions = quads.iter().enumerate().flat_map(|(face, quad)| {
                let away = DVec3::splat(1e-7 * face as f64);
                quad.map(|i| (corner(i) + away) * size)
            });
            let faces: Vec<[u32; 4]> = (0..6).map(|f| [0, 1, 2, 3].map(|i| 4 * f + i)).collect();
            let mesh = PolygonMesh::from_faces(positions.collect(), &faces).unwrap();
            let apart = take_apart(&mesh, Some(WELD), &Progress::none()).unwrap();
            assert!(apart.mesh.is_closed(), "{exponent}");
            assert_eq!((apart.report.n_seam_welded, apart.report.n_welded), (16, 0));
            assert!((apart.report.weld_distance / size) < 1e-6, "{exponent}");
        }
    }
}
