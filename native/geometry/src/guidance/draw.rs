//! Strokes become chains of edges.

use glam::DVec3;

use super::splitting::{Splitting, next, prev};
use super::{Strength, Stroke};
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};

/// An edge that is crossed nearer to its end than this share of it is not split: the end is moved
/// there. Below, triangles get thin; at a half next to none is split, and moves fold faces.
const SNAP: f64 = 0.25;
/// The same of ends that have to stay where they are.
const SNAP_FIXED: f64 = 0.1;
/// A point of a stroke takes a corner of its face that has more than this share there.
const AT_CORNER: f64 = 0.6;
/// The same of corners that have to stay.
const AT_FIXED: f64 = 0.85;
/// And is put onto an edge where the corner across has less than this share.
const AT_EDGE: f64 = 0.2;
/// Cosine of the most by which triangles turn when a corner is moved: 60°.
const LEAST_COSINE: f64 = 0.5;
/// Of its height a triangle keeps at least this share when a corner is moved.
const LEAST_AREA: f64 = 0.2;
/// More edges than this are not crossed from one point of a stroke to the next.
const MOST_CROSSED: usize = 200;

/// What is drawn with.
pub struct Pen<'a> {
    /// How far points of a stroke are apart.
    pub step: f64,
    /// The face of the mesh that is nearest to a place, and where on it; none where nothing is drawn.
    pub locate: &'a dyn Fn(DVec3) -> Option<(FaceId, DVec3)>,
    /// Where new vertices belong that are made at a place.
    pub settle: &'a dyn Fn(DVec3) -> DVec3,
    /// Vertices that have to stay where they are.
    pub is_fixed: &'a VertexMap<bool>,
    /// Edges that are not crossed, on both sides of each.
    pub is_barrier: &'a HalfedgeMap<bool>,
}

/// A mesh with strokes along its edges.
pub struct Drawn {
    /// It; old vertices keep their numbers.
    pub mesh: TriangleMesh,
    /// Of each halfedge the old one that it is a piece of.
    pub sides: HalfedgeMap<Option<HalfedgeId>>,
    /// Of each new vertex the corners it was made between, and their shares.
    pub parents: Vec<[(VertexId, f64); 3]>,
    /// The strength of the strokes along each edge, on both sides of each.
    pub on: HalfedgeMap<Option<Strength>>,
    /// How many gaps each stroke has.
    pub gaps: Vec<usize>,
}

impl Drawn {
    /// Edges of the old mesh, in pieces where they were split.
    pub fn carried(&self, edges: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
        let is_piece = |side: &Option<HalfedgeId>| side.is_some_and(|side| edges[side]);
        self.sides.iter().map(is_piece).collect()
    }

    /// The edges along strokes of some strength.
    pub fn along(&self, strength: Strength) -> HalfedgeMap<bool> {
        self.on.iter().map(|&on| on == Some(strength)).collect()
    }
}

/// Draws strokes on a closed mesh, one after the other. None where the mesh would not be one any
/// more, as where two edges would join the same two vertices.
pub fn draw(mesh: &TriangleMesh, strokes: &[Stroke], pen: &Pen<'_>) -> Option<Drawn> {
    let mut canvas = Canvas {
        cut: Splitting::new(mesh),
        is_fixed: pen.is_fixed.iter().copied().collect(),
        pen,
    };
    let gaps = strokes.iter().map(|stroke| canvas.stroke(stroke)).collect();
    let cut = canvas.cut;
    let faces = cut.faces();
    Some(Drawn {
        mesh: TriangleMesh::new(cut.positions, faces).ok()?,
        sides: cut.sides.into_iter().collect(),
        on: cut.on.into_iter().collect(),
        parents: cut.parents,
        gaps,
    })
}

/// A mesh that is drawn on.
struct Canvas<'a> {
    cut: Splitting,
    is_fixed: Vec<bool>,
    pen: &'a Pen<'a>,
}

/// Where a way leaves the faces around a vertex.
#[derive(Clone, Copy)]
struct Exit {
    h: u32,
    share: f64,
    place: DVec3,
}

impl Canvas<'_> {
    /// Draws one stroke; returns how many gaps it has.
    fn stroke(&mut self, stroke: &Stroke) -> usize {
        let mut n_gaps = 0;
        let mut first = None;
        let mut last: Option<u32> = None;
        let points = stroke.spaced(self.pen.step);
        for &point in &points {
            let at = self.insert(point);
            if let (Some(from), Some(to)) = (last, at)
                && !self.walk(from, to, stroke.strength)
            {
                n_gaps += 1;
            }
            n_gaps += usize::from(at.is_none());
            first = first.or(at);
            last = at;
        }
        if stroke.is_closed
            && let (Some(from), Some(to)) = (last, first)
            && !self.walk(from, to, stroke.strength)
        {
            n_gaps += 1;
        }
        n_gaps
    }

    /// The vertex for a point of a stroke.
    fn insert(&mut self, point: DVec3) -> Option<u32> {
        let (whole, place) = (self.pen.locate)(point)?;
        let pieces = self.cut.pieces(whole.0).into_iter();
        let inside = pieces.map(|face| (face, shares(self.cut.triangle(face), place)));
        let least = |shares: &[f64; 3]| shares.iter().copied().fold(f64::INFINITY, f64::min);
        let best = inside.reduce(|a, b| if least(&b.1) > least(&a.1) { b } else { a });
        let (face, shares) = best?;
        let [low, high] = [0, 1, 2].iter().fold([0, 0], |[low, high], &i| {
            [
                if shares[i] < shares[low] { i } else { low },
                if shares[i] > shares[high] { i } else { high },
            ]
        });
        let corner = self.cut.origin(3 * face + high as u32);
        let is_fixed = self.is_fixed[corner as usize];
        let enough = if is_fixed { AT_FIXED } else { AT_CORNER };
        let settled = (self.pen.settle)(place);
        let v = if shares[high] > enough && (is_fixed || self.moved(corner, settled)) {
            corner
        } else if shares[low] < AT_EDGE {
            let h = next(3 * face + low as u32);
            let [a, b] = [h, next(h)].map(|h| shares[(h % 3) as usize].max(0.0));
            let share = (b / (a + b).max(f64::MIN_POSITIVE)).clamp(0.02, 0.98);
            self.split(h, share, settled)
        } else {
            let v = self.cut.split_face(face, shares, place);
            self.is_fixed.push(false);
            self.moved(v, settled);
            v
        };
        self.is_fixed[v as usize] = true;
        Some(v)
    }

    /// Splits an edge, the new vertex where it belongs unless that folds a face.
    fn split(&mut self, h: u32, share: f64, settled: DVec3) -> u32 {
        let [a, b] = [self.cut.origin(h), self.cut.target(h)].map(|v| self.cut.position(v));
        let v = self.cut.split_edge(h, share, a.lerp(b, share));
        self.is_fixed.push(false);
        self.moved(v, settled);
        v
    }

    /// Moves a vertex unless that folds a face around it or leaves one without height.
    fn moved(&mut self, v: u32, place: DVec3) -> bool {
        let before = self.cut.position(v);
        let keeps = |&h: &u32| {
            let [a, b] = [next(h), prev(h)].map(|h| self.cut.position(self.cut.origin(h)));
            let [now, then] = [before, place].map(|p| across([p, a, b]));
            let turned = now.dot(then) > LEAST_COSINE * now.length() * then.length();
            let longest = (a - b).length_squared().max((a - place).length_squared());
            turned
                && (then.length() > LEAST_AREA * now.length()
                    || then.length() > LEAST_AREA * longest)
        };
        let may = self.cut.around(v).iter().all(keeps);
        if may {
            self.cut.positions[v as usize] = place;
        }
        may
    }

    /// Leads a chain of edges from one vertex to another; false where the way is not found.
    fn walk(&mut self, from: u32, to: u32, strength: Strength) -> bool {
        let mut at = from;
        for _ in 0..MOST_CROSSED {
            if at == to {
                return true;
            }
            let around = self.cut.around(at);
            if let Some(&h) = around.iter().find(|&&h| self.cut.target(h) == to) {
                self.cut.draw(h, strength);
                return true;
            }
            let Some(exit) = self.exit(&around, to) else {
                return false;
            };
            let before = self.cut.position(at).distance(self.cut.position(to));
            if exit.place.distance(self.cut.position(to)) >= before {
                return false;
            }
            let is_barrier =
                self.cut.sides[exit.h as usize].is_some_and(|side| self.pen.is_barrier[side]);
            let step = self.pass(exit);
            let around = self.cut.around(at);
            let Some(&h) = around.iter().find(|&&h| self.cut.target(h) == step) else {
                return false;
            };
            self.cut.draw(h, strength);
            self.is_fixed[step as usize] = true;
            if is_barrier {
                return false;
            }
            at = step;
        }
        false
    }

    /// Where the plane through two vertices, upright on the surface, leaves the faces around the
    /// first towards the second.
    fn exit(&self, around: &[u32], to: u32) -> Option<Exit> {
        let from = self.cut.position(self.cut.origin(*around.first()?));
        let way = self.cut.position(to) - from;
        let normal = |&h: &u32| {
            let [a, b] = [next(h), prev(h)].map(|h| self.cut.position(self.cut.origin(h)));
            across([from, a, b])
        };
        let up: DVec3 = around.iter().map(normal).sum();
        let side = way.cross(up).normalize_or_zero();
        let exits = around.iter().filter_map(|&h| {
            let h = next(h);
            let [a, b] = [self.cut.origin(h), self.cut.target(h)].map(|v| self.cut.position(v));
            let [off_a, off_b] = [a, b].map(|p| (p - from).dot(side));
            let share = off_a / (off_a - off_b);
            let place = a.lerp(b, share);
            let is_crossed = (0.0..=1.0).contains(&share) && (place - from).dot(way) > 0.0;
            is_crossed.then_some(Exit { h, share, place })
        });
        let straight = |exit: &Exit| (exit.place - from).normalize_or_zero().dot(way);
        exits.max_by(|a, b| straight(a).total_cmp(&straight(b)))
    }

    /// The vertex at an exit: an end of its edge that is near, or a new one.
    fn pass(&mut self, Exit { h, share, place }: Exit) -> u32 {
        let settled = (self.pen.settle)(place);
        let ends = [
            (self.cut.origin(h), share),
            (self.cut.target(h), 1.0 - share),
        ];
        for (end, away) in ends {
            let is_fixed = self.is_fixed[end as usize];
            let snaps = away < if is_fixed { SNAP_FIXED } else { SNAP };
            if snaps && (is_fixed || self.moved(end, settled)) {
                return end;
            }
        }
        self.split(h, share.clamp(0.02, 0.98), settled)
    }
}

/// A vector along the normal of a triangle, as long as its area.
fn across([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a) * 0.5
}

/// The shares of a triangle's corners at a place in its plane; negative outside.
fn shares([a, b, c]: [DVec3; 3], place: DVec3) -> [f64; 3] {
    let normal = across([a, b, c]);
    let whole = normal.length_squared().max(f64::MIN_POSITIVE);
    let of = |p: DVec3, q: DVec3| across([place, p, q]).dot(normal) / whole;
    [of(b, c), of(c, a), of(a, b)]
}
