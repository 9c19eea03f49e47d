//! Four quads of each, and three of each triangle.

use std::collections::HashMap;

use glam::DVec3;

use super::{Paired, faces_on};
use crate::mesh::VertexId;

/// Cuts every quad in four at the middles of its edges and of its inner diagonal, and every triangle
/// in three.
///
/// Each of the four lies in the two triangles of its quad, cut again by the diagonal or one beside
/// it: where these were positive on the sphere, so are all. Vertices keep their numbers; the middles
/// of edges follow, then those of quads.
pub fn split(paired: &Paired) -> Paired {
    let quads = &paired.quads;
    let mut points = quads.positions().to_vec();
    let mut middles: HashMap<[VertexId; 2], u32> = HashMap::new();
    let mut around = Vec::with_capacity(quads.n_faces());
    for face in quads.faces() {
        let edges = (0..face.len()).map(|i| {
            let [a, b] = [face[i], face[(i + 1) % face.len()]];
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let middle = quads.position(a) + quads.position(b);
                points.push(middle.normalize_or(quads.position(a)));
                points.len() as u32 - 1
            })
        });
        around.push(edges.collect::<Vec<u32>>());
    }
    let mut four = Vec::with_capacity(4 * quads.n_faces());
    for (face, edges) in quads.faces().zip(around) {
        let middle = points.len() as u32;
        let n = face.len();
        let ends = [0, 2].map(|i| quads.position(face[i]));
        let third = if n == 3 {
            quads.position(face[1])
        } else {
            DVec3::ZERO
        };
        points.push((ends[0] + ends[1] + third).normalize_or(ends[0]));
        four.extend((0..n).map(|i| [face[i].0, edges[i], middle, edges[(i + n - 1) % n]]));
    }
    let halves = |edges: &[[VertexId; 2]]| {
        let both = edges
            .iter()
            .flat_map(|edge| edge.map(|end| [end, VertexId(middles[edge])]));
        let mut both: Vec<_> = both.collect();
        both.sort_unstable();
        both
    };
    Paired {
        kept: halves(&paired.kept),
        firm: halves(&paired.firm),
        quads: faces_on(points, &four),
    }
}
