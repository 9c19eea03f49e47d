//! How many quads go round a rod, and where along it its rings are.

use glam::DVec3;

use super::ball::STAR;
use super::lines::Lines;
use super::section::{Profile, Section};
use crate::elementary::ln;

/// What rings of few quads cost that are to look round, times their number squared; 1 is what quads
/// 2.7 times as long as wide cost. Below, wires become square; above, their rings are too far
/// apart.
const ROUNDNESS: f64 = 32.0;
/// What ends that are no rectangles of squares between lines cost.
const AWRY: f64 = 0.7;
/// The most quads that go round.
const MOST_ROUND: usize = 400;
/// A ring on a line round the rod lies at least this share of a step from the next.
const APART: f64 = 0.25;
/// How much closer rings are where the rod turns by a radian in two steps.
const BENT: f64 = 1.5;
/// Places where it is measured how close rings are wanted.
const N_PLACES: usize = 2048;

/// What decides where rings are.
pub(super) struct Wishes<'a> {
    pub n_quads: usize,
    /// How much closer rings are where the rod bends.
    pub adaptivity: f64,
    /// How many quads an area wants at a place, relative to others.
    pub weight: &'a dyn Fn(DVec3) -> f64,
}

/// A ring that is to be.
#[derive(Clone, Copy)]
pub(super) struct Stop {
    pub along: f64,
    /// The line round the rod that it lies on.
    pub round: Option<usize>,
}

/// The rings that are to be.
pub(super) struct Plan {
    /// How many quads go round.
    pub n_round: usize,
    /// Of them between one line along the rod and the next.
    pub shares: Vec<usize>,
    /// The sides of the rectangles of quads that close the ends.
    pub cap: [usize; 2],
    pub stops: Vec<Stop>,
}

impl Plan {
    /// `middle` is a section that all lines along the rod go through, if there is one. None where
    /// there are too few quads.
    pub fn new(
        profile: &Profile,
        lines: &Lines,
        middle: Option<&Section>,
        wishes: &Wishes<'_>,
    ) -> Option<Self> {
        let n_least = lines.n_along().max(4).next_multiple_of(2);
        let gaps = middle.map_or(Vec::new(), gaps);
        let choices = (n_least..=MOST_ROUND).step_by(2);
        let choices = choices.filter_map(|n| {
            let shares = shared(&gaps, n);
            let cap = cap(n, &shares);
            let n_rings = n_rings(n, n_ends(n, cap), wishes.n_quads)?;
            let cost = cost(profile, (n, &gaps), &shares, wishes.n_quads);
            Some((cost, n, shares, cap, n_rings))
        });
        let best = choices.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (_, n_round, shares, cap, n_rings) = best;
        let stops = stops(profile, lines, (n_round, cap, n_rings), wishes)?;
        Some(Self {
            n_round,
            shares,
            cap,
            stops,
        })
    }
}

/// How far it is from one line along the rod to the next in a section.
pub(super) fn gaps(section: &Section) -> Vec<f64> {
    let at: Vec<f64> = section
        .crossed
        .iter()
        .map(|c| section.at_corner(c.1))
        .collect();
    let n = at.len();
    let gap = |i: usize| {
        if i + 1 < n {
            at[i + 1] - at[i]
        } else {
            at[0] + section.girth() - at[i]
        }
    };
    (0..n).map(gap).collect()
}

/// So many quads shared out by lengths, one for each at least.
fn shared(lengths: &[f64], n: usize) -> Vec<usize> {
    let whole: f64 = lengths.iter().sum();
    let mut shares = vec![1; lengths.len()];
    for _ in lengths.len()..n {
        // Whose pieces are longest gets one more; of equals, but for rounding, the first.
        let mut most = 0;
        for i in 1..lengths.len() {
            let piece = |i: usize| lengths[i] / shares[i] as f64;
            if piece(i) > piece(most) + 1e-9 * whole {
                most = i;
            }
        }
        if let Some(share) = shares.get_mut(most) {
            *share += 1;
        }
    }
    shares
}

/// The sides of the rectangle of quads within a ring; between four lines those of the rod's sides.
fn cap(n: usize, shares: &[usize]) -> [usize; 2] {
    match *shares {
        [a, b, c, d] if a == c && b == d => [a, b],
        _ => [n / 4, n / 2 - n / 4],
    }
}

/// How many quads close both ends.
fn n_ends(n: usize, [a, b]: [usize; 2]) -> usize {
    if n == STAR { STAR } else { 2 * a * b }
}

fn n_rings(n: usize, n_ends: usize, n_quads: usize) -> Option<usize> {
    let steps = (n_quads.checked_sub(n_ends)? as f64 / n as f64).round() as usize;
    (steps >= 2).then_some(steps + 1)
}

fn cost(profile: &Profile, (n, gaps): (usize, &[f64]), shares: &[usize], n_quads: usize) -> f64 {
    let girth = profile.area() / profile.length();
    let even = girth / (profile.area() / n_quads as f64).sqrt();
    let long = 2.0 * ln(n as f64 / even).abs();
    if gaps.len() < 3 {
        return long + ROUNDNESS / (n * n) as f64;
    }
    let pieces = || gaps.iter().zip(shares).map(|(gap, &n)| gap / n as f64);
    let [least, most] = [
        pieces().fold(f64::INFINITY, f64::min),
        pieces().fold(0.0, f64::max),
    ];
    let is_awry = gaps.len() == 4 && (shares[0] != shares[2] || shares[1] != shares[3]);
    long + ln(most / least.max(f64::MIN_POSITIVE)) + if is_awry { AWRY } else { 0.0 }
}

/// The rings: on lines round the rod, and evenly between.
fn stops(
    profile: &Profile,
    lines: &Lines,
    (n, cap, n_rings): (usize, [usize; 2], usize),
    wishes: &Wishes<'_>,
) -> Option<Vec<Stop>> {
    let length = profile.length();
    let step = length / (n_rings - 1) as f64;
    let fixed = fixed(profile, lines, (n, cap), step);
    let fixed = if fixed.len() > n_rings {
        vec![fixed[0], fixed[fixed.len() - 1]]
    } else {
        fixed
    };
    let ways = Ways::new(profile, step, wishes);
    let at: Vec<f64> = fixed.iter().map(|stop| ways.at(stop.along)).collect();
    let lengths: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if lengths.iter().any(|&l| !l.is_finite() || l <= 0.0) {
        return None;
    }
    let counts = shared(&lengths, n_rings - 1);
    let mut stops = vec![fixed[0]];
    for (i, &count) in counts.iter().enumerate() {
        for k in 1..count {
            let way = at[i] + lengths[i] * k as f64 / count as f64;
            let along = ways.along(way);
            stops.push(Stop { along, round: None });
        }
        stops.push(fixed[i + 1]);
    }
    Some(stops)
}

/// The first and the last ring, and those on lines round the rod that are far enough apart.
fn fixed(profile: &Profile, lines: &Lines, (n, cap): (usize, [usize; 2]), step: f64) -> Vec<Stop> {
    let length = profile.length();
    // An end without a rim is closed by quads as large as those round the rod.
    let wide = profile.area() / length / n as f64;
    let size = (cap[0] * cap[1]) as f64 * wide * wide;
    let open = |along: f64| Stop { along, round: None };
    let low = open(profile.along_area(size).min(0.5 * step));
    let high = open(
        profile
            .along_area(profile.area() - size)
            .max(length - 0.5 * step),
    );
    let n_round = lines.round.len();
    let on = |i: usize| Stop {
        along: lines.round[i].0,
        round: Some(i),
    };
    let low = if lines.rims[0] { on(0) } else { low };
    let high = if lines.rims[1] { on(n_round - 1) } else { high };
    let mut fixed = vec![low];
    for stop in (0..n_round).map(on) {
        let last = fixed[fixed.len() - 1].along;
        if stop.along > last + APART * step && stop.along < high.along - APART * step {
            fixed.push(stop);
        }
    }
    fixed.push(high);
    fixed
}

/// Ways along a rod that are longer where rings are wanted closer.
struct Ways {
    step: f64,
    ways: Vec<f64>,
}

impl Ways {
    fn new(profile: &Profile, ring_step: f64, wishes: &Wishes<'_>) -> Self {
        let step = profile.length() / N_PLACES as f64;
        let mut ways = vec![0.0];
        for i in 0..N_PLACES {
            let at = (i as f64 + 0.5) * step;
            let [back, on] = [at - ring_step, at + ring_step]
                .map(|at| profile.direction(at, ring_step.max(profile.median_girth() * 0.25)));
            let turn = (back - on).length();
            let closer = 1.0 + BENT * wishes.adaptivity.min(1.0) * turn.min(1.0);
            let weight = (wishes.weight)(profile.centre(at)).sqrt();
            ways.push(ways[i] + step * closer * weight);
        }
        Self { step, ways }
    }

    fn at(&self, along: f64) -> f64 {
        let place = (along / self.step).clamp(0.0, N_PLACES as f64 - 1e-9);
        let i = place as usize;
        self.ways[i] + (self.ways[i + 1] - self.ways[i]) * (place - i as f64)
    }

    fn along(&self, way: f64) -> f64 {
        let after = self.ways.partition_point(|&x| x <= way);
        let i = after.clamp(1, N_PLACES) - 1;
        let share = (way - self.ways[i]) / (self.ways[i + 1] - self.ways[i]);
        (i as f64 + share.clamp(0.0, 1.0)) * self.step
    }
}
