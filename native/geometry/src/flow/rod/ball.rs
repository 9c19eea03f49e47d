//! The quads of a rod, and their places on the sphere: rings are circles of latitude, the ends
//! caps.

use glam::DVec3;

use super::rings::Ring;
use crate::elementary::sin_cos;
use crate::mesh::VertexId;
use crate::mirror::mirrored;

/// A ring of so many quads is closed by three quads: a rectangle would have no vertex at the tip.
pub(super) const STAR: usize = 6;
/// How far from the poles the first and the last ring are, in radians.
const CAP: f64 = 0.6;

/// Quads in space and on the sphere.
pub(super) struct Ball {
    pub quads: Vec<[u32; 4]>,
    pub positions: Vec<DVec3>,
    pub sphere: Vec<DVec3>,
    /// The edges on sharp lines.
    pub on_lines: Vec<[VertexId; 2]>,
}

/// The rectangle of quads that closes a ring.
struct Cap {
    sides: [usize; 2],
    /// Which vertex of the ring is its first corner.
    offset: usize,
    /// Whether it is that of the far end.
    is_high: bool,
}

impl Ball {
    /// Rings one after the other, closed by rectangles of `cap` quads; `tips` are the ends' places.
    pub fn new(rings: &[Ring], cap: [usize; 2], tips: [DVec3; 2], mirror: Option<usize>) -> Self {
        let n = rings[0].points.len();
        let last = rings.len() - 1;
        let mut ball = Self {
            quads: Vec::new(),
            positions: rings
                .iter()
                .flat_map(|ring| ring.points.iter().copied())
                .collect(),
            sphere: Vec::new(),
            on_lines: Vec::new(),
        };
        for i in 0..=last {
            let share = i as f64 / last as f64;
            let from_pole = CAP + share * (std::f64::consts::PI - 2.0 * CAP);
            ball.sphere
                .extend((0..n).map(|j| latitude(j as f64 / n as f64, from_pole)));
        }
        ball.sides(rings);
        let offset = offset(&rings[0], cap, mirror);
        for (is_high, ring, tip) in [(false, &rings[0], tips[0]), (true, &rings[last], tips[1])] {
            let first = if is_high { last * n } else { 0 };
            let cap = Cap {
                sides: cap,
                offset,
                is_high,
            };
            if n == STAR {
                ball.close_to_a_point(&cap, first, (ring, tip));
            } else {
                ball.close(&cap, first, (ring, tip));
            }
        }
        ball.on_lines.sort_unstable();
        ball
    }

    fn sides(&mut self, rings: &[Ring]) {
        let n = rings[0].points.len();
        for (i, ring) in rings.iter().enumerate() {
            for j in 0..n {
                let next = (j + 1) % n;
                let at = |i: usize, j: usize| (i * n + j) as u32;
                if ring.is_round {
                    let [a, b] = [at(i, j), at(i, next)];
                    self.on_lines.push([VertexId(a.min(b)), VertexId(a.max(b))]);
                }
                let Some(above) = rings.get(i + 1) else {
                    continue;
                };
                self.quads
                    .push([at(i, j), at(i, next), at(i + 1, next), at(i + 1, j)]);
                if ring.is_on_line[j] && above.is_on_line[j] {
                    self.on_lines.push([at(i, j), at(i + 1, j)].map(VertexId));
                }
            }
        }
    }

    /// Closes a ring of six by three quads round the tip.
    fn close_to_a_point(&mut self, cap: &Cap, first: usize, (ring, tip): (&Ring, DVec3)) {
        let n = ring.points.len();
        let middle = ring.centre();
        self.positions
            .push(middle + ring.axis() * ring.axis().dot(tip - middle));
        self.sphere
            .push(if cap.is_high { DVec3::Z } else { -DVec3::Z });
        let top = self.positions.len() as u32 - 1;
        let at = |i: usize| (first + (i + cap.offset) % n) as u32;
        for i in (0..n).step_by(2) {
            let mut quad = [top, at(i), at(i + 1), at(i + 2)];
            if !cap.is_high {
                quad.reverse();
            }
            self.quads.push(quad);
        }
    }

    /// Closes a ring whose vertices are numbered from `first` on.
    fn close(&mut self, cap: &Cap, first: usize, (ring, tip): (&Ring, DVec3)) {
        let [a, b] = cap.sides;
        let n = ring.points.len();
        let middle = ring.centre();
        let rise = ring.axis() * ring.axis().dot(tip - middle);
        let mut ids = vec![0u32; (a + 1) * (b + 1)];
        for j in 0..=b {
            for i in 0..=a {
                let (share, at) = polar([i, j], cap.sides);
                ids[j * (a + 1) + i] = if [0, a].contains(&i) || [0, b].contains(&j) {
                    (first + (at.round() as usize + cap.offset) % n) as u32
                } else {
                    let at = at + cap.offset as f64;
                    let edge = between(&ring.points, at);
                    // A dome, which a flat end is without a rise.
                    let up = (1.0 - share * share).sqrt();
                    self.positions
                        .push(middle + (edge - middle) * share + rise * up);
                    self.sphere
                        .push(on_cap((share, at / n as f64), n, cap.is_high));
                    self.positions.len() as u32 - 1
                };
            }
        }
        for j in 0..b {
            for i in 0..a {
                let at = |i: usize, j: usize| ids[j * (a + 1) + i];
                let mut quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if !cap.is_high {
                    quad.reverse();
                }
                self.quads.push(quad);
            }
        }
    }
}

/// The place of a corner of a rectangle's squares: which share of the way from the middle to its
/// border, and where along the border, in sides of squares from the first corner on.
fn polar([i, j]: [usize; 2], [a, b]: [usize; 2]) -> (f64, f64) {
    let [half_a, half_b] = [a, b].map(|side| side as f64 / 2.0);
    let [x, y] = [(i as f64 - half_a) / half_a, (j as f64 - half_b) / half_b];
    let share = x.abs().max(y.abs());
    if share < 1e-9 {
        return (0.0, 0.0);
    }
    let [x, y] = [(x / share + 1.0) * half_a, (y / share + 1.0) * half_b];
    let [a, b] = [a, b].map(|side| side as f64);
    let at = if y < 1e-9 {
        x
    } else if x > a - 1e-9 {
        a + y
    } else if y > b - 1e-9 {
        a + b + (a - x)
    } else {
        2.0 * a + b + (b - y)
    };
    (share, at)
}

fn between(points: &[DVec3], at: f64) -> DVec3 {
    let i = at.floor() as usize;
    let [p, q] = [i, i + 1].map(|i| points[i % points.len()]);
    p.lerp(q, at - at.floor())
}

/// The point at a share of a circle of latitude, so far from the pole at −z.
fn latitude(share: f64, from_pole: f64) -> DVec3 {
    let [(s, c), (sin, cos)] = [share * std::f64::consts::TAU, from_pole].map(sin_cos);
    DVec3::new(c * sin, s * sin, -cos)
}

/// A point of a cap: at a share of the way from the pole to a point of the ring's chords.
fn on_cap((share, turn): (f64, f64), n: usize, is_high: bool) -> DVec3 {
    let from_pole = if is_high {
        std::f64::consts::PI - CAP
    } else {
        CAP
    };
    let at = turn * n as f64;
    let [p, q] = [at.floor(), at.floor() + 1.0].map(|i| latitude(i / n as f64, from_pole));
    let edge = p.lerp(q, at - at.floor());
    let pole = DVec3::Z * p.z;
    pole.lerp(edge, share).normalize_or(DVec3::Z)
}

/// Which vertex of a ring is a corner of the rectangle in it: such that the rectangle is its own
/// image where the ring is.
fn offset(ring: &Ring, [a, b]: [usize; 2], mirror: Option<usize>) -> usize {
    let n = ring.points.len();
    if ring.is_on_line.iter().filter(|&&is_on| is_on).count() == 4 {
        return 0;
    }
    let off = |sum: usize, axis: usize| -> f64 {
        let image = |j: usize| ring.points[(sum + n - j) % n];
        (0..n)
            .map(|j| mirrored(ring.points[j], axis).distance_squared(image(j)))
            .sum()
    };
    let sum = mirror.and_then(|axis| (0..n).min_by(|&s, &t| off(s, axis).total_cmp(&off(t, axis))));
    let sum = sum.unwrap_or(0);
    if n == STAR {
        return sum / 2 % n;
    }
    let is_even = |o: &usize| {
        let middles = [2 * o + a, 2 * o + 2 * a + b];
        middles.iter().any(|m| m % n == sum) || (a == b && 2 * o % n == sum)
    };
    (0..n).find(is_even).unwrap_or(0)
}
