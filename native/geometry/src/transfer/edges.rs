//! The old edge that an edge of the result lies on.

use glam::DVec3;

use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// An old edge lies under the middle of a new one if it is nearer than this share of the new one's
/// length: chords of a curved line are nearer, a line beside it is farther.
const NEAR: f64 = 0.25;
/// Cosine of the angle at which an old edge still runs along a new one: 45°. At a corner the edges
/// of other lines are as near.
const ALONG: f64 = 0.7;

/// An edge of the result, and the old edge it lies on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CarriedEdge {
    /// The ends of the edge of the result.
    pub ends: [VertexId; 2],
    /// Which of the old edges it lies on at its middle.
    pub from: usize,
}

/// Finds those edges of the output that lie on old edges, out of some that lie along lines.
///
/// An old edge is known by the places of its ends. Costs O(n log n).
///
/// # Errors
/// When cancelled.
pub fn edges(
    old: &[[DVec3; 2]],
    output: &PolygonMesh,
    lines: &[[VertexId; 2]],
    progress: &Progress,
) -> Result<Vec<CarriedEdge>, Cancelled> {
    let segments: Vec<_> = old.iter().map(|&[a, b]| [a, b, b]).collect();
    let tree = Bvh::build(&segments, progress)?;
    let mut found = Vec::new();
    for &ends in lines {
        progress.check()?;
        let [a, b] = ends.map(|v| output.position(v));
        let way = b - a;
        let runs_along =
            |[p, q]: [DVec3; 2]| (q - p).dot(way).abs() >= ALONG * (q - p).length() * way.length();
        let reach = NEAR * NEAR * way.length_squared();
        let under = tree.closest_where(a.midpoint(b), reach, |edge| runs_along(old[edge.index()]));
        found.extend(under.map(|under| CarriedEdge {
            ends,
            from: under.face.index(),
        }));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::shapes;

    /// All edges of a mesh of which both ends fulfil a condition.
    fn edges_where(mesh: &TriangleMesh, fits: impl Fn(DVec3) -> bool) -> Vec<[VertexId; 2]> {
        let ends = mesh
            .halfedge_ids()
            .map(|h| [mesh.origin(h), mesh.target(h)]);
        let is_first = |[a, b]: &[VertexId; 2]| a < b;
        let fits = |ends: &[VertexId; 2]| ends.iter().all(|&v| fits(mesh.position(v)));
        ends.filter(is_first).filter(fits).collect()
    }

    fn places(mesh: &TriangleMesh, edges: &[[VertexId; 2]]) -> Vec<[DVec3; 2]> {
        let places = edges.iter().map(|ends| ends.map(|v| mesh.position(v)));
        places.collect()
    }

    /// A ring of edges around the middle of a sphere.
    fn ring(n: u32) -> (TriangleMesh, Vec<[VertexId; 2]>) {
        let mesh = shapes::mapped_cube(n, DVec3::normalize_or_zero);
        let edges = edges_where(&mesh, |p| p.z.abs() < 1e-9);
        (mesh, edges)
    }

    #[test]
    fn edges_of_a_coarser_ring_lie_on_those_of_the_finer_one() {
        let (fine, old) = ring(24);
        let (coarse, lines) = ring(8);
        let (old, output) = (places(&fine, &old), shapes::polygons(&coarse));
        let found = edges(&old, &output, &lines, &Progress::none()).unwrap();
        assert_eq!((found.len(), lines.len()), (32, 32));
        for carried in found {
            let [a, b] = carried.ends.map(|v| output.position(v));
            let [p, q] = old[carried.from];
            let off = a.midpoint(b).distance(p.midpoint(q));
            assert!(off < a.distance(b) / 2.0, "{off}");
        }
    }

    #[test]
    fn lines_beside_and_across_are_told_from_those_on_it() {
        let (mesh, old) = ring(12);
        let output = shapes::polygons(&mesh);
        let beside = edges_where(&mesh, |p| (p.z - 0.15).abs() < 0.08);
        let meridian = edges_where(&mesh, |p| p.x.abs() < 1e-9);
        assert!(!beside.is_empty() && !meridian.is_empty());
        for lines in [beside, meridian] {
            let found = edges(&places(&mesh, &old), &output, &lines, &Progress::none());
            assert_eq!(found.unwrap(), []);
        }
    }

    #[test]
    fn without_old_edges_there_is_nothing_to_find() {
        let (mesh, lines) = ring(4);
        let found = edges(&[], &shapes::polygons(&mesh), &lines, &Progress::none());
        assert_eq!(found.unwrap(), []);
    }
}
