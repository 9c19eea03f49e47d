//! What the network knows of a vertex.

use std::f64::consts::PI;

use glam::DVec3;
use orbflow_geometry::elementary::ln;
use orbflow_geometry::measure::area_vector;
use orbflow_geometry::mesh::{Id, VertexId};

/// Position (3), normal (3), logarithm of the area around the vertex.
pub const N_FEATURES: usize = 7;

/// The smallest area that is told apart, as a share of the mean: below it single precision ends.
const LEAST_SHARE: f64 = 1e-6;

/// [`N_FEATURES`] numbers per vertex, from the mesh of a level in the network's frame.
pub fn features(positions: &[DVec3], faces: &[[VertexId; 3]]) -> Vec<f32> {
    let mut areas = vec![DVec3::ZERO; positions.len()];
    let mut sizes = vec![0.0; positions.len()];
    for face in faces {
        let area = area_vector(face.map(|v| positions[v.index()]));
        for v in face {
            areas[v.index()] += area;
            sizes[v.index()] += area.length() / 3.0;
        }
    }
    let mean = 4.0 * PI / positions.len() as f64;
    let rows = positions.iter().zip(&areas).zip(&sizes);
    let numbers = rows.flat_map(|((p, area), size)| {
        let normal = area.normalize_or_zero();
        let log = ln((size / mean).max(LEAST_SHARE));
        [p.x, p.y, p.z, normal.x, normal.y, normal.z, log]
    });
    numbers.map(|number| number as f32).collect()
}
