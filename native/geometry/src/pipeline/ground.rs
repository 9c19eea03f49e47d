//! What faces are made on.

use glam::DVec3;

use super::Error;
use super::clock::Clock;
use super::mirror::Faced;
use super::open::{Closing, Opening, Small};
use super::part::Wanted;
use crate::deform::{self, Deformed, Held, Target};
use crate::measure::{self, FeatureLine};
use crate::mesh::{HalfedgeMap, PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;

/// What faces are made on.
pub struct Ground {
    pub target: Target,
    /// The target's marked edges.
    pub marked: HalfedgeMap<bool>,
    /// The density asked for there.
    pub density: Option<VertexMap<f64>>,
    /// The axis across the plane of symmetry.
    pub axis: Option<usize>,
    /// How many faces are wanted on what is real.
    n_asked: usize,
    /// What is real of the target, where it was closed.
    pub opening: Option<Opening>,
}

impl Ground {
    /// A part at full resolution, with what closed it where it is to be opened again, and how many
    /// faces are wanted: on all of it, and on what is real.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(
        faced: Faced,
        closing: Option<(Closing, Small)>,
        (wanted, n_asked): (&Wanted<'_>, usize),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let Faced { mesh, marked, .. } = faced;
        let border = closing.as_ref().map(|(closing, _)| closing.border());
        let lines = (&marked, border.as_ref());
        let target = clock.step("deform", || wanted.target((mesh, lines), progress))?;
        let counts = [wanted.n_faces, n_asked];
        let opening = closing.map(|(closing, small)| closing.opening(&small, counts, progress));
        Ok(Self {
            target,
            marked,
            density: faced.density,
            axis: faced.axis,
            n_asked,
            opening: opening.transpose()?,
        })
    }

    /// The borders of what is real, on the map's mesh.
    pub fn lines(&self) -> &[FeatureLine] {
        self.opening
            .as_ref()
            .map_or(&[], |opening| &opening.lines[..])
    }

    /// The part as it came, open or not.
    pub fn bare(&self) -> &Target {
        self.opening
            .as_ref()
            .map_or(&self.target, |opening| &opening.bare)
    }

    /// How faces are laid on it that do not flow.
    pub fn deform(&self) -> deform::Settings {
        deform::Settings {
            separates: self
                .opening
                .as_ref()
                .is_none_or(|opening| !opening.overlaps()),
            ..deform::Settings::default()
        }
    }

    /// Faces that lie on it, those on what is real alone; or why these are not the part. The edges along
    /// its borders are given, and the map whose sphere they cover.
    pub fn opened(
        &self,
        map: &SphereMap,
        deformed: Deformed,
        border: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        let Some(opening) = &self.opening else {
            return Ok(Ok(deformed));
        };
        let faces = (&deformed.mesh, &deformed.sphere[..]);
        let is_real = opening.real(map, faces, border, progress)?;
        opening.kept(&deformed, &is_real, progress)
    }

    /// What of a primitive was made along its borders, held there.
    pub fn held(
        &self,
        map: &SphereMap,
        made: &Adaptive,
        progress: &Progress<'_>,
    ) -> Result<Held, Error> {
        match &self.opening {
            Some(opening) => opening.held_all(map, made, progress),
            None => Ok(Held::default()),
        }
    }

    /// How many faces are wanted on what is real, of so many on all.
    pub fn n_asked(&self, wanted: &Wanted<'_>) -> usize {
        match self.opening {
            Some(_) => self.n_asked,
            None => wanted.n_faces,
        }
    }

    /// The share of a surface's faces that lie on what is real, between the edges along borders.
    pub fn real_share(
        &self,
        map: &SphereMap,
        faces: (&PolygonMesh, &[DVec3]),
        border: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<f64, Cancelled> {
        let Some(opening) = &self.opening else {
            return Ok(1.0);
        };
        let is_real = opening.real(map, faces, border, progress)?;
        let n_real = is_real.iter().filter(|is_real| **is_real).count();
        Ok(n_real as f64 / is_real.len().max(1) as f64)
    }
}

impl Wanted<'_> {
    /// The part with the edges that the result is to have too.
    fn target(
        &self,
        (part, (marked, border)): (
            TriangleMesh,
            (&HalfedgeMap<bool>, Option<&HalfedgeMap<bool>>),
        ),
        progress: &Progress<'_>,
    ) -> Result<Target, Cancelled> {
        progress.check()?;
        let sharp = measure::sharp_edges(&part, self.settings.sharp_angle.to_radians());
        // Borders are held from the beginning.
        let is_border = |h| border.is_some_and(|border| border[h]);
        let halfedges = part.halfedge_ids();
        let either = halfedges.map(|h| (sharp[h] || marked[h]) && !is_border(h));
        let either = either.collect();
        Target::with_features(part, &either, progress)
    }
}

#[cfg(test)]
impl Ground {
    /// A closed part of which nothing is marked.
    pub fn closed(target: Target) -> Self {
        Self {
            marked: HalfedgeMap::filled(3 * target.mesh().n_faces(), false),
            target,
            density: None,
            axis: None,
            n_asked: 0,
            opening: None,
        }
    }
}
