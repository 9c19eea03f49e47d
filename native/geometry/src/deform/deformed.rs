//! A remeshed surface out of a sheet, or of faces that lie on it already.

use glam::DVec3;

use super::sheet::Sheet;
use super::{Deformed, Error, Report, separate, untangle};
use crate::mesh::{PolygonMesh, VertexId};
use crate::progress::Progress;
use crate::sphere_map::check_cover;

impl Deformed {
    /// Faces that lie on the surface already, with their points on the sphere and the edges that lie
    /// on sharp lines, each once, in order. What is inverted or crosses is counted.
    ///
    /// # Errors
    /// Faces that do not cover the sphere once, and [`Cancelled`](crate::progress::Cancelled).
    pub fn laid(
        mesh: PolygonMesh,
        sphere: Vec<DVec3>,
        on_lines: Vec<[VertexId; 2]>,
        progress: &Progress,
    ) -> Result<Self, Error> {
        check_cover(&mesh, &sphere)?;
        let n_crossing = separate::n_crossing(&mesh, progress)?;
        let report = Report {
            n_feature_goals: on_lines.len(),
            n_feature_vertices: on_lines.len(),
            n_crossing,
            n_crossing_left: n_crossing,
            n_inverted: untangle::n_inverted(&mesh),
            ..Report::default()
        };
        Ok(Self {
            features: on_lines.clone(),
            led: on_lines,
            mesh,
            sphere,
            report,
        })
    }

    /// The same with its vertices elsewhere in space; what is inverted is counted anew.
    ///
    /// # Panics
    /// When the number of positions differs.
    #[must_use]
    pub fn moved(mut self, positions: Vec<DVec3>) -> Self {
        self.mesh = self.mesh.with_positions(positions);
        self.report.n_inverted = untangle::n_inverted(&self.mesh);
        self
    }

    /// What a sheet has become.
    pub(super) fn new(sheet: Sheet, mut report: Report) -> Self {
        let [features, led] = [sheet.features(), sheet.led()];
        let (mesh, sphere) = sheet.into_mesh();
        debug_assert_eq!(check_cover(&mesh, &sphere), Ok(()));
        report.n_inverted = untangle::n_inverted(&mesh);
        Self {
            mesh,
            sphere,
            features,
            led,
            report,
        }
    }
}
