//! Why a run ends without a mesh.

use glam::DVec3;
use thiserror::Error;

use super::kept::{Kept, refusal};
use super::report::Report;
use super::settings::{Kind, MAX_FACES, MIN_FACES, Primitive};
use super::solid::SOLID_DETAILS;
use super::warning::{Warning, grave};
use crate::close::handles;
use crate::mesh::VertexId;
use crate::progress::Cancelled;
use crate::{clean, close, decimate, deform, embed, flow, pair, solid, sphere};

/// Why a run ends without a mesh; nothing was changed.
#[derive(Debug, Error)]
pub enum Error {
    /// The count is out of range.
    #[error("{faces} faces were asked for; {MIN_FACES} to {MAX_FACES} can be made")]
    FacesOutOfRange {
        /// What was asked for.
        faces: usize,
    },
    /// A setting of the style is out of range.
    #[error("{name} is {value}; it goes from 0 to 1")]
    StyleOutOfRange {
        /// Which.
        name: &'static str,
        /// What was asked for.
        value: f64,
    },
    /// The sharp angle is out of range.
    #[error("the sharp angle is {degrees} degrees; it goes from 0 to 180")]
    AngleOutOfRange {
        /// What was asked for.
        degrees: f64,
    },
    /// A marked or carried edge names a vertex that does not exist.
    #[error("{kind} edge {edge} names vertex {vertex}, but there are {n_vertices} vertices")]
    EdgeOutOfRange {
        /// Which kind of edge.
        kind: &'static str,
        /// Which edge.
        edge: usize,
        /// What it names.
        vertex: VertexId,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// A stroke has too few points.
    #[error("guide {guide} has {n_points} points; it needs {n_least} at least")]
    GuideTooShort {
        /// Which stroke.
        guide: usize,
        /// How many points it has.
        n_points: usize,
        /// How many it needs.
        n_least: usize,
    },
    /// A point of a stroke is no place.
    #[error("point {point} of guide {guide} is ({}, {}, {}), which is not finite", at.x, at.y, at.z)]
    GuideNotFinite {
        /// Which stroke.
        guide: usize,
        /// Which of its points.
        point: usize,
        /// Where it is.
        at: DVec3,
    },
    /// All points of a stroke are in one place.
    #[error("the {n_points} points of guide {guide} are all in one place")]
    GuideWithoutLength {
        /// Which stroke.
        guide: usize,
        /// How many points it has.
        n_points: usize,
    },
    /// Only quads that flow follow strokes.
    #[error("guides are for quads that flow, but the {} primitive was asked for", primitive.name())]
    GuidesNeedFlow {
        /// What was asked for.
        primitive: Primitive,
    },
    /// Not one density per vertex.
    #[error("{n_values} densities for {n_vertices} vertices")]
    DensityCount {
        /// How many densities.
        n_values: usize,
        /// How many vertices.
        n_vertices: usize,
    },
    /// A density is out of range.
    #[error("vertex {vertex} has the density {value}; it goes from 0 to 1")]
    DensityOutOfRange {
        /// The first such vertex.
        vertex: VertexId,
        /// What was asked for there.
        value: f64,
    },
    /// The primitive has other polygons than were asked for.
    #[error("the {} primitive makes {}, but {} were asked for", primitive.name(), primitive.kind().name(), kind.name())]
    KindMismatch {
        /// The primitive.
        primitive: Primitive,
        /// What was asked for.
        kind: Kind,
    },
    /// Not one material per face.
    #[error("{n_materials} material indices for {n_faces} faces")]
    MaterialCount {
        /// How many indices.
        n_materials: usize,
        /// How many faces.
        n_faces: usize,
    },
    /// Not said of every face whether it is kept.
    #[error("{n_flags} flags of faces to keep for {n_faces} faces")]
    KeepCount {
        /// How many flags.
        n_flags: usize,
        /// How many faces.
        n_faces: usize,
    },
    /// Nothing is left to remesh.
    #[error("all {n_faces} faces are kept: nothing is left to remesh")]
    AllKept {
        /// How many faces there are.
        n_faces: usize,
    },
    /// What is kept leaves no faces for the rest.
    #[error(
        "{n_kept} faces are kept, but {n_faces} were asked for in all: at least {} are needed",
        n_kept + MIN_FACES
    )]
    KeptTooMany {
        /// How many are kept.
        n_kept: usize,
        /// How many were asked for.
        n_faces: usize,
    },
    /// A solid has no faces of the input.
    #[error("{n_kept} faces are to be kept, but a solid is made anew all over")]
    KeptInSolid {
        /// How many are to be kept.
        n_kept: usize,
    },
    /// A part was closed and could not be opened again.
    #[error("the part could not be opened again: {reason}")]
    Unopened {
        /// Why not.
        reason: String,
    },
    /// The detail of a solid is out of range.
    #[error("the solid detail is {pct} %; it goes from {} to {}", SOLID_DETAILS[0], SOLID_DETAILS[1])]
    DetailOutOfRange {
        /// What was asked for.
        pct: f64,
    },
    /// A size is out of range.
    #[error("the {name} is {value}; it goes from 0 to {most}")]
    SizeOutOfRange {
        /// Which.
        name: &'static str,
        /// What was asked for.
        value: f64,
        /// The most that can be.
        most: f64,
    },
    /// No part of the mesh can be done, or in a strict run not all.
    #[error("{}", refusal(kept, *n_parts))]
    Refused {
        /// The parts that cannot be done, with all reasons.
        kept: Vec<Kept>,
        /// How many parts there are.
        n_parts: usize,
    },
    /// A strict run made a result that is not fit for use.
    #[error("the result is not sound: {}", grave(warnings))]
    Unsound {
        /// All that is wrong with it.
        warnings: Vec<Warning>,
        /// What is told of the run.
        report: Box<Report>,
    },
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(rayon::ThreadPoolBuildError),
    /// The mesh cannot be mended.
    #[error(transparent)]
    Clean(clean::Error),
    /// Borders could not be closed.
    #[error(transparent)]
    Close(close::Error),
    /// Handles could not be cut.
    #[error(transparent)]
    Cut(handles::Error),
    /// The shells could not be made one closed surface.
    #[error(transparent)]
    Solid(solid::Error),
    /// Decimation failed.
    #[error(transparent)]
    Decimate(decimate::Error),
    /// The collapse to a tetrahedron failed.
    #[error(transparent)]
    Collapse(decimate::CollapseError),
    /// The embedding failed.
    #[error(transparent)]
    Embed(embed::Error),
    /// The primitive could not be made.
    #[error(transparent)]
    Sphere(sphere::AdaptiveError),
    /// No quads that flow were found.
    #[error(transparent)]
    Flow(flow::Error),
    /// They could not be laid on the sphere.
    #[error(transparent)]
    Cover(embed::CoverError),
    /// The triangles could not be paired.
    #[error(transparent)]
    Pair(pair::Error),
    /// The primitive could not be laid on the surface.
    #[error(transparent)]
    Deform(deform::Error),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Whether the user asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_))
    }
}

/// Lifts a step's cancellation to that of the run.
macro_rules! lift {
    ($($module:ident :: $error:ident => $variant:ident),*) => {$(
        impl From<$module::$error> for Error {
            fn from(error: $module::$error) -> Self {
                match error {
                    $module::$error::Cancelled(cancelled) => Self::Cancelled(cancelled),
                    error => Self::$variant(error),
                }
            }
        }
    )*};
}

lift!(
    clean::Error => Clean,
    close::Error => Close,
    handles::Error => Cut,
    solid::Error => Solid,
    decimate::Error => Decimate,
    decimate::CollapseError => Collapse,
    embed::Error => Embed,
    embed::CoverError => Cover,
    flow::Error => Flow,
    pair::Error => Pair,
    sphere::AdaptiveError => Sphere,
    deform::Error => Deform
);
