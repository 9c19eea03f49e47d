//! Reaching: parts of the surface that the faces cut off are reached for.
//!
//! Straddling asks where the faces are and not what they miss: the tip of an ear, an edge. Points
//! of the surface that are far from every face pull the nearest corner of the closest one.

use glam::DVec3;
use rayon::prelude::*;

use super::project::lift_towards;
use super::sheet::Sheet;
use super::sites::{self, Site};
use super::skin::Skin;
use super::target::Target;
use crate::mesh::{Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Which points of the surface are reached for, by their distance from the faces in mean edges.
#[derive(Clone, Copy)]
pub(super) struct Span {
    /// Nearer ones are reached.
    near: f64,
    /// Farther ones are given up.
    far: f64,
}

impl Span {
    /// All that faces miss by more than those that straddle do; before the fit, which evens out.
    pub const MISSED: Self = Self {
        near: 0.3,
        far: 2.0,
    };
    /// What the fit has left; nearer points would pull vertices out of it.
    pub const LEFT: Self = Self {
        near: 0.6,
        far: 2.0,
    };
    /// Limbs whose tips are cut off. Nearer than an edge, small triangles along sharp edges would be
    /// drawn across these.
    pub const CUT_OFF: Self = Self {
        near: 1.0,
        far: 6.0,
    };
}

/// Points that are looked at, about.
const N_POINTS: usize = 16_000;
/// Rounds of pulling.
const N_ROUNDS: usize = 6;
/// Share of the way to a point that a vertex goes at once; at 1 faces in folds of the surface spoil.
const SHARE: f64 = 0.5;
/// Quality that a pull may not spoil unless the face is worse already; above, fingers stay cut off.
const GUARDED_QUALITY: f64 = 0.3;
/// A vertex, the step that it is to take, and the squared distance that calls for it.
type Pull = (VertexId, DVec3, f64);

/// Pulls vertices towards what the faces miss by more than a share of a mean edge.
pub(super) fn reach(
    sheet: &mut Sheet,
    (target, span): (&Target, Span),
    progress: &Progress,
) -> Result<(), Cancelled> {
    let edge = sheet.mean_edge();
    let mut sites = sites::vertices(target, N_POINTS);
    for _ in 0..N_ROUNDS {
        progress.check()?;
        let pulls = pulls(sheet, (&sites, span), edge, progress)?;
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

/// For each point that is far from the faces the vertex that it pulls, and the step.
fn pulls(
    sheet: &Sheet,
    (sites, span): (&[Site], Span),
    edge: f64,
    progress: &Progress,
) -> Result<Vec<Option<Pull>>, Cancelled> {
    let skin = Skin::new(sheet, progress)?;
    let pull = |site: &Site| {
        progress.check()?;
        let Some(foot) = skin.closest(site, span.far * edge) else {
            return Ok(None);
        };
        if foot.distance_squared < (span.near * edge).powi(2) {
            return Ok(None);
        }
        let heaviest = (0..3).max_by(|&i, &j| foot.weights[i].total_cmp(&foot.weights[j]));
        let heaviest = heaviest.unwrap_or(0);
        let vertex = skin.corners[foot.face.index()][heaviest];
        let step = (site.position - sheet.position(vertex)) * SHARE;
        Ok(Some((vertex, step, foot.distance_squared)))
    };
    sites.par_iter().map(pull).collect()
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::deform::project::project;
    use crate::elementary::exp;
    use crate::measure::vertex_normals;
    use crate::mesh::{FaceId, PolygonMesh, TriangleMesh};
    use crate::shapes;
    use crate::sphere::{icosphere, quad_sphere};
    use crate::sphere_map::SphereMap;

    /// How high faces reach on a sphere with a spike up to 1.4, before and after.
    fn heights(primitive: &PolygonMesh, sharpness: f64, span: Span) -> [f64; 2] {
        let round = shapes::sphere(16);
        let sphere: VertexMap<DVec3> = round.positions().iter().copied().collect();
        let spike = |p: &DVec3| *p * (1.0 + 0.4 * exp(sharpness * (p.z - 1.0)));
        let pointed = round.positions().iter().map(spike).collect();
        let mesh = TriangleMesh::new(pointed, round.faces().to_vec()).unwrap();
        let target = Target::new(mesh.clone(), &Progress::none()).unwrap();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let normals = vertex_normals(map.mesh());
        let mut sheet = Sheet::new(&map, normals, primitive);
        let edge = sheet.mean_edge();
        project(&mut sheet, &target, edge, &Progress::none()).unwrap();
        let top = |sheet: &Sheet| {
            let heights = sheet.vertex_ids().map(|v| sheet.position(v).z);
            heights.fold(0.0, f64::max)
        };
        let before = top(&sheet);
        reach(&mut sheet, (&target, span), &Progress::none()).unwrap();
        [before, top(&sheet)]
    }

    #[test]
    fn a_spike_that_the_faces_miss_is_reached() {
        let [before, after] = heights(&quad_sphere([7, 7, 7]), 60.0, Span::MISSED);
        assert!(before < 1.2 && after > 1.3, "{before} {after}");
    }

    #[test]
    fn only_what_is_cut_off_by_more_than_an_edge_is_reached_so_far() {
        // Edges about 0.13 long against a spike that is 0.3 longer, and 0.24 long.
        for (n, sharpness, is_cut_off) in [(9, 600.0, true), (5, 60.0, false)] {
            // A face's middle under the spike.
            let ball = icosphere(n);
            let corners = ball.face(FaceId(0)).iter().map(|&v| ball.position(v));
            let middle = corners.sum::<DVec3>().normalize_or_zero();
            let turned = DQuat::from_rotation_arc(middle, DVec3::Z);
            let ball = ball.with_positions(ball.positions().iter().map(|&p| turned * p).collect());
            let [before, after] = heights(&ball, sharpness, Span::CUT_OFF);
            assert_eq!(after > before, is_cut_off, "{before} {after}");
        }
    }
}
