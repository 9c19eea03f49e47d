//! What there is to see of a shape: what came in, what was proposed, what is finished.

use glam::DVec3;
use orbflow_geometry::mesh::PolygonMesh;

use super::outcome::{OutcomeError, Subject, finest};
use super::rebuilt::{ball, carried};
use crate::sample::Sample;
use crate::set::{Shape, Which};

/// A mesh and what it is.
pub type Exhibit = (&'static str, PolygonMesh);

impl Subject {
    /// The level that the network reads, the sphere of even points as its proposal carries it to the
    /// level, and the mesh that is finished. Level and rebuilt shape have their spheres beside them,
    /// vertex by vertex the same mesh. All stand as the shape itself does.
    ///
    /// # Errors
    /// [`OutcomeError`].
    pub fn exhibits(&self, which: Which<'_>, shape: &Shape) -> Result<[Exhibit; 5], OutcomeError> {
        let sample = Sample::of(which.name(), &shape.level, &self.levels)?;
        let directions = self.network.forward(&sample.prepared.pyramid);
        let sphere: Vec<DVec3> = directions.iter().map(|d| d.normalize_or_zero()).collect();
        let level = PolygonMesh::from(&sample.mesh);
        let turned = |mesh: &PolygonMesh| {
            let points = mesh.positions().iter();
            mesh.with_positions(points.map(|&p| sample.prepared.frame * p).collect())
        };
        Ok([
            ("level", turned(&level)),
            (
                "level_sphere",
                turned(&level.with_positions(sphere.clone())),
            ),
            ("rebuilt", turned(&carried(&sample.mesh, &sphere))),
            ("rebuilt_sphere", turned(&ball())),
            ("whole", finest(&shape.whole)?),
        ])
    }
}
