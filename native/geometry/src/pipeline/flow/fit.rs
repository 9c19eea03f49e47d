//! One attempt at quads that flow: found on the even surface, laid on its sphere, fitted.

use super::ground::{Ground, Refusal};
use crate::deform::{self, Deformed, Flowing};
use crate::elementary::powf;
use crate::embed::{self, Covered};
use crate::flow::{self, Flow};
use crate::mesh::VertexMap;
use crate::mirror::Reflection;
use crate::pipeline::attempt::Attempt;
use crate::pipeline::clock::Clock;
use crate::pipeline::flowed::{Flowed, FlowedPart};
use crate::pipeline::paired::told;
use crate::pipeline::probe::n_missed;
use crate::pipeline::{Error, crosses, density, mirror};
use crate::progress::{Cancelled, Progress};

/// Quads that flow, laid on the sphere.
struct Laid {
    flow: Flow,
    covered: Covered,
}

impl Ground<'_> {
    /// Quads that flow by some settings, laid on the target.
    pub fn attempt(
        &self,
        attempt: Attempt,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, Refusal>, Cancelled> {
        let part = progress.part("flow", 0.0, 0.75);
        let laid = match clock.step("flow", || self.laid(attempt, &part))? {
            Ok(laid) => laid,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let part = progress.part("deform", 0.75, 1.0);
        let fitted = clock.step("deform", || told(self.fitted(&laid, &part)))?;
        let fitted = fitted.map(|fitted| self.evened(fitted, &laid.flow));
        let opened = match (fitted, self.asked.opening) {
            (Ok(fitted), Some(opening)) => {
                opening.reopened(&fitted, (&laid.flow.firm, self.target), progress)?
            }
            (fitted, _) => fitted,
        };
        let is_over = false;
        let deformed = match opened {
            Ok(deformed) => deformed,
            Err(reason) => return Ok(Err(Refusal { reason, is_over })),
        };
        let marks = (&deformed.mesh, &deformed.features[..]);
        let even = self.surface.even.mesh();
        Ok(Ok(FlowedPart {
            mirrored: self.surface.doubled.as_ref().map(|_| Ok(())),
            n_missed: n_missed(&deformed.mesh, self.asked.bare(self.target)),
            lost: self.wanted.lost(marks, progress)?,
            deformed,
            sphere: self.sphere.clone(),
            crosses: crosses::some(even, &laid.flow, self.asked.n_crosses()),
            flowed: Flowed::Used {
                attempt,
                n_attempts: 1,
                flow: laid.flow.report,
                cover: laid.covered.report,
            },
        }))
    }

    /// Quads that flow by some settings, laid on the sphere.
    fn laid(
        &self,
        attempt: Attempt,
        progress: &Progress<'_>,
    ) -> Result<Result<Laid, Refusal>, Cancelled> {
        let mut settings = attempt.settings(&self.style);
        let even = self.surface.even.mesh();
        let weights = |values| density::weights(values, self.target, even);
        settings.sizes.weights = self.finer(self.asked.density.map(weights));
        let found = self.find(&settings, progress);
        let is_over = matches!(
            found,
            Err(Error::Flow(flow::Error::Count { n_quads, n_wanted })) if n_quads > n_wanted
        );
        Ok(told(found)?.map_err(|reason| Refusal { reason, is_over }))
    }

    /// How many more quads per area are wanted at every vertex of the even surface, with what strokes
    /// want more of them. The flow follows about half of a wish.
    fn finer(&self, weights: Option<VertexMap<f64>>) -> Option<VertexMap<f64>> {
        if self.finer.is_empty() {
            return weights;
        }
        let even = self.surface.even.mesh();
        let mut weights = weights.unwrap_or_else(|| VertexMap::filled(even.n_vertices(), 1.0));
        for v in even.vertex_ids() {
            weights[v] *= powf(self.finer.at(even.position(v)), 4.0);
        }
        Some(weights)
    }

    /// The flow of the surface, laid on its sphere.
    fn find(&self, settings: &flow::Settings, progress: &Progress<'_>) -> Result<Laid, Error> {
        let surface = &self.surface;
        let part = progress.part("", 0.0, 0.95);
        let mut flow = flow::flow(
            &surface.even,
            surface.guides(self.is_strict),
            settings,
            &part,
        )?;
        if settings.may_exceed {
            flow = flow.thinned(self.asked.n_quads)?;
        }
        let part = progress.part("", 0.95, 1.0);
        let covered = embed::cover(&flow.mesh, &flow.sphere, &part)?;
        Ok(Laid { flow, covered })
    }

    /// Quads on the sphere fitted to the target.
    fn fitted(&self, laid: &Laid, progress: &Progress<'_>) -> Result<Deformed, Error> {
        let flow = &laid.flow;
        let quads = flow.mesh.with_positions(laid.covered.sphere.clone());
        let flowing = Flowing {
            quads: &quads,
            wanted: flow.mesh.positions(),
            crosses: &flow.crosses,
            sizes: &flow.sizes,
            seams: &flow.seams,
        };
        let settings = deform::Settings {
            evenness: self.evenness(),
            is_on_lines: self.keeps_lines(),
            forces_lines: self.has_firm(),
            is_inscribed: self.is_solid(),
            // What is virtual may lie on what is real.
            separates: self.asked.opening.is_none_or(|opening| !opening.overlaps()),
            ..deform::Settings::default()
        };
        let even = &self.surface.even;
        let fitted = deform::deform_flow(even, flowing, self.target, &settings, progress);
        Ok(fitted?)
    }

    /// Fitted quads made images of each other again in the plane, where they were.
    fn evened(&self, fitted: Deformed, flow: &Flow) -> Deformed {
        let mirrored = flow.images.as_deref().zip(self.surface.doubled.as_ref());
        match mirrored.map(|(images, doubled)| (images, doubled.reflection())) {
            Some((images, Reflection::Across(axis))) => {
                mirror::even_out(&fitted, images, axis, self.target)
            }
            // Of a sheet one side alone is kept.
            Some((_, Reflection::Onto)) | None => fitted,
        }
    }

    /// How much edges wish for one length; where somebody wants quads of other sizes, not at all.
    fn evenness(&self) -> f64 {
        match self.asked.density {
            None if self.finer.is_empty() => self.asked.settings.style.evenness(),
            _ => 0.0,
        }
    }
}
