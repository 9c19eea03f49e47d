//! Rods: parts that are one limb from end to end, as poles, wires, springs and cables are.
//!
//! A field of crosses and a flat metric ask for a surface whose triangles show its width; a wire
//! five hundred times as long as thick has none. It needs none either: a *height* that is
//! harmonic but for the two ends has no saddle, so each of its levels is one closed line round the
//! rod.
//!
//! ```text
//! triangles ─▶ height ─▶ sections, sharp lines ─▶ how many round, which levels ─▶ rings, ends
//!   fine       height     section     lines                  plan                 rings  ball
//! ```
//!
//! Rings of vertices lie on sections, a rectangle of quads closes each end: eight irregular
//! vertices, the fewest there can be. Sharp lines along the rod and round it get edges. Where the
//! count is too short for squares, quads are long rather than few round. On the sphere rings are
//! circles of latitude: what covers the sphere once is closed and whole.
//!
//! Not done here: rods that branch, and knobs on rods, which rings do not show.

mod ball;
mod fine;
mod height;
mod lines;
mod plan;
mod rings;
mod section;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use glam::DVec3;
use thiserror::Error;

use super::strips;
use crate::measure::{total_area, volume};
use crate::mesh::{HalfedgeMap, PolygonMesh, PolygonMeshError, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use ball::Ball;
use fine::Fine;
use height::Height;
use lines::Lines;
use plan::{Plan, Wishes};
use rings::Rings;
use section::{Levels, Profile, Section};

/// Shorter parts, in girths, are no rods.
pub const LEAST_GIRTHS: f64 = 2.0;
/// Triangles round a rod, where there is no line that asks for more.
const AROUND: f64 = 10.0;
/// And at least.
const LEAST_AROUND: f64 = 4.0;
/// The most triangles that a rod is cut into, about.
const MOST_TRIANGLES: f64 = 60_000.0;
/// No girth is larger than so many times the middle one: else it is a branch or a knob.
const MOST_GIRTH: f64 = 2.5;
/// The middle girth is no larger than this many times that of a round rod of the same area and
/// volume: a flat strip of 1 : 4 has 2.
const FLAT: f64 = 2.6;

/// What to make.
pub struct Settings<'a> {
    /// How many quads.
    pub n_quads: usize,
    /// How much closer rings are where the rod bends, 0 for not at all.
    pub adaptivity: f64,
    /// How many quads an area wants at a place, relative to others.
    pub weight: &'a dyn Fn(DVec3) -> f64,
    /// The axis across the plane of symmetry through the origin, where the rod has one.
    pub mirror: Option<usize>,
}

/// Quads round a rod.
#[derive(Clone, PartialEq, Debug)]
pub struct Rod {
    /// The quads, on the surface.
    pub mesh: PolygonMesh,
    /// The point of each vertex on the sphere.
    pub sphere: Vec<DVec3>,
    /// The edges that lie on sharp lines, each once, in order.
    pub on_lines: Vec<[VertexId; 2]>,
    /// How the quads run.
    pub strips: strips::Strips,
    /// How long the rod is, in girths.
    pub n_girths: f64,
    /// How many quads go round.
    pub n_round: usize,
    /// How many vertices lie on rings; the others are those of the ends.
    pub n_on_rings: usize,
    /// How many sharp lines there are, and how many of them have edges.
    pub n_lines: [usize; 2],
}

/// Why a part got no rings.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum RodError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It is too short for its thickness.
    #[error("it is {n_girths:.1} girths long; rods have {LEAST_GIRTHS} or more")]
    Short {
        /// How long it is.
        n_girths: f64,
    },
    /// It branches, or is flat, or too thin for any number.
    #[error("it is no single limb from end to end")]
    NoLimb,
    /// There are too few quads for two rings.
    #[error("{n_quads} quads are too few for rings")]
    TooFew {
        /// How many there are.
        n_quads: usize,
    },
    /// Rings that make no mesh.
    #[error("the rings are no mesh: {0}")]
    Mesh(#[from] PolygonMeshError),
}

/// How long a part would be in girths if it were a round rod of its area and volume; 0.7 for a
/// ball.
pub fn n_girths(mesh: &TriangleMesh) -> f64 {
    let [area, volume] = [total_area(mesh), volume(mesh)];
    area.powi(3) / (4.0 * PI * volume).powi(2)
}

/// Makes rings of quads round a closed surface of genus 0 that is one limb from end to end.
///
/// `sharp` are the edges that edges of quads are to lie on. The number of quads differs by half a
/// ring at most. Costs one factorisation of some 10,000 rows and a walk round every ring.
///
/// # Errors
/// [`enum@RodError`].
pub fn rod(
    mesh: &TriangleMesh,
    sharp: &HalfedgeMap<bool>,
    settings: &Settings<'_>,
    progress: &Progress,
) -> Result<Rod, RodError> {
    let long = n_girths(mesh);
    if long < LEAST_GIRTHS || !long.is_finite() {
        return Err(RodError::Short { n_girths: long });
    }
    let area = total_area(mesh);
    let girth = (area / long).sqrt();
    let longest = (girth / AROUND).max((4.0 * area / MOST_TRIANGLES).sqrt());
    if longest > girth / LEAST_AROUND {
        return Err(RodError::NoLimb);
    }
    progress.at(0.0)?;
    let fine = Fine::new(mesh, sharp, longest).ok_or(RodError::NoLimb)?;
    progress.at(0.3)?;
    let height = Height::new(&fine.mesh, girth).ok_or(RodError::NoLimb)?;
    progress.at(0.6)?;
    around(&fine, &height, girth, settings, progress)
}

/// Rings on the levels of a height.
fn around(
    fine: &Fine,
    height: &Height,
    girth: f64,
    settings: &Settings<'_>,
    progress: &Progress,
) -> Result<Rod, RodError> {
    let levels = Levels {
        mesh: &fine.mesh,
        height,
    };
    let profile = Profile::new(&levels, girth).ok_or(RodError::NoLimb)?;
    let middle = profile.median_girth();
    if middle > FLAT * girth || profile.most_girth() > MOST_GIRTH * middle {
        return Err(RodError::NoLimb);
    }
    progress.at(0.7)?;
    let lines = Lines::new(fine, height.ends, &height.of, &profile);
    let crossed = crossed(&levels, &profile, &lines);
    let wishes = Wishes {
        n_quads: settings.n_quads,
        adaptivity: settings.adaptivity,
        weight: settings.weight,
    };
    let n_quads = settings.n_quads;
    let plan = Plan::new(&profile, &lines, crossed.as_ref(), &wishes);
    let plan = plan.ok_or(RodError::TooFew { n_quads })?;
    progress.at(0.8)?;
    let order: Vec<usize> = crossed
        .iter()
        .flat_map(|s| &s.crossed)
        .map(|c| c.0)
        .collect();
    let rings = Rings {
        levels: &levels,
        profile: &profile,
        lines: &lines,
        plan: &plan,
        order: &order,
        mirror: settings.mirror,
    };
    let rings = rings.all().ok_or(RodError::NoLimb)?;
    let tips = height.ends.map(|end| fine.mesh.position(end));
    let ball = Ball::new(&rings, plan.cap, tips, settings.mirror);
    let strips = strips::strips(&ball.quads, ball.positions.len()).unwrap_or_default();
    let n_round_met = plan
        .stops
        .iter()
        .filter(|stop| stop.round.is_some())
        .count();
    Ok(Rod {
        mesh: PolygonMesh::from_faces(ball.positions, &ball.quads)?,
        sphere: ball.sphere,
        on_lines: ball.on_lines,
        strips,
        n_girths: profile.length() / middle,
        n_round: plan.n_round,
        n_on_rings: plan.n_round * plan.stops.len(),
        n_lines: [
            lines.n_along() + lines.round.len(),
            order.len() + n_round_met,
        ],
    })
}

/// A section half way along the rod which all lines along it cross once, anticlockwise seen from
/// the far end; none where there are no lines.
fn crossed(levels: &Levels<'_>, profile: &Profile, lines: &Lines) -> Option<Section> {
    let n = lines.n_along();
    let shares = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8];
    let section = shares.into_iter().find_map(|share| {
        let along = share * profile.length();
        let section = levels.section(profile.level(along), |h| lines.along[h])?;
        let way = profile.direction(along, 0.5 * profile.median_girth());
        let mut section = if section.area().dot(way) < 0.0 {
            section.turned()
        } else {
            section
        };
        section.crossed.sort_unstable_by_key(|c| c.1);
        let mut seen: Vec<usize> = section.crossed.iter().map(|c| c.0).collect();
        seen.sort_unstable();
        seen.iter().copied().eq(0..n).then_some(section)
    })?;
    (n > 0).then_some(section)
}
