//! What a surface wears before it is made flat: the field, the wish, the lines.

use std::f64::consts::PI;

use glam::DVec2;

use super::creases::{self, Line, Network};
use super::field::{self, OrientationField};
use super::mirror::{Plan, plan, plane_edges, straighten};
use super::quads::{Error, Guides};
use super::settings::{Creases, Settings};
use super::singularities::tidy;
use super::wish::wish;
use crate::measure::{sharp_edges, total_area};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh};
use crate::mirror::Doubled;
use crate::progress::Progress;

/// What a surface wears before it is made flat.
pub(super) struct Dressed {
    pub field: OrientationField,
    pub wish: HalfedgeMap<DVec2>,
    /// The edges that quads should lie along but for marked ones and those in the plane.
    sharp: HalfedgeMap<bool>,
    /// What to keep to: of a solid all lines; else all, if the sharp ones are clear; those of marked edges alone, if
    /// there are any; no lines.
    pub plans: Vec<Plan>,
}

impl Dressed {
    /// Whether those lines of a plan that are met hold enough of the sharp edges, if it has any.
    pub fn are_met(&self, mesh: &TriangleMesh, plan: &Plan, is_met: &[bool]) -> bool {
        let length = |line: &Line| line.length_of(mesh, |h| self.sharp[*h]);
        let lines = plan.lines().zip(is_met).filter(|(_, is_met)| **is_met);
        let on_lines = lines.map(|(line, _)| length(line)).sum();
        let has_sharp = plan.beside.iter().any(|line| length(line) > 0.0);
        !has_sharp || creases::are_clear(mesh, &self.sharp, on_lines)
    }
}

/// The field, its singularities tidied for quads of the wanted sizes, the wish, and the lines of
/// marked edges and of sharp ones if these are clear.
pub(super) fn dress(
    mesh: &TriangleMesh,
    (guides, sizes): (Guides<'_>, &FaceMap<f64>),
    settings: &Settings,
    progress: &Progress,
) -> Result<Dressed, Error> {
    let sharp_angle = settings.sharp_angle.unwrap_or(f64::INFINITY);
    let pull = field::Settings {
        sharp_angle: sharp_angle.min(PI),
        ..settings.field
    };
    let plane = |lines: &HalfedgeMap<bool>| match guides.mirror {
        Some(doubled) => either(lines, &plane_edges(doubled)),
        None => lines.clone(),
    };
    let all = lines(mesh, guides, (settings.creases, sharp_angle));
    let along = plane(&all);
    let both = all.iter().zip(guides.marked);
    let sharp: HalfedgeMap<bool> = both
        .map(|(&is_line, &is_marked)| is_line && !is_marked)
        .collect();
    let part = progress.part("", 0.0, 0.5);
    let mut field = field::orient_along(mesh, (&pull, &along), &part)?;
    let mirror = |field: &mut OrientationField| {
        if let Some(doubled) = guides.mirror {
            straighten(field, doubled, sizes);
        }
    };
    mirror(&mut field);
    tidy(mesh, &mut field, sizes);
    mirror(&mut field);
    let is_solid = settings.creases == Creases::All;
    let network = is_solid.then(|| network(mesh, (&all, &along), guides));
    let network = network.transpose()?;
    let h = (total_area(mesh) / settings.n_quads.max(1) as f64).sqrt();
    let lines = creases::lines(mesh, &field, &along, h).into_iter();
    let on_lines = lines.map(|line| line.length_of(mesh, |h| sharp[*h])).sum();
    let mut kept = vec![guides.marked];
    if creases::are_clear(mesh, &sharp, on_lines) {
        kept.insert(0, &all);
    }
    match &network {
        Some(network) => network.settle(&mut field),
        None => creases::attract(mesh, &mut field, kept[0], sizes),
    }
    mirror(&mut field);
    let part = progress.part("", 0.5, 0.7);
    field::settle_along(mesh, &mut field, (&pull, &along), &part)?;
    mirror(&mut field);
    let wish = wish(mesh, &field, sizes, &progress.part("", 0.7, 1.0))?;
    let plan = |lines| planned(guides.mirror, &field, lines);
    let plans = if network.is_some() {
        vec![plan(creases::whole_lines(mesh, &field, &along, h)).firm()]
    } else {
        let kept = kept.into_iter().filter(|kept| kept.iter().any(|&is| is));
        let lines = kept.map(|kept| creases::lines(mesh, &field, &plane(kept), h));
        lines.chain([Vec::new()]).map(plan).collect()
    };
    Ok(Dressed {
        field,
        wish,
        sharp,
        plans,
    })
}

/// The edges that quads should lie along.
fn lines(
    mesh: &TriangleMesh,
    guides: Guides<'_>,
    (creases, sharp_angle): (Creases, f64),
) -> HalfedgeMap<bool> {
    match creases {
        Creases::All => guides.lines.clone(),
        Creases::Long => either(&sharp_edges(mesh, sharp_angle), guides.lines),
    }
}

/// The network of all lines, and of the edges in the plane where there is one.
fn network<'a>(
    mesh: &'a TriangleMesh,
    (all, along): (&HalfedgeMap<bool>, &'a HalfedgeMap<bool>),
    guides: Guides<'a>,
) -> Result<Network<'a>, Error> {
    let has_lines = all.iter().any(|&is_line| is_line);
    let network = has_lines.then(|| Network::new(mesh, along, guides.mirror));
    network.flatten().ok_or(Error::NoSolid)
}

/// What to keep to with some lines of sharp edges.
fn planned(mirror: Option<&Doubled>, field: &OrientationField, beside: Vec<Line>) -> Plan {
    match mirror {
        Some(doubled) => plan(doubled, field, &beside),
        None => Plan {
            plane: Vec::new(),
            beside,
            pairs: Vec::new(),
            is_firm: false,
        },
    }
}

fn either(a: &HalfedgeMap<bool>, b: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
    a.iter().zip(b).map(|(a, b)| a | b).collect()
}
