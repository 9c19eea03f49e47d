//! The shape of single faces: edge lengths, corners, warp.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use serde::Serialize;

use super::statistics::{mean, quantile};
use super::surface::Surface;
use crate::measure::{angle_between, corner_angle};
use crate::progress::{Cancelled, Progress};

/// How even the edges and how square the faces are; angles are in degrees.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Shape {
    /// Mean edge length, in the mesh's units.
    pub edge_mean: f64,
    /// ↓ Standard deviation / mean of edge lengths.
    pub edge_cv: f64,
    /// ↓ Quads with a scaled Jacobian of 0 or less.
    pub inverted: Option<usize>,
    /// ↑ The least scaled Jacobian of a quad's corners: 1 in a rectangle, below 0 in a fold.
    pub jacobian_min: Option<f64>,
    /// ↑ The 1 % quantile over quads.
    pub jacobian_p01: Option<f64>,
    /// ↑ The mean over quads.
    pub jacobian_mean: Option<f64>,
    /// ↓ Mean deviation of quad corners from a right angle.
    pub corner_deviation: Option<f64>,
    /// ↓ Mean angle between the two triangles of a quad.
    pub warp_mean: Option<f64>,
    /// ↓ The 99 % quantile of that angle.
    pub warp_p99: Option<f64>,
    /// ↑ Mean of the smallest angles of triangle faces.
    pub triangle_angle_mean_min: Option<f64>,
    /// ↑ The 1 % quantile of the smallest angles of triangle faces.
    pub triangle_angle_p01: Option<f64>,
}

pub fn shape(surface: &Surface, progress: &Progress) -> Result<Shape, Cancelled> {
    let mean_length = mean(&surface.edge_lengths);
    let squares: Vec<f64> = surface
        .edge_lengths
        .iter()
        .map(|length| (length - mean_length).powi(2))
        .collect();
    let quads = polygons::<4>(surface);
    progress.check()?;
    let triangles = polygons::<3>(surface);
    progress.check()?;
    let jacobians: Vec<f64> = quads.iter().map(jacobian).collect();
    progress.check()?;
    let warps: Vec<f64> = quads.iter().map(warp).collect();
    progress.check()?;
    let deviations: Vec<f64> = quads.iter().flat_map(corner_deviations).collect();
    progress.check()?;
    let mut smallest = Vec::with_capacity(triangles.len());
    for triangle in &triangles {
        progress.check()?;
        smallest.push(smallest_angle(triangle));
    }
    Ok(Shape {
        edge_mean: mean_length,
        edge_cv: mean(&squares).sqrt() / mean_length.max(1e-300),
        inverted: any(&jacobians).map(|all| all.iter().filter(|&&j| j <= 0.0).count()),
        jacobian_min: jacobians.iter().copied().min_by(f64::total_cmp),
        jacobian_p01: any(&jacobians).map(|all| quantile(all.to_vec(), 0.01)),
        jacobian_mean: any(&jacobians).map(mean),
        corner_deviation: any(&deviations).map(mean),
        warp_mean: any(&warps).map(mean),
        warp_p99: any(&warps).map(|all| quantile(all.to_vec(), 0.99)),
        triangle_angle_mean_min: any(&smallest).map(mean),
        triangle_angle_p01: any(&smallest).map(|all| quantile(all.to_vec(), 0.01)),
    })
}

fn any(values: &[f64]) -> Option<&[f64]> {
    Some(values).filter(|values| !values.is_empty())
}

/// The positions of the corners of all faces with N corners.
fn polygons<const N: usize>(surface: &Surface) -> Vec<[DVec3; N]> {
    let faces = surface
        .mesh
        .faces()
        .filter_map(|face| <[_; N]>::try_from(face).ok());
    faces
        .map(|face| face.map(|v| surface.mesh.position(v)))
        .collect()
}

/// At each corner the directions to the next and to the previous one.
fn arms(p: &[DVec3; 4]) -> [[DVec3; 2]; 4] {
    [0, 1, 2, 3].map(|i| [p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i]])
}

fn jacobian(p: &[DVec3; 4]) -> f64 {
    let normal = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
    let at_corner = arms(p).map(|[ahead, behind]| {
        ahead
            .normalize_or_zero()
            .cross(behind.normalize_or_zero())
            .dot(normal)
    });
    at_corner.into_iter().fold(f64::INFINITY, f64::min)
}

fn corner_deviations(p: &[DVec3; 4]) -> [f64; 4] {
    arms(p).map(|[ahead, behind]| {
        (angle_between(ahead, behind) - FRAC_PI_2)
            .abs()
            .to_degrees()
    })
}

fn warp(&[a, b, c, d]: &[DVec3; 4]) -> f64 {
    let [first, second] = if a.distance(c) <= b.distance(d) {
        [(b - a).cross(c - a), (c - a).cross(d - a)]
    } else {
        [(b - a).cross(d - a), (c - b).cross(d - b)]
    };
    angle_between(first.normalize_or_zero(), second.normalize_or_zero()).to_degrees()
}

fn smallest_angle(p: &[DVec3; 3]) -> f64 {
    let angles = [0, 1, 2].map(|i| corner_angle(*p, i));
    angles
        .into_iter()
        .fold(f64::INFINITY, f64::min)
        .to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PolygonMesh;

    fn of_quad(corners: [[f64; 3]; 4]) -> Shape {
        let mesh =
            PolygonMesh::from_faces(corners.map(DVec3::from).to_vec(), &[[0, 1, 2, 3]]).unwrap();
        let progress = Progress::none();
        let surface = Surface::new(&mesh, &progress).unwrap().unwrap();
        shape(&surface, &progress).unwrap()
    }

    fn bent() -> Shape {
        of_quad([
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 1e-6],
        ])
    }

    fn is_near(value: Option<f64>, wanted: f64) -> bool {
        value.is_some_and(|value| (value - wanted).abs() < 1e-9)
    }

    #[test]
    fn a_square_is_perfect_and_a_sheared_quad_is_not() {
        let square = of_quad([
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ]);
        assert!(is_near(square.jacobian_min, 1.0) && is_near(square.corner_deviation, 0.0));
        assert!(is_near(square.warp_mean, 0.0) && square.edge_cv < 1e-12);
        assert_eq!(square.triangle_angle_mean_min, None);
        let sheared = of_quad([
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
        ]);
        assert!(is_near(sheared.jacobian_mean, 0.5f64.sqrt()));
        assert!(is_near(sheared.corner_deviation, 45.0));
    }

    #[test]
    fn a_fold_has_a_negative_jacobian_and_a_bend_has_warp() {
        let folded = of_quad([
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.9, 0.1, 0.0],
        ]);
        assert!(folded.jacobian_min.is_some_and(|j| j < 0.0));
        assert_eq!((folded.inverted, bent().inverted), (Some(1), Some(0)));
        assert!(
            bent()
                .warp_mean
                .is_some_and(|w| (w / (2f64.sqrt() * 1e-6f64.to_degrees()) - 1.0).abs() < 1e-6)
        );
    }
}
