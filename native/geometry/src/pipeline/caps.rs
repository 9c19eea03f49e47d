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

/// Of more lines than these some have none in any case, and rings do.
const MOST_LINES: usize = 8;

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
        let lacks = first.as_ref().map_or(true, |found| self.lacks_lines(found));
        if !can_have_tubes || !lacks || !has_few_lines(whole) {
            return first;
        }
        let n_first = first.as_ref().map_or(usize::MAX, n_lacking);
        let with_tubes = Self {
            has_tubes: true,
            ..*self
        };
        let part = progress.part("", share, 1.0);
        match with_tubes.run((whole.clone(), came), clock, &part) {
            Ok(found) if n_lacking(&found) < n_first => Ok(found),
            Err(error) if error.is_cancelled() => Err(error),
            _ => first,
        }
    }
}

impl Wanted<'_> {
    /// Whether quads do not lie along all borders, or do not flow, on a part that was not doubled. Of
    /// what was made solid all borders are cuts, and rings were asked for.
    fn lacks_lines(&self, found: &PartResult) -> bool {
        let way = found.report.opened.and_then(|opened| opened.way);
        way != Some(Closure::Doubled)
            && match &found.report.flow {
                Some(Flowed::Refused { .. }) => true,
                Some(flowed) => flowed.n_rings() > 0 && !self.settings.solid,
                None => false,
            }
    }
}

/// Whether a part has so few borders, with those of cuts, that all may be met.
fn has_few_lines(whole: &Whole) -> bool {
    let n_handles = whole.shape.genus.unwrap_or(0).max(0) as usize;
    2 * n_handles + whole.shape.n_borders <= MOST_LINES
}

/// How many lines are not met; of quads that do not flow none is.
fn n_lacking(found: &PartResult) -> usize {
    match &found.report.flow {
        Some(flowed @ Flowed::Used { .. }) => flowed.n_rings(),
        _ => usize::MAX,
    }
}
