//! Four quads of each.

use std::collections::HashMap;

use super::{Paired, quads_on};
use crate::mesh::VertexId;

/// Cuts every quad in four at the middles of its edges and of its inner diagonal.
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
        around.push([0, 1, 2, 3].map(|i| {
            let [a, b] = [face[i], face[(i + 1) % 4]];
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let middle = quads.position(a) + quads.position(b);
                points.push(middle.normalize_or(quads.position(a)));
                points.len() as u32 - 1
            })
        }));
    }
    let mut four = Vec::with_capacity(4 * quads.n_faces());
    for (face, edges) in quads.faces().zip(around) {
        let middle = points.len() as u32;
        let ends = [face[0], face[2]].map(|v| quads.position(v));
        points.push((ends[0] + ends[1]).normalize_or(ends[0]));
        four.extend((0..4).map(|i| [face[i].0, edges[i], middle, edges[(i + 3) % 4]]));
    }
    let mut kept: Vec<_> = (paired.kept.iter())
        .flat_map(|edge| edge.map(|end| [end, VertexId(middles[edge])]))
        .collect();
    kept.sort_unstable();
    Paired {
        quads: quads_on(points, &four),
        kept,
    }
}
