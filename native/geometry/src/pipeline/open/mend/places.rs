//! Where the vertices of an open part stand, while its inverted quads are opened.

use std::array;
use std::f64::consts::TAU;

use glam::DVec3;

use super::{Bed, around, beside};
use crate::elementary::sin_cos;
use crate::measure::{PolygonEdges, area_vector};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};
use crate::pipeline::open::weld::loops;
use crate::progress::{Cancelled, Progress};

/// Quality below which a quad is opened where any is inverted, and up to which it is.
const BAD: f64 = 0.1;
const ENOUGH: f64 = 0.25;
/// How far away the places are that a vertex tries, in mean edges.
const REACHES: [f64; 6] = [0.8, 0.4, 0.2, 0.1, 0.05, 0.02];
/// And on a border no farther than this share of the way to the next vertex.
const MOST_OF_WAY: f64 = 0.8;
/// Rounds over the vertices of bad quads.
const N_ROUNDS: usize = 30;
/// Rings of quads round a knot that are pulled smooth with it, at most.
const MOST_RINGS: usize = 3;
/// How often each of their vertices goes to the middle of its neighbours.
const N_SMOOTHINGS: usize = 8;
/// What a vertex a mean edge away from where it was costs, against 0.06 for a quad without area.
const COST: f64 = 0.02;
/// What a border costs whose edges at a vertex have their middles a mean edge off the part's.
const OFF_BORDER: f64 = 1.0;
/// No vertex goes farther than this, in mean edges.
const FARTHEST: f64 = 0.6;
/// How far a vertex between two edges of one quad on a straight border leaves it, in mean edges.
const BULGES: [f64; 2] = [0.06, 0.03];
/// The least share by which a move has to lower the sum of both.
const LEAST_GAIN: f64 = 1e-4;
/// A quad whose own normal is farther than this from that of the surface has both to agree with.
const LEAST_AGREEMENT: f64 = 0.2;

/// Where a vertex may go.
#[derive(Clone, Copy)]
enum Stand {
    /// Anywhere.
    Free,
    /// Along a border, between these.
    Along([VertexId; 2]),
    /// Nowhere: a corner of a border.
    Fixed,
}

/// Vertices and where they may go.
pub struct Places<'a> {
    mesh: &'a PolygonMesh,
    bed: Bed<'a>,
    around: Vec<Vec<FaceId>>,
    stands: Vec<Stand>,
    /// Which way the surface faces at each vertex.
    normals: Vec<DVec3>,
    starts: Vec<DVec3>,
    pub positions: Vec<DVec3>,
    edge: f64,
    /// Whether vertices may leave the surface.
    is_loose: bool,
}

impl<'a> Places<'a> {
    pub fn new(
        mesh: &'a PolygonMesh,
        bed: Bed<'a>,
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let edges = PolygonEdges::new(mesh, progress)?;
        let length = |&[a, b]: &[VertexId; 2]| mesh.position(a).distance(mesh.position(b));
        let edge = edges.ends.iter().map(length).sum::<f64>() / edges.len().max(1) as f64;
        let mut stands = vec![Stand::Free; mesh.n_vertices()];
        for border in loops(mesh, progress)? {
            let n = border.len();
            for (i, &v) in border.iter().enumerate() {
                let beside = [border[(i + n - 1) % n], border[(i + 1) % n]];
                stands[v.index()] = if bed.line.is_none() || (bed.is_corner)(mesh.position(v)) {
                    Stand::Fixed
                } else {
                    Stand::Along(beside)
                };
            }
        }
        Ok(Self {
            around: around(mesh),
            normals: normals(mesh),
            starts: mesh.positions().to_vec(),
            positions: mesh.positions().to_vec(),
            mesh,
            bed,
            stands,
            edge,
            is_loose: false,
        })
    }

    /// Moves the vertices of bad quads until none is inverted or no move helps.
    pub fn untangle(&mut self, progress: &Progress<'_>) -> Result<(), Cancelled> {
        self.open_all(progress)?;
        self.is_loose = true;
        if !self.worse_than(0.0).is_empty() {
            self.open_all(progress)?;
        }
        for n_rings in 1..=MOST_RINGS {
            let knots = self.worse_than(0.0);
            if knots.is_empty() {
                break;
            }
            let before = self.positions.clone();
            self.smooth(&knots, n_rings);
            self.open_all(progress)?;
            if self.worse_than(0.0).len() >= knots.len() {
                self.positions = before;
            }
        }
        self.lay_back();
        Ok(())
    }

    fn open_all(&mut self, progress: &Progress<'_>) -> Result<(), Cancelled> {
        for _ in 0..N_ROUNDS {
            progress.check()?;
            let mut has_moved = false;
            for v in self.corners(&self.worse_than(BAD)) {
                has_moved |= self.open(v);
            }
            if !has_moved {
                break;
            }
        }
        Ok(())
    }

    /// Moves a vertex to the best place around it; false if it stands there.
    fn open(&mut self, v: VertexId) -> bool {
        let start = self.starts[v.index()];
        let cost = |at: DVec3| {
            let way = at.distance_squared(start) / (self.edge * self.edge);
            self.badness(v, at) + COST * way + OFF_BORDER * self.off_border(v, at)
        };
        let before = cost(self.positions[v.index()]);
        let mut best = (before * (1.0 - LEAST_GAIN), None);
        let is_near = |there: &DVec3| there.distance(start) <= FARTHEST * self.edge;
        for there in self.around(v).into_iter().filter(is_near) {
            let cost = cost(there);
            if cost < best.0 {
                best = (cost, Some(there));
            }
        }
        if let Some(there) = best.1 {
            self.positions[v.index()] = there;
        }
        best.1.is_some()
    }

    /// The places that a vertex tries.
    fn around(&self, v: VertexId) -> Vec<DVec3> {
        let now = self.positions[v.index()];
        let reaches = REACHES.into_iter().map(|reach| reach * self.edge);
        match self.stands[v.index()] {
            Stand::Fixed => Vec::new(),
            Stand::Along(beside) => {
                let ways = beside.map(|u| self.positions[u.index()] - now);
                let within = |way: DVec3, reach: f64| {
                    let longest = MOST_OF_WAY * way.length();
                    way.clamp_length_max(longest).clamp_length_max(reach)
                };
                let all = reaches.flat_map(|reach| ways.map(|way| now + within(way, reach)));
                let on_line = |there| Some(self.bed.line?.closest(there).position);
                all.filter_map(on_line)
                    .chain(self.bulges(v, beside))
                    .collect()
            }
            Stand::Free => {
                let normal = self.normals[v.index()];
                let off = self.is_loose.then_some([normal, -normal]);
                let ways: Vec<DVec3> = (ways(normal).into_iter())
                    .chain(off.into_iter().flatten())
                    .collect();
                let all = reaches.flat_map(|reach| ways.iter().map(move |way| now + *way * reach));
                all.filter_map(|there| self.laid(v, there)).collect()
            }
        }
    }

    /// A place on the surface, or as it is where vertices may leave it.
    fn laid(&self, v: VertexId, there: DVec3) -> Option<DVec3> {
        if self.is_loose {
            return Some(there);
        }
        let normal = self.normals[v.index()];
        let foot = self.bed.target.closest_agreeing(there, normal, self.edge)?;
        Some(foot.position)
    }

    /// Places beside a straight border for a vertex that has one quad alone there.
    fn bulges(&self, v: VertexId, beside: [VertexId; 2]) -> Vec<DVec3> {
        let &[face] = &self.around[v.index()][..] else {
            return Vec::new();
        };
        let corners = self.mesh.face(face).iter();
        let middle = corners.map(|u| self.positions[u.index()]).sum::<DVec3>() / 4.0;
        let now = self.starts[v.index()];
        let [a, b] = beside.map(|u| self.positions[u.index()]);
        let out = (now - middle).reject_from((b - a).normalize_or(DVec3::X));
        let out = out.normalize_or_zero();
        let bulges = BULGES.into_iter().filter(|_| self.is_loose);
        bulges
            .map(|share| now + out * (share * self.edge))
            .collect()
    }

    /// How far the middles of a vertex's edges are off the border in mean edges, squared.
    fn off_border(&self, v: VertexId, there: DVec3) -> f64 {
        let (Stand::Along(beside), Some(line)) = (self.stands[v.index()], self.bed.line) else {
            return 0.0;
        };
        let off = |u: VertexId| {
            let middle = there.midpoint(self.positions[u.index()]);
            line.closest(middle).distance_squared / (self.edge * self.edge)
        };
        beside.into_iter().map(off).sum()
    }

    /// How bad the quads of a vertex are once it is somewhere.
    fn badness(&self, v: VertexId, there: DVec3) -> f64 {
        let at = |u: VertexId| {
            if u == v {
                there
            } else {
                self.positions[u.index()]
            }
        };
        let lacks = self.around[v.index()].iter().map(|&face| {
            let corners = self.mesh.face(face);
            let outward: DVec3 = corners.iter().map(|u| self.normals[u.index()]).sum();
            (ENOUGH - quality(corners, &at, outward)).max(0.0).powi(2)
        });
        lacks.sum()
    }

    /// The quads of less than a quality, seen along their own normals.
    fn worse_than(&self, least: f64) -> Vec<FaceId> {
        let at = |u: VertexId| self.positions[u.index()];
        let is_worse = |&face: &FaceId| {
            let found = quality(self.mesh.face(face), &at, DVec3::ZERO);
            found < least || found <= 0.0
        };
        self.mesh.face_ids().filter(is_worse).collect()
    }

    /// The corners of faces, each once.
    fn corners(&self, faces: &[FaceId]) -> Vec<VertexId> {
        let corners = faces.iter().flat_map(|&face| self.mesh.face(face));
        let mut corners: Vec<VertexId> = corners.copied().collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    }

    /// Moves free vertices round some quads to the middle of their neighbours, some times.
    fn smooth(&mut self, knots: &[FaceId], n_rings: usize) {
        let mut vertices = self.corners(knots);
        for _ in 0..n_rings {
            let rings = vertices.iter().flat_map(|v| &self.around[v.index()]);
            let faces: Vec<FaceId> = rings.copied().collect();
            vertices = self.corners(&faces);
        }
        vertices.retain(|v| matches!(self.stands[v.index()], Stand::Free));
        for _ in 0..N_SMOOTHINGS {
            for v in &vertices {
                let sides = self.around[v.index()].iter();
                let sides = sides.filter_map(|&face| beside(self.mesh.face(face), *v));
                let ends: Vec<DVec3> = sides.flatten().map(|u| self.positions[u.index()]).collect();
                self.positions[v.index()] = ends.iter().sum::<DVec3>() / ends.len().max(1) as f64;
            }
        }
    }

    /// Brings vertices that have left the surface back where that spoils no quad.
    fn lay_back(&mut self) {
        for i in 0..self.positions.len() {
            let now = self.positions[i];
            if now == self.starts[i] || !matches!(self.stands[i], Stand::Free) {
                continue;
            }
            let v = VertexId::from_index(i);
            let foot = self
                .bed
                .target
                .closest_agreeing(now, self.normals[i], self.edge);
            if let Some(foot) = foot
                && self.badness(v, foot.position) <= self.badness(v, now)
            {
                self.positions[i] = foot.position;
            }
        }
    }
}

/// The least sine of a quad's corners, seen along its own normal, and where that turns away from
/// one that is given, along this too; other faces are good.
fn quality(corners: &[VertexId], at: &impl Fn(VertexId) -> DVec3, outward: DVec3) -> f64 {
    let Ok(p) = <[VertexId; 4]>::try_from(corners).map(|corners| corners.map(at)) else {
        return 1.0;
    };
    let edges: [DVec3; 4] = array::from_fn(|i| (p[(i + 1) % 4] - p[i]).normalize_or_zero());
    let worst = |normal: DVec3| {
        let turns = (0..4).map(|i| edges[i].cross(edges[(i + 1) % 4]).dot(normal));
        turns.fold(1.0, f64::min)
    };
    let own = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
    let outward = outward.normalize_or_zero();
    if outward == DVec3::ZERO || own.dot(outward) > LEAST_AGREEMENT {
        worst(own)
    } else {
        worst(own).min(worst(outward))
    }
}

/// Eight ways along a surface.
fn ways(normal: DVec3) -> [DVec3; 8] {
    let (x, y) = normal.any_orthonormal_pair();
    array::from_fn(|i| {
        let (sin, cos) = sin_cos(i as f64 * TAU / 8.0);
        x * cos + y * sin
    })
}

/// Which way the surface faces at every vertex, smoothed once over its faces.
fn normals(mesh: &PolygonMesh) -> Vec<DVec3> {
    let sums = |of_face: &dyn Fn(&[VertexId]) -> DVec3| {
        let mut sums = vec![DVec3::ZERO; mesh.n_vertices()];
        for face in mesh.faces() {
            let more = of_face(face);
            for v in face {
                sums[v.index()] += more;
            }
        }
        sums
    };
    let area = |face: &[VertexId]| {
        let at = |i: usize| mesh.position(face[i]);
        (2..face.len())
            .map(|i| area_vector([at(0), at(i - 1), at(i)]))
            .sum()
    };
    let own = sums(&area);
    let smooth = sums(&|face| face.iter().map(|v| own[v.index()]).sum());
    let unit = |n: DVec3| n.try_normalize().unwrap_or(DVec3::Z);
    smooth.into_iter().map(unit).collect()
}
