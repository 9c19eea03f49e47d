//! Closed lines round a rod, and how they follow each other from end to end.

use glam::DVec3;

use super::height::Height;
use crate::measure::area_vector;
use crate::mesh::{FaceId, HalfedgeId, TriangleMesh};

/// A closed line round a rod.
#[derive(Clone)]
pub(super) struct Section {
    /// Its corners; the last is joined to the first.
    pub points: Vec<DVec3>,
    /// Arc length from the first to each of them, and at the end that of the whole.
    lengths: Vec<f64>,
    /// What lies at corners that lines along the rod go through: which line, and the corner.
    pub crossed: Vec<(usize, usize)>,
}

impl Section {
    pub fn new(points: Vec<DVec3>, crossed: Vec<(usize, usize)>) -> Self {
        let mut lengths = vec![0.0];
        for i in 0..points.len() {
            let next = points[(i + 1) % points.len()];
            lengths.push(lengths[i] + points[i].distance(next));
        }
        Self {
            points,
            lengths,
            crossed,
        }
    }

    pub fn girth(&self) -> f64 {
        self.lengths[self.points.len()]
    }

    /// The arc length of a corner.
    pub fn at_corner(&self, corner: usize) -> f64 {
        self.lengths[corner]
    }

    /// The point at an arc length, around and around.
    pub fn point(&self, at: f64) -> DVec3 {
        let at = at.rem_euclid(self.girth());
        let after = self.lengths.partition_point(|&l| l <= at);
        let i = after.clamp(1, self.points.len()) - 1;
        let step = self.lengths[i + 1] - self.lengths[i];
        let share = ((at - self.lengths[i]) / step.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        self.points[i].lerp(self.points[(i + 1) % self.points.len()], share)
    }

    pub fn centre(&self) -> DVec3 {
        centre(&self.points)
    }

    /// A vector across the line, as long as the area that it encloses.
    pub fn area(&self) -> DVec3 {
        area(&self.points)
    }

    /// The same line the other way round.
    pub fn turned(self) -> Self {
        let n = self.points.len();
        let crossed = self.crossed.iter().map(|&(line, i)| (line, n - 1 - i));
        let crossed = crossed.collect();
        Self::new(self.points.into_iter().rev().collect(), crossed)
    }
}

/// The middle of a closed line.
pub(super) fn centre(points: &[DVec3]) -> DVec3 {
    let n = points.len();
    let pieces = (0..n).map(|i| {
        let [a, b] = [points[i], points[(i + 1) % n]];
        (a.midpoint(b), a.distance(b))
    });
    let (sum, length) = pieces.fold((DVec3::ZERO, 0.0), |(sum, length), (middle, l)| {
        (sum + middle * l, length + l)
    });
    sum / length.max(f64::MIN_POSITIVE)
}

pub(super) fn area(points: &[DVec3]) -> DVec3 {
    let (n, o) = (points.len(), points[0]);
    let pieces = (0..n).map(|i| (points[i] - o).cross(points[(i + 1) % n] - o));
    pieces.sum::<DVec3>() * 0.5
}

/// The level lines of a height.
pub(super) struct Levels<'a> {
    pub mesh: &'a TriangleMesh,
    pub height: &'a Height,
}

impl Levels<'_> {
    /// The line of one height, which `line_of` says at which edges it crosses lines along the rod.
    pub fn section(
        &self,
        level: f64,
        line_of: impl Fn(HalfedgeId) -> Option<usize>,
    ) -> Option<Section> {
        let mesh = self.mesh;
        let of = |h: HalfedgeId| self.height.of[mesh.origin(h)] - level;
        // The line leaves a face over the halfedge that climbs through the level.
        let climbs = |h: HalfedgeId| of(h) < 0.0 && of(h.next()) >= 0.0;
        let first = self.first(level)?;
        let (mut points, mut crossed) = (Vec::new(), Vec::new());
        let mut h = first;
        loop {
            let [low, high] = [of(h), of(h.next())];
            let [a, b] = [h, h.next()].map(|h| mesh.position(mesh.origin(h)));
            crossed.extend(line_of(h).map(|line| (line, points.len())));
            points.push(a.lerp(b, low / (low - high)));
            let twin = mesh.twin(h)?;
            h = if climbs(twin.next()) {
                twin.next()
            } else {
                twin.prev()
            };
            if h == first {
                break;
            }
            if points.len() > 3 * mesh.n_faces() {
                return None;
            }
        }
        (points.len() > 2).then(|| Section::new(points, crossed))
    }

    /// A halfedge on the way from end to end that climbs through a level.
    fn first(&self, level: f64) -> Option<HalfedgeId> {
        let is_below = |i: usize| self.height.of[self.height.path[i]] < level;
        let n = self.height.path.len();
        let i = (1..n).find(|&i| is_below(i - 1) && !is_below(i))?;
        let [from, to] = [self.height.path[i - 1], self.height.path[i]];
        let mut leaving = self.mesh.outgoing(from);
        leaving.find(|&h| self.mesh.target(h) == to)
    }
}

/// How a rod goes from end to end, in samples.
pub(super) struct Profile {
    /// The height of each, from 0 to 1, ends included.
    levels: Vec<f64>,
    /// How far it is along the rod.
    along: Vec<f64>,
    /// The girth there.
    pub girths: Vec<f64>,
    /// The area of the surface below.
    areas: Vec<f64>,
    /// The middle of the section.
    pub centres: Vec<DVec3>,
}

/// Samples a girth along the rod, and at most.
const SAMPLES: [f64; 2] = [8.0, 4_000.0];
/// Shares of a squared girth below the samples next to the ends.
const NEAR_ENDS: [f64; 9] = [0.001, 0.003, 0.006, 0.01, 0.02, 0.035, 0.055, 0.08, 0.11];

impl Profile {
    /// Samples at even shares of the area, closer at the ends. None where a level has no line.
    pub fn new(levels: &Levels<'_>, girth: f64) -> Option<Self> {
        let mesh = levels.mesh;
        let mean = |f: FaceId| {
            mesh.face(f)
                .iter()
                .map(|&v| levels.height.of[v])
                .sum::<f64>()
                / 3.0
        };
        let mut faces: Vec<(f64, f64)> = mesh
            .face_ids()
            .map(|f| (mean(f), area_vector(mesh.triangle(f)).length()))
            .collect();
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        let whole: f64 = faces.iter().map(|face| face.1).sum();
        let n = (SAMPLES[0] * whole / (girth * girth)).clamp(32.0, SAMPLES[1]) as usize;
        let near = NEAR_ENDS.map(|share| share * girth * girth);
        let inner = (1..n).map(|i| whole * i as f64 / n as f64);
        let inner = inner.filter(|&a| a > near[8] * 1.2 && a < whole - near[8] * 1.2);
        let far = near.iter().rev().map(|&a| whole - a);
        let wanted: Vec<f64> = near.iter().copied().chain(inner).chain(far).collect();
        let mut profile = Self {
            levels: vec![0.0],
            along: vec![0.0],
            girths: vec![0.0],
            areas: vec![0.0],
            centres: vec![mesh.position(levels.height.ends[0])],
        };
        let (mut below, mut next) = (0.0, 0);
        for area in wanted {
            while next < faces.len() && below < area {
                below += faces[next].1;
                next += 1;
            }
            let level = faces[next.saturating_sub(1)].0;
            if level <= profile.levels[profile.levels.len() - 1] || level >= 1.0 {
                continue;
            }
            let section = levels.section(level, |_| None)?;
            profile.push([level, below, section.girth()], section.centre());
        }
        profile.push([1.0, whole, 0.0], mesh.position(levels.height.ends[1]));
        Some(profile)
    }

    fn push(&mut self, [level, area, girth]: [f64; 3], centre: DVec3) {
        let last = self.levels.len() - 1;
        let step = (area - self.areas[last]).max(0.0);
        let mean = f64::midpoint(girth, self.girths[last]).max(f64::MIN_POSITIVE);
        self.along.push(self.along[last] + step / mean);
        self.levels.push(level);
        self.areas.push(area);
        self.girths.push(girth);
        self.centres.push(centre);
    }

    /// How long the rod is.
    pub fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// How far along the rod a height is.
    pub fn along(&self, level: f64) -> f64 {
        between(&self.levels, &self.along, level)
    }

    /// The height at a way along the rod.
    pub fn level(&self, along: f64) -> f64 {
        between(&self.along, &self.levels, along)
    }

    /// How far along the rod so much of the surface is left behind.
    pub fn along_area(&self, area: f64) -> f64 {
        between(&self.areas, &self.along, area)
    }

    pub fn area(&self) -> f64 {
        self.areas[self.areas.len() - 1]
    }

    /// The way that the rod goes at a way along it, on the scale of a reach.
    pub fn direction(&self, along: f64, reach: f64) -> DVec3 {
        let [from, to] = [along - reach, along + reach].map(|at| self.centre(at));
        (to - from).normalize_or_zero()
    }

    /// The middle of the rod at a way along it.
    pub fn centre(&self, along: f64) -> DVec3 {
        let after = self.along.partition_point(|&x| x <= along);
        let i = after.clamp(1, self.along.len() - 1) - 1;
        let step = self.along[i + 1] - self.along[i];
        let share = ((along - self.along[i]) / step.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        self.centres[i].lerp(self.centres[i + 1], share)
    }

    /// The middle one of the girths.
    pub fn median_girth(&self) -> f64 {
        let mut girths = self.girths.clone();
        girths.sort_by(f64::total_cmp);
        girths[girths.len() / 2]
    }

    pub fn most_girth(&self) -> f64 {
        self.girths.iter().copied().fold(0.0, f64::max)
    }
}

/// Linear between samples.
fn between(from: &[f64], to: &[f64], at: f64) -> f64 {
    let after = from.partition_point(|&x| x <= at);
    let i = after.clamp(1, from.len() - 1) - 1;
    let step = from[i + 1] - from[i];
    let share = ((at - from[i]) / step.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    to[i] + (to[i + 1] - to[i]) * share
}
