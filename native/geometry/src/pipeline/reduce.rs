//! Brings a part to the size of the map.

use std::borrow::Cow;

use super::Error;
use super::mirror::{self, Faced};
use super::open::{Closing, Small};
use super::part::Wanted;
use super::report::Reduced;
use super::settings::Kind;
use crate::decimate;
use crate::mesh::{PolygonMesh, TriangleMesh, VertexId};
use crate::progress::Progress;

/// The map's mesh has this many vertices for each vertex of the result: below 2 the map misses
/// detail that the faces could show, above 4 only time grows.
const MAP_VERTICES_PER_VERTEX: f64 = 2.0;
/// Fewer vertices than this are not worth saving.
const LEAST_MAP_VERTICES: usize = 3_000;

/// A part at the size of the map.
pub struct Reduction {
    pub mesh: TriangleMesh,
    /// The same with its borders, where it was closed.
    pub small: Option<Small>,
    /// What became of the mesh that somebody else reduced.
    pub reduced: Option<Reduced>,
    pub report: Option<decimate::Report>,
}

impl Wanted<'_> {
    /// Brings a part down to the size of the map; one that is to be opened again is closed there.
    pub fn reduce(
        &self,
        (faced, closing): (&Faced, Option<&Closing>),
        progress: &Progress<'_>,
    ) -> Result<Reduction, Error> {
        match closing {
            Some(closing) => self.reduce_open(closing, progress),
            None => self.reduce_closed((&faced.mesh, faced.axis), progress),
        }
    }

    /// Brings a part without borders down.
    fn reduce_closed(
        &self,
        (part, axis): (&TriangleMesh, Option<usize>),
        progress: &Progress<'_>,
    ) -> Result<Reduction, Error> {
        let full = Cow::Borrowed(part);
        let (start, reduced) = match self.reduced.map(|mesh| usable(mesh, (&full, axis))) {
            Some(Ok(mesh)) => {
                let n_faces = mesh.n_faces();
                (Cow::Owned(mesh), Some(Reduced::Used { n_faces }))
            }
            Some(Err(reason)) => (full, Some(Reduced::Refused { reason })),
            None => (full, None),
        };
        let n_faces = self.n_map_faces();
        if start.n_faces() <= n_faces {
            return Ok(Reduction {
                mesh: start.into_owned(),
                small: None,
                reduced,
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&start, &settings, progress)?;
        Ok(Reduction {
            mesh: simplified.mesh,
            small: None,
            reduced,
            report: Some(simplified.report),
        })
    }

    fn n_map_faces(&self) -> usize {
        let per_face = match self.settings.kind {
            Kind::Triangles => 0.5,
            Kind::Quads => 1.0,
        };
        let wanted = self.n_faces as f64 * per_face * MAP_VERTICES_PER_VERTEX;
        2 * (wanted as usize).max(LEAST_MAP_VERTICES)
    }

    /// Brings a part with borders down, and closes it.
    fn reduce_open(&self, closing: &Closing, progress: &Progress<'_>) -> Result<Reduction, Error> {
        let small = closing.reduced(self.n_map_faces(), progress)?;
        let reason = "the part is open, and has to be closed first".to_owned();
        Ok(Reduction {
            mesh: small.mesh.clone(),
            reduced: self.reduced.map(|_| Reduced::Refused { reason }),
            report: small.report.clone(),
            small: Some(small),
        })
    }
}

/// The triangles of a mesh that was reduced outside, or why they cannot stand for the part.
fn usable(
    reduced: &PolygonMesh,
    (full, axis): (&TriangleMesh, Option<usize>),
) -> Result<TriangleMesh, String> {
    let faces: Option<Vec<[VertexId; 3]>> =
        reduced.faces().map(|face| face.try_into().ok()).collect();
    let faces = faces.ok_or("it has faces that are not triangles")?;
    let mesh = TriangleMesh::new(reduced.positions().to_vec(), faces).map_err(|e| e.to_string())?;
    if !mesh.is_closed() {
        return Err("it is not closed".to_owned());
    }
    let n_parts = mesh.face_components().1;
    if n_parts != 1 {
        return Err(format!("it has {n_parts} parts"));
    }
    let [found, wanted] = [mesh.euler_number(), full.euler_number()];
    if found != wanted {
        return Err(format!("its Euler number is {found}, not {wanted}"));
    }
    match axis {
        Some(axis) => mirror::doubled(&mesh, axis),
        None => Ok(mesh),
    }
}
