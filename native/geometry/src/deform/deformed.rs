//! A remeshed surface out of a sheet, or of faces that lie on it already.

use glam::DVec3;

use super::sheet::Sheet;
use super::{Deformed, Error, Report, separate, untangle};
use crate::mesh::{Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::check_cover;

impl Deformed {
    /// Faces that lie on the surface already, with their points on the sphere and the edges that lie
    /// on sharp lines, each once, in order. What is inverted or crosses is counted.
    ///
    /// # Errors
    /// Faces that do not cover the sphere once, and [`Cancelled`].
    pub fn laid(
        mesh: PolygonMesh,
        sphere: Vec<DVec3>,
        on_lines: Vec<[VertexId; 2]>,
        progress: &Progress,
    ) -> Result<Self, Error> {
        check_cover(&mesh, &sphere)?;
        Ok(Self::in_space(mesh, sphere, on_lines, progress)?)
    }

    /// The same of faces that cover no sphere, as those of a surface with handles, with any points.
    ///
    /// # Errors
    /// When cancelled.
    pub fn in_space(
        mesh: PolygonMesh,
        sphere: Vec<DVec3>,
        on_lines: Vec<[VertexId; 2]>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
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

    /// Some of its faces alone, with the vertices that they use; what is inverted or crosses is counted
    /// anew. They no longer cover the sphere.
    ///
    /// # Errors
    /// When cancelled.
    pub fn only(&self, is_wanted: &[bool], progress: &Progress) -> Result<Self, Cancelled> {
        let faces = self.mesh.faces().zip(is_wanted);
        let faces: Vec<&[VertexId]> = faces.filter(|(_, is)| **is).map(|(face, _)| face).collect();
        let mut names = vec![None; self.mesh.n_vertices()];
        let mut left = Vec::new();
        for v in faces.iter().copied().flatten() {
            names[v.index()].get_or_insert_with(|| {
                left.push(*v);
                left.len() as u32 - 1
            });
        }
        let named = |v: VertexId| names[v.index()];
        let faces = faces
            .iter()
            .map(|face| face.iter().filter_map(|&v| named(v)).collect());
        let faces: Vec<Vec<u32>> = faces.collect();
        let edges = |edges: &[[VertexId; 2]]| -> Vec<[VertexId; 2]> {
            let both = |[a, b]: &[VertexId; 2]| Some([VertexId(named(*a)?), VertexId(named(*b)?)]);
            let mut edges: Vec<_> = edges.iter().filter_map(both).collect();
            for ends in &mut edges {
                ends.sort_unstable();
            }
            edges.sort_unstable();
            edges
        };
        let positions = left.iter().map(|&v| self.mesh.position(v)).collect();
        let mesh = PolygonMesh::from_faces(positions, &faces);
        let mesh = mesh.expect("some faces of a mesh are one");
        let n_crossing = separate::n_crossing(&mesh, progress)?;
        let report = Report {
            n_crossing_left: n_crossing,
            n_inverted: untangle::n_inverted(&mesh),
            ..self.report
        };
        Ok(Self {
            sphere: left.iter().map(|v| self.sphere[v.index()]).collect(),
            features: edges(&self.features),
            led: edges(&self.led),
            mesh,
            report,
        })
    }

    /// The same with some vertices joined: another mesh of the same faces, and what became of each
    /// vertex. What is inverted or crosses is counted anew.
    ///
    /// # Errors
    /// When cancelled.
    ///
    /// # Panics
    /// When the mesh does not have these vertices.
    pub fn renamed(
        self,
        mesh: PolygonMesh,
        names: &VertexMap<VertexId>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let mut sphere = vec![DVec3::ZERO; mesh.n_vertices()];
        for (&point, &name) in self.sphere.iter().zip(names).rev() {
            sphere[name.index()] = point;
        }
        let edges = |edges: Vec<[VertexId; 2]>| -> Vec<[VertexId; 2]> {
            let named = edges.into_iter().map(|ends| ends.map(|v| names[v]));
            let mut edges: Vec<_> = named.map(|[a, b]| [a.min(b), a.max(b)]).collect();
            edges.sort_unstable();
            edges.dedup();
            edges
        };
        Ok(Self {
            sphere,
            features: edges(self.features),
            led: edges(self.led),
            report: Report {
                n_crossing_left: separate::n_crossing(&mesh, progress)?,
                n_inverted: untangle::n_inverted(&mesh),
                ..self.report
            },
            mesh,
        })
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
