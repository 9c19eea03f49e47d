//! Quads that flow: an even surface, its flow, a cover of the sphere, the fit.

use super::Settings;
use super::attempt::{Attempt, Budget};
use super::clock::Clock;
use super::crosses;
use super::even::{For, Marked, even};
use super::flowed::{Flowed, FlowedPart, better};
use super::open::Opening;
use super::paired::told;
use super::probe::n_missed;
use super::{density, mirror, rods};
use crate::deform::{self, Flowing, Target};
use crate::embed::{self, Covered};
use crate::flow::FirmEdges;
use crate::measure::FeatureLine;
use crate::mesh::{HalfedgeMap, VertexMap};
use crate::mirror::{Doubled, Reflection};
use crate::progress::{Cancelled, Progress};
use crate::sphere;
use crate::sphere_map::SphereMap;
use crate::{flow, pipeline};

/// Of the marked edges this share may be lost before other settings are tried: short ones are.
const MOST_LOST: f64 = 0.1;

/// Curvature weighs so much less beside marked edges: irregular vertices leave their lines no way,
/// at 5/6 a ring on a ball is lost at 2,000 quads, at 1 at 400 and 500 too.
const BESIDE_MARKS: f64 = 2.0 / 3.0;

/// What quads of a part are to be.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    pub n_quads: usize,
    pub settings: &'a Settings,
    /// The density at the vertices of the target, where any is asked for.
    pub density: Option<&'a VertexMap<f64>>,
    /// The target's edges that the user marked.
    pub marked: &'a HalfedgeMap<bool>,
    /// The axis across the plane of symmetry, which goes through the origin.
    pub axis: Option<usize>,
    /// What is real of a part that was closed, and where its borders lie.
    pub opening: Option<&'a Opening>,
}

impl Asked<'_> {
    /// What the quads are held against: the part as it came, open or not.
    pub fn bare<'b>(&'b self, target: &'b Target) -> &'b Target {
        self.opening.map_or(target, |opening| &opening.bare)
    }

    /// How many crosses of all that are asked for fall to the part, by its quads.
    pub fn n_crosses(&self) -> usize {
        let settings = self.settings;
        (settings.n_crosses * self.n_quads).div_ceil(settings.faces)
    }
}

/// An even surface and what its quads are fitted to.
struct Ground<'a> {
    even: SphereMap,
    /// The edges of the even surface that lie along the target's sharp or marked ones.
    lines: HalfedgeMap<bool>,
    /// Those that lie along marked ones.
    marked: HalfedgeMap<bool>,
    /// Those that lie along borders of a part that was closed.
    border: Option<FirmEdges>,
    /// Whose image is whose, where the even surface is its own image.
    doubled: Option<Doubled>,
    sphere: sphere::Report,
    target: &'a Target,
    /// The marked edges of the target.
    wanted: Marked,
    asked: Asked<'a>,
    style: flow::Settings,
}

/// An even surface and its edges along lines, along marked ones, and along borders.
type Wearing = (
    SphereMap,
    HalfedgeMap<bool>,
    HalfedgeMap<bool>,
    Option<FirmEdges>,
);

/// Why an attempt gave no quads.
struct Refusal {
    reason: String,
    /// Whether it had too many.
    is_over: bool,
}

/// Quads off the flat metric of an even surface, along all lines of a solid, or, where none are
/// given, along what is long and clear.
///
/// Other settings are tried while quads are inverted or a part of the surface is missed and the
/// budget has room; the first of those with the fewest is it.
pub fn along(
    (map, target): (&SphereMap, &Target),
    (asked, lines): (Asked<'_>, &[FeatureLine]),
    budget: &mut Budget,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let (n_quads, settings) = (asked.n_quads, asked.settings);
    let part = progress.part("sphere", 0.0, 0.15);
    let wanted = Marked::new(target.mesh(), asked.marked);
    let mut style = settings.flow(n_quads);
    if !wanted.is_empty() {
        style.field.alignment *= BESIDE_MARKS;
    }
    if !lines.is_empty() {
        style.creases = flow::Creases::All;
    }
    let borders = asked.opening.map_or(&[][..], |opening| &opening.lines);
    let quads = For {
        n_quads,
        sizes: &style.sizes,
        seed: settings.seed,
        lines: if lines.is_empty() { borders } else { lines },
        is_solid: !lines.is_empty(),
        opening: asked.opening,
    };
    let even = clock.step("sphere", || {
        told(even(map, (target, &wanted), &quads, &part))
    })?;
    let even = match even {
        Ok(even) => even,
        Err(reason) => return Ok(Err(reason)),
    };
    let border = asked.opening.zip(even.border);
    let border = border.map(|(opening, is_on)| opening.firm(even.map.mesh(), is_on));
    let ground = Ground {
        even: even.map,
        lines: even.lines,
        marked: even.marked,
        border,
        doubled: None,
        sphere: even.sphere,
        target,
        wanted,
        asked,
        style,
    };
    let part = progress.part("", 0.15, 1.0);
    let sheet = asked.opening.filter(|opening| opening.is_sheet());
    let symmetry = match (sheet, asked.axis) {
        (Some(sheet), _) => Some(Symmetry::OtherSide(sheet)),
        (None, Some(axis)) => Some(Symmetry::Plane(axis)),
        (None, None) => None,
    };
    let found = match symmetry {
        Some(symmetry) => symmetric((ground, symmetry), budget, clock, &part),
        None => ground.best(budget, clock, &part),
    }?;
    let of_sheet = "it is a sheet, whose sides are each other's images".to_owned();
    let found = found.map(|found| match (sheet, asked.axis) {
        (Some(_), axis) => FlowedPart {
            mirrored: axis.map(|_| Err(of_sheet)),
            ..found
        },
        _ => found,
    });
    Ok(found.map(|found| found.found_in(budget.n_attempts)))
}

/// Of what quads shall be the images of each other.
#[derive(Clone, Copy)]
enum Symmetry<'a> {
    /// Of what lies on the other side of the plane across an axis.
    Plane(usize),
    /// Of what is virtual of a sheet: so its border is a line of edges, whatever the flow is.
    OtherSide(&'a Opening),
}

/// Quads that are their own image, or the usual ones where these cannot be or miss less of the
/// surface.
fn symmetric(
    (mut ground, symmetry): (Ground<'_>, Symmetry<'_>),
    budget: &mut Budget,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let part = progress.part("sphere", 0.0, 0.05);
    let found = clock.step("sphere", || {
        let lines = ground.keeps_lines().then_some(&ground.lines);
        told(match (symmetry, &ground.border) {
            (Symmetry::OtherSide(sheet), Some(border)) => {
                sheet.doubled((&ground.even, &border.is_on), ground.target, &part)
            }
            (Symmetry::OtherSide(_), None) => Ok(Err("it has no borders".to_owned())),
            (Symmetry::Plane(axis), _) => mirror::symmetric((&ground.even, lines), axis, &part),
        })
    })?;
    let mut symmetric = None;
    let reason = match found.flatten() {
        Ok((even, doubled)) => {
            let usual = ground.doubled(even, doubled);
            let best = ground.best(budget, clock, &progress.part("", 0.05, 0.6))?;
            (ground.even, ground.lines, ground.marked, ground.border) = usual;
            ground.doubled = None;
            match best {
                Ok(best) if best.n_missed == 0 => return Ok(Ok(best)),
                Ok(best) => {
                    symmetric = Some(best);
                    "a part of the surface would be missed".to_owned()
                }
                Err(reason) => reason,
            }
        }
        Err(reason) => reason,
    };
    let usual = ground.best(budget, clock, &progress.part("", 0.6, 1.0))?;
    let usual = usual.map(|usual| FlowedPart {
        mirrored: Some(Err(reason)),
        ..usual
    });
    Ok(match symmetric {
        Some(symmetric) => better(Ok(symmetric), usual),
        None => usual,
    })
}

impl Ground<'_> {
    /// Takes an even surface that is its own image in place of the usual one, which it returns.
    fn doubled(&mut self, even: SphereMap, doubled: Doubled) -> Wearing {
        let carried = |lines| doubled.carried(self.even.mesh(), lines);
        let (lines, marked) = (carried(&self.lines), carried(&self.marked));
        let border = self.asked.opening.zip(self.border.as_ref());
        let border =
            border.map(|(opening, firm)| opening.firm(doubled.mesh(), carried(&firm.is_on)));
        self.doubled = Some(doubled);
        (
            std::mem::replace(&mut self.even, even),
            std::mem::replace(&mut self.lines, lines),
            std::mem::replace(&mut self.marked, marked),
            std::mem::replace(&mut self.border, border),
        )
    }

    /// The first of the attempts in which nothing fails, or the one in which least does of those that
    /// the budget has room for; one more is worth the marks that it may meet.
    fn best(
        &self,
        budget: &mut Budget,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, String>, Cancelled> {
        let mut best: Result<FlowedPart, String> = Err(String::new());
        let mut from = 0.0;
        let all = Attempt::ALL.into_iter();
        // Where a solid's creases are not met other settings do not help.
        let all = all.filter(|attempt| !self.is_solid() || *attempt == Attempt::Usual);
        for attempt in all.filter(|attempt| attempt.is_worth_trying(&self.style)) {
            // Without strips nothing is its own image.
            let is_flowing = best.as_ref().is_ok_and(|best| !best.is_last_resort());
            // Nor do lines stay that have to be met.
            let is_bound = self.doubled.is_some() || self.asked.opening.is_some();
            if attempt.is_last_resort() && (is_flowing || is_bound) {
                break;
            }
            // Without too many quads there is nothing to take out.
            if attempt == Attempt::Thinned && !budget.is_over {
                continue;
            }
            let is_spare = attempt == Attempt::Usual || attempt.is_last_resort();
            let kept_back = if is_spare {
                0
            } else {
                self.kept_back(&best, budget)
            };
            if !budget.take(attempt, kept_back) {
                continue;
            }
            let to = from + 0.6 * (1.0 - from);
            let found = self.attempt(attempt, clock, &progress.part("", from, to))?;
            budget.is_over |= matches!(found, Err(Refusal { is_over: true, .. }));
            let found = found.map_err(|refusal| refusal.reason);
            let found = found.and_then(FlowedPart::not_cut_off);
            from = to;
            best = better(best, found);
            let is_failing = best.as_ref().map_or(true, |best| best.n_failed() > 0);
            if attempt == Attempt::Usual && is_failing && self.asked.opening.is_none() {
                best = better(best, self.rings(clock, &progress.part("", from, from))?);
            }
            let is_done = |best: &FlowedPart| {
                best.n_failed() == 0 && (best.lost <= MOST_LOST || attempt != Attempt::Usual)
            };
            if best.as_ref().is_ok_and(is_done) {
                break;
            }
        }
        Ok(best)
    }

    /// Rings, if the part is one limb from end to end.
    fn rings(
        &self,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, String>, Cancelled> {
        let ground = (self.target, &self.wanted);
        rods::rings(&self.even, ground, self.asked, (clock, progress))
    }

    /// What of the budget is kept back for what comes when no more settings are tried here.
    fn kept_back(&self, best: &Result<FlowedPart, String>, budget: &Budget) -> usize {
        match best {
            Ok(best) => usize::from(self.doubled.is_some() && best.n_missed > 0),
            Err(_) => budget.kept_back(self.doubled.is_some()),
        }
    }

    /// Quads that flow by some settings, laid on the target.
    fn attempt(
        &self,
        attempt: Attempt,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, Refusal>, Cancelled> {
        let part = progress.part("flow", 0.0, 0.75);
        let mut settings = attempt.settings(&self.style);
        let weights = |values| density::weights(values, self.target, self.even.mesh());
        settings.sizes.weights = self.asked.density.map(weights);
        let found = clock.step("flow", || self.find(&settings, &part));
        let is_over = matches!(
            found,
            Err(pipeline::Error::Flow(flow::Error::Count { n_quads, n_wanted })) if n_quads > n_wanted
        );
        let (found, covered) = match told(found)? {
            Ok(found) => found,
            Err(reason) => return Ok(Err(Refusal { reason, is_over })),
        };
        let part = progress.part("deform", 0.75, 1.0);
        let quads = found.mesh.with_positions(covered.sphere);
        let flowing = Flowing {
            quads: &quads,
            wanted: found.mesh.positions(),
            crosses: &found.crosses,
            sizes: &found.sizes,
            seams: &found.seams,
        };
        let settings = deform::Settings {
            evenness: self.evenness(),
            is_on_lines: self.keeps_lines(),
            forces_lines: self.asked.opening.is_some(),
            // What is virtual may lie on what is real.
            separates: self.asked.opening.is_none_or(|opening| !opening.is_sheet()),
            ..deform::Settings::default()
        };
        let fit = || deform::deform_flow(&self.even, flowing, self.target, &settings, &part);
        let deformed = clock.step("deform", || told(fit().map_err(pipeline::Error::from)))?;
        let mirrored = found.images.as_deref().zip(self.doubled.as_ref());
        let evened = |deformed| match mirrored.map(|(images, of)| (images, of.reflection())) {
            Some((images, Reflection::Across(axis))) => {
                mirror::even_out(&deformed, images, axis, self.target)
            }
            // Of a sheet one side alone is kept.
            Some((_, Reflection::Onto)) | None => deformed,
        };
        let deformed = match deformed.map(evened) {
            Ok(deformed) => deformed,
            Err(reason) => return Ok(Err(Refusal { reason, is_over })),
        };
        let opened = match self.asked.opening {
            Some(opening) => opening.reopened(&deformed, (&found.firm, self.target), progress)?,
            None => Ok(deformed),
        };
        let deformed = match opened {
            Ok(deformed) => deformed,
            Err(reason) => return Ok(Err(Refusal { reason, is_over })),
        };
        let marks = (&deformed.mesh, &deformed.features[..]);
        Ok(Ok(FlowedPart {
            mirrored: self.doubled.as_ref().map(|_| Ok(())),
            n_missed: n_missed(&deformed.mesh, self.asked.bare(self.target)),
            lost: self.wanted.lost(marks, progress)?,
            deformed,
            sphere: self.sphere.clone(),
            crosses: crosses::some(self.even.mesh(), &found, self.asked.n_crosses()),
            flowed: Flowed::Used {
                attempt,
                n_attempts: 1,
                flow: found.report,
                cover: covered.report,
            },
        }))
    }

    /// Whether there are lines that have to be met.
    fn keeps_lines(&self) -> bool {
        self.is_solid() || self.asked.opening.is_some()
    }

    /// Whether all sharp edges are followed.
    fn is_solid(&self) -> bool {
        self.style.creases == flow::Creases::All
    }

    /// How much edges wish for one length; where somebody wants quads of other sizes, not at all.
    fn evenness(&self) -> f64 {
        match self.asked.density {
            None => self.asked.settings.style.evenness(),
            Some(_) => 0.0,
        }
    }

    /// The flow of the surface, laid on its sphere.
    fn find(
        &self,
        settings: &flow::Settings,
        progress: &Progress<'_>,
    ) -> Result<(flow::Flow, Covered), pipeline::Error> {
        let guides = flow::Guides {
            lines: &self.lines,
            marked: &self.marked,
            firm: self.border.as_ref(),
            mirror: self.doubled.as_ref(),
        };
        let found = flow::flow(&self.even, guides, settings, &progress.part("", 0.0, 0.95))?;
        let found = if settings.may_exceed {
            found.thinned(self.asked.n_quads)?
        } else {
            found
        };
        let covered = embed::cover(&found.mesh, &found.sphere, &progress.part("", 0.95, 1.0))?;
        Ok((found, covered))
    }
}
