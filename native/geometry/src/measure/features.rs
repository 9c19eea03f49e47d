//! Sharp and marked edges of a surface, chained into lines that end in corners.

use glam::DVec3;

use super::Polyline;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};

/// Cosine of the turn at which a line has a corner even without a third line: 50°.
const CORNER_COSINE: f64 = 0.64;

/// A chain of marked edges from corner to corner, or around.
#[derive(Clone, PartialEq, Debug)]
pub struct FeatureLine {
    /// The vertices in order; a closed line ends with the one it starts with.
    pub vertices: Vec<VertexId>,
    line: Polyline,
}

impl FeatureLine {
    /// The line along some vertices, each joined to the next by an edge; a closed one ends with the
    /// vertex it starts with.
    pub fn new(mesh: &TriangleMesh, vertices: Vec<VertexId>) -> Self {
        let points = vertices.iter().map(|&v| mesh.position(v)).collect();
        Self {
            vertices,
            line: Polyline::new(points, false),
        }
    }

    /// The length of the whole line.
    pub fn length(&self) -> f64 {
        self.line.length()
    }

    /// Whether it goes round.
    pub fn is_closed(&self) -> bool {
        self.vertices.first() == self.vertices.last()
    }

    /// Its straight pieces.
    pub fn segments(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.line.pieces()
    }

    /// The point at an arc length from the start, and the vertex before it.
    pub fn at(&self, length: f64) -> (DVec3, VertexId) {
        let (before, _) = self.line.piece_at(length);
        (self.line.point(length), self.vertices[before])
    }

    /// The two vertices around the point at an arc length from the start, and its share of the way.
    pub fn between(&self, length: f64) -> ([VertexId; 2], f64) {
        let (before, share) = self.line.piece_at(length);
        ([self.vertices[before], self.vertices[before + 1]], share)
    }
}

/// Chains the edges that are marked on either side, longest line first.
pub fn feature_lines(mesh: &TriangleMesh, marked: &HalfedgeMap<bool>) -> Vec<FeatureLine> {
    let neighbours = marked_neighbours(mesh, marked);
    let is_corner = |v: VertexId| match neighbours[v][..] {
        [] => false,
        [a, b] => {
            let way = |to: VertexId| (mesh.position(to) - mesh.position(v)).normalize_or_zero();
            -way(a).dot(way(b)) < CORNER_COSINE
        }
        _ => true,
    };
    let mut walker = Walker {
        neighbours: &neighbours,
        seen: VertexMap::filled(mesh.n_vertices(), 0),
    };
    let mut lines = Vec::new();
    for v in mesh.vertex_ids().filter(|&v| is_corner(v)) {
        for i in 0..neighbours[v].len() {
            lines.extend(walker.walk(v, i, is_corner));
        }
    }
    for v in mesh.vertex_ids().filter(|&v| !neighbours[v].is_empty()) {
        lines.extend(walker.walk(v, 0, |u| u == v));
    }
    let mut lines: Vec<_> = lines
        .into_iter()
        .map(|line| FeatureLine::new(mesh, line))
        .collect();
    lines.sort_by(|a, b| b.length().total_cmp(&a.length()));
    lines
}

/// The share of all marked edges, by length, on lines that begin or end where no other goes on: 0
/// where they are the creases of a solid.
pub fn loose_share(mesh: &TriangleMesh, sharp: &HalfedgeMap<bool>) -> f64 {
    let mut n = VertexMap::filled(mesh.n_vertices(), 0_u32);
    for h in mesh.halfedge_ids().filter(|&h| sharp[h]) {
        n[mesh.origin(h)] += 1;
    }
    // The line of a loose end, as far as nothing branches off.
    let mut is_loose = HalfedgeMap::filled(sharp.len(), false);
    for start in mesh
        .halfedge_ids()
        .filter(|&h| sharp[h] && n[mesh.origin(h)] == 1)
    {
        let mut h = start;
        loop {
            is_loose[h] = true;
            let at = mesh.target(h);
            let on = mesh
                .outgoing(at)
                .filter(|&next| sharp[next] && mesh.target(next) != mesh.origin(h));
            let Some(next) = on.take(usize::from(n[at] == 2)).next() else {
                break;
            };
            h = next;
        }
    }
    let length = |h: HalfedgeId| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.target(h)))
    };
    let all: f64 = mesh.halfedge_ids().filter(|&h| sharp[h]).map(length).sum();
    let loose: f64 = mesh
        .halfedge_ids()
        .filter(|&h| is_loose[h])
        .map(length)
        .sum();
    2.0 * loose / all.max(f64::MIN_POSITIVE)
}

fn marked_neighbours(mesh: &TriangleMesh, marked: &HalfedgeMap<bool>) -> VertexMap<Vec<VertexId>> {
    let mut neighbours = VertexMap::filled(mesh.n_vertices(), Vec::new());
    for h in mesh.halfedge_ids() {
        let Some(twin) = mesh.twin(h).filter(|twin| h < *twin) else {
            continue;
        };
        if marked[h] || marked[twin] {
            neighbours[mesh.origin(h)].push(mesh.target(h));
            neighbours[mesh.target(h)].push(mesh.origin(h));
        }
    }
    neighbours
}

/// Walks along marked edges, each once. A bit per neighbour says which edges were walked.
struct Walker<'a> {
    neighbours: &'a VertexMap<Vec<VertexId>>,
    seen: VertexMap<u64>,
}

impl Walker<'_> {
    /// The line that leaves `start` towards its i-th neighbour, up to a vertex that `ends` it.
    fn walk(
        &mut self,
        start: VertexId,
        i: usize,
        ends: impl Fn(VertexId) -> bool,
    ) -> Option<Vec<VertexId>> {
        let mut line = vec![start];
        let mut way = Some(i);
        let mut at = start;
        while let Some(i) = way.filter(|&i| self.mark(at, i)) {
            let next = self.neighbours[at][i];
            let back = self.neighbours[next].iter().position(|&v| v == at);
            self.mark(next, back.unwrap_or(0));
            line.push(next);
            at = next;
            way = self.neighbours[at]
                .iter()
                .position(|&v| v != line[line.len() - 2]);
            if ends(at) {
                break;
            }
        }
        (line.len() > 1).then_some(line)
    }

    /// Marks an edge as walked and says whether it had not been.
    fn mark(&mut self, vertex: VertexId, i: usize) -> bool {
        // Beyond 64 sharp edges at a vertex no line is worth following.
        let bit = 1u64.checked_shl(i as u32).unwrap_or(0);
        let is_new = self.seen[vertex] & bit == 0 && bit != 0;
        self.seen[vertex] |= bit;
        is_new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::sharp_edges;
    use crate::shapes;

    fn lines(mesh: &TriangleMesh) -> Vec<FeatureLine> {
        feature_lines(mesh, &sharp_edges(mesh, 40f64.to_radians()))
    }

    #[test]
    fn a_box_has_twelve_lines_between_eight_corners() {
        let lines = lines(&shapes::cuboid(6));
        assert_eq!(lines.len(), 12);
        let total: f64 = lines.iter().map(FeatureLine::length).sum();
        assert!((total - 4.0 * (1.0 + 0.8 + 0.6)).abs() < 1e-12);
        assert!(
            lines
                .iter()
                .all(|line| line.vertices.len() == 7 && !line.is_closed())
        );
        let mut ends: Vec<_> = lines
            .iter()
            .flat_map(|l| [l.vertices[0], *l.vertices.last().unwrap()])
            .collect();
        ends.sort_unstable();
        ends.dedup();
        assert_eq!(ends.len(), 8);
    }

    #[test]
    fn smooth_bodies_have_none_and_a_rim_closes() {
        assert_eq!(lines(&shapes::sphere(12)), []);
        let rod = shapes::mapped_cube(12, |p| {
            let round = DVec3::new(p.x, p.y, 0.0);
            let size = p.x.abs().max(p.y.abs());
            round.normalize_or_zero() * size + DVec3::Z * p.z
        });
        let lines = lines(&rod);
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().all(FeatureLine::is_closed));
    }

    #[test]
    fn points_lie_at_their_arc_length() {
        let line = &lines(&shapes::cuboid(5))[0];
        let (middle, _) = line.at(line.length() / 2.0);
        let [first, last] = [line.at(0.0).0, line.at(line.length() + 1.0).0];
        assert!(middle.distance((first + last) / 2.0) < 1e-12);
        assert!((first.distance(last) - line.length()).abs() < 1e-12);
    }
}
