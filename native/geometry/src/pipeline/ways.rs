//! Which way the quads of a part are found: by rings, on a sheet made thick, along the edges of a
//! solid, or off the flat metric as it is.

use super::attempt::Budget;
use super::clock::Clock;
use super::even::{self, Marked};
use super::flow::{Asked, along};
use super::flowed::{FlowedPart, better};
use super::open::Opening;
use super::paired::told;
use super::rods;
use super::sheets::Thick;
use crate::deform::Target;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Makes flowing quads of a part; the text of an error is the reason to use something else.
///
/// A way of its own, for a rod, a sheet or a solid, comes first; where quads fail on it, what it
/// cost is no longer there for the usual one.
pub fn flow_part(
    map: &SphereMap,
    target: &Target,
    asked: Asked<'_>,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let mut budget = Budget::new(asked.n_quads);
    let part = progress.part("sphere", 0.0, 0.05);
    let thick = match asked.opening {
        Some(_) => None,
        None if !asked.strokes.is_empty() => None,
        None => clock.step("sphere", || Thick::new(map, target, asked, &part))?,
    };
    let mut from = 0.0;
    if let Some(thick) = thick {
        budget = budget.after(1, 0);
        let surface = (&thick.map, &thick.target);
        let part = progress.part("", 0.05, 0.6);
        let mut own = budget;
        if let Ok(found) = flowing(surface, asked, &mut own, clock, &part)? {
            let onto = (target, asked);
            let found = told(thick.thinned(found, onto, progress))?;
            if found.as_ref().is_ok_and(FlowedPart::is_sound) {
                return Ok(found);
            }
        }
        budget = budget.after(0, own.n_attempts);
        from = 0.6;
    } else if asked.opening.is_none() && asked.strokes.is_empty() && rods::are_clear(target) {
        let wanted = Marked::new(target.mesh(), asked.marked);
        let found = rods::rings(map, (target, &wanted), asked, (clock, &part))?;
        // Where rings cannot be their own image, quads off the metric may.
        let is_uneven = |found: &FlowedPart| matches!(found.mirrored, Some(Err(_)));
        let is_it = |found: &FlowedPart| found.is_sound() && !is_uneven(found);
        if found.as_ref().is_ok_and(is_it) {
            return Ok(found);
        }
        from = 0.05;
    }
    let part = progress.part("", from, 1.0);
    let surface = (map, target);
    // What was made solid has cuts alone: rings at them cost a third, and quads flow better round them.
    let mut first = None;
    if asked.settings.solid {
        match loosened(surface, asked, budget, (clock, &part))? {
            Some(found) if found.n_inverted() == 0 => return Ok(Ok(found)),
            found => first = found,
        }
    }
    let mut own = budget;
    let found = flowing(surface, asked, &mut own, clock, &part)?;
    if let Some(first) = first {
        return Ok(better(Ok(first), found));
    }
    if found.is_err() && !asked.settings.solid {
        let budget = budget.again(own.n_attempts);
        if let Some(found) = loosened(surface, asked, budget, (clock, &part))? {
            return Ok(Ok(found));
        }
    }
    Ok(found)
}

/// Quads of a closed part some lines of which are given up: most often one attempt, which mostly ends
/// before it costs much.
fn loosened(
    surface: (&SphereMap, &Target),
    asked: Asked<'_>,
    mut budget: Budget,
    (clock, progress): (&mut Clock, &Progress<'_>),
) -> Result<Option<FlowedPart>, Cancelled> {
    let ways = asked.opening.map_or(&[][..], Opening::ways_to_be_loose);
    for &loose in ways {
        let mut own = budget;
        let loosened = Asked { loose, ..asked };
        let found = along(surface, (loosened, &[]), &mut own, clock, progress)?;
        if let Ok(found) = found {
            return Ok(Some(found));
        }
        budget = budget.again(own.n_attempts);
    }
    Ok(None)
}

/// Quads off a flat metric: along all edges of a solid, if it is one, else the usual way.
fn flowing(
    surface: (&SphereMap, &Target),
    asked: Asked<'_>,
    budget: &mut Budget,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let (map, target) = surface;
    let style = asked.settings.flow(asked.n_quads);
    let border = asked.opening.map(|opening| &opening.small);
    let lines = even::solid(map.mesh(), style.sharp_angle, border);
    let is_bare = Marked::new(target.mesh(), asked.marked).is_empty() && asked.strokes.is_empty();
    let lines = lines.filter(|_| is_bare);
    let mut from = 0.0;
    if let Some(lines) = lines {
        from = 0.5;
        let mut own = *budget;
        let part = progress.part("", 0.0, from);
        let found = along(surface, (asked, &lines), &mut own, clock, &part)?;
        if let Ok(found) = found
            && found.n_failed() == 0
        {
            return Ok(Ok(found));
        }
        *budget = budget.after(1, own.n_attempts - budget.n_attempts);
    }
    let part = progress.part("", from, 1.0);
    along(surface, (asked, &[]), budget, clock, &part)
}
