//! Guidance that somebody proposes for each part, and how it joins what the artist drew.
//!
//! Where both have a line, the artist's stays alone; where both have a density, the larger one holds.

use glam::DVec3;
use serde::Serialize;

use super::density::Density;
use super::frame::Prepared;
use super::settings::Primitive;
use super::split::components;
use super::{Error, Input, Settings};
use crate::guidance::{Guidance, GuidanceError, Recognised, Stroke};
use crate::measure::Polyline;
use crate::mesh::TriangleMesh;
use crate::progress::Progress;

/// A proposed line that is nearer to a drawn one than this share of its own length, in the mean, is
/// that line. A ring beside another is a tenth of its length away where a limb is as long as thick.
const SAME: f64 = 0.06;
/// Points of it that are looked at.
const N_LOOKS: f64 = 32.0;

/// Who was asked for guidance, and what came of it.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Asked {
    /// What it is called.
    pub predictor: &'static str,
    /// What it proposed for each part that was remeshed, in their order.
    pub parts: Vec<Proposed>,
}

/// What was proposed for a part.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Proposed {
    /// What the part was taken for.
    pub recognised: Option<Recognised>,
    /// How many lines were proposed, those that the artist drew too among them.
    pub n_strokes: usize,
    /// Whether a density was.
    pub has_density: bool,
    /// Why nothing was; none where the proposal could be used.
    pub refused: Option<String>,
}

/// All proposals for a mesh, in the frame of work.
#[derive(Default)]
pub struct Proposals {
    strokes: Vec<Stroke>,
    /// Places of vertices and the densities there.
    densities: Vec<(DVec3, f64)>,
    /// What is told of them; none where nobody was asked.
    pub asked: Option<Asked>,
}

impl Proposals {
    /// Asks for every part; nobody is asked where no quads are to flow.
    ///
    /// # Errors
    /// When cancelled.
    pub fn ask(
        input: &Input<'_>,
        prepared: &Prepared,
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<Self, Error> {
        let mut all = Self::default();
        if input.guidance.is_empty() || settings.primitive() != Primitive::Flow {
            return Ok(all);
        }
        let parts = components(&prepared.mesh, progress)?;
        let told = parts.iter().map(|part| all.of_part(input, part, progress));
        let parts = told.collect::<Result<Vec<Proposed>, Error>>()?;
        let predictor = input.guidance.name();
        all.asked = Some(Asked { predictor, parts });
        Ok(all)
    }

    fn of_part(
        &mut self,
        input: &Input<'_>,
        part: &TriangleMesh,
        progress: &Progress<'_>,
    ) -> Result<Proposed, Error> {
        progress.check()?;
        let refused = |reason: String| Proposed {
            recognised: None,
            n_strokes: 0,
            has_density: false,
            refused: Some(reason),
        };
        let guidance = match input.guidance.propose(part, progress) {
            Ok(guidance) => guidance,
            Err(GuidanceError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(error) => return Ok(refused(error.to_string())),
        };
        if let Err(error) = guidance.check(part) {
            return Ok(refused(format!("the proposal cannot be used: {error}")));
        }
        let Guidance {
            strokes,
            density,
            recognised,
        } = guidance;
        let told = Proposed {
            recognised,
            n_strokes: strokes.len(),
            has_density: density.is_some(),
            refused: None,
        };
        self.strokes.extend(strokes);
        let values = density.iter().flat_map(|values| values.iter().copied());
        let places = part.positions().iter().copied();
        self.densities.extend(places.zip(values));
        Ok(told)
    }

    /// The proposed strokes that are not among those drawn.
    pub fn beside(&self, drawn: &[Stroke]) -> Vec<Stroke> {
        let lines = drawn.iter().map(|stroke| {
            let points: Vec<DVec3> = stroke.round().collect();
            Polyline::new(points, stroke.is_closed)
        });
        let lines: Vec<Polyline> = lines.collect();
        let is_drawn = |stroke: &Stroke| {
            let length = stroke.length();
            let points = stroke.spaced(length / N_LOOKS);
            lines.iter().any(|line| {
                let off: f64 = points.iter().map(|&p| line.distance(p)).sum();
                off < SAME * length * points.len() as f64
            })
        };
        let new = self.strokes.iter().filter(|stroke| !is_drawn(stroke));
        new.cloned().collect()
    }

    /// A density, larger where a larger one was proposed.
    pub fn raised(&self, density: Density) -> Density {
        density.raised(self.densities.iter().copied())
    }
}
