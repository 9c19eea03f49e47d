//! Rounds of collapses: the cheapest first, costs refreshed only where something has changed.

use rayon::prelude::*;

use super::rings::Rings;
use crate::mesh::{VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Vertices per parallel task, and per look at the cancellation flag (some 10 ms of work).
const TASK: usize = 256;
const BATCH: usize = 8192;

/// The best collapse of a vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Candidate {
    pub cost: f64,
    pub into: VertexId,
}

/// A collapse of this round, in the order of cost.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Choice {
    pub cost: f64,
    pub vertex: VertexId,
    pub into: VertexId,
}

/// The best collapse of every vertex, and which of them have to be looked at again.
pub(super) struct Rounds {
    pub alive: Vec<VertexId>,
    best: VertexMap<Option<Candidate>>,
    /// The round in which `best` was computed, and that in which the ring or place changed last.
    evaluated: VertexMap<u32>,
    changed: VertexMap<u32>,
    dirty: Vec<VertexId>,
    round: u32,
    /// The share of the vertices that a round looks at, cheapest first.
    share: f64,
}

impl Rounds {
    pub fn new(n_vertices: usize, share: f64) -> Self {
        let best: VertexMap<_> = VertexMap::filled(n_vertices, None);
        Self {
            alive: best.ids().collect(),
            dirty: best.ids().collect(),
            best,
            evaluated: VertexMap::filled(n_vertices, 0),
            changed: VertexMap::filled(n_vertices, 0),
            round: 0,
            share,
        }
    }

    /// The cheapest collapses, in order; `None` when no vertex has one. `best` is asked in
    /// parallel, and again where a neighbour of the vertex has changed since.
    pub fn next(
        &mut self,
        rings: &Rings,
        best: impl Fn(VertexId) -> Option<Candidate> + Sync,
        progress: &Progress,
    ) -> Result<Option<Vec<Choice>>, Cancelled> {
        self.round += 1;
        self.alive.retain(|&v| !rings.of(v).is_empty());
        let dirty = std::mem::take(&mut self.dirty);
        self.evaluate(&dirty, &best, progress)?;
        let Some(limit) = self.cost_limit() else {
            return Ok(None);
        };
        let is_cheap = |v: &VertexId| self.best[*v].is_some_and(|best| best.cost <= limit);
        let cheap: Vec<VertexId> = self.alive.iter().copied().filter(is_cheap).collect();
        let is_stale = |v: &VertexId| self.is_stale(rings, *v);
        let stale: Vec<VertexId> = cheap.iter().copied().filter(is_stale).collect();
        self.evaluate(&stale, &best, progress)?;
        let choice = |vertex: VertexId| {
            let Candidate { cost, into } = self.best[vertex].filter(|best| best.cost <= limit)?;
            Some(Choice { cost, vertex, into })
        };
        let mut order: Vec<Choice> = cheap.into_iter().filter_map(choice).collect();
        order.sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.vertex.cmp(&b.vertex)));
        Ok(Some(order))
    }

    fn evaluate(
        &mut self,
        vertices: &[VertexId],
        best: &(impl Fn(VertexId) -> Option<Candidate> + Sync),
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut found = Vec::new();
        for batch in vertices.chunks(BATCH) {
            progress.check()?;
            let tasks = batch.par_iter().with_min_len(TASK);
            tasks.map(|&v| best(v)).collect_into_vec(&mut found);
            for (&v, &candidate) in batch.iter().zip(&found) {
                self.best[v] = candidate;
                self.evaluated[v] = self.round;
            }
        }
        Ok(())
    }

    /// The cost up to which this round takes collapses; none when nothing can be collapsed.
    fn cost_limit(&self) -> Option<f64> {
        let best = |v: &VertexId| self.best[*v].map(|best| best.cost);
        let mut costs: Vec<f64> = self.alive.iter().filter_map(best).collect();
        let last = costs.len().checked_sub(1)?;
        let at = (self.share * self.alive.len() as f64) as usize;
        let (_, limit, _) = costs.select_nth_unstable_by(at.min(last), f64::total_cmp);
        Some(*limit)
    }

    fn is_stale(&self, rings: &Rings, vertex: VertexId) -> bool {
        let evaluated = self.evaluated[vertex];
        rings
            .of(vertex)
            .iter()
            .any(|&w| !rings.is_virtual(w) && self.changed[w] >= evaluated)
    }

    /// Whether a vertex was marked in this round.
    pub fn is_changed(&self, vertex: VertexId) -> bool {
        self.changed[vertex] == self.round
    }

    /// Says that the ring or the place of a vertex has changed in this round.
    pub fn mark(&mut self, vertex: VertexId) {
        if !self.is_changed(vertex) {
            self.changed[vertex] = self.round;
            self.dirty.push(vertex);
        }
    }

    /// Says that what may be collapsed has changed everywhere.
    pub fn mark_all(&mut self) {
        self.dirty.clone_from(&self.alive);
    }
}
