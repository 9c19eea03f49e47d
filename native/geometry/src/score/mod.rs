//! How good a remeshed model is, in numbers: topology, distance, shape of faces, edge flow.
//!
//! `↓` marks figures of which less is better, `↑` of which more is. d is the length of the diagonal
//! of the input's bounding box, and distances are in percent of d. Quads are cut into triangles along
//! the shorter diagonal that lies inside, larger polygons as a fan or, where that folds, by clipping
//! ears. Distances come from seeded samples even by area, all other figures are exact but for the
//! curvature of very large inputs. Nothing is welded: what counts is how the faces hang together.
//! Whether an output hangs together as the input did is told of the input as whoever asks has cleaned it.
//! Figures of quads are none where there are none.

mod borders;
mod crossing;
mod distance;
mod features;
mod flow;
mod glance;
mod lines;
mod near;
mod shape;
mod statistics;
mod surface;
mod symmetry;
mod watched;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::measure::{Topology, topology_of};
use crate::mesh::PolygonMesh;
use crate::progress::{Cancelled, Progress};
use crate::sparse::NotPositiveDefinite;
use surface::Surface;

pub use borders::BorderDistance;
pub use distance::Distance;
pub use flow::Flow;
pub use glance::{Glance, glance};
pub use lines::{Chains, Strips};
pub use shape::Shape;

/// What is asked of a score.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// How many quads were asked for; a triangle counts as half a quad.
    pub target: Option<usize>,
    /// Samples on each of the two surfaces. Mean distances err by about 1 / √samples of
    /// themselves; 1,000 will do for a glance.
    pub n_samples: usize,
    /// Where the samples start.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            target: None,
            n_samples: 100_000,
            seed: 0,
        }
    }
}

/// What an output is measured against.
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// The mesh that was to be rebuilt.
    pub mesh: &'a PolygonMesh,
    /// How it hangs together once it is cleaned; none takes it as it comes, with faces apart that
    /// have vertices of their own in the same place.
    pub topology: Option<Topology>,
}

impl<'a> From<&'a PolygonMesh> for Reference<'a> {
    fn from(mesh: &'a PolygonMesh) -> Self {
        Self {
            mesh,
            topology: None,
        }
    }
}

/// Why there is no score.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// The input has no face with an area.
    #[error("the input has no face with an area ({n_faces} faces)")]
    FlatInput {
        /// How many faces it has.
        n_faces: usize,
    },
    /// The output has no face with an area.
    #[error("the output has no face with an area ({n_faces} faces)")]
    FlatOutput {
        /// How many faces it has.
        n_faces: usize,
    },
    /// No samples were asked for.
    #[error("0 samples; at least 1 is needed")]
    NoSamples,
    /// The target is zero.
    #[error("a target of 0 quads; at least 1 is needed")]
    NoTarget,
    /// The input's curvature cannot be computed.
    #[error("the input's curvature cannot be computed")]
    Curvature(#[from] NotPositiveDefinite),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Every figure of one output; none where a figure does not apply.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Score {
    /// Faces, whatever their number of corners.
    pub faces: usize,
    /// Vertices in use.
    pub vertices: usize,
    /// ↑ Share of faces with four corners.
    pub quads_pct: f64,
    /// Triangles once all faces are cut.
    pub triangles: usize,
    /// (triangles / 2 − target) / target; nearer to 0 is better.
    pub count_error_pct: Option<f64>,
    /// No edge has only one face.
    pub closed: bool,
    /// At most two faces an edge, one fan a vertex, consistently turned.
    pub manifold: bool,
    /// Pieces that share no vertex.
    pub components: usize,
    /// Border lines.
    pub borders: usize,
    /// Handles; none unless manifold.
    pub genus: Option<i64>,
    /// The five above are the input's, once that is cleaned.
    pub same_topology: bool,
    /// ↓ Pairs of triangles that cross; neighbours across an edge are not tested.
    pub self_intersections: usize,
    /// ↓ Share of triangles in such a pair.
    pub self_intersecting_pct: f64,
    /// How far from the input.
    #[serde(flatten)]
    pub distance: Distance,
    /// ↓ Mean distance × (triangles / 2) / target, which takes out a count that was missed.
    pub chamfer_at_target_pct: Option<f64>,
    /// The shape of single faces.
    #[serde(flatten)]
    pub shape: Shape,
    /// How the edges run over the surface.
    #[serde(flatten)]
    pub flow: Flow,
    /// How long the edges run straight on.
    #[serde(flatten)]
    pub chains: Chains,
    /// How the quads line up.
    #[serde(flatten)]
    pub strips: Strips,
    /// How far border lines are apart.
    #[serde(flatten)]
    pub border_distance: BorderDistance,
    /// ↑ F1 at 0.5 % of points on sharp lines of input and output; none without clear lines.
    pub feature_f1_pct: Option<f64>,
    /// ↓ Mean distance of mirrored vertices to the nearest vertex / mean edge length, over the
    /// axes in which the input is symmetric; none if there is none. Random vertices have 0.38.
    pub asymmetry: Option<f64>,
    /// What warnings are made of.
    #[serde(skip)]
    pub glance: Glance,
}

/// Measures how good `output` is as a remeshing of `input`.
///
/// # Errors
/// When one of them has no area, a setting is 0, or cancelled.
pub fn score<'a>(
    input: impl Into<Reference<'a>>,
    output: &PolygonMesh,
    settings: &Settings,
    progress: &Progress,
) -> Result<Score, Error> {
    if settings.n_samples == 0 {
        return Err(Error::NoSamples);
    }
    if settings.target == Some(0) {
        return Err(Error::NoTarget);
    }
    let Reference { mesh, topology } = input.into();
    let n_faces = mesh.n_faces();
    let input = Surface::new(mesh, &progress.part("", 0.0, 0.1))?;
    let input = input.ok_or(Error::FlatInput { n_faces })?;
    let n_faces = output.n_faces();
    let output = Surface::new(output, &progress.part("", 0.1, 0.15))?;
    let output = output.ok_or(Error::FlatOutput { n_faces })?;
    let topology = match topology {
        Some(topology) => topology,
        None => topology_of(input.mesh, &input.edges, progress)?,
    };
    measure((&input, &topology), &output, settings, progress)
}

fn measure(
    (input, topology): (&Surface, &Topology),
    output: &Surface,
    settings: &Settings,
    progress: &Progress,
) -> Result<Score, Error> {
    let crossing = crossing::pairs(output, &progress.part("", 0.15, 0.2))?;
    let distance = distance::distance(input, output, settings, &progress.part("", 0.2, 0.7))?;
    let flow = flow::flow(input, output, settings.target, &progress.part("", 0.7, 0.9))?;
    progress.at(0.9)?;
    let found = features::found(input, output, progress)?;
    progress.at(0.93)?;
    let own = topology_of(output.mesh, &output.edges, progress)?;
    progress.at(0.95)?;
    let border_distance = borders::borders(input, output, progress)?;
    progress.at(0.97)?;
    let asymmetry = symmetry::asymmetry(input, output, settings.seed, progress)?;
    progress.at(0.98)?;
    let shape = shape::shape(output, progress)?;
    progress.check()?;
    let chains = lines::chains(output, progress)?;
    let strips = lines::strips(output);
    progress.at(0.99)?;
    let triangles = output.triangles.len();
    let of_target = |target: usize| triangles as f64 / 2.0 / target as f64;
    Ok(Score {
        faces: own.n_faces,
        vertices: own.n_vertices,
        quads_pct: 100.0 * own.n_quads as f64 / own.n_faces as f64,
        triangles,
        count_error_pct: settings
            .target
            .map(|target| 100.0 * (of_target(target) - 1.0)),
        closed: own.closed,
        manifold: own.manifold,
        components: own.n_components,
        borders: own.n_borders,
        genus: own.genus,
        same_topology: own.is_alike(topology),
        self_intersections: crossing.len(),
        self_intersecting_pct: crossing::involved_pct(&crossing, triangles),
        chamfer_at_target_pct: settings.target.map(|t| distance.chamfer_pct * of_target(t)),
        distance,
        shape,
        flow,
        chains,
        strips,
        border_distance,
        feature_f1_pct: found.map(|found| found.f1_pct()),
        asymmetry,
        glance: Glance::new(&distance, found.as_ref()),
    })
}

#[cfg(test)]
mod tests;
