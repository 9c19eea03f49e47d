//! Repair of a proposed map: what is folded is taken out, collapse by collapse, and put back.

use std::f64::consts::PI;

use glam::DVec3;

use super::growth::{GrowError, Growth, Limits};
use super::partial::Partial;
use super::rest::Stiffness;
use crate::elementary::atan2;
use crate::hierarchy::Collapse;
use crate::mesh::{TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{is_positive, triple_product};

/// The share of the vertices that may be taken out. Beyond that little of the proposal is left,
/// and the solver makes a better map.
const MAX_SHARE: f64 = 0.5;
/// The largest valence that a collapse may make while there are others.
const MAX_VALENCE: usize = 12;
/// The sweeps over all vertices that a whole map gets in the end.
pub const SMOOTHING: Limits = Limits {
    max_sweeps: 2,
    tolerance: 0.0,
};

/// A map without folds.
#[derive(Clone, Debug)]
pub struct Repaired {
    /// Its points.
    pub sphere: VertexMap<DVec3>,
    /// How many vertices were taken out and put back.
    pub n_moved: usize,
    /// How many relaxations of single vertices that took.
    pub n_relaxations: u64,
}

/// Takes the vertices of folds out until every fan is positive and winds once, then puts them back
/// in reverse, and smooths all. None when too much would have to go, or when there is no room to put it back.
///
/// `sphere` holds zero where there is no usable point; such vertices are taken out too.
///
/// # Errors
/// [`Cancelled`].
pub fn repair(
    mesh: &TriangleMesh,
    sphere: VertexMap<DVec3>,
    smoothing: Limits,
    progress: &Progress,
) -> Result<Option<Repaired>, Cancelled> {
    let mut clearing = Clearing {
        partial: Partial::whole(mesh, sphere, progress)?,
        removed: Vec::new(),
    };
    if !clearing.clear(&progress.part("", 0.0, 0.5))? {
        return Ok(None);
    }
    let Clearing { partial, removed } = clearing;
    let mut growth = Growth::new(partial, mesh, Stiffness::Shape, progress)?;
    match put_back(
        &mut growth,
        &removed,
        smoothing,
        &progress.part("", 0.5, 1.0),
    ) {
        Err(GrowError::NoRoom { .. }) => Ok(None),
        Err(GrowError::Cancelled(cancelled)) => Err(cancelled),
        Ok(()) => Ok(Some(Repaired {
            sphere: growth.partial.sphere,
            n_moved: removed.len(),
            n_relaxations: growth.n_relaxations,
        })),
    }
}

/// Undoes the removals, last first, and relaxes around each.
fn put_back(
    growth: &mut Growth,
    removed: &[(VertexId, Vec<VertexId>)],
    smoothing: Limits,
    progress: &Progress,
) -> Result<(), GrowError> {
    for (i, (vertex, ring)) in removed.iter().rev().enumerate() {
        let vertex = *vertex;
        growth.insert_all(&[Collapse { vertex, ring }], progress)?;
        growth.relax_each(ring);
        growth.relax_each(&[vertex]);
        if i % 256 == 0 {
            progress.at(i as f64 / removed.len() as f64)?;
        }
    }
    Ok(growth.sweeps(smoothing, progress)?)
}

/// A map from which the folds are taken out.
struct Clearing {
    partial: Partial,
    removed: Vec<(VertexId, Vec<VertexId>)>,
}

impl Clearing {
    /// Collapses until no fan is bad; false when too many would have to go.
    fn clear(&mut self, progress: &Progress) -> Result<bool, Cancelled> {
        let n_whole = self.partial.n_there();
        let mut suspects: Vec<VertexId> = self.partial.there().map(|(v, _)| v).collect();
        let mut forced = false;
        loop {
            suspects.retain(|&v| !self.partial.ring(v).is_empty() && self.badness(v) > 0);
            if suspects.is_empty() {
                return Ok(true);
            }
            if self.removed.len() as f64 > MAX_SHARE * n_whole as f64 {
                return Ok(false);
            }
            progress.at(self.removed.len() as f64 / n_whole as f64)?;
            // The culprit of folds has more of them than its neighbours.
            suspects.sort_by_cached_key(|&v| (std::cmp::Reverse(self.badness(v)), v));
            let mut next = suspects.clone();
            let mut made_progress = false;
            for &v in &suspects {
                progress.check()?;
                let badness = self.badness(v);
                if badness == 0 || self.partial.ring(v).is_empty() {
                    continue;
                }
                if let Some(into) = self.best_target(v, badness, forced) {
                    next.extend_from_slice(self.partial.ring(v));
                    self.take_out(v, into);
                    made_progress = true;
                }
            }
            if forced && !made_progress {
                return Ok(false);
            }
            forced = !made_progress;
            next.sort_unstable();
            next.dedup();
            suspects = next;
        }
    }

    fn take_out(&mut self, vertex: VertexId, into: VertexId) {
        let ring = self.partial.ring_from(vertex, into);
        self.partial.collapse(Collapse {
            vertex,
            ring: &ring,
        });
        self.removed.push((vertex, ring));
    }

    /// The folded triangles of a fan, and one more if it does not wind once around its vertex.
    fn badness(&self, vertex: VertexId) -> usize {
        let ring = self.partial.closed_ring(self.partial.ring(vertex));
        let p = self.partial.sphere[vertex];
        let folds = ring.windows(2).filter(|e| !is_positive(p, e[0], e[1]));
        let n_folds = folds.count();
        n_folds + usize::from(n_folds > 0 || !winds_once(p, &ring))
    }

    /// The neighbour to collapse into that leaves the fewest folds: fewer than there were, unless
    /// `forced`. Ties go to the smaller valence.
    fn best_target(&self, vertex: VertexId, badness: usize, forced: bool) -> Option<VertexId> {
        let valence = |v: VertexId| self.partial.ring(v).len();
        let left = |into: VertexId| {
            let ring = self.partial.ring_from(vertex, into);
            let u = self.partial.sphere[into];
            let point = |i: usize| self.partial.sphere[ring[i]];
            let folds = (1..ring.len() - 1).filter(|&i| !is_positive(u, point(i), point(i + 1)));
            folds.count()
        };
        let targets = self.partial.ring(vertex).iter().copied();
        let choices = targets
            .filter(|&into| self.partial.is_legal(vertex, into))
            .map(|into| (left(into), valence(into) + valence(vertex) - 4, into))
            .filter(|&(left, valence, _)| forced || (left < badness && valence <= MAX_VALENCE));
        choices.min().map(|(_, _, into)| into)
    }
}

/// Whether a fan of positive triangles winds once around its middle, not twice or more.
fn winds_once(p: DVec3, ring: &[DVec3]) -> bool {
    let turn = |e: &[DVec3]| {
        let [u, w] = [e[0] - p, e[1] - p].map(|d| d - p * d.dot(p));
        atan2(triple_product(p, u, w), u.dot(w))
    };
    ring.windows(2).map(turn).sum::<f64>() < 3.0 * PI
}
