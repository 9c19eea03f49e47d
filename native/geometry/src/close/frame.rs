//! A scale in which products of lengths are safe.

use glam::DVec3;

use crate::mesh::bounds;

/// The box round some points, which goes to the cube from −1 to 1 without being stretched.
pub struct Frame {
    low: DVec3,
    high: DVec3,
    centre: DVec3,
    half: f64,
}

impl Frame {
    pub fn of(points: &[DVec3]) -> Self {
        let [low, high] = bounds(points);
        // Halves first: the difference of two finite numbers need not be finite.
        let half = (high / 2.0 - low / 2.0).max_element();
        Self {
            low,
            high,
            centre: high / 2.0 + low / 2.0,
            half: if half > 0.0 { half } else { 1.0 },
        }
    }

    pub fn inside(&self, point: DVec3) -> DVec3 {
        (point - self.centre) / self.half
    }

    /// Back to where points lie; never outside of the box, so that it is finite.
    pub fn outside(&self, point: DVec3) -> DVec3 {
        let scaled = (point * self.half + self.centre).clamp(self.low, self.high);
        DVec3::select(scaled.is_nan_mask(), self.centre, scaled)
    }
}
