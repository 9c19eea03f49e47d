//! Connectivity that can be edited: the ring of neighbours of every vertex.

use rayon::prelude::*;
use smallvec::SmallVec;

use super::rounds::{BATCH, TASK};
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Where a ring lies in the arena, and how far it can grow there.
#[derive(Clone, Copy, Default)]
struct Span {
    start: u32,
    len: u32,
    capacity: u32,
}

/// The neighbours of every vertex, counter-clockwise and closed.
///
/// A border is closed by one virtual vertex per loop, joined to all vertices of the loop, so that
/// the link condition needs no special cases (Dey et al. 1999). Virtual vertices have ids from
/// `n_vertices` on and keep no ring of their own: a border can be long.
pub(super) struct Rings {
    spans: VertexMap<Span>,
    arena: Vec<VertexId>,
    has_border: bool,
    /// The ring of the last removed vertex, from the vertex that it went into.
    removed: Vec<VertexId>,
    spliced: Vec<VertexId>,
}

impl Rings {
    pub fn of_mesh(mesh: &TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        let n = mesh.n_vertices();
        let mut rings = Self {
            spans: VertexMap::filled(n, Span::default()),
            arena: Vec::with_capacity(n * 9),
            has_border: !mesh.is_closed(),
            removed: Vec::new(),
            spliced: Vec::new(),
        };
        let mut outside: VertexMap<Option<VertexId>> = VertexMap::filled(n, None);
        for (i, border) in mesh.border_loops().iter().enumerate() {
            let outer = VertexId::from_index(n + i);
            for &h in border {
                outside[mesh.origin(h)] = Some(outer);
            }
        }
        let vertices: Vec<VertexId> = mesh.vertex_ids().collect();
        let ring = |&v: &VertexId| mesh.neighbours(v).chain(outside[v]).collect();
        let mut around: Vec<SmallVec<[VertexId; 12]>> = Vec::new();
        for batch in vertices.chunks(BATCH) {
            progress.check()?;
            let batched = batch.par_iter().with_min_len(TASK);
            batched.map(ring).collect_into_vec(&mut around);
            for (&v, ring) in batch.iter().zip(&around) {
                rings.place(v, ring);
            }
        }
        Ok(rings)
    }

    /// The neighbours of a vertex that is not virtual; none after its removal.
    pub fn of(&self, vertex: VertexId) -> &[VertexId] {
        let Span { start, len, .. } = self.spans[vertex];
        &self.arena[start as usize..(start + len) as usize]
    }

    pub fn is_virtual(&self, vertex: VertexId) -> bool {
        vertex.index() >= self.spans.len()
    }

    /// Whether a vertex lies on the border.
    pub fn is_border(&self, vertex: VertexId) -> bool {
        self.has_border && self.of(vertex).iter().any(|&w| self.is_virtual(w))
    }

    /// Whether collapsing `vertex` into entry `at` of its ring keeps the surface a manifold of the
    /// same genus with the same borders.
    pub fn is_legal(&self, vertex: VertexId, at: usize) -> bool {
        let ring = self.of(vertex);
        let into = ring[at];
        if self.is_virtual(into) {
            return false;
        }
        let [next, previous] = beside(ring, at);
        // Two borders must not meet in one vertex: their edge has to be a border edge.
        let runs_along = self.is_virtual(next) || self.is_virtual(previous);
        if self.has_border && !runs_along && self.is_border(vertex) && self.is_border(into) {
            return false;
        }
        // Only in a tetrahedron do the two have no other common neighbour although an opposite
        // vertex has valence 3.
        let shrinks = |v: VertexId| self.is_virtual(v) || self.of(v).len() > 3;
        if !shrinks(next) || !shrinks(previous) {
            return false;
        }
        let around = self.of(into);
        let is_free = |&w: &VertexId| {
            if w == next || w == previous {
                return true;
            }
            if self.is_virtual(w) || around.len() <= self.of(w).len() {
                !around.contains(&w)
            } else {
                !self.of(w).contains(&into)
            }
        };
        ring[..at].iter().all(is_free) && ring[at + 1..].iter().all(is_free)
    }

    /// Removes `vertex` by a legal collapse into entry `at` of its ring; returns that ring, rotated
    /// so that it starts with the vertex collapsed into.
    pub fn collapse(&mut self, vertex: VertexId, at: usize) -> &[VertexId] {
        let mut removed = std::mem::take(&mut self.removed);
        removed.clear();
        let ring = self.of(vertex);
        removed.extend_from_slice(&ring[at..]);
        removed.extend_from_slice(&ring[..at]);
        let (into, k) = (removed[0], removed.len());
        self.replace(removed[1], vertex, &[]);
        self.replace(removed[k - 1], vertex, &[]);
        for &w in &removed[2..k - 1] {
            self.replace(w, vertex, &[into]);
        }
        self.replace(into, vertex, &removed[2..k - 1]);
        self.spans[vertex] = Span::default();
        self.removed = removed;
        &self.removed
    }

    /// Puts `new` where `old` stands in the ring of a vertex; rings of virtual vertices stay away.
    fn replace(&mut self, vertex: VertexId, old: VertexId, new: &[VertexId]) {
        if self.is_virtual(vertex) {
            return;
        }
        let span = self.spans[vertex];
        let ring = &mut self.arena[span.start as usize..(span.start + span.len) as usize];
        let at = ring
            .iter()
            .position(|&w| w == old)
            .expect("neighbours name each other");
        match *new {
            [] => {
                ring.copy_within(at + 1.., at);
                self.spans[vertex].len -= 1;
            }
            [only] => ring[at] = only,
            _ => {
                let mut spliced = std::mem::take(&mut self.spliced);
                spliced.clear();
                spliced.extend_from_slice(&ring[..at]);
                spliced.extend_from_slice(new);
                spliced.extend_from_slice(&ring[at + 1..]);
                self.place(vertex, &spliced);
                self.spliced = spliced;
            }
        }
    }

    /// Writes a ring where the old one was, or at the end of the arena when it has outgrown it.
    fn place(&mut self, vertex: VertexId, ring: &[VertexId]) {
        let len = ring.len();
        let span = &mut self.spans[vertex];
        if len > span.capacity as usize {
            // Room for three collapses of the common kind; doubling bounds the arena.
            let capacity = if span.capacity == 0 { len + 3 } else { 2 * len };
            span.start = u32::try_from(self.arena.len()).expect("rings fill less than the ids");
            span.capacity = capacity as u32;
            self.arena.resize(self.arena.len() + capacity, VertexId(0));
        }
        span.len = len as u32;
        let start = span.start as usize;
        self.arena[start..start + len].copy_from_slice(ring);
    }
}

/// The entries after and before an entry of a ring.
pub(super) fn beside(ring: &[VertexId], at: usize) -> [VertexId; 2] {
    let after = if at + 1 == ring.len() { 0 } else { at + 1 };
    let before = if at == 0 { ring.len() } else { at } - 1;
    [ring[after], ring[before]]
}
