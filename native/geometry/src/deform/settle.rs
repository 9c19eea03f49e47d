//! Mends bad quads that lie on a surface and cover no sphere: vertex by vertex, on the surface.

use glam::DVec3;

use super::Target;
use crate::measure::area_vector;
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// Rounds over the vertices of bad quads.
const N_ROUNDS: usize = 20;
/// Shares of the way to a better place that are tried.
const SHARES: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
/// The least share by which a move has to mend.
const LEAST_GAIN: f64 = 1e-3;

/// Quads with vertices of those whose worst corner has a smaller sine than `enough` at better places of
/// the target; vertices that are fixed stay.
///
/// # Errors
/// When cancelled.
pub fn settle(
    mesh: &PolygonMesh,
    (is_fixed, enough): (&[bool], f64),
    target: &Target,
    progress: &Progress,
) -> Result<PolygonMesh, Cancelled> {
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.n_vertices()];
    for face in mesh.face_ids() {
        for v in mesh.face(face) {
            around[v.index()].push(face.index() as u32);
        }
    }
    let faces: Vec<&[VertexId]> = mesh.faces().collect();
    let mut settling = Settling {
        positions: mesh.positions().to_vec(),
        faces: &faces,
        enough,
    };
    for round in 0..N_ROUNDS {
        progress.at(round as f64 / N_ROUNDS as f64)?;
        let mut n_moves = 0;
        for (v, ring) in around.iter().enumerate().filter(|(v, _)| !is_fixed[*v]) {
            n_moves += usize::from(settling.mend(v, ring, target));
        }
        if n_moves == 0 {
            break;
        }
    }
    Ok(mesh.with_positions(settling.positions))
}

struct Settling<'a> {
    positions: Vec<DVec3>,
    faces: &'a [&'a [VertexId]],
    enough: f64,
}

impl Settling<'_> {
    fn corners(&self, face: u32) -> impl Iterator<Item = DVec3> + Clone {
        let corners = self.faces[face as usize].iter();
        corners.map(|v| self.positions[v.index()])
    }

    fn badness(&self, ring: &[u32]) -> f64 {
        let of = |&face: &u32| {
            let p: Vec<DVec3> = self.corners(face).collect();
            (self.enough - quality(&p)).max(0.0)
        };
        ring.iter().map(|face| of(face) * of(face)).sum()
    }

    fn mend(&mut self, v: usize, ring: &[u32], target: &Target) -> bool {
        let before = self.badness(ring);
        if before == 0.0 {
            return false;
        }
        let now = self.positions[v];
        let all = ring.iter().flat_map(|&face| self.corners(face));
        let (sum, n) = all.fold((DVec3::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
        let normal: DVec3 = ring.iter().map(|&face| area(self.corners(face))).sum();
        let normal = normal.normalize_or_zero();
        let reach = (sum / n).distance(now) + f64::MIN_POSITIVE;
        let mut best = (before * (1.0 - LEAST_GAIN), None);
        for share in SHARES {
            let wanted = now.lerp(sum / n, share);
            let foot = target.closest_agreeing(wanted, normal, reach);
            let place = foot.map_or(wanted, |foot| foot.position);
            self.positions[v] = place;
            let badness = self.badness(ring);
            if badness < best.0 {
                best = (badness, Some(place));
            }
        }
        self.positions[v] = best.1.unwrap_or(now);
        best.1.is_some()
    }
}

fn area(corners: impl Iterator<Item = DVec3>) -> DVec3 {
    let p: Vec<DVec3> = corners.collect();
    (2..p.len())
        .map(|i| area_vector([p[0], p[i - 1], p[i]]))
        .sum()
}

/// The sine of the worst corner, seen along the face's own normal.
fn quality(p: &[DVec3]) -> f64 {
    let n = p.len();
    let normal = area(p.iter().copied()).normalize_or_zero();
    let edge = |i: usize| (p[(i + 1) % n] - p[i % n]).normalize_or_zero();
    let turns = (0..n).map(|i| edge(i).cross(edge(i + 1)).dot(normal));
    turns.fold(1.0, f64::min)
}
