//! Rings for parts that are one limb from end to end: poles, wires, springs.

use std::collections::HashSet;

use glam::DVec3;

use super::attempt::Attempt;
use super::clock::Clock;
use super::crosses::Cross;
use super::even::Marked;
use super::flow::Asked;
use super::flowed::{Flowed, FlowedPart};
use super::mirror::even_out;
use super::probe::{Halves, n_missed};
use super::{Error, density};
use crate::deform::{Deformed, Target};
use crate::flow::rod::{self, Rod, RodError};
use crate::flow::search::Score;
use crate::measure::sharp_edges;
use crate::mesh::{HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::mirror::mirrored;
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::SphereMap;
use crate::{embed, flow, sphere};

/// A part this many girths long is a rod before anything else is tried: a round one is then 25 times
/// as long as thick. Shorter ones flow well mostly.
const CLEAR: f64 = 8.0;
/// Larger parts are read off the map's mesh, which is decimated.
const MOST_FACES: usize = 60_000;
/// No point of the surface is farther from rings than this share of what a quad is wide.
const FARTHEST: f64 = 0.5;

/// Whether a part is much longer than thick, or flat: rings are to be tried first.
pub fn are_clear(target: &Target) -> bool {
    rod::n_girths(target.mesh()) >= CLEAR
}

/// Rings of quads round a part; the text of an error is why there are none.
pub fn rings(
    map: &SphereMap,
    (target, wanted): (&Target, &Marked),
    asked: Asked<'_>,
    (clock, progress): (&mut Clock, &Progress<'_>),
) -> Result<Result<FlowedPart, String>, Cancelled> {
    let whole = target.mesh();
    let is_small = whole.n_faces() <= MOST_FACES;
    let mesh = if is_small { whole } else { map.mesh() };
    let angle = asked.settings.sharp_angle.to_radians();
    let sharp = sharp_edges(mesh, angle);
    let sharp: HalfedgeMap<bool> = if is_small {
        sharp.iter().zip(asked.marked).map(|(a, b)| a | b).collect()
    } else {
        sharp
    };
    let found = clock.step("flow", || found(mesh, &sharp, (target, asked), progress));
    let rod = match found {
        Ok(rod) => rod,
        Err(RodError::Cancelled(cancelled)) => return Err(cancelled),
        Err(error) => return Ok(Err(error.to_string())),
    };
    let part = clock.step("deform", || laid(rod, (target, wanted), asked, progress));
    match part {
        Ok(part) => Ok(Ok(part)),
        Err(Error::Cancelled(cancelled)) => Err(cancelled),
        Err(error) => Ok(Err(error.to_string())),
    }
}

fn found(
    mesh: &TriangleMesh,
    sharp: &HalfedgeMap<bool>,
    (target, asked): (&Target, Asked<'_>),
    progress: &Progress<'_>,
) -> Result<Rod, RodError> {
    let weight = |place: DVec3| match asked.density {
        Some(values) => density::weight_at(values, target, place),
        None => 1.0,
    };
    let settings = rod::Settings {
        n_quads: asked.n_quads,
        adaptivity: asked.settings.flow(asked.n_quads).sizes.adaptivity,
        weight: &weight,
        mirror: asked.axis,
    };
    rod::rod(mesh, sharp, &settings, progress)
}

fn laid(
    rod: Rod,
    (target, wanted): (&Target, &Marked),
    asked: Asked<'_>,
    progress: &Progress<'_>,
) -> Result<FlowedPart, Error> {
    let report = report(&rod, asked.n_quads);
    let quads = &rod.mesh;
    let far = farthest(quads, target);
    let wide = width(quads, rod.n_round);
    let crosses = crosses(quads, asked.n_crosses());
    let mut deformed = Deformed::laid(rod.mesh, rod.sphere, rod.on_lines, progress)?;
    let mirrored = asked.axis.map(|axis| match images(&deformed.mesh, axis) {
        Some(images) => {
            deformed = even_out(&deformed, &images, axis, target);
            Ok(())
        }
        None => Err("the rings are not their own image in the plane".to_owned()),
    });
    let missed = n_missed(&deformed.mesh, target);
    let marks = (&deformed.mesh, &deformed.features[..]);
    Ok(FlowedPart {
        n_missed: missed + usize::from(far > FARTHEST * wide),
        lost: wanted.lost(marks, progress)?,
        deformed,
        sphere: sphere::Report::default(),
        flowed: Flowed::Used {
            attempt: Attempt::Rings,
            flow: report,
            cover: embed::CoverReport::default(),
        },
        crosses,
        mirrored,
    })
}

fn report(rod: &Rod, n_wanted: usize) -> flow::Report {
    let n_quads = rod.mesh.n_faces();
    let count_error = (n_quads as f64 / n_wanted as f64 - 1.0).abs();
    flow::Report {
        n_quads,
        n_cones: 8,
        score: Score {
            n_quads,
            count_error,
            energy: 0.0,
            spiral: rod.strips.spiral,
            loops: rod.strips.loops,
            n_doubled: 0,
        },
        n_thinned: 0,
        n_trials: 0,
        n_stuck: 0,
        n_creases: [0, 0],
    }
}

/// How far the farthest point of the surface is from the quads.
fn farthest(quads: &PolygonMesh, target: &Target) -> f64 {
    let gaps = Halves::of(quads).gaps(target);
    gaps.into_iter().fold(0.0, f64::max).sqrt()
}

/// How wide a quad of the middle ring is.
fn width(quads: &PolygonMesh, n_round: usize) -> f64 {
    let first = quads.n_vertices() / n_round / 2 * n_round;
    let at = |i: usize| quads.positions()[first + i % n_round];
    let girth: f64 = (0..n_round).map(|i| at(i).distance(at(i + 1))).sum();
    girth / n_round as f64
}

/// The image of every vertex, where each quad has one.
fn images(quads: &PolygonMesh, axis: usize) -> Option<Vec<VertexId>> {
    let tree = Bvh::of_points(quads.positions());
    let images: Vec<VertexId> = quads
        .positions()
        .iter()
        .map(|&p| VertexId::from_index(tree.closest(mirrored(p, axis)).face.index()))
        .collect();
    let is_involution = |(v, image): (usize, &VertexId)| images[image.index()].index() == v;
    if !images.iter().enumerate().all(is_involution) {
        return None;
    }
    let turned = |face: &[VertexId]| {
        let first = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
        let mut face = face.to_vec();
        face.rotate_left(first);
        face
    };
    let all: HashSet<Vec<VertexId>> = quads.faces().map(turned).collect();
    let image = |face: &[VertexId]| {
        let corners: Vec<VertexId> = face.iter().rev().map(|v| images[v.index()]).collect();
        turned(&corners)
    };
    quads
        .faces()
        .all(|face| all.contains(&image(face)))
        .then_some(images)
}

/// At most so many crosses along the edges of quads.
fn crosses(quads: &PolygonMesh, n: usize) -> Vec<Cross> {
    if n == 0 {
        return Vec::new();
    }
    let cross = |face: &[VertexId]| {
        let p = [0, 1, 2, 3].map(|i| quads.position(face[i]));
        Cross {
            place: p.iter().sum::<DVec3>() / 4.0,
            arms: [
                (p[1] + p[2] - p[0] - p[3]) / 4.0,
                (p[2] + p[3] - p[0] - p[1]) / 4.0,
            ],
        }
    };
    let step = quads.n_faces().div_ceil(n);
    quads.faces().step_by(step).map(cross).collect()
}
