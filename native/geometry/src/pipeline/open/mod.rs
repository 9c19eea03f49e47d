//! Parts with borders and handles: closed before anything else, reopened once quads lie on them.
//!
//! ```text
//! part ─ cut ─▶ genus 0 ─ close ─▶ closed, faces real or virtual ─ flow, borders firm ─▶ quads ─ reopen ─▶ real quads ─ weld twins
//! ```
//!
//! The map is made of the part reduced while it is open, which keeps borders, and closed then.

mod reopen;

use super::even::Marked;
use super::{Error, Settings};
use crate::close::{self, Closed};
use crate::decimate;
use crate::deform::Target;
use crate::measure::{FeatureLine, feature_lines};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// A part that was closed.
pub struct Closing {
    /// The part, open.
    open: TriangleMesh,
    closed: Closed,
    settings: close::Settings,
}

/// A part reduced to the size of the map and closed.
pub struct Small {
    pub mesh: TriangleMesh,
    /// Its edges between real and virtual faces, on both sides of each.
    pub border: HalfedgeMap<bool>,
    pub report: Option<decimate::Report>,
}

impl Closing {
    /// Closes a part; none if it is closed and without handles.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        part: &TriangleMesh,
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<Option<Self>, Error> {
        if part.is_closed() {
            return Ok(None);
        }
        let settings = settings.close();
        let closed = close::close(part, &settings, progress)?;
        Ok(Some(Self {
            open: part.clone(),
            closed,
            settings,
        }))
    }

    /// The part, closed.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.closed.mesh
    }

    /// The part reduced to a number of faces, if it has more, and closed.
    ///
    /// # Errors
    /// As above.
    pub fn reduced(&self, n_faces: usize, progress: &Progress<'_>) -> Result<Small, Error> {
        let share = self.closed.mesh.n_faces() as f64 / self.open.n_faces() as f64;
        let n_faces = (n_faces as f64 / share) as usize;
        if self.open.n_faces() <= n_faces {
            return Ok(Small {
                mesh: self.closed.mesh.clone(),
                border: self.closed.border(),
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&self.open, &settings, progress)?;
        let closed = close::close(&simplified.mesh, &self.settings, progress)?;
        Ok(Small {
            border: closed.border(),
            mesh: closed.mesh,
            report: Some(simplified.report),
        })
    }

    /// The edges of the closed part between real and virtual faces, on both sides of each.
    pub fn border(&self) -> HalfedgeMap<bool> {
        self.closed.border()
    }

    /// What the quads have to keep to, and what of them is kept.
    ///
    /// # Errors
    /// When cancelled.
    pub fn opening(
        self,
        (map, border): (&SphereMap, HalfedgeMap<bool>),
        progress: &Progress<'_>,
    ) -> Result<Opening, Cancelled> {
        let edges = Marked::new(&self.closed.mesh, &self.closed.border());
        let is_real = self.closed.is_real;
        let faces = self.closed.mesh.face_ids();
        let real = faces.filter(|&f| is_real[f]);
        let real = real.map(|f| self.closed.mesh.face(f));
        let real = TriangleMesh::of_faces(self.closed.mesh.positions(), real);
        let (bare, _) = real.expect("the real faces of a closed part are a mesh");
        Ok(Opening {
            lines: feature_lines(map.mesh(), &border),
            small: border,
            edges,
            is_real,
            bare: Target::new(bare, progress)?,
        })
    }
}

/// What of a closed part is real, and where its borders lie.
pub struct Opening {
    /// The borders on the map's mesh, as its edges and as lines.
    pub small: HalfedgeMap<bool>,
    pub lines: Vec<FeatureLine>,
    /// Where they lie on the target.
    pub edges: Marked,
    /// Which faces of the target are real.
    is_real: FaceMap<bool>,
    /// The real part of the target alone.
    pub bare: Target,
}
