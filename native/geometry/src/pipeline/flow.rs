//! Quads that flow: an even surface, its flow, a cover of the sphere, the fit.

mod drawn;
mod fit;
mod ground;

use super::attempt::Budget;
use super::clock::Clock;
use super::even::{For, Marked, even};
use super::flowed::{FlowedPart, better};
use super::open::{Loose, Opening};
use super::paired::told;
use super::strokes::{Finer, OnPart};
use super::{Error, Settings, mirror};
use crate::deform::Target;
use crate::flow;
use crate::measure::{FeatureLine, total_area};
use crate::mesh::{HalfedgeMap, VertexMap};
use crate::mirror::Doubled;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;
use ground::{Ground, Surface};

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
    /// The strokes that somebody drew on it.
    pub strokes: OnPart<'a>,
    /// Which of its borders need no lines.
    pub loose: Loose,
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
    let part = progress.part("sphere", 0.0, 0.15);
    let ground = clock.step("sphere", || ground((map, target), (asked, lines), &part))?;
    let mut ground = match ground {
        Ok(ground) => ground,
        Err(reason) => return Ok(Err(reason)),
    };
    let sheet = asked.opening.filter(|opening| opening.is_sheet());
    let symmetry = match (sheet, asked.axis) {
        (Some(sheet), _) => Some(Symmetry::OtherSide(sheet)),
        (None, Some(axis)) => Some(Symmetry::Plane(axis)),
        (None, None) => None,
    };
    let split = if ground.is_strict { 0.6 } else { 1.0 };
    let part = progress.part("", 0.15, split);
    let mut found = found((&mut ground, symmetry), budget, clock, &part)?;
    if ground.is_strict && found.as_ref().map_or(true, |found| !found.is_sound()) {
        // Lines that need not be met leave more ways out.
        ground.is_strict = false;
        let mut own = budget.after(0, 0);
        let part = progress.part("", split, 1.0);
        let softer = self::found((&mut ground, symmetry), &mut own, clock, &part)?;
        budget.n_attempts = own.n_attempts;
        found = better(found, softer);
    }
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

/// Quads on an even surface, of one side alone where they are to be symmetric.
fn found(
    (ground, symmetry): (&mut Ground<'_>, Option<Symmetry<'_>>),
    budget: &mut Budget,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    match symmetry {
        Some(symmetry) => symmetric((ground, symmetry), budget, clock, progress),
        None => ground.best(budget, clock, progress),
    }
}

/// An even surface for quads along some lines; the text of the inner error is why there is none.
fn ground<'a>(
    (map, target): (&SphereMap, &'a Target),
    (asked, lines): (Asked<'a>, &[FeatureLine]),
    progress: &Progress<'_>,
) -> Result<Result<Ground<'a>, String>, Cancelled> {
    let wanted = Marked::new(target.mesh(), asked.marked);
    let mut style = asked.settings.flow(asked.n_quads);
    if !wanted.is_empty() || !asked.strokes.is_empty() {
        style.field.alignment *= BESIDE_MARKS;
    }
    if !lines.is_empty() {
        style.creases = flow::Creases::All;
    }
    let borders = asked.opening.map(|opening| opening.firm_lines(asked.loose));
    let borders = borders.unwrap_or_default();
    let edge = (total_area(target.mesh()) / asked.n_quads.max(1) as f64).sqrt();
    let finer = Finer::new(asked.strokes, edge);
    let quads = For {
        n_quads: asked.n_quads,
        sizes: &style.sizes,
        seed: asked.settings.seed,
        lines: if lines.is_empty() { &borders } else { lines },
        is_solid: !lines.is_empty(),
        opening: asked.opening,
        finer: &finer,
    };
    let even = match told(even(map, (target, &wanted), &quads, progress))? {
        Ok(even) => even,
        Err(reason) => return Ok(Err(reason)),
    };
    let sphere = even.sphere.clone();
    let surface = Surface::new(even, (asked.opening, target));
    let surface = surface.drawn((asked, target, edge), progress)?;
    let surface = surface.loosened((map, asked));
    let exact = surface.strokes.as_ref().map(|strokes| &strokes.exact);
    let exact = exact.map(|exact| Marked::new(surface.even.mesh(), exact));
    Ok(Ok(Ground {
        wanted: wanted.and(exact),
        is_strict: surface.strokes.is_some(),
        finer,
        sphere,
        surface,
        target,
        asked,
        style,
    }))
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
    (ground, symmetry): (&mut Ground<'_>, Symmetry<'_>),
    budget: &mut Budget,
    clock: &mut Clock,
    progress: &Progress<'_>,
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let part = progress.part("sphere", 0.0, 0.05);
    let found = clock.step("sphere", || told(own_image(ground, symmetry, &part)))?;
    let mut symmetric = None;
    let reason = match found.flatten() {
        Ok((even, doubled)) => {
            let own = ground
                .surface
                .doubled((even, doubled), (ground.asked.opening, ground.target));
            let usual = std::mem::replace(&mut ground.surface, own);
            let best = ground.best(budget, clock, &progress.part("", 0.05, 0.6))?;
            ground.surface = usual;
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

/// The even surface made its own image; the text of the inner error is why that cannot be.
fn own_image(
    ground: &Ground<'_>,
    symmetry: Symmetry<'_>,
    progress: &Progress<'_>,
) -> Result<Result<(SphereMap, Doubled), String>, Error> {
    let surface = &ground.surface;
    match (symmetry, &surface.border) {
        (Symmetry::OtherSide(sheet), Some(border)) => {
            sheet.doubled((&surface.even, &border.is_on), ground.target, progress)
        }
        (Symmetry::OtherSide(_), None) => Ok(Err("it has no borders".to_owned())),
        (Symmetry::Plane(axis), _) => {
            let has_strokes = !ground.asked.strokes.is_empty();
            let keeps = ground.keeps_lines() || has_strokes;
            let lines = keeps.then_some(&surface.lines);
            mirror::symmetric((&surface.even, lines), axis, progress)
        }
    }
}
