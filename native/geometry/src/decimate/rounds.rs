//! Rounds of collapses: the cheapest first, costs refreshed only where something has changed.

use rayon::prelude::*;

use super::rings::Rings;
use crate::mesh::{VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Vertices per parallel task.
pub(super) const TASK: usize = 256;
/// Vertices per look at the cancellation flag: some 10 ms of work.
pub(super) const BATCH: usize = 8192;

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

/// What a vertex costs to remove, asked in parallel.
pub(super) trait Costs: Sync {
    /// The rings of the level.
    fn rings(&self) -> &Rings;
    /// A quick lower bound of the cost of the best collapse; infinite when there is surely none.
    fn bound(&self, vertex: VertexId) -> f64;
    /// The best collapse of a vertex that is allowed.
    fn best(&self, vertex: VertexId) -> Option<Candidate>;
}

/// The best collapse of every vertex, and which of them have to be looked at again.
///
/// A vertex whose ring or place changes gets the quick bound; only those that come among the
/// cheapest are looked at in earnest, and again when a neighbour has changed since.
pub(super) struct Rounds {
    pub alive: Vec<VertexId>,
    costs: VertexMap<f64>,
    into: VertexMap<VertexId>,
    /// The round in which the best was found (0 for bounds), and that of the last change.
    found: VertexMap<u32>,
    changed: VertexMap<u32>,
    round: u32,
    /// The share of the vertices that a round looks at, cheapest first.
    share: f64,
}

impl Rounds {
    pub fn new(n_vertices: usize, share: f64) -> Self {
        let costs: VertexMap<_> = VertexMap::filled(n_vertices, f64::INFINITY);
        Self {
            alive: costs.ids().collect(),
            costs,
            into: VertexMap::filled(n_vertices, VertexId(0)),
            found: VertexMap::filled(n_vertices, 0),
            changed: VertexMap::filled(n_vertices, 0),
            round: 0,
            share,
        }
    }

    /// The cheapest collapses, in order; `None` when no vertex has one.
    pub fn next(
        &mut self,
        costs: &impl Costs,
        progress: &Progress,
    ) -> Result<Option<Vec<Choice>>, Cancelled> {
        self.round += 1;
        self.alive.retain(|&v| !costs.rings().of(v).is_empty());
        // In the order of ids, which is that of memory, not in that of changes.
        let is_dirty = |v: &VertexId| self.changed[*v] + 1 == self.round;
        let dirty: Vec<VertexId> = self.alive.iter().copied().filter(is_dirty).collect();
        self.bound(&dirty, costs, progress)?;
        let limit = self.cost_limit();
        progress.check()?;
        if limit == f64::INFINITY {
            return Ok(None);
        }
        let is_cheap = |v: &VertexId| self.costs[*v] <= limit;
        let cheap: Vec<VertexId> = self.alive.iter().copied().filter(is_cheap).collect();
        let is_stale = |v: &VertexId| self.is_stale(costs.rings(), *v);
        let stale: Vec<VertexId> = cheap.iter().copied().filter(is_stale).collect();
        progress.check()?;
        self.find(&stale, costs, progress)?;
        let choice = |vertex: VertexId| {
            let (cost, into) = (self.costs[vertex], self.into[vertex]);
            (cost <= limit).then_some(Choice { cost, vertex, into })
        };
        let mut order: Vec<Choice> = cheap.into_iter().filter_map(choice).collect();
        order.sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.vertex.cmp(&b.vertex)));
        Ok(Some(order))
    }

    /// Bounds the costs of some vertices.
    fn bound(
        &mut self,
        vertices: &[VertexId],
        costs: &impl Costs,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut bounds = Vec::new();
        for batch in vertices.chunks(BATCH) {
            progress.check()?;
            let tasks = batch.par_iter().with_min_len(TASK);
            tasks.map(|&v| costs.bound(v)).collect_into_vec(&mut bounds);
            for (&v, &bound) in batch.iter().zip(&bounds) {
                self.costs[v] = bound;
                self.found[v] = 0;
            }
        }
        Ok(())
    }

    /// Finds the best collapses of some vertices.
    fn find(
        &mut self,
        vertices: &[VertexId],
        costs: &impl Costs,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut best = Vec::new();
        for batch in vertices.chunks(BATCH) {
            progress.check()?;
            let tasks = batch.par_iter().with_min_len(TASK);
            tasks.map(|&v| costs.best(v)).collect_into_vec(&mut best);
            for (&v, best) in batch.iter().zip(&best) {
                self.costs[v] = best.map_or(f64::INFINITY, |best| best.cost);
                self.into[v] = best.map_or(v, |best| best.into);
                self.found[v] = self.round;
            }
        }
        Ok(())
    }

    /// The cost up to which this round takes collapses; infinite when nothing can be collapsed.
    fn cost_limit(&self) -> f64 {
        let cost = |&v: &VertexId| self.costs[v];
        let mut costs: Vec<f64> = self
            .alive
            .iter()
            .map(cost)
            .filter(|cost| cost.is_finite())
            .collect();
        let Some(last) = costs.len().checked_sub(1) else {
            return f64::INFINITY;
        };
        let at = (self.share * self.alive.len() as f64) as usize;
        *costs.select_nth_unstable_by(at.min(last), f64::total_cmp).1
    }

    fn is_stale(&self, rings: &Rings, vertex: VertexId) -> bool {
        let found = self.found[vertex];
        let has_changed = |&w: &VertexId| !rings.is_virtual(w) && self.changed[w] >= found;
        found == 0 || rings.of(vertex).iter().any(has_changed)
    }

    /// Whether a vertex was marked in this round.
    pub fn is_changed(&self, vertex: VertexId) -> bool {
        self.changed[vertex] == self.round
    }

    /// Says that the ring or the place of a vertex has changed in this round.
    pub fn mark(&mut self, vertex: VertexId) {
        self.changed[vertex] = self.round;
    }

    /// Says that what may be collapsed has changed everywhere.
    pub fn mark_all(&mut self) {
        for &v in &self.alive {
            self.changed[v] = self.round;
        }
    }
}
