//! The network's last layer: vertices on the sphere move towards their neighbours.
//!
//! ```text
//! y ← y / |y|,   y ← y + Σ σ(key + query' − 4) y'      over the neighbours y'
//! ```
//!
//! Key and query are the network's, a pair for each vertex and each relaxation; the gate is one for
//! all three coordinates, so that nothing depends on the axes. Where the map squeezes a limb, an
//! error of a triangle's width folds it. Sums of positive weights shrink such errors with the
//! triangles, as those of an embedding by means of neighbours do (Tutte 1963; Floater 2003).

use glam::Vec3;

use crate::gated::gated_sum;
use crate::neighbours::Neighbours;

/// Added to the squared length of a vector, so that one of no length has a direction.
pub const LEAST_SQUARE: f32 = 1e-6;
/// Added to the keys, so that an untrained network hardly moves anything.
pub const BIAS: f32 = -4.0;

/// Moves places, a row of three numbers each, once for every pair of columns of the gates: the keys
/// of all relaxations stand first in a row, then their queries.
pub fn relaxed(mut places: Vec<f32>, gates: &[f32], graph: &Neighbours) -> Vec<f32> {
    let n_columns = gates.len() / graph.n_vertices();
    let n = n_columns / 2;
    for i in 0..n {
        let rows = places.chunks_exact(3).zip(gates.chunks_exact(n_columns));
        let rows = rows.flat_map(|(place, gates)| {
            let [x, y, z] = unit(place);
            let (key, query) = (gates[i] + BIAS, gates[n + i]);
            [x, y, z, key, key, key, query, query, query, x, y, z]
        });
        places = gated_sum(&rows.collect::<Vec<_>>(), graph, 3);
    }
    places
}

/// The direction of a vector, of a length below 1 near the centre.
pub fn unit(vector: &[f32]) -> [f32; 3] {
    let v = Vec3::from_slice(vector);
    (v / (v.length_squared() + LEAST_SQUARE).sqrt()).to_array()
}

#[cfg(test)]
mod tests {
    use orbflow_geometry::mesh::VertexId;

    use super::*;

    #[test]
    fn a_place_takes_its_neighbours_as_their_gates_say() {
        let faces = [[0, 1, 2], [0, 2, 1]].map(|face| face.map(VertexId));
        let graph = Neighbours::of_faces(3, &faces);
        let places = vec![2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.5];
        // The first vertex wants all that its neighbours show; the second shows itself, the third
        // hides.
        let gates = [4.0, -99.0, -99.0, 0.0, -99.0, -99.0];
        let moved = relaxed(places, &gates, &graph);
        for (x, wanted) in moved.iter().zip([1.0, 0.5, 0.0, 0.0, 1.0, 0.0]) {
            assert!((x - wanted).abs() < 1e-5, "{moved:?}");
        }
    }

    #[test]
    fn two_relaxations_are_one_after_the_other() {
        let faces = [[0, 1, 2], [0, 2, 1]].map(|face| face.map(VertexId));
        let graph = Neighbours::of_faces(3, &faces);
        let places: Vec<f32> = (0..9).map(|i| (i * i % 7 - 3) as f32).collect();
        let gates = |columns: &[usize]| -> Vec<f32> {
            let rows = (0..3).flat_map(|v| columns.iter().map(move |c| (v * 4 + c) as f32 * 0.3));
            rows.collect()
        };
        let both = relaxed(places.clone(), &gates(&[0, 1, 2, 3]), &graph);
        let first = relaxed(places, &gates(&[0, 2]), &graph);
        assert_eq!(both, relaxed(first, &gates(&[1, 3]), &graph));
    }
}
