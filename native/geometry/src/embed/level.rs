//! Sweeps of relaxation over all vertices of a level, colour by colour.
//!
//! Vertices of one colour are no neighbours, so that each of them reads only points that stay where
//! they are: the result is the same for any order and any number of threads. Everything that a
//! sweep needs lies in flat arrays, ordered by colour.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::fan::{self, Relaxed, Rest};
use super::partial::Partial;
use super::rest::Metric;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// A colour with fewer vertices than this is relaxed by one thread: waking another takes longer.
const LEAST_PARALLEL: usize = 512;
/// How many vertices a thread takes at least.
const LEAST_CHUNK: usize = 128;

/// The mesh of a level, laid out for sweeps. A vertex is named by its slot in that layout.
#[derive(Clone, Debug)]
pub struct Level {
    order: Vec<VertexId>,
    colours: Vec<Range<usize>>,
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    rests: Vec<Rest>,
    points: Vec<Point>,
    metric: Metric,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    position: DVec3,
    /// How far its last relaxation moved it, in ring radii.
    moved: f64,
}

/// What a sweep did.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Sweep {
    /// How many vertices were relaxed.
    pub n_relaxations: u64,
    /// The energy of the relaxed fans before.
    pub energy: f64,
    /// By how much it fell.
    pub decrease: f64,
}

impl Level {
    /// Lays out the mesh that is on the sphere, with its rest shapes in the given metric.
    pub fn new(partial: &Partial, positions: &[DVec3], metric: Metric) -> Self {
        let (order, colours) = by_colour(partial);
        let mut slots = vec![u32::MAX; partial.sphere.len()];
        for (slot, &v) in order.iter().enumerate() {
            slots[v.index()] = slot as u32;
        }
        let mut starts = vec![0];
        let mut neighbours = Vec::with_capacity(6 * order.len());
        for &v in &order {
            neighbours.extend(partial.ring(v).iter().map(|r| slots[r.index()]));
            starts.push(neighbours.len() as u32);
        }
        let (rests, metric) = rest_shapes(&order, positions, partial, metric);
        let points = order.iter().map(|&v| Point {
            position: partial.sphere[v],
            moved: f64::INFINITY,
        });
        Self {
            points: points.collect(),
            order,
            colours,
            starts,
            neighbours,
            rests,
            metric,
        }
    }

    /// The metric, scaled to the area of the sphere.
    pub fn metric(&self) -> Metric {
        self.metric
    }

    /// Puts the points back to where they were taken from.
    pub fn store(&self, partial: &mut Partial) {
        for (&v, point) in self.order.iter().zip(&self.points) {
            partial.sphere[v] = point.position;
        }
    }

    /// Relaxes every vertex once, unless neither it nor a neighbour moved by more than `still`
    /// ring radii last time.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn sweep(&mut self, still: f64, progress: &Progress) -> Result<Sweep, Cancelled> {
        let mut sweep = Sweep::default();
        let mut relaxed: Vec<Option<Relaxed>> = Vec::new();
        for colour in self.colours.clone() {
            progress.check()?;
            if colour.len() < LEAST_PARALLEL {
                let mut ring = Vec::new();
                let slots = colour.clone();
                relaxed.clear();
                relaxed.extend(slots.map(|slot| self.relax(slot, still, &mut ring)));
            } else {
                let slots = colour.clone().into_par_iter().with_min_len(LEAST_CHUNK);
                slots
                    .map_init(Vec::new, |ring, slot| self.relax(slot, still, ring))
                    .collect_into_vec(&mut relaxed);
            }
            for (point, relaxed) in self.points[colour].iter_mut().zip(&relaxed) {
                if let Some(relaxed) = relaxed {
                    point.position = relaxed.position;
                    point.moved = relaxed.moved;
                    sweep.n_relaxations += 1;
                    sweep.energy += relaxed.before;
                    sweep.decrease += relaxed.before - relaxed.after;
                }
            }
        }
        Ok(sweep)
    }

    /// Relaxes the vertex of a slot, unless everything around it is still.
    fn relax(&self, slot: usize, still: f64, ring: &mut Vec<DVec3>) -> Option<Relaxed> {
        let corners = self.starts[slot] as usize..self.starts[slot + 1] as usize;
        let Point { position, moved } = self.points[slot];
        let mut is_still = moved < still;
        ring.clear();
        for &neighbour in &self.neighbours[corners.clone()] {
            let point = self.points[neighbour as usize];
            is_still &= point.moved < still;
            ring.push(point.position);
        }
        if is_still {
            return None;
        }
        ring.push(ring[0]);
        Some(fan::relax(position, ring, &self.rests[corners]))
    }
}

/// The vertices ordered by colour, and the range of each colour.
fn by_colour(partial: &Partial) -> (Vec<VertexId>, Vec<Range<usize>>) {
    let mut buckets: Vec<Vec<VertexId>> = Vec::new();
    for v in partial.there() {
        let colour = partial.colour(v) as usize;
        if colour >= buckets.len() {
            buckets.resize(colour + 1, Vec::new());
        }
        buckets[colour].push(v);
    }
    let mut end = 0;
    let ranges = buckets.iter().map(|bucket| {
        let start = end;
        end += bucket.len();
        start..end
    });
    let ranges = ranges.collect();
    (buckets.concat(), ranges)
}

/// The rest shape of every corner in the order of the layout, scaled to the area of the sphere.
fn rest_shapes(
    order: &[VertexId],
    positions: &[DVec3],
    partial: &Partial,
    metric: Metric,
) -> (Vec<Rest>, Metric) {
    let corners = order.iter().flat_map(|&p| {
        let ring = partial.ring(p);
        (0..ring.len()).map(move |i| [p, ring[i], ring[(i + 1) % ring.len()]])
    });
    let corners: Vec<[VertexId; 3]> = corners.collect();
    let unscaled = Metric {
        scale: 1.0,
        ..metric
    };
    let rest = |corner: &[VertexId; 3]| {
        let [p, b, c] = corner.map(|v| positions[v.index()]);
        unscaled.rest(p, b, c)
    };
    let mut rests: Vec<Rest> = if corners.len() < LEAST_PARALLEL {
        corners.iter().map(rest).collect()
    } else {
        corners
            .par_iter()
            .with_min_len(LEAST_CHUNK)
            .map(rest)
            .collect()
    };
    // Every face has three corners.
    let double_area = rests.iter().map(|r| r.square.sqrt()).sum::<f64>() / 3.0;
    let metric = metric.scaled_to_sphere(double_area);
    for rest in &mut rests {
        rest.square *= metric.scale.powi(2);
    }
    (rests, metric)
}
