//! Undoing collapses on the sphere, round by round.

use glam::DVec3;
use rayon::prelude::*;
use thiserror::Error;

use super::fan;
use super::level::Level;
use super::partial::Partial;
use super::rest::{Metric, Stiffness, to_size_one};
use super::room;
use crate::hierarchy::{Collapse, CollapseHierarchy};
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// Relaxations of a new vertex while its neighbours stay.
const N_SETTLING: usize = 3;
/// A vertex that moved by less than this share of its ring's radius is still.
pub const STILL: f64 = 1e-3;
/// How often the surroundings are relaxed, more evenly each time, before a vertex has no room.
const MAX_RESCUES: u32 = 6;
/// A round with fewer insertions than this is computed by one thread.
const LEAST_PARALLEL: usize = 256;

/// A hierarchy that grows on the sphere.
pub struct Growth<'a> {
    /// What grows.
    pub hierarchy: &'a CollapseHierarchy,
    /// What is there.
    pub partial: Partial,
    /// How many relaxations of single vertices were done.
    pub n_relaxations: u64,
    positions: Vec<DVec3>,
    stiffness: Stiffness,
    metric: Metric,
}

/// Why vertices could not be put on the sphere.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum GrowError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Rounding leaves no place for a vertex, even after its surroundings were relaxed.
    #[error("there is no room for vertex {vertex} on the sphere")]
    NoRoom {
        /// The first such vertex.
        vertex: VertexId,
    },
}

impl<'a> Growth<'a> {
    /// The coarsest level.
    pub fn new(hierarchy: &'a CollapseHierarchy, stiffness: Stiffness) -> Self {
        let partial = Partial::tetrahedron(hierarchy);
        let positions = to_size_one(hierarchy.mesh().positions());
        let level = Level::new(&partial, &positions, stiffness.metric(4));
        Self {
            metric: level.metric(),
            positions,
            hierarchy,
            partial,
            n_relaxations: 0,
            stiffness,
        }
    }

    /// Undoes the collapses of a round. They are independent, so all places are found first.
    ///
    /// # Errors
    /// [`GrowError`].
    pub fn insert_round(&mut self, round: usize, progress: &Progress) -> Result<(), GrowError> {
        let round = self.hierarchy.round(round);
        let place = |index: usize| self.place(self.hierarchy.collapse(index));
        let places: Vec<Option<DVec3>> = if round.len() < LEAST_PARALLEL {
            round.clone().map(place).collect()
        } else {
            round.clone().into_par_iter().map(place).collect()
        };
        let mut crowded = Vec::new();
        for (index, place) in round.zip(places) {
            match place {
                Some(position) => self.insert(index, position),
                None => crowded.push(index),
            }
        }
        crowded
            .into_iter()
            .try_for_each(|index| self.rescue(index, progress))
    }

    fn insert(&mut self, index: usize, position: DVec3) {
        self.partial
            .insert(self.hierarchy.collapse(index), position);
        self.n_relaxations += N_SETTLING as u64;
    }

    /// Where a collapsed vertex goes: into the kernel of its ring, then down its energy.
    fn place(&self, collapse: Collapse<'_>) -> Option<DVec3> {
        let ring = self.partial.closed_ring(collapse.ring);
        let corners = (0..collapse.ring.len()).map(|i| {
            let next = collapse.ring[(i + 1) % collapse.ring.len()];
            let [p, b, c] =
                [collapse.vertex, collapse.ring[i], next].map(|v| self.positions[v.index()]);
            self.metric.rest(p, b, c)
        });
        let rests: Vec<_> = corners.collect();
        let start = room::point(&ring).filter(|&p| fan::energy(p, &ring, &rests).is_finite())?;
        let settle = |p, _| fan::relax(p, &ring, &rests).position;
        Some((0..N_SETTLING).fold(start, settle))
    }

    /// Makes room for a vertex by relaxing everything in an ever more even metric.
    fn rescue(&mut self, index: usize, progress: &Progress) -> Result<(), GrowError> {
        for attempt in 1..=MAX_RESCUES {
            let even = Metric {
                delta: self.metric.delta + 0.05 * 4.0_f64.powi(attempt as i32),
                ..self.metric
            };
            self.relax(10, even, progress)?;
            if let Some(position) = self.place(self.hierarchy.collapse(index)) {
                self.insert(index, position);
                return Ok(());
            }
        }
        let vertex = self.hierarchy.collapse(index).vertex;
        Err(GrowError::NoRoom { vertex })
    }

    /// Sweeps over all vertices that are there, in the metric of this level.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn sweeps(&mut self, n_sweeps: u32, progress: &Progress) -> Result<(), Cancelled> {
        let n_there = self.partial.n_there();
        let metric = self.stiffness.metric(n_there);
        self.relax(n_sweeps, metric, progress)
    }

    fn relax(
        &mut self,
        n_sweeps: u32,
        metric: Metric,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut level = Level::new(&self.partial, &self.positions, metric);
        self.metric = level.metric();
        for _ in 0..n_sweeps {
            self.n_relaxations += level.sweep(STILL, progress)?.n_relaxations;
        }
        level.store(&mut self.partial);
        Ok(())
    }
}
