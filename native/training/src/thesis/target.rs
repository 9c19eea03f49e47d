//! What the thesis reads of a shape, and the target that it is to learn.

use glam::DVec3;
use orbflow_geometry::hierarchy::{CollapseHierarchy, HierarchyError};
use orbflow_geometry::mesh::{Id, PolygonMesh};
use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_geometry::sphere::icosphere;
use orbflow_network::features::N_FEATURES;
use orbflow_network::pyramid::{Level, Prepared};
use thiserror::Error;

use super::chamfer::{self, offsets};

const FREQUENCY: u32 = 7;
/// How many points the sphere has, and how many vertices a shape is read at.
pub const N_POINTS: usize = 10 * (FREQUENCY * FREQUENCY) as usize + 2;
/// How many faces a closed mesh with as many vertices has: levels need so many.
pub const N_FACES: usize = 2 * N_POINTS - 4;

/// The sphere of even points that is to become the shape.
pub fn sphere() -> PolygonMesh {
    icosphere(FREQUENCY)
}

/// Why a shape is nothing for the thesis.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum ThesisError {
    /// It has too few vertices.
    #[error("the level has {found} vertices, but the sphere has {N_POINTS} points")]
    Small {
        /// How many there are.
        found: usize,
    },
    /// Its levels contradict each other.
    #[error(transparent)]
    Hierarchy(#[from] HierarchyError),
    /// Adam ran away: the rate or a weight is too high.
    #[error("the target is not finite; lower chamfer.rate or the weights in the settings")]
    NotFinite,
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// How far each point of the sphere is to move, three numbers a point, and how that was found.
#[derive(Clone, PartialEq, Debug)]
pub struct Target {
    /// The settings that it was made with.
    pub settings: chamfer::Settings,
    /// Three numbers for each of the [`N_POINTS`] points.
    pub offsets: Vec<f32>,
}

/// A shape as the thesis reads it: as many vertices as the sphere has points, centred, scaled into the
/// unit sphere, not turned.
#[derive(Clone, Debug)]
pub struct Reading {
    /// Its graph and features.
    pub level: Level,
    /// Its vertices, coarse to fine.
    pub positions: Vec<DVec3>,
    /// Its triangles.
    pub surface: Vec<[DVec3; 3]>,
}

impl Reading {
    /// Reads the level of a hierarchy that has as many vertices as the sphere has points.
    ///
    /// # Errors
    /// [`ThesisError::Small`], [`ThesisError::Hierarchy`].
    pub fn new(hierarchy: &CollapseHierarchy) -> Result<Self, ThesisError> {
        let found = hierarchy.mesh().n_vertices();
        if found < N_POINTS {
            return Err(ThesisError::Small { found });
        }
        let prepared = Prepared::new(hierarchy, &[N_POINTS])?;
        // The thesis saw shapes as they stand, not in a frame of their own.
        let mut prepared = prepared.turned(prepared.frame);
        let mut level = prepared.pyramid.levels.remove(0);
        let lengths = prepared.positions.iter().map(|p| p.length());
        let radius = lengths.fold(f64::MIN_POSITIVE, f64::max);
        let positions: Vec<DVec3> = prepared.positions.iter().map(|p| *p / radius).collect();
        for (row, p) in level.features.chunks_exact_mut(N_FEATURES).zip(&positions) {
            row[..3].copy_from_slice(&p.as_vec3().to_array());
        }
        let faces = prepared.faces.iter();
        Ok(Self {
            level,
            surface: faces.map(|f| f.map(|v| positions[v.index()])).collect(),
            positions,
        })
    }

    /// Makes its target.
    ///
    /// # Errors
    /// [`ThesisError::NotFinite`], [`ThesisError::Cancelled`].
    pub fn target(
        &self,
        settings: &chamfer::Settings,
        progress: &Progress,
    ) -> Result<Target, ThesisError> {
        let offsets = offsets(&sphere(), &self.surface, settings, progress)?;
        if !offsets.iter().all(|x| x.is_finite()) {
            return Err(ThesisError::NotFinite);
        }
        Ok(Target {
            settings: settings.clone(),
            offsets,
        })
    }
}
