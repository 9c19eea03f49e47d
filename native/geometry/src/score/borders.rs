//! Border lines of the input and of the output, compared.

use glam::DVec3;
use serde::Serialize;

use super::near::distances;
use super::statistics::mean;
use super::surface::Surface;
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Between two samples of a border, in diagonals.
const SPACING: f64 = 0.0005;
/// Borders have some so many samples at most, or those of an output in other units would fill the memory.
const MOST_SAMPLES: f64 = 2e5;

/// Distances between border lines; none where one of the two meshes is closed.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct BorderDistance {
    /// ↓ Mean of both mean distances.
    pub border_mean_pct: Option<f64>,
    /// ↓ The largest distance of a sample.
    pub border_hausdorff_pct: Option<f64>,
}

pub fn borders(
    input: &Surface,
    output: &Surface,
    progress: &Progress,
) -> Result<BorderDistance, Cancelled> {
    let spacing = SPACING * input.diagonal();
    let lines = [input, output].map(|surface| samples(surface, spacing));
    if lines.iter().any(Vec::is_empty) {
        return Ok(BorderDistance::default());
    }
    let mut means = [0.0; 2];
    let mut largest: f64 = 0.0;
    for (i, mean_of_way) in means.iter_mut().enumerate() {
        let tree = Bvh::build_of_points(&lines[i], progress)?;
        let far = distances(&tree, &lines[1 - i], progress)?;
        *mean_of_way = mean(&far);
        largest = far.into_iter().fold(largest, f64::max);
    }
    let scale = 100.0 / input.diagonal();
    Ok(BorderDistance {
        border_mean_pct: Some(scale * f64::midpoint(means[0], means[1])),
        border_hausdorff_pct: Some(scale * largest),
    })
}

/// Points along the edges that have one face, both ends of each included.
fn samples(surface: &Surface, spacing: f64) -> Vec<DVec3> {
    let edges = &surface.edges;
    let border = || (0..edges.len()).filter(|&edge| edges.n_sides[edge] == 1);
    let length: f64 = border().map(|edge| surface.edge_lengths[edge]).sum();
    let spacing = spacing.max(length / MOST_SAMPLES);
    let along = |edge: usize| {
        let [a, b] = edges.ends[edge].map(|v| surface.mesh.position(v));
        let n = (surface.edge_lengths[edge] / spacing).ceil() as usize;
        (0..=n).map(move |i| a.lerp(b, i as f64 / n.max(1) as f64))
    };
    border().flat_map(along).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::{cos, sin};
    use crate::mesh::PolygonMesh;
    use crate::shapes;

    fn between(input: &PolygonMesh, output: &PolygonMesh) -> BorderDistance {
        let progress = Progress::none();
        let [a, b] = [input, output].map(|mesh| Surface::new(mesh, &progress).unwrap().unwrap());
        borders(&a, &b, &progress).unwrap()
    }

    #[test]
    fn borders_are_as_far_apart_as_their_circles() {
        let ring = |radius: f64, n: u32| {
            let at = |i: u32, z: f64| {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                DVec3::new(radius * cos(angle), radius * sin(angle), z)
            };
            let positions = (0..n).map(|i| at(i, 0.0)).chain((0..n).map(|i| at(i, 1.0)));
            let quad = |i: u32| [i, (i + 1) % n, (i + 1) % n + n, i + n];
            let faces: Vec<[u32; 4]> = (0..n).map(quad).collect();
            PolygonMesh::from_faces(positions.collect(), &faces).unwrap()
        };
        let found = between(&ring(1.0, 200), &ring(1.1, 90));
        let wanted = 100.0 * 0.1 / 3.0;
        for found in [found.border_mean_pct, found.border_hausdorff_pct] {
            assert!(
                found.is_some_and(|far| (far - wanted).abs() < 0.03 * wanted),
                "{found:?}"
            );
        }
        let closed = between(&ring(1.0, 20), &shapes::polygons(&shapes::sphere(3)));
        assert_eq!(closed, BorderDistance::default());
    }
}
