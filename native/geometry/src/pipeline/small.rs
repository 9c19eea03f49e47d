//! Parts that are too small to be remeshed.

use serde::{Deserialize, Serialize};

use super::frame::Frame;
use super::kept::{Flaw, Kept, Outcome, Reason};
use super::split::Part;
use super::{Error, MIN_FACES, Settings, own};
use crate::mesh::{FaceId, PolygonMesh, VertexId, bounds};

/// A part that is at least this share of the largest is never small: where a mesh has many equal
/// parts and few faces are asked for, each gets the fewest that close it. At a quarter of the area
/// a part is half as large across.
const COMPARABLE: f64 = 0.25;

/// What becomes of parts that are too small.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SmallParts {
    /// They stay as they were.
    #[default]
    Keep,
    /// They go.
    Drop,
}

impl SmallParts {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Drop => "drop",
        }
    }

    pub(super) fn outcome(self) -> Outcome {
        match self {
            Self::Keep => Outcome::Kept,
            Self::Drop => Outcome::Dropped,
        }
    }
}

/// The faces of small parts that stay. They are among those asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Beside {
    /// How many there are.
    pub n_faces: usize,
    /// How many faces fewer are asked of the other parts: no more than every third one, so that
    /// small parts leave the others their shape.
    pub n_less: usize,
}

impl Beside {
    pub fn new(kept: &[Kept], settings: &Settings) -> Self {
        let stays = |kept: &&Kept| kept.is_small() && kept.outcome == Outcome::Kept;
        let n_faces = kept.iter().filter(stays).map(|kept| kept.n_faces).sum();
        let most = settings.faces - (2 * settings.faces).div_ceil(3).max(MIN_FACES);
        let n_less = usize::min(n_faces, most);
        Self { n_faces, n_less }
    }

    /// What is asked of the others.
    pub fn settings(self, settings: &Settings) -> Settings {
        Settings {
            faces: settings.faces - self.n_less,
            ..settings.clone()
        }
    }
}

/// Gives small parts a reason more.
///
/// A part is small when it measures less than was asked for; or when it could be done, but its fair
/// share of the faces is less than the fewest that close it, and the largest part is more than four
/// times as large. A part in quads has no smaller share of them than of all. `amounts` has what the
/// share of each surface goes by.
pub fn mark(parts: &mut [Part], mesh: &PolygonMesh, amounts: &[f64], settings: &Settings) {
    if parts.len() < 2 {
        return;
    }
    let all = parts.iter().flat_map(|part| &part.faces).copied();
    let whole = diagonal(mesh, all);
    let size_pct = |part: &Part| 100.0 * diagonal(mesh, part.faces.iter().copied()) / whole;
    if settings.small_size > 0.0 {
        for part in parts.iter_mut() {
            let size_pct = size_pct(part);
            if size_pct < settings.small_size {
                let text = format!(
                    "it measures {size_pct:.3} % of the mesh's diagonal; parts below {} % are small",
                    settings.small_size
                );
                part.is_small(mesh, (None, size_pct), text);
            }
        }
    }
    let amount = |part: &Part| {
        let surface = part.surface.filter(|_| part.reasons.is_empty());
        surface.map(|surface| amounts[surface])
    };
    let [total, largest] = parts
        .iter()
        .filter_map(amount)
        .fold([0.0, 0.0], |[sum, most], a| [sum + a, f64::max(most, a)]);
    let least = settings.kind.fewest_faces();
    for part in parts.iter_mut() {
        let Some(amount) = amount(part).filter(|a| *a < COMPARABLE * largest) else {
            continue;
        };
        let share = (settings.faces as f64 * amount / total).max(own_share(part, mesh, settings));
        if share < least as f64 {
            let faces = settings.faces;
            let text = format!(
                "its share is {share:.1e} of {faces} faces; {least} are the fewest that close it"
            );
            let size_pct = size_pct(part);
            part.is_small(mesh, (Some(share), size_pct), text);
        }
    }
}

/// The share of a part in quads that can stay: as much of them as of all faces.
fn own_share(part: &Part, mesh: &PolygonMesh, settings: &Settings) -> f64 {
    let are_quads = || part.faces.iter().all(|&face| mesh.face(face).len() == 4);
    if !own::are_wanted(settings) || !are_quads() {
        return 0.0;
    }
    let share = settings.faces as f64 / mesh.n_faces() as f64;
    share.min(1.0) * part.faces.len() as f64
}

impl Part {
    fn is_small(
        &mut self,
        mesh: &PolygonMesh,
        (share, size_pct): (Option<f64>, f64),
        text: String,
    ) {
        let flaw = Flaw::Small { share, size_pct };
        let reason = Reason::new(mesh, &self.faces, &[], flaw, text);
        self.reasons.push(reason);
    }
}

/// The diagonal of the bounding box of some faces.
fn diagonal(mesh: &PolygonMesh, faces: impl Iterator<Item = FaceId>) -> f64 {
    let corners: Vec<_> = faces
        .flat_map(|face| mesh.face(face))
        .map(|&v: &VertexId| mesh.position(v))
        .collect();
    Frame::new(bounds(&corners)).diagonal()
}

impl Settings {
    /// Whether the sizes are in their ranges.
    pub(super) fn check_sizes(&self) -> Result<(), Error> {
        let named = [
            ("small size", self.small_size, 100.0),
            ("weld distance", self.weld.unwrap_or(0.0), MAX_WELD),
        ];
        match named
            .into_iter()
            .find(|&(_, value, most)| !(0.0..=most).contains(&value))
        {
            Some((name, value, most)) => Err(Error::SizeOutOfRange { name, value, most }),
            None => Ok(()),
        }
    }
}

/// The largest weld distance, as a share of the diagonal: what is larger is no seam.
pub const MAX_WELD: f64 = 0.01;
