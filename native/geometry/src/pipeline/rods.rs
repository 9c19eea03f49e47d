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

/// A part this many girths long is a rod before anything else is tried: a round one is then 25
/// times as long as thick. Shorter ones flow well mostly.
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
    let ends = |(v, &p): (usize, &DVec3)| {
        if v < rod.n_on_rings {
            p
        } else {
            target.bvh().closest(p).position
        }
    };
    let positions = rod.mesh.positions().iter().enumerate().map(ends).collect();
    let quads = &rod.mesh.with_positions(positions);
    let far = farthest(quads, target);
    let wide = width(quads, rod.n_round);
    let crosses = crosses(quads, asked.n_crosses());
    let mut deformed = Deformed::laid(quads.clone(), rod.sphere, rod.on_lines, progress)?;
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
        n_unmet: 0,
        n_missed: missed + usize::from(far > FARTHEST * wide),
        lost: wanted.lost(marks, progress)?,
        deformed,
        sphere: sphere::Report::default(),
        flowed: Flowed::Used {
            attempt: Attempt::Rings,
            n_attempts: 0,
            n_rings: 0,
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
        n_cones: n_irregular(&rod.mesh),
        score: Score {
            n_quads,
            count_error,
            energy: 0.0,
            spiral: rod.strips.spiral,
            loops: rod.strips.loops,
            n_doubled: 0,
            n_unmet: 0,
        },
        n_thinned: 0,
        n_trials: 0,
        n_stuck: 0,
        n_creases: rod.n_lines,
    }
}

/// How many vertices have not four quads.
fn n_irregular(quads: &PolygonMesh) -> usize {
    let valences = quads.faces_per_vertex();
    valences.into_iter().filter(|&n| n != 4).count()
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
pub fn images(quads: &PolygonMesh, axis: usize) -> Option<Vec<VertexId>> {
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
pub(super) fn crosses(quads: &PolygonMesh, n: usize) -> Vec<Cross> {
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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::elementary::sin_cos;
    use crate::embed::Solver;
    use crate::pipeline::report::Mirrored;
    use crate::pipeline::{Input, PartReport, Settings, remesh};
    use crate::shapes::{polygons, swept};

    fn made(path: &[DVec3], n: u32, faces: usize) -> (PolygonMesh, PartReport) {
        let mesh = polygons(&swept(path, 0.5, n));
        let settings = Settings {
            faces,
            ..Settings::default()
        };
        let run = remesh(
            Input::new(&mesh),
            &settings,
            &Solver::default(),
            &Progress::none(),
        );
        let run = run.unwrap();
        let part = run.report.parts[0].clone();
        let is_rings = matches!(
            part.flow,
            Some(Flowed::Used {
                attempt: Attempt::Rings,
                ..
            })
        );
        assert!(is_rings, "{:?}", part.flow);
        assert_eq!(part.deform.n_inverted, 0);
        assert_eq!(part.deform.n_crossing_left, 0);
        (run.mesh, part)
    }

    #[test]
    fn a_spring_gets_rings_and_none_is_inverted() {
        let path = (0..70).map(|i| {
            let angle = f64::from(i) * 0.2;
            let (sin, cos) = sin_cos(angle);
            DVec3::new(4.0 * cos, 4.0 * sin, 0.4 * angle)
        });
        let path: Vec<DVec3> = path.collect();
        let (mesh, _) = made(&path, 8, 400);
        assert!(mesh.n_faces().abs_diff(400) <= 8);
        for end in [path[0], path[69]] {
            let distance = |p: &DVec3| p.distance(end);
            let nearest = mesh.positions().iter().map(distance).fold(9.0, f64::min);
            assert!(nearest < 0.55, "{nearest}");
        }
    }

    #[test]
    fn a_pole_stays_straight_and_its_own_image() {
        let (mesh, part) = made(&[DVec3::X * -40.0, DVec3::X * 40.0], 8, 150);
        assert!(matches!(part.mirrored, Some(Mirrored::Used)));
        let sides = mesh.positions().iter().filter(|p| p.x.abs() < 39.9);
        for p in sides {
            let off = (DVec3::new(0.0, p.y, p.z).length() - 0.5).abs();
            assert!(off < 1e-6, "{p}");
        }
    }
}
