//! Reaching: parts of the surface that the faces cut off are reached for.
//!
//! Straddling asks where the faces are and not what they miss: the tip of an ear, an edge. Points
//! of the surface that are far from every face pull the nearest corner of the closest one.

use glam::DVec3;
use rayon::prelude::*;

use super::project::lift_towards;
use super::sheet::Sheet;
use super::straddle::triangles;
use super::target::Target;
use crate::measure::area_vector;
use crate::mesh::{FaceId, Id, VertexId, VertexMap};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Points nearer than this many mean edges are reached: faces that straddle miss as much.
const NEAR: f64 = 0.3;
/// Points that are looked at, about.
const N_POINTS: usize = 16_000;
/// Rounds of pulling.
const N_ROUNDS: usize = 3;
/// Share of the way to a point that a vertex goes at once; at 1 faces in folds of the surface spoil.
const SHARE: f64 = 0.5;
/// Quality that a pull may not spoil unless the face is worse already.
const GUARDED_QUALITY: f64 = 0.45;
/// Cosine between the normals of a point and a face from which on it is another sheet's.
const LEAST_AGREEMENT: f64 = -0.2;

/// A point of the surface and the normal there.
#[derive(Clone, Copy)]
struct Site {
    position: DVec3,
    normal: DVec3,
}

/// A vertex, the step that it is to take, and the squared distance that calls for it.
type Pull = (VertexId, DVec3, f64);

/// Pulls vertices towards what the faces miss by more than a share of a mean edge.
pub(super) fn reach(
    sheet: &mut Sheet,
    target: &Target,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let edge = sheet.mean_edge();
    let mut sites = sites(target);
    for _ in 0..N_ROUNDS {
        progress.check()?;
        let pulls = pulls(sheet, &sites, edge, progress)?;
        let mut wanted = VertexMap::filled(sheet.n_vertices(), (0.0, DVec3::ZERO));
        let mut left = Vec::new();
        for (site, pull) in sites.iter().zip(pulls) {
            let Some((vertex, step, gap)) = pull else {
                continue;
            };
            left.push(*site);
            if gap > wanted[vertex].0 {
                wanted[vertex] = (gap, step);
            }
        }
        for v in sheet.vertex_ids() {
            if wanted[v].0 > 0.0 && !sheet.is_pinned(v) {
                lift_towards(sheet, v, sheet.position(v) + wanted[v].1, GUARDED_QUALITY);
            }
        }
        sites = left;
    }
    Ok(())
}

/// Vertices of the surface, evenly chosen.
fn sites(target: &Target) -> Vec<Site> {
    let n = target.mesh().n_vertices();
    let ids = (0..n).step_by(n.div_ceil(N_POINTS).max(1));
    let site = |i| {
        let v = VertexId::from_index(i);
        Site {
            position: target.mesh().position(v),
            normal: target.vertex_normal(v),
        }
    };
    ids.map(site).collect()
}

/// For each point that is far from the faces the vertex that it pulls, and the step.
fn pulls(
    sheet: &Sheet,
    sites: &[Site],
    edge: f64,
    progress: &Progress,
) -> Result<Vec<Option<Pull>>, Cancelled> {
    let corners = triangles(sheet);
    let flat: Vec<_> = corners
        .iter()
        .map(|t| t.map(|v| sheet.position(v)))
        .collect();
    let normal = |&triangle: &[DVec3; 3]| area_vector(triangle).normalize_or_zero();
    let normals: Vec<DVec3> = flat.iter().map(normal).collect();
    let bvh = Bvh::build(&flat, progress)?;
    let pull = |site: &Site| {
        progress.check()?;
        let agrees = |face: FaceId| normals[face.index()].dot(site.normal) > LEAST_AGREEMENT;
        let reach = (2.0 * edge).powi(2);
        let Some(foot) = bvh.closest_where(site.position, reach, agrees) else {
            return Ok(None);
        };
        if foot.distance_squared < (NEAR * edge).powi(2) {
            return Ok(None);
        }
        let heaviest = (0..3).max_by(|&i, &j| foot.weights[i].total_cmp(&foot.weights[j]));
        let heaviest = heaviest.unwrap_or(0);
        let vertex = corners[foot.face.index()][heaviest];
        let step = (site.position - sheet.position(vertex)) * SHARE;
        Ok(Some((vertex, step, foot.distance_squared)))
    };
    sites.par_iter().map(pull).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::project::project;
    use crate::measure::vertex_normals;
    use crate::mesh::TriangleMesh;
    use crate::shapes;
    use crate::sphere::quad_sphere;
    use crate::sphere_map::SphereMap;

    #[test]
    fn a_spike_that_the_faces_miss_is_reached() {
        let round = shapes::sphere(16);
        let sphere: VertexMap<DVec3> = round.positions().iter().copied().collect();
        let spike = |p: &DVec3| *p * (1.0 + 0.4 * (60.0 * (p.z - 1.0)).exp());
        let pointed = round.positions().iter().map(spike).collect();
        let mesh = TriangleMesh::new(pointed, round.faces().to_vec()).unwrap();
        let target = Target::new(mesh.clone(), &Progress::none()).unwrap();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let normals = vertex_normals(map.mesh());
        let mut sheet = Sheet::new(&map, normals, &quad_sphere([7, 7, 7]));
        let edge = sheet.mean_edge();
        project(&mut sheet, &target, edge, &Progress::none()).unwrap();
        let top = |sheet: &Sheet| {
            let heights = sheet.vertex_ids().map(|v| sheet.position(v).z);
            heights.fold(0.0, f64::max)
        };
        let before = top(&sheet);
        reach(&mut sheet, &target, &Progress::none()).unwrap();
        let after = top(&sheet);
        assert!(before < 1.2 && after > 1.3, "{before} {after}");
    }
}
