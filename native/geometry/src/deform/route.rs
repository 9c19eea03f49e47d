//! Shortest paths over a sheet's edges along a line in space.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::sheet::Sheet;
use crate::measure::FeatureLine;
use crate::mesh::{VertexId, VertexMap};
use crate::nearest::Bvh;

/// How much dearer an edge is whose end lies one edge length off the line. Below 2 paths cut
/// corners; above 20 they zigzag to stay near.
const DETOUR: f64 = 6.0;
/// Vertices farther off the line than this many edge lengths are not used.
const CORRIDOR: f64 = 2.0;

/// Finds paths; keeps what it learned about vertices between calls.
pub(super) struct Router {
    edge: f64,
    costs: VertexMap<f64>,
    from: VertexMap<VertexId>,
    touched: Vec<VertexId>,
}

impl Router {
    /// For a sheet of `n` vertices whose edges are about `edge` long.
    pub fn new(n: usize, edge: f64) -> Self {
        Self {
            edge,
            costs: VertexMap::filled(n, f64::INFINITY),
            from: VertexMap::filled(n, VertexId(0)),
            touched: Vec::new(),
        }
    }

    /// The cheapest path from the first to the last vertex along a line, over free vertices only.
    pub fn path(
        &mut self,
        sheet: &Sheet,
        [first, last]: [VertexId; 2],
        line: &FeatureLine,
        is_free: impl Fn(VertexId) -> bool,
    ) -> Option<Vec<VertexId>> {
        let segments: Vec<_> = line.segments().map(|[a, b]| [a, b, b]).collect();
        let segments = Bvh::new(&segments);
        let reach = (CORRIDOR * self.edge).powi(2);
        let off_line = |p: DVec3| segments.closest_where(p, reach, |_| true);
        self.forget();
        self.set(first, 0.0, first);
        let mut heap = BinaryHeap::from([Reverse((0u64, first))]);
        while let Some(Reverse((cost, v))) = heap.pop() {
            // Costs are not negative, so their bits sort as they do.
            let cost = f64::from_bits(cost);
            if v == last {
                return Some(self.back_from(last, first));
            }
            if cost > self.costs[v] {
                continue;
            }
            for &face in sheet.ring(v) {
                let face = &sheet.faces()[face];
                let next = face.corner(face.find(v).unwrap_or(0), 1);
                if next != last && !is_free(next) {
                    continue;
                }
                let p = sheet.position(next);
                let Some(foot) = off_line(p) else { continue };
                let detour = foot.distance_squared / self.edge.powi(2);
                let length = p.distance(sheet.position(v));
                let total = cost + length * (1.0 + DETOUR * detour);
                if total < self.costs[next] {
                    self.set(next, total, v);
                    heap.push(Reverse((total.to_bits(), next)));
                }
            }
        }
        None
    }

    fn set(&mut self, v: VertexId, cost: f64, from: VertexId) {
        self.costs[v] = cost;
        self.from[v] = from;
        self.touched.push(v);
    }

    fn forget(&mut self) {
        for v in self.touched.drain(..) {
            self.costs[v] = f64::INFINITY;
        }
    }

    fn back_from(&self, last: VertexId, first: VertexId) -> Vec<VertexId> {
        let mut path = vec![last];
        let mut at = last;
        while at != first {
            at = self.from[at];
            path.push(at);
        }
        path.reverse();
        path
    }
}
