//! Coordinates in which the surface has a known size, whatever the input's units are.

use glam::DVec3;

use crate::mesh::{TriangleMesh, VertexMap, bounds};

/// The way from the mesh's coordinates to those around the origin in which its area is 4π (or its
/// size 1 when it has no area), and back.
pub(super) struct Frame {
    /// Applied first, so that neither huge nor tiny coordinates leave the range of numbers.
    size: f64,
    middle: DVec3,
    by: f64,
}

impl Frame {
    pub fn of_mesh(mesh: &TriangleMesh) -> Self {
        let largest = |m: f64, p: &DVec3| m.max(p.abs().max_element());
        let size = mesh
            .positions()
            .iter()
            .fold(0.0, largest)
            .max(f64::MIN_POSITIVE);
        let [low, high] = bounds(mesh.positions()).map(|p| p / size);
        let middle = low.midpoint(high);
        let extent = (high - low).max_element();
        let unit = Self {
            size,
            middle,
            by: if extent > 0.0 { extent.recip() } else { 1.0 },
        };
        let doubled = |face| {
            let [a, b, c] = mesh.triangle(face).map(|p| unit.enter(p));
            (b - a).cross(c - a).length()
        };
        let area: f64 = 0.5 * mesh.face_ids().map(doubled).sum::<f64>();
        // What is nearly a line would be blown up without end.
        let by = unit.by * (4.0 * std::f64::consts::PI / area.max(1e-12)).sqrt();
        Self { by, ..unit }
    }

    fn enter(&self, p: DVec3) -> DVec3 {
        (p / self.size - self.middle) * self.by
    }

    pub fn points(&self, mesh: &TriangleMesh) -> VertexMap<DVec3> {
        mesh.positions().iter().map(|&p| self.enter(p)).collect()
    }

    /// The point in the mesh's coordinates.
    pub fn leave(&self, p: DVec3) -> DVec3 {
        let point = (p / self.by + self.middle) * self.size;
        point.clamp(DVec3::splat(f64::MIN), DVec3::splat(f64::MAX))
    }
}
