//! What is asked for about the parts of a mesh, and what is told of those that were not remeshed.

use clap::Args;
use orbflow_geometry::pipeline::{
    Borders, Flaw, Handles, Inner, Kept, Outcome, PartReport, Reason, SOLID_DETAIL, Settings,
    SmallParts, Solid,
};

use crate::parsers::{borders, handles, inner, percent, small_parts, solid_detail, weld};
use crate::place::Place;

/// The most lines about single parts.
const MOST_LINES: usize = 20;

/// What becomes of parts that are small, open or cannot be done.
#[derive(Args, Clone, Copy, Debug)]
pub struct OfParts {
    /// What becomes of parts that are too small: they stay as they were, or go
    #[arg(long, default_value = SmallParts::default().name(), value_parser = small_parts())]
    pub small_parts: SmallParts,
    /// Parts that measure less than so many percent of the mesh's diagonal are small; at 0 only
    /// those whose share of the faces is too few to close them
    #[arg(long, value_name = "PERCENT", default_value_t = Settings::default().small_size, value_parser = percent)]
    pub small_size: f64,
    /// What becomes of borders: they stay as lines of edges of the result, or are filled, all of them
    /// or those no longer than so many percent of the mesh's diagonal, 1000 at most
    #[arg(long, value_name = "keep|fill|fill:SIZE", default_value = "keep", value_parser = borders)]
    pub borders: Borders,
    /// What becomes of handles: they stay, or those are closed for good round which a tight loop is no
    /// longer than SIZE % of the mesh's diagonal, from 0 to 1000, as of noise in scans
    #[arg(long, value_name = "keep|seal:SIZE", default_value = "keep", value_parser = handles)]
    pub handles: Handles,
    #[command(flatten)]
    pub shells: OfShells,
    /// Weld borders that lie on each other up to a gap of this share of the mesh's diagonal, 0.01 at
    /// most; off: weld equal points alone
    #[arg(long, value_name = "D|off", default_value = "1e-5", value_parser = weld)]
    pub weld: Weld,
    /// End with 3 where a part cannot be done, instead of leaving it as it was, and where a warning
    /// of the result is grave: inverted quads, crossing faces, a surface that is far off
    #[arg(long)]
    pub strict: bool,
}

/// What becomes of shells that intersect or lie in each other.
#[derive(Args, Clone, Copy, Debug)]
pub struct OfShells {
    /// Make everything one closed surface first: shells that intersect, double walls, cavities and
    /// open scraps
    #[arg(long)]
    pub solid: bool,
    /// With --solid, the size of the cells of the grid that does it, in percent of the mesh's
    /// diagonal, 0.02 to 5: thinner walls and gaps are lost
    #[arg(long, value_name = "PERCENT", default_value_t = SOLID_DETAIL, value_parser = solid_detail)]
    pub solid_detail: f64,
    /// What becomes of closed parts that lie wholly inside another: they are parts like others, or go
    #[arg(long, default_value = Inner::default().name(), value_parser = inner())]
    pub inner: Inner,
}

/// A weld distance; none welds equal points alone.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Weld(pub Option<f64>);

impl OfParts {
    /// Settings with what is asked for here.
    pub fn asked(&self, settings: &Settings) -> Settings {
        Settings {
            small_parts: self.small_parts,
            small_size: self.small_size,
            borders: self.borders,
            handles: self.handles,
            solid: self.shells.solid,
            solid_detail: self.shells.solid_detail,
            inner: self.shells.inner,
            weld: self.weld.0,
            strict: self.strict,
            ..settings.clone()
        }
    }
}

/// Says on standard error which parts were not remeshed, where they are and why.
pub fn tell(place: &Place, kept: &[Kept]) {
    for line in lines(kept, "left as before") {
        eprintln!("{place}: {line}");
    }
}

/// Says on standard error how many borders were filled, if any.
pub fn tell_filled(place: &Place, parts: &[PartReport]) {
    let opened = parts.iter().filter_map(|part| part.opened);
    let n_filled = opened.map(|opened| opened.n_filled).sum();
    if n_filled > 0 {
        eprintln!("{place}: {} filled", count(n_filled, "border"));
    }
}

/// Says on standard error how many handles were sealed, if any.
pub fn tell_sealed(place: &Place, parts: &[PartReport]) {
    let opened = parts.iter().filter_map(|part| part.opened);
    let n_sealed = opened.map(|opened| opened.n_sealed).sum();
    if n_sealed > 0 {
        eprintln!("{place}: {} sealed", count(n_sealed, "handle"));
    }
}

/// Says on standard error what became of the shells that were made one surface.
pub fn tell_solid(place: &Place, solid: &Solid) {
    eprintln!("{place}: {}", solid.text());
}

/// A line for each reason of parts that cannot be done, and one for all that are small.
pub fn lines(kept: &[Kept], what: &str) -> Vec<String> {
    let (bad, others): (Vec<_>, Vec<_>) = kept.iter().partition(|kept| kept.is_bad());
    let (inner, small): (Vec<_>, Vec<_>) = others.into_iter().partition(|kept| kept.is_inner());
    let reasons = bad.iter().flat_map(|kept| {
        kept.reasons.iter().map(|reason| {
            let [x, y, z] = reason.place.map(rounded);
            let (part, faces) = (kept.part + 1, count(kept.n_faces, "face"));
            format!("part {part} ({faces}): {}, at ({x}, {y}, {z})", reason.text)
        })
    });
    let mut lines: Vec<String> = reasons.collect();
    if lines.len() > MOST_LINES {
        let more = lines.len() - MOST_LINES;
        lines.truncate(MOST_LINES);
        lines.push(format!("and {} more", count(more, "reason")));
    }
    if !bad.is_empty() {
        let faces: usize = bad.iter().map(|kept| kept.n_faces).sum();
        let [parts, faces] = [count(bad.len(), "part"), count(faces, "face")];
        lines.push(format!("{parts} with {faces} cannot be done: {what}"));
    }
    lines.extend(told_of_small(&small));
    if !inner.is_empty() {
        let faces: usize = inner.iter().map(|kept| kept.n_faces).sum();
        let [parts, faces] = [count(inner.len(), "part"), count(faces, "face")];
        lines.push(format!("{parts} with {faces} inside others: dropped"));
    }
    lines
}

fn told_of_small(small: &[&Kept]) -> Option<String> {
    let first = small.first()?;
    let is_size = |reason: &&Reason| matches!(reason.flaw, Flaw::Small { .. });
    let why = first.reasons.iter().find(is_size)?;
    let faces: usize = small.iter().map(|kept| kept.n_faces).sum();
    let [parts, faces] = [count(small.len(), "part"), count(faces, "face")];
    let what = match first.outcome {
        Outcome::Kept => "kept as they were",
        Outcome::Dropped => "dropped",
    };
    let why = &why.text;
    Some(format!(
        "{parts} with {faces} too small: {what}; the first: {why}"
    ))
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// A coordinate with six digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
