//! The even surface that quads flow on, and the settings that are tried on it.

use crate::deform::Target;
use crate::flow::{self, FirmEdges};
use crate::mesh::HalfedgeMap;
use crate::mirror::Doubled;
use crate::pipeline::attempt::{Attempt, Budget};
use crate::pipeline::clock::Clock;
use crate::pipeline::even::{Even, Marked};
use crate::pipeline::flow::Asked;
use crate::pipeline::flowed::{Flowed, FlowedPart, better};
use crate::pipeline::open::{Loose, Opening, Regions};
use crate::pipeline::rods;
use crate::pipeline::strokes::Finer;
use crate::progress::{Cancelled, Progress};
use crate::sphere;
use crate::sphere_map::SphereMap;

/// Of the marked edges this share may be lost before other settings are tried: short ones are.
const MOST_LOST: f64 = 0.1;

/// The share that the count of quads with rings may be off before they are made again.
const NEAR_COUNT: f64 = 0.015;

/// An even surface and what its quads are fitted to.
pub struct Ground<'a> {
    pub surface: Surface,
    pub sphere: sphere::Report,
    pub target: &'a Target,
    /// The marked edges of the target, and the strokes on it that have to be met.
    pub wanted: Marked,
    pub asked: Asked<'a>,
    pub style: flow::Settings,
    /// Whether strokes have to be met, or are as marked edges are.
    pub is_strict: bool,
    /// Where strokes want smaller quads.
    pub finer: Finer,
}

/// An even surface, with those of its edges that quads heed.
pub struct Surface {
    pub even: SphereMap,
    /// The edges that lie along the target's sharp or marked ones.
    pub lines: HalfedgeMap<bool>,
    /// Those that lie along marked ones.
    pub marked: HalfedgeMap<bool>,
    /// Those that lie along borders of a part that was closed.
    pub border: Option<FirmEdges>,
    /// The same with those along strokes that have to be met, where there are any.
    pub strokes: Option<Firm>,
    /// Those along strokes that the field alone turns to.
    pub turned: Option<HalfedgeMap<bool>>,
    /// Its pieces, where caps are to get rings whatever lines are met.
    pub regions: Option<Regions>,
    /// Whose image is whose, where the surface is its own image.
    pub doubled: Option<Doubled>,
}

/// Edges along strokes that have to be met.
pub struct Firm {
    /// They, and those along borders.
    pub edges: FirmEdges,
    /// They alone.
    pub exact: HalfedgeMap<bool>,
}

/// Why an attempt gave no quads.
pub struct Refusal {
    pub reason: String,
    /// Whether it had too many.
    pub is_over: bool,
}

impl Surface {
    /// An even surface, its edges along borders firm if it is one of a part that was closed.
    pub fn new(even: Even, (opening, target): (Option<&Opening>, &Target)) -> Self {
        let border = opening.zip(even.border);
        Self {
            regions: None,
            border: border.map(|(opening, is_on)| opening.firm(even.map.mesh(), is_on, target)),
            even: even.map,
            lines: even.lines,
            marked: even.marked,
            strokes: None,
            turned: None,
            doubled: None,
        }
    }

    /// One that is its own image, with the edges of this one.
    pub fn doubled(
        &self,
        (even, doubled): (SphereMap, Doubled),
        (opening, target): (Option<&Opening>, &Target),
    ) -> Self {
        let carried = |edges| doubled.carried(self.even.mesh(), edges);
        let border = opening.zip(self.border.as_ref());
        let border = border
            .map(|(opening, firm)| opening.firm(doubled.mesh(), carried(&firm.is_on), target));
        let exact = self.strokes.as_ref().map(|strokes| carried(&strokes.exact));
        let strokes = exact.and_then(|exact| Firm::new(doubled.mesh(), &exact, border.as_ref()));
        Self {
            lines: carried(&self.lines),
            marked: carried(&self.marked),
            strokes,
            turned: self.turned.as_ref().map(carried),
            border,
            even,
            regions: None,
            doubled: Some(doubled),
        }
    }

    /// The same with the pieces of a part some borders of which need no lines.
    #[must_use]
    pub fn loosened(mut self, (map, asked): (&SphereMap, Asked<'_>)) -> Self {
        let opening = asked.opening.filter(|_| asked.loose != Loose::Nothing);
        self.regions = opening.map(|opening| opening.regions(map, &self.even, asked.loose));
        self
    }

    /// What quads on it have to heed, with lines that have to be met.
    pub fn guides<'a>(&'a self, firm: Option<&'a FirmEdges>) -> flow::Guides<'a> {
        flow::Guides {
            lines: &self.lines,
            marked: &self.marked,
            firm,
            turned: self.turned.as_ref(),
            drawn: self.strokes.as_ref().map(|strokes| &strokes.exact),
            mirror: self.doubled.as_ref(),
        }
    }
}

impl Ground<'_> {
    /// The first of the attempts in which nothing fails, or the one in which least does of those that
    /// the budget has room for; one more is worth the marks that it may meet.
    pub fn best(
        &self,
        budget: &mut Budget,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, String>, Cancelled> {
        let mut best: Result<FlowedPart, String> = Err(String::new());
        let mut from = 0.0;
        for attempt in Attempt::ALL {
            let kept_back = self.kept_back(attempt, &best, budget);
            if !self.may_help(attempt, &best, budget) || !budget.take(attempt, kept_back) {
                continue;
            }
            let to = from + 0.6 * (1.0 - from);
            let found = self.attempt((attempt, 1.0), clock, &progress.part("", from, to))?;
            from = to;
            budget.is_over |= matches!(found, Err(Refusal { is_over: true, .. }));
            let found = found.map_err(|refusal| refusal.reason);
            best = better(best, found.and_then(FlowedPart::not_cut_off));
            let is_usual = attempt == Attempt::Usual;
            let is_failing = best.as_ref().map_or(true, |best| best.n_failed() > 0);
            let may_ring = self.asked.opening.is_none() && !self.asked.strokes.has_exact();
            if is_usual && is_failing && may_ring {
                best = better(best, self.rings(clock, &progress.part("", from, from))?);
            }
            // Lines may go where rings can be.
            if best.is_err() && self.is_bound_to_cuts() {
                break;
            }
            let is_done =
                |best: &FlowedPart| best.n_failed() == 0 && (best.lost <= MOST_LOST || !is_usual);
            if best.as_ref().is_ok_and(is_done) {
                break;
            }
        }
        match best {
            Ok(best) => Ok(Ok(self.counted(best, budget, clock, progress)?)),
            best => Ok(best),
        }
    }

    /// Quads with rings at borders, made again where their number is off: a ring is no line of a
    /// metric, and how many quads go inside it is not known before.
    fn counted(
        &self,
        best: FlowedPart,
        budget: &mut Budget,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<FlowedPart, Cancelled> {
        let (Flowed::Used { attempt, .. }, Some(opening)) = (&best.flowed, self.asked.opening)
        else {
            return Ok(best);
        };
        let off = |n: usize| (opening.n_asked as f64 / n.max(1) as f64 - 1.0).abs();
        let n = best.deformed.mesh.n_faces();
        if best.n_rings() == 0 || off(n) <= NEAR_COUNT || !budget.take(*attempt, 0) {
            return Ok(best);
        }
        let more = opening.n_asked as f64 / n as f64;
        let found = self.attempt((*attempt, more), clock, progress)?;
        Ok(match found {
            Ok(found)
                if found.n_failed() <= best.n_failed()
                    && off(found.deformed.mesh.n_faces()) < off(n) =>
            {
                found
            }
            _ => best,
        })
    }

    /// Whether an attempt may be better than the best so far.
    fn may_help(
        &self,
        attempt: Attempt,
        best: &Result<FlowedPart, String>,
        budget: &Budget,
    ) -> bool {
        // Where a solid's creases are not met other settings do not help.
        if self.is_solid() && attempt != Attempt::Usual {
            return false;
        }
        // Without strips nothing is its own image.
        let is_flowing = best.as_ref().is_ok_and(|best| !best.is_last_resort());
        // Nor do lines stay that have to be met.
        let is_bound = self.surface.doubled.is_some() || self.has_firm_lines();
        if attempt.is_last_resort() && (is_flowing || is_bound) {
            return false;
        }
        // Without too many quads there is nothing to take out.
        let has_room = attempt != Attempt::Thinned || budget.is_over;
        has_room && attempt.is_worth_trying(&self.style)
    }

    /// Rings, if the part is one limb from end to end.
    fn rings(
        &self,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<FlowedPart, String>, Cancelled> {
        let ground = (self.target, &self.wanted);
        rods::rings(&self.surface.even, ground, self.asked, (clock, progress))
    }

    /// The edges that have to be met: along borders, and along strokes unless these may be lost.
    pub fn firm(&self) -> Option<&FirmEdges> {
        let strokes = self.surface.strokes.as_ref().filter(|_| self.is_strict);
        strokes
            .map(|strokes| &strokes.edges)
            .or(self.surface.border.as_ref())
    }

    /// Whether there are any such edges.
    fn has_firm_lines(&self) -> bool {
        self.firm()
            .is_some_and(|firm| firm.is_on.iter().any(|&is_on| is_on))
    }

    /// Whether lines that have to be met may be given up later.
    pub fn is_bound_to_cuts(&self) -> bool {
        let opening = self.asked.opening;
        self.asked.loose == Loose::Nothing && opening.is_some_and(Opening::can_be_loose)
    }

    /// What of the budget an attempt leaves for what comes when no more settings are tried here.
    fn kept_back(
        &self,
        attempt: Attempt,
        best: &Result<FlowedPart, String>,
        budget: &Budget,
    ) -> usize {
        if attempt == Attempt::Usual || attempt.is_last_resort() {
            return 0;
        }
        let is_symmetric = self.surface.doubled.is_some();
        match best {
            // Quads with rings may have to be made again for their number.
            Ok(best) => usize::from((is_symmetric && best.n_missed > 0) || best.n_rings() > 0),
            // Strips are not taken out of quads with borders.
            Err(_) if self.has_firm_lines() => usize::from(is_symmetric),
            Err(_) => budget.kept_back(is_symmetric),
        }
    }

    /// Whether there are lines that have to be met.
    pub fn keeps_lines(&self) -> bool {
        self.is_solid() || self.has_firm()
    }

    /// Whether there are borders or strokes that have to be met.
    pub fn has_firm(&self) -> bool {
        self.asked.opening.is_some() || (self.is_strict && self.surface.strokes.is_some())
    }

    /// Whether all sharp edges are followed.
    pub fn is_solid(&self) -> bool {
        self.style.creases == flow::Creases::All
    }
}
