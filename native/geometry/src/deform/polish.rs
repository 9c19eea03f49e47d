//! Quads that no field leads: they stay where their vertices are, and bad ones are mended.
//!
//! Pairs of triangles are rhombs and kites, long ones on wires, and would lose their shape if they
//! slid to even sizes. So corners of bad quads alone go where their quads are better, vertex by vertex,
//! in space, while all else keeps what the surface gave it.

use glam::DVec3;

use super::project::project;
use super::separate::separate;
use super::sheet::{Face, Point, Sheet};
use super::skin::{normals, triangles};
use super::squares::spoke;
use super::straddle::Fit;
use super::target::Target;
use super::untangle::{corners, untangle, worse_than};
use super::{Deformed, Error, Held, Report, Settings, check_primitive};
use crate::measure::vertex_normals;
use crate::mesh::{PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;

/// Quality up to which a quad is mended; at 0.9 quads far from any bad one move too.
const ENOUGH: f64 = 0.75;
/// Shares of the way to a better place that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];
/// The least share by which a move has to mend.
const LEAST_GAIN: f64 = 1e-3;

/// Rounds in which corners of bad quads are mended.
const N_ROUNDS: usize = 20;

/// Lays quads on the target that lie on the map's surface already, as pairs of its triangles do.
///
/// Some edges lie along the target's sharp ones, and their ends stay where they are or are put. All else
/// goes onto the target, is fitted by least squares and mended where it is bad. Connections and points
/// of the sphere stay.
///
/// # Errors
/// Quads that do not cover the sphere, and [`Cancelled`].
pub fn lay(
    map: &SphereMap,
    (quads, held): (&PolygonMesh, &Held),
    target: &Target,
    settings: &Settings,
    progress: &Progress,
) -> Result<Deformed, Error> {
    check_primitive(quads)?;
    let mut report = Report::default();
    let mut sheet = Sheet::new(map, vertex_normals(map.mesh()), quads);
    for &[a, b] in &held.edges {
        sheet.keep_edge(a, b);
        sheet.pin(a);
        sheet.pin(b);
    }
    for &(v, place) in &held.goals {
        sheet.lift(v, place);
        sheet.pin(v);
    }
    report.n_feature_goals = sheet.vertex_ids().filter(|&v| sheet.is_pinned(v)).count();
    report.n_feature_vertices = report.n_feature_goals;
    let fit = Fit::plain(target, sheet.mean_edge(), settings.anchor);
    report.n_unprojected = project(&mut sheet, target, fit.reach, progress)?;
    fit.straddle(
        &mut sheet,
        settings.n_straddles,
        &progress.part("", 0.1, 0.3),
    )?;
    let part = progress.part("", 0.3, 0.9);
    [report.n_knotted, report.n_opened] = polish(&mut sheet, target, &part)?;
    project(&mut sheet, target, fit.reach, progress)?;
    if settings.separates {
        [report.n_crossing, report.n_crossing_left] = separate(&mut sheet, progress)?;
    }
    report.n_opened += free(&mut sheet, progress)?;
    Ok(Deformed::new(sheet, report))
}

/// Rounds of mending over all vertices that are not pinned; then what is still inverted is opened,
/// with its pinned corners where nothing else helps. Returns how many faces were inverted before
/// they were opened, and how many moves that took.
fn polish(
    sheet: &mut Sheet,
    target: &Target,
    progress: &Progress,
) -> Result<[usize; 2], Cancelled> {
    let reach = sheet.mean_edge();
    for round in 0..N_ROUNDS {
        progress.at(round as f64 / N_ROUNDS as f64)?;
        sheet.turn(&normals(sheet, &triangles(sheet)));
        let mut n_moves = 0;
        for v in sheet.vertex_ids() {
            if v.0 % 4096 == 0 {
                progress.check()?;
            }
            n_moves += usize::from(!sheet.is_pinned(v) && mend(sheet, v, (target, reach)));
        }
        if n_moves == 0 {
            break;
        }
    }
    sheet.turn(&normals(sheet, &triangles(sheet)));
    let [n_knotted, n_moves] = untangle(sheet, progress)?;
    Ok([n_knotted, n_moves + free(sheet, progress)?])
}

/// Opens what is still inverted, with its pinned corners; returns how many moves it took.
fn free(sheet: &mut Sheet, progress: &Progress) -> Result<usize, Cancelled> {
    let stuck = worse_than(sheet, 0.0);
    if stuck.is_empty() {
        return Ok(0);
    }
    for v in corners(sheet, &stuck) {
        sheet.unpin(v);
    }
    Ok(untangle(sheet, progress)?[1])
}

/// Moves a vertex of a bad quad to a better place on the target; false if there is none.
fn mend(sheet: &mut Sheet, v: VertexId, (target, reach): (&Target, f64)) -> bool {
    let now = *sheet.point(v);
    let before = sheet.badness(v, &now, ENOUGH);
    if before == 0.0 {
        return false;
    }
    let mut best = (before * (1.0 - LEAST_GAIN), None);
    for wanted in [square(sheet, v), middle(sheet, v)] {
        for share in SHARES {
            let away = now.position.lerp(wanted, share);
            let foot = target.closest_agreeing(away, now.normal, reach);
            let position = foot.map_or(away, |foot| foot.position);
            let badness = sheet.badness(v, &Point { position, ..now }, ENOUGH);
            if badness < best.0 {
                best = (badness, Some(position));
            }
        }
    }
    let found = best.1;
    if let Some(position) = found {
        sheet.lift(v, position);
    }
    found.is_some()
}

/// The mean of where a vertex is when its quads become the nearest squares.
fn square(sheet: &Sheet, v: VertexId) -> DVec3 {
    let at = |face: &Face| {
        let corner = face.find(v).expect("a ring's faces have the vertex");
        let points = [0, 1, 2, 3].map(|i| sheet.position(face.corner(corner, i)));
        points.iter().sum::<DVec3>() / 4.0 + spoke(&points).0
    };
    mean(sheet, v, at)
}

/// The middle of a vertex's quads.
fn middle(sheet: &Sheet, v: VertexId) -> DVec3 {
    let at = |face: &Face| {
        let corners = face.corners().iter().map(|&u| sheet.position(u));
        corners.sum::<DVec3>() / 4.0
    };
    mean(sheet, v, at)
}

fn mean(sheet: &Sheet, v: VertexId, at: impl Fn(&Face) -> DVec3) -> DVec3 {
    let ring = sheet.ring(v);
    let sum: DVec3 = ring.iter().map(|&face| at(&sheet.faces()[face])).sum();
    sum / ring.len() as f64
}
