//! Areas that neither overflow nor vanish, whatever the size of the coordinates.

use crate::elementary::log2;
use glam::DVec3;

/// A triangle whose height is below this share of its longest side is a line or a point.
/// Rounding makes collinear points look like 1e-16; ten times coarser data starts at 1e-13.
const FLAT: f64 = 1e-14;

/// A power of two that brings coordinates to about 1, so that scaling is exact.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    /// Two factors, because the inverse of a tiny number may not be a number.
    factors: [f64; 2],
}

impl Scale {
    /// The scale that brings the largest coordinate to about 1.
    pub(super) fn of(positions: &[DVec3]) -> Self {
        let largest = positions
            .iter()
            .fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        let exponent = if largest > 0.0 {
            log2(largest).floor() as i32
        } else {
            0
        };
        let half = exponent / 2;
        Self {
            factors: [half, exponent - half].map(|e| 2f64.powi(-e)),
        }
    }

    /// A point in the scale where products of coordinates are safe.
    pub(super) fn point(self, position: DVec3) -> DVec3 {
        position * self.factors[0] * self.factors[1]
    }

    /// A length in this scale.
    pub(super) fn factor(self, length: f64) -> f64 {
        length * self.factors[0] * self.factors[1]
    }

    /// A length back from this scale.
    pub(super) fn length(self, factor: f64) -> f64 {
        factor / self.factors[0] / self.factors[1]
    }

    /// Whether three points are on a line, as far as rounding lets one see.
    pub(super) fn is_flat(self, corners: [DVec3; 3]) -> bool {
        let [a, b, c] = corners.map(|p| self.point(p));
        let longest = (b - a).length_squared().max((c - b).length_squared());
        let longest = longest.max((a - c).length_squared());
        (b - a).cross(c - a).length() <= FLAT * longest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flatness_does_not_depend_on_size() {
        for size in [
            1e-300,
            5e-324 * 64.0,
            1e-30,
            1.0,
            1e30,
            1e300,
            f64::MAX / 2.0,
        ] {
            let triangle = [DVec3::ZERO, DVec3::X * size, DVec3::Y * size];
            let line = [DVec3::ZERO, DVec3::X * size, DVec3::X * (size / 2.0)];
            let scale = Scale::of(&triangle);
            assert!(!scale.is_flat(triangle) && scale.is_flat(line), "{size}");
        }
        assert!(Scale::of(&[DVec3::ZERO]).is_flat([DVec3::ZERO; 3]));
    }

    #[test]
    fn rounded_points_on_a_line_are_flat() {
        let at = |t: f64| DVec3::new(1.0 / 3.0, 0.1, -0.7) * t + DVec3::new(0.2, 0.3, 0.4);
        let line = [at(0.0), at(0.3), at(1.0)];
        assert!(Scale::of(&line).is_flat(line));
    }
}
