//! What a surface wears before it is made flat: the field, the wish, the lines.

use std::f64::consts::PI;

use glam::DVec2;

use super::creases::{self, Line};
use super::field::{self, OrientationField};
use super::mirror::{Plan, plan, plane_edges, straighten};
use super::quads::{Error, Guides, Settings};
use super::singularities::tidy;
use super::wish::wish;
use crate::measure::{sharp_edges, total_area};
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, TriangleMesh};
use crate::mirror::Doubled;
use crate::progress::Progress;

/// What a surface wears before it is made flat.
pub(super) struct Dressed {
    pub field: OrientationField,
    pub wish: HalfedgeMap<DVec2>,
    /// The edges that quads should lie along but for those in the plane.
    pub sharp: HalfedgeMap<bool>,
    /// What to keep to; without lines if these are not clear.
    pub plan: Plan,
}

/// The field, its singularities tidied for quads of the wanted sizes, the wish, and the lines of
/// sharp edges if these are clear.
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
    let sharp = joined(&sharp_edges(mesh, sharp_angle), guides.marked);
    let along = match guides.mirror {
        Some(doubled) => joined(&sharp, &plane_edges(doubled)),
        None => sharp.clone(),
    };
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
    let h = (total_area(mesh) / settings.n_quads.max(1) as f64).sqrt();
    let is_sharp = |h: &HalfedgeId| sharp[*h];
    let all = creases::lines(mesh, &field, &along, h);
    let on_lines = all.iter().map(|line| line.length_of(mesh, is_sharp)).sum();
    let are_clear = creases::are_clear(mesh, &sharp, on_lines);
    if are_clear {
        creases::attract(mesh, &mut field, &sharp, sizes);
        mirror(&mut field);
    }
    let part = progress.part("", 0.5, 0.7);
    field::settle_along(mesh, &mut field, (&pull, &along), &part)?;
    mirror(&mut field);
    let wish = wish(mesh, &field, sizes, &progress.part("", 0.7, 1.0))?;
    let lines = if are_clear {
        creases::lines(mesh, &field, &along, h)
    } else {
        Vec::new()
    };
    Ok(Dressed {
        plan: planned(guides.mirror, &field, lines),
        field,
        wish,
        sharp,
    })
}

/// What to keep to with some lines of sharp edges.
pub(super) fn planned(
    mirror: Option<&Doubled>,
    field: &OrientationField,
    beside: Vec<Line>,
) -> Plan {
    match mirror {
        Some(doubled) => plan(doubled, field, &beside),
        None => Plan {
            plane: Vec::new(),
            beside,
            pairs: Vec::new(),
        },
    }
}

fn joined(a: &HalfedgeMap<bool>, b: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
    a.iter().zip(b).map(|(a, b)| a | b).collect()
}
