//! What is told of a run.

use serde::Serialize;

use super::borders::Opened;
use super::carried::CarriedReport;
use super::clock::Step;
use super::flowed::Flowed;
use super::kept::Kept;
use super::mirror::Plane;
use super::proposed::Asked;
use super::region::KeptFaces;
use super::settings::Settings;
use super::solid::Solid;
use super::strokes::GuideReport;
use super::warning::Warning;
use crate::measure::Topology;
use crate::score::Score;
use crate::{clean, decimate, deform, embed, sphere};

/// What is told of a run; the program writes it as JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The version of Orbflow.
    pub version: &'static str,
    /// What was asked for.
    pub settings: Settings,
    /// The mesh that came in.
    pub input: Topology,
    /// What had to be mended in it.
    pub clean: clean::Report,
    /// How it became one closed surface; none where that was not asked for.
    pub solid: Option<Solid>,
    /// The mesh that went out.
    pub output: Topology,
    /// The plane of symmetry; none when none was asked for or there is none.
    pub plane: Option<Plane>,
    /// The embeddings of all parts together.
    pub embedding: embed::Report,
    /// Each part that was remeshed, in the order of its first face.
    pub parts: Vec<PartReport>,
    /// The parts that were not, in that order too, with all reasons.
    pub kept: Vec<Kept>,
    /// What became of the edges that were to be carried; none where there were none.
    pub carried: Option<CarriedReport>,
    /// What became of lines along which sheets meet; none where there were none.
    pub rejoined: Option<Rejoined>,
    /// What became of faces that were to be kept; none where there were none.
    pub kept_faces: Option<KeptFaces>,
    /// What became of strokes, in their order.
    pub guides: Vec<GuideReport>,
    /// Who was asked for guidance, and what came of it; none where nobody was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub guidance: Option<Asked>,
    /// How good the result is; none when it was not asked for or could not be measured.
    pub score: Option<Score>,
    /// Why it could not be measured.
    pub score_refused: Option<String>,
    /// What is not as it was to be, what is grave first.
    pub warnings: Vec<Warning>,
    /// How long each step took.
    pub steps: Vec<Step>,
    /// The most memory that the process held, in MiB; none where the system does not tell.
    pub peak_memory_mb: Option<f64>,
}

/// What became of lines along which sheets meet, where at least one of them was remeshed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Rejoined {
    /// How many there are.
    pub n_shared_lines: usize,
    /// At how many all sheets have the same vertices again.
    pub n_joined: usize,
    /// At how many they have not: with other numbers of edges there, or because one stays as it was.
    pub n_left: usize,
}

/// What is told of one part.
#[derive(Clone, Debug, Serialize)]
pub struct PartReport {
    /// How many triangles came in.
    pub n_input_faces: usize,
    /// How many faces it was to get.
    pub n_asked_faces: usize,
    /// How many faces it got.
    pub n_faces: usize,
    /// What became of the mesh that was reduced outside; none when there was none.
    pub reduced: Option<Reduced>,
    /// How it was reduced before the embedding; none when it was small enough.
    pub decimate: Option<decimate::Report>,
    /// What became of its borders; none where it had none.
    pub opened: Option<Opened>,
    /// Its embedding.
    pub embedding: embed::Report,
    /// Whether its quads flow; none when that was not asked for.
    pub flow: Option<Flowed>,
    /// Whether it is its own image in the plane; none where there is no plane.
    pub mirrored: Option<Mirrored>,
    /// How the adaptive primitive, or the even surface for the flow, was made; none for a fixed one.
    pub sphere: Option<sphere::Report>,
    /// How the primitive was laid on the surface.
    pub deform: deform::Report,
}

/// Whether a part is its own image, or that of another, in the plane of symmetry.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Mirrored {
    /// It is its own image.
    Used,
    /// It is the image of another part.
    Image {
        /// Which part, counted from 0.
        of: usize,
    },
    /// It is not.
    Refused {
        /// Why not.
        reason: String,
    },
}

/// Whether a mesh that was reduced outside could be used.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Reduced {
    /// It was used in the place of our own decimation.
    Used {
        /// How many triangles it has.
        n_faces: usize,
    },
    /// It was not used.
    Refused {
        /// Why not.
        reason: String,
    },
}
