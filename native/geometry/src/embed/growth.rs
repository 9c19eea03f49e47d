//! Putting vertices back on the sphere: each into the kernel of its ring, with sweeps in between.

use glam::DVec3;
use rayon::prelude::*;
use thiserror::Error;

use super::fan::{Fan, Rest};
use super::level::Level;
use super::partial::Partial;
use super::rest::{Metric, Stiffness, to_size_one};
use super::room;
use crate::hierarchy::{Collapse, CollapseHierarchy};
use crate::mesh::{Id, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// Relaxations of a new vertex while its neighbours stay.
const N_SETTLING: usize = 3;
/// A vertex that moved by less than this share of its ring's radius is still.
pub const STILL: f64 = 1e-3;
/// How often the surroundings are relaxed, more evenly each time, before a vertex has no room.
const MAX_RESCUES: i32 = 6;
/// Each such attempt.
const RESCUE: Limits = Limits {
    max_sweeps: 10,
    tolerance: 0.0,
};
/// How many places a thread finds at least: waking it takes as long as some of them.
const LEAST_CHUNK: usize = 16;

/// How long a level is relaxed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Limits {
    /// Sweeps over all vertices, at most.
    pub max_sweeps: u32,
    /// They end when one lowers the energy by less than this share.
    pub tolerance: f64,
}

/// A mesh that grows on the sphere.
#[derive(Clone, Debug)]
pub struct Growth {
    /// What is there.
    pub partial: Partial,
    /// How many relaxations of single vertices were done.
    pub n_relaxations: u64,
    positions: Vec<DVec3>,
    stiffness: Stiffness,
    /// The metric in which new vertices settle: that of the last level.
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

impl Growth {
    /// The coarsest level of a hierarchy.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn tetrahedron(
        hierarchy: &CollapseHierarchy,
        stiffness: Stiffness,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let partial = Partial::tetrahedron(hierarchy);
        Self::new(partial, hierarchy.mesh(), stiffness, progress)
    }

    /// A map of (parts of) a mesh.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        partial: Partial,
        mesh: &TriangleMesh,
        stiffness: Stiffness,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let positions = to_size_one(mesh.positions());
        let metric = stiffness.metric(partial.n_there());
        Ok(Self {
            metric: Level::new(&partial, &positions, metric, progress)?.metric(),
            positions,
            partial,
            n_relaxations: 0,
            stiffness,
        })
    }

    /// Undoes independent collapses: all places are found before the first is taken.
    ///
    /// # Errors
    /// [`GrowError`].
    pub fn insert_all(
        &mut self,
        collapses: &[Collapse<'_>],
        progress: &Progress,
    ) -> Result<(), GrowError> {
        // After a cancellation the rest of the places is not looked for, nor used.
        let place = |&collapse: &Collapse<'_>| {
            let goes_on = progress.check().is_ok();
            goes_on.then(|| self.place(collapse)).flatten()
        };
        let chunks = collapses.par_iter().with_min_len(LEAST_CHUNK);
        let places: Vec<Option<DVec3>> = chunks.map(place).collect();
        let mut crowded = Vec::new();
        for (&collapse, place) in collapses.iter().zip(places) {
            progress.check()?;
            match place {
                Some(position) => self.insert(collapse, position),
                None => crowded.push(collapse),
            }
        }
        crowded
            .into_iter()
            .try_for_each(|collapse| self.rescue(collapse, progress))
    }

    fn insert(&mut self, collapse: Collapse<'_>, position: DVec3) {
        self.partial.insert(collapse, position);
        self.n_relaxations += N_SETTLING as u64;
    }

    /// Where a collapsed vertex goes: into the kernel of its ring, then down its energy.
    fn place(&self, collapse: Collapse<'_>) -> Option<DVec3> {
        let ring = self.partial.closed_ring(collapse.ring);
        let rests = self.rests(collapse);
        let fan = Fan {
            ring: &ring,
            rests: &rests,
            evenness: self.metric.evenness,
        };
        let start = room::point(&ring).filter(|&p| fan.energy(p).is_finite())?;
        let settle = |p, _| fan.relax(p).position;
        Some((0..N_SETTLING).fold(start, settle))
    }

    /// The rest shapes of the fan of a vertex.
    fn rests(&self, Collapse { vertex, ring }: Collapse<'_>) -> Vec<Rest> {
        let corners = (0..ring.len()).map(|i| [vertex, ring[i], ring[(i + 1) % ring.len()]]);
        let shape = |corner: [VertexId; 3]| {
            let [p, b, c] = corner.map(|v| self.positions[v.index()]);
            self.metric.rest(p, b, c)
        };
        corners.map(shape).collect()
    }

    /// Relaxes some vertices one after the other.
    pub fn relax_each(&mut self, vertices: &[VertexId]) {
        for &vertex in vertices {
            let around = self.partial.ring(vertex);
            let ring = self.partial.closed_ring(around);
            let rests = self.rests(Collapse {
                vertex,
                ring: around,
            });
            let fan = Fan {
                ring: &ring,
                rests: &rests,
                evenness: self.metric.evenness,
            };
            self.partial.sphere[vertex] = fan.relax(self.partial.sphere[vertex]).position;
            self.n_relaxations += 1;
        }
    }

    /// Makes room for a vertex by relaxing everything in an ever more even metric.
    fn rescue(&mut self, collapse: Collapse<'_>, progress: &Progress) -> Result<(), GrowError> {
        let usual = self.metric;
        for attempt in 1..=MAX_RESCUES {
            let even = Metric {
                delta: usual.delta + 0.05 * 4.0_f64.powi(attempt),
                ..usual
            };
            self.relax(RESCUE, even, progress)?;
            if let Some(position) = self.place(collapse) {
                self.insert(collapse, position);
                self.metric = usual;
                return Ok(());
            }
        }
        let vertex = collapse.vertex;
        Err(GrowError::NoRoom { vertex })
    }

    /// Sweeps over all vertices that are there, in the metric of this level.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn sweeps(&mut self, limits: Limits, progress: &Progress) -> Result<(), Cancelled> {
        let metric = self.stiffness.metric(self.partial.n_there());
        self.relax(limits, metric, progress)
    }

    fn relax(
        &mut self,
        limits: Limits,
        metric: Metric,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut level = Level::new(&self.partial, &self.positions, metric, progress)?;
        self.metric = level.metric();
        let mut whole = None;
        for _ in 0..limits.max_sweeps {
            let sweep = level.sweep(STILL, progress)?;
            self.n_relaxations += sweep.n_relaxations;
            if sweep.is_settled(&mut whole, limits.tolerance) {
                break;
            }
        }
        level.store(&mut self.partial);
        Ok(())
    }
}
