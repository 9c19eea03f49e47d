//! Cuts a mesh at the plane where a coordinate is 0.

use std::collections::HashMap;

use glam::DVec3;

use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};

/// What lies on the positive side: triangles without a common numbering of components yet.
pub struct Side {
    pub positions: Vec<DVec3>,
    /// The ends of the edge that each vertex lies on; one vertex twice where it is that.
    pub sources: Vec<[VertexId; 2]>,
    pub faces: Vec<[VertexId; 3]>,
}

/// The triangles on the positive side of a mesh.
///
/// Edges across the plane are split where they meet it. A vertex nearer to that point than the
/// share `snap` of the edge is moved there instead, so that no slivers come to be; one that would
/// leave a face flat in the plane is not, and one on a line only along it.
pub fn positive_side(
    mesh: &TriangleMesh,
    (axis, snap): (usize, f64),
    lines: Option<&HalfedgeMap<bool>>,
) -> Side {
    let mut cut = Cut {
        positions: mesh.positions().to_vec(),
        mesh,
        lines,
        axis,
    };
    for v in mesh.vertex_ids() {
        cut.snap(v, snap);
    }
    cut.split()
}

struct Cut<'a> {
    mesh: &'a TriangleMesh,
    positions: Vec<DVec3>,
    lines: Option<&'a HalfedgeMap<bool>>,
    axis: usize,
}

impl Cut<'_> {
    fn height(&self, v: VertexId) -> f64 {
        self.positions[v.index()][self.axis]
    }

    /// Where an edge across the plane meets it, and at which share of its length from `a`.
    fn crossing(&self, a: VertexId, b: VertexId) -> Option<(f64, DVec3)> {
        let [x, y] = [self.height(a), self.height(b)];
        if x * y >= 0.0 {
            return None;
        }
        let share = x / (x - y);
        let mut point = self.positions[a.index()].lerp(self.positions[b.index()], share);
        point[self.axis] = 0.0;
        Some((share, point))
    }

    fn snap(&mut self, v: VertexId, snap: f64) {
        let is_line = |h: &HalfedgeId| self.lines.is_some_and(|lines| lines[*h]);
        // One that ends at a vertex of a border leaves it for no face.
        let leaving = self.mesh.outgoing(v).map(|h| (h, self.mesh.target(h)));
        let arriving = self.mesh.outgoing(v).map(HalfedgeId::prev);
        let arriving = arriving.filter(|&h| self.mesh.twin(h).is_none());
        let all = leaving.chain(arriving.map(|h| (h, self.mesh.origin(h))));
        let all: Vec<(HalfedgeId, VertexId)> = all.collect();
        let on_line = all.iter().any(|(h, _)| is_line(h));
        let ways = all.iter().filter(|(h, _)| !on_line || is_line(h));
        let crossings = ways.filter_map(|&(_, u)| self.crossing(v, u));
        let nearest = crossings.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let Some((_, point)) = nearest.filter(|(share, _)| *share < snap) else {
            return;
        };
        let is_flat = |h: HalfedgeId| {
            let others = [self.mesh.target(h), self.mesh.origin(h.prev())];
            others.iter().all(|&u| self.height(u) == 0.0)
        };
        if !self.mesh.outgoing(v).any(is_flat) {
            self.positions[v.index()] = point;
        }
    }

    fn split(mut self) -> Side {
        let mut faces = Vec::new();
        let mut sources: Vec<[VertexId; 2]> = self.mesh.vertex_ids().map(|v| [v, v]).collect();
        let mut between: HashMap<[VertexId; 2], VertexId> = HashMap::new();
        for &face in self.mesh.faces() {
            if face.iter().all(|&v| self.height(v) <= 0.0) {
                continue;
            }
            let mut kept = Vec::with_capacity(4);
            for i in 0..3 {
                let [a, b] = [face[i], face[(i + 1) % 3]];
                if self.height(a) >= 0.0 {
                    kept.push(a);
                }
                let Some((_, point)) = self.crossing(a, b) else {
                    continue;
                };
                let new = VertexId::from_index(self.positions.len());
                let v = *between.entry([a.min(b), a.max(b)]).or_insert(new);
                if v == new {
                    self.positions.push(point);
                    sources.push([a, b]);
                }
                kept.push(v);
            }
            faces.extend(self.triangles(&kept));
        }
        Side {
            positions: self.positions,
            sources,
            faces,
        }
    }

    /// A triangle, or a quad cut from a vertex off the plane along its shorter diagonal.
    fn triangles(&self, kept: &[VertexId]) -> Vec<[VertexId; 3]> {
        let &[a, b, c, d] = kept else {
            return kept.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        };
        let length = |u: VertexId, v: VertexId| {
            self.positions[u.index()].distance_squared(self.positions[v.index()])
        };
        if length(b, d) < length(a, c) {
            vec![[a, b, d], [b, c, d]]
        } else {
            vec![[a, b, c], [a, c, d]]
        }
    }
}
