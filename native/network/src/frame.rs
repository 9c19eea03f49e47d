//! The frame that the network sees a mesh in: it turns, moves and grows with the mesh.
//!
//! The axes are the principal axes of the surface, longest first, each pointing to the side of the
//! larger third moment; the third follows from the first two, so that a mesh is never mirrored. A
//! shape without such a side has no unique frame; the network is trained on all four choices.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use orbflow_geometry::elementary::{atan2, sin_cos};
use orbflow_geometry::measure::area_vector;
use orbflow_geometry::mesh::{Id, VertexId};

/// The rotation from the principal frame to the mesh's own, and the positions in that frame,
/// centred and scaled to the area 4π.
pub fn principal_frame(positions: &[DVec3], faces: &[[VertexId; 3]]) -> (DMat3, Vec<DVec3>) {
    let size = positions.iter().map(|p| p.abs().max_element());
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let points: Vec<DVec3> = positions.iter().map(|&p| p / size).collect();
    // Corners of weight one and the middle of weight nine: exact for the second moments of a
    // triangle and close for the third.
    let mut samples = Vec::with_capacity(4 * faces.len());
    for face in faces {
        let corners = face.map(|v| points[v.index()]);
        let area = area_vector(corners).length();
        samples.extend(corners.map(|p| (p, area / 12.0)));
        samples.push(((corners[0] + corners[1] + corners[2]) / 3.0, area * 0.75));
    }
    let area: f64 = samples
        .iter()
        .map(|s| s.1)
        .sum::<f64>()
        .max(f64::MIN_POSITIVE);
    let centre = samples.iter().map(|&(p, w)| p * w).sum::<DVec3>() / area;
    let covariance = samples.iter().fold(DMat3::ZERO, |sum, &(p, w)| {
        let d = p - centre;
        sum + DMat3::from_cols(d * d.x, d * d.y, d * d.z) * w
    });
    let axes = eigenvectors(covariance);
    let side = |axis: DVec3| {
        let third: f64 = samples
            .iter()
            .map(|&(p, w)| w * axis.dot(p - centre).powi(3))
            .sum();
        if third < 0.0 { -axis } else { axis }
    };
    let [x, y] = [side(axes[0]), side(axes[1])];
    let frame = DMat3::from_cols(x, y, x.cross(y));
    let scale = (4.0 * PI / area).sqrt();
    let own = points
        .iter()
        .map(|&p| frame.transpose() * (p - centre) * scale);
    (frame, own.collect())
}

/// The two rotations by which two frames of a shape may differ when its sides look alike, and
/// their product, and none: the half turns about the axes.
pub fn half_turns() -> [DMat3; 4] {
    let diagonal = |x, y, z| DMat3::from_diagonal(DVec3::new(x, y, z));
    [
        DMat3::IDENTITY,
        diagonal(1.0, -1.0, -1.0),
        diagonal(-1.0, 1.0, -1.0),
        diagonal(-1.0, -1.0, 1.0),
    ]
}

/// The eigenvectors of a symmetric matrix, largest eigenvalue first, by Jacobi rotations.
pub fn eigenvectors(matrix: DMat3) -> [DVec3; 3] {
    let (mut a, mut vectors) = (matrix, DMat3::IDENTITY);
    // Converges quadratically; five or six rounds reach the last bit.
    for _ in 0..12 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let off = a.col(j)[i];
            if off.abs() <= f64::MIN_POSITIVE {
                continue;
            }
            let angle = 0.5 * atan2(2.0 * off, a.col(j)[j] - a.col(i)[i]);
            let (s, c) = sin_cos(angle);
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(i)[i] = c;
            turn.col_mut(j)[j] = c;
            turn.col_mut(i)[j] = -s;
            turn.col_mut(j)[i] = s;
            a = turn.transpose() * a * turn;
            vectors *= turn;
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a.col(j)[j].total_cmp(&a.col(i)[i]));
    order.map(|i| vectors.col(i).normalize_or(DVec3::X))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_turned_diagonal_are_found() {
        let turn = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_x(0.4);
        let matrix = turn * DMat3::from_diagonal(DVec3::new(1.0, 3.0, 2.0)) * turn.transpose();
        let axes = eigenvectors(matrix);
        for (axis, i) in axes.iter().zip([1, 2, 0]) {
            assert!(
                (axis.dot(turn.col(i)).abs() - 1.0).abs() < 1e-12,
                "{axes:?}"
            );
        }
    }

    #[test]
    fn the_frame_turns_with_the_mesh() {
        let faces = [[0, 2, 1], [0, 1, 3], [2, 0, 3], [1, 2, 3]].map(|f| f.map(VertexId));
        let points = [
            [0.0, 0.0, 0.0],
            [3.0, 0.2, 0.0],
            [0.3, 2.0, 0.1],
            [0.2, 0.1, 1.0],
        ];
        let points = points.map(DVec3::from_array);
        let (_, own) = principal_frame(&points, &faces);
        let turn = DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(2.0);
        let turned = points.map(|p| turn * p * 7.0 + DVec3::ONE);
        let (frame, same) = principal_frame(&turned, &faces);
        assert!((frame.determinant() - 1.0).abs() < 1e-12);
        for (p, q) in own.iter().zip(&same) {
            assert!(p.distance(*q) < 1e-9, "{p} {q}");
        }
    }
}
