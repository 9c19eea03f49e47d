//! The mesh of a level in flat arrays, ordered by colour and cut into chunks of work.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::fan::Rest;
use super::partial::Partial;
use super::rest::Metric;
use crate::mesh::{Id, VertexId};
use crate::progress::{Cancelled, Progress};

/// How many vertices a thread takes at once: some 20 µs of relaxation. Sums are made per chunk, so
/// that they do not depend on the number of threads.
pub const CHUNK: usize = 64;

/// The order of the vertices, their chunks, and the metric, scaled to the area of the sphere. A
/// vertex is named by its slot, its place in the order.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The vertices, colour by colour.
    pub order: Vec<VertexId>,
    /// The slots of each colour.
    pub colours: Vec<Range<usize>>,
    /// The chunks of all colours; no chunk has vertices of two.
    pub chunks: Vec<Chunk>,
    /// The metric of the rest shapes.
    pub metric: Metric,
}

/// The fans of some consecutive slots.
#[derive(Clone, Debug)]
pub struct Chunk {
    ends: Vec<u32>,
    neighbours: Vec<u32>,
    rests: Vec<Rest>,
    double_area: f64,
}

impl Layout {
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
        let (order, colours) = by_colour(partial);
        let mut slots = vec![u32::MAX; partial.sphere.len()];
        for (slot, &v) in order.iter().enumerate() {
            slots[v.index()] = slot as u32;
        }
        let pieces: Vec<&[VertexId]> = colours
            .iter()
            .flat_map(|colour| order[colour.clone()].chunks(CHUNK))
            .collect();
        let unscaled = Metric {
            scale: 1.0,
            ..metric
        };
        let chunk = |&piece: &&[VertexId]| {
            let mut chunk = Chunk::new(piece.len());
            // A chunk that stays empty after a cancellation is never seen.
            let piece = if progress.check().is_ok() { piece } else { &[] };
            for &v in piece {
                chunk.push(v, partial.ring(v), (&slots, positions), unscaled);
            }
            chunk
        };
        let mut chunks: Vec<Chunk> = pieces.par_iter().map(chunk).collect();
        progress.check()?;
        // Every face has three corners.
        let double_area = chunks.iter().map(|c| c.double_area).sum::<f64>() / 3.0;
        let metric = metric.scaled_to_sphere(double_area);
        chunks.par_iter_mut().for_each(|chunk| {
            for rest in &mut chunk.rests {
                rest.square *= metric.scale * metric.scale;
            }
        });
        Ok(Self {
            order,
            colours,
            chunks,
            metric,
        })
    }
}

impl Chunk {
    fn new(n_vertices: usize) -> Self {
        Self {
            ends: Vec::with_capacity(n_vertices),
            neighbours: Vec::with_capacity(6 * n_vertices + 8),
            rests: Vec::with_capacity(6 * n_vertices + 8),
            double_area: 0.0,
        }
    }

    fn push(
        &mut self,
        vertex: VertexId,
        ring: &[VertexId],
        (slots, positions): (&[u32], &[DVec3]),
        metric: Metric,
    ) {
        let position = |v: VertexId| positions[v.index()];
        let p = position(vertex);
        let mut b = position(ring[ring.len() - 1]);
        // The corner between the last neighbour and the first comes last.
        let mut last = None;
        for &next in ring {
            let c = position(next);
            let rest = metric.rest(p, b, c);
            self.double_area += rest.square.sqrt();
            self.neighbours.push(slots[next.index()]);
            if last.is_none() {
                last = Some(rest);
            } else {
                self.rests.push(rest);
            }
            b = c;
        }
        self.rests.extend(last);
        self.ends.push(self.neighbours.len() as u32);
    }

    /// The neighbours' slots and the rest shapes of each vertex.
    pub fn fans(&self) -> impl Iterator<Item = (&[u32], &[Rest])> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let corners = start as usize..end as usize;
            start = end;
            (&self.neighbours[corners.clone()], &self.rests[corners])
        })
    }
}

/// The vertices ordered by colour, and the range of each colour.
fn by_colour(partial: &Partial) -> (Vec<VertexId>, Vec<Range<usize>>) {
    let mut buckets: Vec<Vec<VertexId>> = Vec::new();
    for (v, colour) in partial.there() {
        let colour = colour as usize;
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
