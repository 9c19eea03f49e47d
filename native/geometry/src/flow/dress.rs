//! What a surface wears before it is made flat: the field, the wish, the lines.

use std::f64::consts::PI;

use glam::DVec2;

use super::creases::{self, Line, Network, Sharp};
use super::error::Error;
use super::field::{self, OrientationField};
use super::guides::{FirmEdges, Guides};
use super::mirror::{Plan, plan, plane_edges, straighten};
use super::settings::{Creases, Settings};
use super::singularities::tidy;
use super::wish::wish;
use crate::measure::{sharp_edges, total_area};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh};
use crate::progress::Progress;

/// What a surface wears before it is made flat.
pub(super) struct Dressed {
    pub field: OrientationField,
    pub wish: HalfedgeMap<DVec2>,
    /// The edges that quads should lie along but for marked ones and those in the plane.
    sharp: HalfedgeMap<bool>,
    /// What to keep to: of a solid all lines; else all, if the sharp ones are clear; those of marked
    /// edges alone, if there are any; those alone that have to be met.
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
    let is_firm = |h| guides.firm.is_some_and(|firm| firm.is_on[h]);
    let sharp: HalfedgeMap<bool> = mesh
        .halfedge_ids()
        .map(|h| all[h] && !guides.marked[h] && !is_firm(h))
        .collect();
    let firm = match settings.creases {
        Creases::All => Some(all.clone()),
        Creases::Long => guides.firm.map(|firm| firm.is_on.clone()),
    };
    let held = firm.as_ref().map(plane);
    let known = guides.firm;
    let sharp_of = |edges| Sharp { edges, firm: known };
    let network = match (&firm, &held) {
        (Some(firm), Some(held)) if firm.iter().any(|&is_firm| is_firm) => {
            Some(Network::new(mesh, sharp_of(held), guides.mirror).ok_or(Error::NoSolid)?)
        }
        (Some(_), _) if settings.creases == Creases::All => return Err(Error::NoSolid),
        _ => None,
    };
    let part = progress.part("", 0.0, 0.5);
    let mut field = field::orient_along(mesh, (&pull, &along), &part)?;
    let corners = network
        .as_ref()
        .filter(|_| settings.creases == Creases::Long);
    let mirror = |field: &mut OrientationField| {
        if let Some(doubled) = guides.mirror {
            straighten(field, doubled, (sizes, corners));
        }
    };
    mirror(&mut field);
    tidy(mesh, &mut field, sizes);
    mirror(&mut field);
    let h = (total_area(mesh) / settings.n_quads.max(1) as f64).sqrt();
    let lines = creases::lines(mesh, &field, sharp_of(&along), h).into_iter();
    let on_lines = lines.map(|line| line.length_of(mesh, |h| sharp[*h])).sum();
    let mut kept = vec![guides.marked];
    if creases::are_clear(mesh, &sharp, on_lines) {
        kept.insert(0, &all);
    }
    if settings.creases == Creases::Long {
        creases::attract(mesh, &mut field, sharp_of(kept[0]), sizes);
    }
    if let Some(network) = &network {
        network.settle(&mut field);
        if settings.creases == Creases::Long {
            network.clear(&mut field, sizes);
        }
    }
    mirror(&mut field);
    let part = progress.part("", 0.5, 0.7);
    field::settle_along(mesh, &mut field, (&pull, &along), &part)?;
    mirror(&mut field);
    let wish = wish(mesh, &field, sizes, &progress.part("", 0.7, 1.0))?;
    let plan = |lines| planned(guides, &field, lines);
    let plans = if settings.creases == Creases::All {
        vec![plan(creases::whole_lines(mesh, &field, sharp_of(&along), h)).firm()]
    } else {
        let kept = kept.into_iter().filter(|kept| kept.iter().any(|&is| is));
        let lines = kept.map(|kept| lines_of((mesh, &field), (&plane(kept), known), h));
        let none = held
            .as_ref()
            .map(|held| lines_of((mesh, &field), (held, known), h));
        lines.chain([none.unwrap_or_default()]).map(plan).collect()
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

/// Lines along some edges, of which those that have to be met are taken whole.
fn lines_of(
    (mesh, field): (&TriangleMesh, &OrientationField),
    (along, firm): (&HalfedgeMap<bool>, Option<&FirmEdges>),
    h: f64,
) -> Vec<Line> {
    let Some(known) = firm else {
        let edges = along;
        return creases::lines(mesh, field, Sharp { edges, firm }, h);
    };
    let edges = &either(along, &known.is_on);
    let sharp = Sharp { edges, firm };
    let whole = creases::whole_lines(mesh, field, sharp, h);
    let mut lines = creases::firm_lines(whole, &known.is_on);
    lines.extend(creases::lines_beside(&lines, (mesh, field, sharp), h));
    lines
}

/// What to keep to with some lines of sharp edges.
fn planned(guides: Guides<'_>, field: &OrientationField, beside: Vec<Line>) -> Plan {
    match guides.mirror {
        Some(doubled) => {
            let firm = guides.firm.map(|firm| &firm.is_on);
            plan((doubled, firm), field, &beside)
        }
        None => Plan {
            plane: Vec::new(),
            beside,
            pairs: Vec::new(),
        },
    }
}

fn either(a: &HalfedgeMap<bool>, b: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
    a.iter().zip(b).map(|(a, b)| a | b).collect()
}
