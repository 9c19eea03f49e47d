//! Sizes that change slowly, and as many quads as wanted.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::mesh::{TriangleMesh, VertexId, VertexMap};

/// Lowers sizes until none grows by more than `slope` per length of the way from another.
pub fn grade(mesh: &TriangleMesh, sizes: &mut VertexMap<f64>, slope: f64) {
    // The bits of positive numbers are ordered as the numbers are.
    let entry = |v: VertexId, size: f64| Reverse((size.to_bits(), v));
    let all = mesh.vertex_ids().filter(|&v| sizes[v].is_finite());
    let mut queue: BinaryHeap<_> = all.map(|v| entry(v, sizes[v])).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let size = f64::from_bits(bits);
        if size > sizes[v] {
            continue;
        }
        for h in mesh.outgoing(v) {
            let to = mesh.target(h);
            let most = size + slope * mesh.position(to).distance(mesh.position(v));
            if most < sizes[to] {
                sizes[to] = most;
                queue.push(entry(to, most));
            }
        }
    }
}

/// Shares of the surface with what is wanted there.
pub struct Wanted<'a> {
    /// The area around each vertex.
    pub areas: &'a VertexMap<f64>,
    /// Sizes, about right for the count.
    pub sizes: &'a VertexMap<f64>,
    /// What they must not exceed.
    pub caps: &'a VertexMap<f64>,
    /// How much longer edges elsewhere may become to make room for caps; beyond, caps give way too.
    pub most_growth: f64,
}

impl Wanted<'_> {
    /// The sizes, times a factor and capped, of which `n_quads` cover the surface.
    pub fn fit(&self, n_quads: f64) -> VertexMap<f64> {
        // More quads for a smaller factor: halve what brackets the wanted number.
        let [mut low, mut high] = [0.01, 100.0];
        for _ in 0..50 {
            let factor = f64::sqrt(low * high);
            if self.count(factor) > n_quads {
                low = factor;
            } else {
                high = factor;
            }
        }
        let size = |v| self.size(v, f64::sqrt(low * high));
        self.areas.ids().map(size).collect()
    }

    fn size(&self, v: VertexId, factor: f64) -> f64 {
        let give = (factor / self.most_growth).max(1.0);
        (self.sizes[v] * factor).min(self.caps[v] * give)
    }

    fn count(&self, factor: f64) -> f64 {
        let count = |v| self.areas[v] / self.size(v, factor).powi(2);
        self.areas.ids().map(count).sum()
    }
}
