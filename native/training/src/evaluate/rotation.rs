//! The rotation that brings points nearest to others: what two maps may differ by and be equal.

use glam::{DMat3, DVec3};
use orbflow_geometry::measure::angle_between;
use orbflow_network::frame::eigenvectors;

/// The rotation that brings `from` nearest to `to` in the mean square (kabsch1976rotation).
pub fn best_rotation(from: &[DVec3], to: &[DVec3]) -> DMat3 {
    let covariance = from.iter().zip(to).fold(DMat3::ZERO, |sum, (&p, &q)| {
        sum + DMat3::from_cols(q * p.x, q * p.y, q * p.z)
    });
    let [a, b, _] = eigenvectors(covariance.transpose() * covariance);
    // Two axes and where they go; the third follows, so that nothing is mirrored.
    let x = (covariance * a).normalize_or(a);
    let image = covariance * b;
    let y = (image - x * image.dot(x)).normalize_or(x.any_orthonormal_vector());
    let [before, after] = [[a, b], [x, y]].map(|[x, y]| DMat3::from_cols(x, y, x.cross(y)));
    after * before.transpose()
}

/// The angles between two maps of the same vertices after the best rotation, in degrees, sorted.
pub fn angles_between(from: &[DVec3], to: &[DVec3]) -> Vec<f64> {
    let rotation = best_rotation(from, to);
    let pairs = from.iter().zip(to);
    let mut angles: Vec<f64> = pairs
        .map(|(&p, &q)| angle_between(rotation * p, q).to_degrees())
        .collect();
    angles.sort_by(f64::total_cmp);
    angles
}

#[cfg(test)]
mod tests {
    use super::*;
    use orbflow_geometry::sphere::icosphere;

    #[test]
    fn a_rotation_is_found_and_undone() {
        let points = icosphere(3).positions().to_vec();
        for (axis, angle) in [(DVec3::X, 0.3), (DVec3::Y, 3.1), (DVec3::Z, -2.0)] {
            let turn = DMat3::from_axis_angle(axis, angle) * DMat3::from_rotation_x(0.7);
            // Squeezed, so that the best rotation is not the only candidate among equals.
            let from: Vec<DVec3> = points
                .iter()
                .map(|p| (*p * DVec3::new(1.0, 0.6, 0.3)).normalize_or_zero())
                .collect();
            let to: Vec<DVec3> = from.iter().map(|&p| turn * p).collect();
            let found = best_rotation(&from, &to);
            assert!((found - turn).abs_diff_eq(DMat3::ZERO, 1e-9), "{found}");
            let worst = angles_between(&from, &to).pop().expect("there are points");
            assert!(worst < 1e-5, "{worst}");
        }
    }

    #[test]
    fn mirrored_points_are_not_turned_into_each_other() {
        let points = icosphere(3).positions().to_vec();
        let mirrored: Vec<DVec3> = points.iter().map(|p| -*p).collect();
        let rotation = best_rotation(&points, &mirrored);
        assert!((rotation.determinant() - 1.0).abs() < 1e-9);
        let angles = angles_between(&points, &mirrored);
        assert!(angles[angles.len() / 2] > 30.0);
    }
}
