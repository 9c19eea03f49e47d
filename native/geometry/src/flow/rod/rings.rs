//! Rings of a rod: the places of their vertices, from one to the next with as little twist as can
//! be.

use glam::{DQuat, DVec3};

use super::lines::Lines;
use super::plan::{Plan, Stop};
use super::section::{Levels, Profile, Section, area, centre};
use crate::mirror::mirrored;

/// Places round a ring where its first vertex is tried.
const N_TURNS: usize = 96;
/// Halvings of the step between them round the best.
const N_HALVINGS: usize = 16;
/// A ring is laid through at most this much more than its corners, to hold the area of its section.
const MOST_SWELL: f64 = 1.25;

/// A ring.
#[derive(Clone)]
pub(super) struct Ring {
    pub points: Vec<DVec3>,
    /// Which of them lie on lines along the rod.
    pub is_on_line: Vec<bool>,
    /// Whether it lies on a line round the rod.
    pub is_round: bool,
    /// A vector along the rod as long as the area that its section encloses.
    area: DVec3,
    /// The arc lengths of the vertices as shares of the girth, from that of the first on.
    shares: Vec<f64>,
}

impl Ring {
    pub fn centre(&self) -> DVec3 {
        centre(&self.points)
    }

    pub fn axis(&self) -> DVec3 {
        self.area.normalize_or(DVec3::Z)
    }
}

/// What all rings share.
pub(super) struct Rings<'a> {
    pub levels: &'a Levels<'a>,
    pub profile: &'a Profile,
    pub lines: &'a Lines,
    pub plan: &'a Plan,
    /// The order in which lines along the rod follow each other round it; empty without any.
    pub order: &'a [usize],
    /// The axis across a plane of symmetry through the origin.
    pub mirror: Option<usize>,
}

impl Rings<'_> {
    /// All rings; none where a level has no line.
    pub fn all(&self) -> Option<Vec<Ring>> {
        let sections = self.plan.stops.iter().map(|&stop| self.section(stop));
        let sections: Vec<Section> = sections.collect::<Option<_>>()?;
        let known = |section: &Section| self.on_lines(section);
        let start = sections
            .iter()
            .position(|s| known(s).is_some())
            .unwrap_or(0);
        let n = sections.len();
        let mut rings: Vec<Option<Ring>> = vec![None; n];
        rings[start] =
            Some(known(&sections[start]).unwrap_or_else(|| self.first(&sections[start])));
        for i in (start + 1..n).chain((0..start).rev()) {
            let before = if i > start { i - 1 } else { i + 1 };
            let section = &sections[i];
            let ring = match known(section) {
                Some(ring) => ring,
                None => follow(rings[before].as_ref()?, section),
            };
            rings[i] = Some(ring);
        }
        let mut rings: Vec<Ring> = rings.into_iter().collect::<Option<_>>()?;
        for ((ring, stop), section) in rings.iter_mut().zip(&self.plan.stops).zip(&sections) {
            ring.is_round = stop.round.is_some();
            swell(ring, section);
        }
        Some(rings)
    }

    /// The section of a stop, anticlockwise seen from the far end.
    fn section(&self, stop: Stop) -> Option<Section> {
        let section = if let Some(i) = stop.round {
            self.lines.round[i].1.clone()
        } else {
            let level = self.profile.level(stop.along);
            self.levels.section(level, |h| self.lines.along[h])?
        };
        let reach = self.profile.median_girth() * 0.5;
        let way = self.profile.direction(stop.along, reach);
        Some(if section.area().dot(way) < 0.0 {
            section.turned()
        } else {
            section
        })
    }

    /// The ring of a section that all lines along the rod go through as they should.
    fn on_lines(&self, section: &Section) -> Option<Ring> {
        if self.order.is_empty() {
            return None;
        }
        let mut crossed = section.crossed.clone();
        crossed.sort_unstable_by_key(|c| c.1);
        let first = crossed.iter().position(|c| c.0 == self.order[0])?;
        crossed.rotate_left(first);
        if !crossed.iter().map(|c| c.0).eq(self.order.iter().copied()) {
            return None;
        }
        let girth = section.girth();
        let start = section.at_corner(crossed[0].1);
        let n = crossed.len();
        let (mut shares, mut is_on_line) = (Vec::new(), Vec::new());
        for (k, &count) in self.plan.shares.iter().enumerate() {
            let at = |k: usize| {
                let at = section.at_corner(crossed[k % n].1) - start;
                if k < n { at.rem_euclid(girth) } else { girth }
            };
            let [from, to] = [at(k), at(k + 1)];
            for i in 0..count {
                shares.push((from + (to - from) * i as f64 / count as f64) / girth);
                is_on_line.push(i == 0);
            }
        }
        Some(ring(section, (start, shares), is_on_line))
    }

    /// The ring that others follow, where no lines say where it is: its corners hold the most, as
    /// those of a prism do, and are their own images where the section is.
    fn first(&self, section: &Section) -> Ring {
        let n = self.plan.n_round;
        let step = section.girth() / n as f64;
        let starts = match self.mirror.and_then(|axis| in_plane(section, axis)) {
            Some(at) => vec![at, at + 0.5 * step],
            None => (0..N_TURNS)
                .map(|i| step * i as f64 / N_TURNS as f64)
                .collect(),
        };
        let shares: Vec<f64> = (0..n).map(|i| i as f64 / n as f64).collect();
        let made = |start: f64| ring(section, (start, shares.clone()), vec![false; n]);
        let held = |ring: &Ring| area(&ring.points).length();
        let mut best = made(starts[0]);
        for &start in &starts[1..] {
            let next = made(start);
            if held(&next) > held(&best) * (1.0 + 1e-4) {
                best = next;
            }
        }
        best
    }
}

/// Where a section meets a plane that it is its own image in.
fn in_plane(section: &Section, axis: usize) -> Option<f64> {
    let middle = section.centre();
    if (mirrored(middle, axis) - middle).length() > 0.02 * section.girth() {
        return None;
    }
    let n = section.points.len();
    let crosses = (0..n).find(|&i| {
        let [a, b] = [section.points[i][axis], section.points[(i + 1) % n][axis]];
        a < 0.0 && b >= 0.0
    })?;
    let [a, b] = [crosses, (crosses + 1) % n].map(|i| section.points[i]);
    let share = a[axis] / (a[axis] - b[axis]);
    Some(section.at_corner(crosses) + share * a.distance(b))
}

fn ring(section: &Section, (start, shares): (f64, Vec<f64>), is_on_line: Vec<bool>) -> Ring {
    let girth = section.girth();
    let points = shares
        .iter()
        .map(|share| section.point(start + share * girth));
    Ring {
        points: points.collect(),
        is_on_line,
        is_round: false,
        area: section.area(),
        shares,
    }
}

/// The ring of a section whose vertices are nearest to where those of the one before would be,
/// carried along the rod without a twist.
fn follow(before: &Ring, section: &Section) -> Ring {
    let way = section.area().normalize_or(DVec3::Z);
    let turn = DQuat::from_rotation_arc(before.axis(), way);
    let grown = (section.area().length() / before.area.length().max(f64::MIN_POSITIVE)).sqrt();
    let [from, to] = [before.centre(), section.centre()];
    let wanted: Vec<DVec3> = before
        .points
        .iter()
        .map(|&p| to + turn * (p - from) * grown)
        .collect();
    let girth = section.girth();
    let off = |start: f64| -> f64 {
        let places = before
            .shares
            .iter()
            .map(|s| section.point(start + s * girth));
        places
            .zip(&wanted)
            .map(|(p, q)| p.distance_squared(*q))
            .sum()
    };
    let step = girth / N_TURNS as f64;
    let mut best = (f64::INFINITY, 0.0);
    for i in 0..N_TURNS {
        let start = i as f64 * step;
        let cost = off(start);
        if cost < best.0 {
            best = (cost, start);
        }
    }
    let mut reach = 0.5 * step;
    for _ in 0..N_HALVINGS {
        for start in [best.1 - reach, best.1 + reach] {
            let cost = off(start);
            if cost < best.0 {
                best = (cost, start);
            }
        }
        reach *= 0.5;
    }
    let n = before.points.len();
    ring(section, (best.1, before.shares.clone()), vec![false; n])
}

/// Widens a ring until it holds as much as its section; what lies on lines stays.
fn swell(ring: &mut Ring, section: &Section) {
    let [wanted, now] = [section.area().length(), area(&ring.points).length()];
    let factor = (wanted / now.max(f64::MIN_POSITIVE))
        .sqrt()
        .clamp(1.0, MOST_SWELL);
    let middle = ring.centre();
    for (p, _) in ring
        .points
        .iter_mut()
        .zip(&ring.is_on_line)
        .filter(|p| !p.1)
    {
        *p = middle + (*p - middle) * factor;
    }
}
