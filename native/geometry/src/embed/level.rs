//! Sweeps of relaxation over all vertices of a level, colour by colour.
//!
//! Vertices of one colour are no neighbours, so that each of them reads only points that stay where
//! they are: the result is the same for any order and any number of threads.

use glam::DVec3;
use rayon::prelude::*;

use super::fan::Fan;
use super::layout::{CHUNK, Chunk, Layout};
use super::partial::Partial;
use super::rest::Metric;
use crate::progress::{Cancelled, Progress};

/// The mesh of a level, laid out for sweeps.
#[derive(Clone, Debug)]
pub struct Level {
    layout: Layout,
    points: Vec<Point>,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    position: DVec3,
    /// How far its last relaxation moved it, in ring radii.
    moved: f64,
}

/// The points of the other colours while those of one are relaxed.
struct Others<'a> {
    /// The slots before that colour, and those after it.
    sides: [&'a [Point]; 2],
    /// The first slot of each side.
    starts: [usize; 2],
    /// The weight of keeping areas.
    evenness: f64,
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

impl Sweep {
    /// Whether it lowered the energy by no more than a share of `whole`, the energy of all faces,
    /// which the first sweep of a level finds.
    pub fn is_settled(&self, whole: &mut Option<f64>, tolerance: f64) -> bool {
        // The first sweep sees every fan, and so every face three times.
        let whole = *whole.get_or_insert(self.energy / 3.0);
        self.decrease <= tolerance * whole
    }

    fn add(&mut self, other: &Self) {
        self.n_relaxations += other.n_relaxations;
        self.energy += other.energy;
        self.decrease += other.decrease;
    }
}

impl Level {
    /// Lays out the mesh that is on the sphere, with its rest shapes in the given metric.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        partial: &Partial,
        positions: &[DVec3],
        metric: Metric,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let layout = Layout::new(partial, positions, metric, progress)?;
        let points = layout.order.iter().map(|&v| Point {
            position: partial.sphere[v],
            moved: f64::INFINITY,
        });
        Ok(Self {
            points: points.collect(),
            layout,
        })
    }

    /// The metric, scaled to the area of the sphere.
    pub fn metric(&self) -> Metric {
        self.layout.metric
    }

    /// Puts the points back to where they were taken from.
    pub fn store(&self, partial: &mut Partial) {
        for (&v, point) in self.layout.order.iter().zip(&self.points) {
            partial.sphere[v] = point.position;
        }
    }

    /// Relaxes every vertex once, unless neither it nor a neighbour moved by more than `still`
    /// ring radii last time.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn sweep(&mut self, still: f64, progress: &Progress) -> Result<Sweep, Cancelled> {
        let mut sum = Sweep::default();
        let mut chunks = &self.layout.chunks[..];
        for colour in &self.layout.colours {
            let (before, rest) = self.points.split_at_mut(colour.start);
            let (points, after) = rest.split_at_mut(colour.len());
            let others = Others {
                sides: [before, after],
                starts: [0, colour.end],
                evenness: self.layout.metric.evenness,
            };
            let (own, later) = chunks.split_at(points.len().div_ceil(CHUNK));
            chunks = later;
            let pairs = points.par_chunks_mut(CHUNK).zip(own);
            // After a cancellation nobody asks for the points that are left as they are.
            let relax = |(points, chunk): (&mut [Point], &Chunk)| match progress.check() {
                Ok(()) => others.relax(points, chunk, still),
                Err(Cancelled) => Sweep::default(),
            };
            let sweeps: Vec<Sweep> = pairs.map(relax).collect();
            progress.check()?;
            for sweep in &sweeps {
                sum.add(sweep);
            }
        }
        Ok(sum)
    }
}

impl Others<'_> {
    /// Relaxes the vertices of a chunk, unless everything around them is still.
    fn relax(&self, points: &mut [Point], chunk: &Chunk, still: f64) -> Sweep {
        let mut sweep = Sweep::default();
        let mut ring = Vec::new();
        for (point, (neighbours, rests)) in points.iter_mut().zip(chunk.fans()) {
            let mut is_still = point.moved < still;
            ring.clear();
            for &slot in neighbours {
                let other = self.get(slot as usize);
                is_still &= other.moved < still;
                ring.push(other.position);
            }
            if is_still {
                continue;
            }
            ring.push(ring[0]);
            let fan = Fan {
                ring: &ring,
                rests,
                evenness: self.evenness,
            };
            let relaxed = fan.relax(point.position);
            point.position = relaxed.position;
            point.moved = relaxed.moved;
            sweep.add(&Sweep {
                n_relaxations: 1,
                energy: relaxed.before,
                decrease: relaxed.before - relaxed.after,
            });
        }
        sweep
    }

    fn get(&self, slot: usize) -> &Point {
        let side = usize::from(slot >= self.starts[1]);
        &self.sides[side][slot - self.starts[side]]
    }
}
