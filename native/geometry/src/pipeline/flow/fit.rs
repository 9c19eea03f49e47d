//! One attempt at quads that flow: found on the even surface, laid on its sphere, fitted.

use super::ground::{Ground, Refusal};
use crate::deform::{self, Deformed, Flowing, Lines};
use crate::elementary::powf;
use crate::embed::{self, Covered};
use crate::flow::{self, FirmEdges, Flow};
use crate::mesh::VertexMap;
use crate::mirror::Reflection;
use crate::pipeline::attempt::Attempt;
use crate::pipeline::clock::Clock;
use crate::pipeline::flowed::{Flowed, FlowedPart};
use crate::pipeline::open::{self, Opening, Regions};
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
    /// Quads that flow by some settings, so many times as many as are asked for, laid on the target.
    pub fn attempt(
        &self,
        (attempt, more): (Attempt, f64),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, Refusal>, Cancelled> {
        let part = progress.part("flow", 0.0, 0.75);
        let laid = match clock.step("flow", || self.laid((attempt, more), &part))? {
            Ok(laid) => laid,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let part = progress.part("deform", 0.75, 1.0);
        let fitted = clock.step("deform", || told(self.fitted(&laid, &part)))?;
        let fitted = fitted.map(|fitted| self.evened(fitted, &laid.flow));
        let opened = match (fitted, self.asked.opening) {
            (Ok(fitted), Some(opening)) => {
                self.reopened(&fitted, (opening, &laid.flow), progress)?
            }
            (fitted, _) => fitted.map(|fitted| (fitted, 0)),
        };
        let is_over = false;
        let (deformed, n_rings) = match opened {
            Ok(opened) => opened,
            Err(reason) => return Ok(Err(Refusal { reason, is_over })),
        };
        if self
            .asked
            .opening
            .is_some_and(|opening| !opening.has_room(n_rings))
        {
            let reason = format!("{n_rings} rings at borders are too many for the quads");
            return Ok(Err(Refusal { reason, is_over }));
        }
        if n_rings > 0 && self.is_across() {
            let reason = "rings at its borders are no images of each other".to_owned();
            return Ok(Err(Refusal { reason, is_over }));
        }
        let marks = (&deformed.mesh, &deformed.features[..]);
        let even = self.surface.even.mesh();
        Ok(Ok(FlowedPart {
            mirrored: self.surface.doubled.as_ref().map(|_| Ok(())),
            n_missed: n_missed(&deformed.mesh, self.asked.bare(self.target)),
            n_unmet: self.n_unmet(n_rings),
            lost: self.wanted.lost(marks, progress)?,
            deformed,
            sphere: self.sphere.clone(),
            crosses: crosses::some(even, &laid.flow, self.asked.n_crosses()),
            flowed: Flowed::Used {
                attempt,
                n_attempts: 1,
                n_rings,
                flow: laid.flow.report,
                cover: laid.covered.report,
            },
        }))
    }

    /// Whether quads are to be images of others across a plane.
    fn is_across(&self) -> bool {
        let doubled = self.surface.doubled.as_ref();
        doubled.is_some_and(|doubled| matches!(doubled.reflection(), Reflection::Across(_)))
    }

    /// Of so many rings, those that stand for lines that were to be met.
    fn n_unmet(&self, n_rings: usize) -> usize {
        let loose = self.surface.regions.as_ref();
        n_rings.saturating_sub(loose.map_or(0, |regions| regions.loose.len()))
    }

    /// Quads of a closed part opened again, and how many borders have rings: those that lines miss,
    /// and all where these cannot be opened.
    fn reopened(
        &self,
        fitted: &Deformed,
        (opening, flow): (&Opening, &Flow),
        progress: &Progress<'_>,
    ) -> Result<Result<(Deformed, usize), String>, Cancelled> {
        let even = &self.surface.even;
        let border = self.surface.border.as_ref();
        let between = || border.map(|firm| Regions::between(even, firm));
        let loose = self.surface.regions.as_ref();
        let is_partly = loose.is_none() && !flow.unmet.is_empty();
        let partly = is_partly.then(between).flatten();
        let regions = loose.or(partly.as_ref());
        let lines = open::Lines {
            met: &flow.firm,
            unmet: &flow.unmet,
            surface: regions.map(|regions| (even, regions)),
        };
        let n_rings = flow.unmet.len() + regions.map_or(0, |regions| regions.loose.len());
        let opened = opening.reopened(fitted, (lines, self.target), progress)?;
        if opened.is_ok() || !self.is_bound_to_cuts() {
            return Ok(opened.map(|opened| (opened, n_rings)));
        }
        let Some(all) = between().map(Regions::all_loose) else {
            return Ok(opened.map(|opened| (opened, n_rings)));
        };
        let lines = open::Lines {
            met: &[],
            unmet: &[],
            surface: Some((even, &all)),
        };
        let opened = opening.reopened(fitted, (lines, self.target), progress)?;
        Ok(opened.map(|opened| (opened, all.loose.len())))
    }

    /// Quads that flow by some settings, laid on the sphere.
    fn laid(
        &self,
        (attempt, more): (Attempt, f64),
        progress: &Progress<'_>,
    ) -> Result<Result<Laid, Refusal>, Cancelled> {
        let times = |n: usize| (more * n as f64).round() as usize;
        let mut settings = attempt.settings(&self.style);
        settings.n_quads = times(settings.n_quads);
        let mut firm = self.firm().cloned();
        if let Some(real) = firm.as_mut().and_then(|firm| firm.real.as_mut()) {
            real.n_quads = times(real.n_quads);
        }
        let even = self.surface.even.mesh();
        let weights = |values| density::weights(values, self.target, even);
        settings.sizes.weights = self.finer(self.asked.density.map(weights));
        let found = self.find(&settings, firm.as_ref(), progress);
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
    fn find(
        &self,
        settings: &flow::Settings,
        firm: Option<&FirmEdges>,
        progress: &Progress<'_>,
    ) -> Result<Laid, Error> {
        let surface = &self.surface;
        let part = progress.part("", 0.0, 0.95);
        let mut flow = flow::flow(&surface.even, surface.guides(firm), settings, &part)?;
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
            lines: self.lines(),
            is_inscribed: self.is_solid(),
            // What is virtual may lie on what is real.
            separates: self.asked.opening.is_none_or(|opening| !opening.overlaps()),
            ..deform::Settings::default()
        };
        let even = &self.surface.even;
        let fitted = deform::deform_flow(even, flowing, self.target, &settings, progress);
        Ok(fitted?)
    }

    /// How far vertices go for sharp lines.
    fn lines(&self) -> Lines {
        if self.has_firm() {
            Lines::Forced
        } else if self.is_solid() {
            Lines::Kept
        } else {
            Lines::Sought
        }
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
