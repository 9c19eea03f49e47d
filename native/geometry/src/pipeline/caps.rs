//! Open parts twice: with flush caps, and with caps at the end of tubes where quads do not flow else.

use super::Error;
use super::borders::Closure;
use super::clock::Clock;
use super::flowed::Flowed;
use super::mapless::Came;
use super::open::Whole;
use super::part::{PartResult, Wanted};
use super::settings::Primitive;
use crate::progress::Progress;

impl Wanted<'_> {
    /// Makes the faces of an open part.
    ///
    /// # Errors
    /// Any of the steps'.
    pub(super) fn run_open(
        &self,
        (whole, came): (&Whole, Came),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        let can_have_tubes = self.settings.primitive() == Primitive::Flow;
        let share = if can_have_tubes { 0.9 } else { 1.0 };
        let first = self.run((whole.clone(), came), clock, &progress.part("", 0.0, share));
        if !can_have_tubes || !first.as_ref().map_or(true, is_stuck) {
            return first;
        }
        let with_tubes = Self {
            has_tubes: true,
            ..*self
        };
        let part = progress.part("", share, 1.0);
        match with_tubes.run((whole.clone(), came), clock, &part) {
            Ok(found) if !is_stuck(&found) => Ok(found),
            Err(error) if error.is_cancelled() => Err(error),
            _ => first,
        }
    }
}

/// Whether quads were to flow and do not, on a part that was not doubled.
fn is_stuck(found: &PartResult) -> bool {
    let way = found.report.opened.and_then(|opened| opened.way);
    way != Some(Closure::Doubled) && matches!(found.report.flow, Some(Flowed::Refused { .. }))
}
