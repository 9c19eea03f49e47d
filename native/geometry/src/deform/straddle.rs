//! Straddling: faces cut through the surface instead of lying inside of it where it bulges.
//!
//! With its vertices on the surface, a mesh lies on one side of whatever is curved. Least squares
//! moves the vertices until samples of the faces lie on the tangent planes of their closest points:
//! minimise Σ (m · (Σᵢ wᵢ uᵢ − (c − x)))² + Σ a uᵢ², with x a sample of weights w, c its closest
//! point on the target, m the normal there and uᵢ the step of vertex i. About halves the distance;
//! steps along the surface draw edges to the ridges that they cross.
//!
//! Asked that way alone, faces know nothing of what they miss. Sites of the surface then call upon
//! their closest faces by the same equation, x the closest point, c the site and m the way between
//! (Hoppe et al. 1993), and quads wish to be squares meanwhile. Faces that meet in a fold of the
//! surface, below a brow, cross far inside it: their vertex is called back, for the samples beside
//! it no longer know the way once the faces stand across the surface.

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::least_squares::{Call, N_SAMPLES, Problem, SAMPLES, Samples, Wish};
use super::project::lift_towards;
use super::sheet::{Face, Sheet};
use super::sites::Site;
use super::skin::{Skin, normals, triangles};
use super::springs::Springs;
use super::squares::{Squares, spoke};
use super::target::Target;
use crate::mesh::{FaceMap, Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Quality that a step may not spoil unless the face is worse already.
const GUARDED_QUALITY: f64 = 0.35;
/// How many edges away a face is that a site calls upon, at most.
const FARTHEST_CALL: f64 = 2.0;
/// How far off the surface a vertex may go, in edges, before it is called back: at 0.25 it holds
/// what straddles a thin blade.
const FARTHEST_OFF: f64 = 0.35;

/// How strongly vertices are held while faces are fitted, relative to the samples' pull.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Anchor {
    /// Along the normal: at 0 single vertices jump where samples say little.
    pub across: f64,
    /// Along the surface: below 0.02 faces become slivers, above 0.3 ridges are missed.
    pub along: f64,
}

impl Default for Anchor {
    fn default() -> Self {
        Self {
            across: 0.1,
            along: 0.06,
        }
    }
}

/// What faces are fitted to.
pub(super) struct Fit<'a> {
    pub target: &'a Target,
    /// About an edge: no vertex goes farther than half of it.
    pub reach: f64,
    pub anchor: Anchor,
    /// What calls upon the faces; may be none.
    pub sites: &'a [Site],
    /// How much quads wish to be squares, relative to the samples' pull. At 0 faces are guarded
    /// instead: no step spoils one.
    pub squareness: f64,
    /// Where edges wish to be equally long.
    pub even: Option<Even<'a>>,
}

/// What makes quads even.
pub(super) struct Even<'a> {
    /// What their edges keep to: one arm for every face of the map.
    pub crosses: &'a FaceMap<DVec3>,
    /// How much edges wish to be equally long, relative to the samples' pull.
    pub springs: f64,
    /// How much quads wish to be squares of one size.
    pub squares: f64,
}

impl<'a> Fit<'a> {
    /// Faces through the surface and nothing more: no shape of theirs is wished for, and no step spoils
    /// one.
    pub fn plain(target: &'a Target, reach: f64, anchor: Anchor) -> Self {
        Self {
            target,
            reach,
            anchor,
            sites: &[],
            squareness: 0.0,
            even: None,
        }
    }

    /// Moves vertices to the least squares fit, so many times; pinned ones stay.
    pub fn straddle(
        &self,
        sheet: &mut Sheet,
        n_rounds: usize,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        if self.squareness > 0.0 {
            sheet.turn(&normals(sheet, &triangles(sheet)));
        }
        for round in 0..n_rounds {
            progress.at(round as f64 / n_rounds as f64)?;
            self.once(sheet, progress)?;
        }
        Ok(())
    }

    fn once(&self, sheet: &mut Sheet, progress: &Progress) -> Result<(), Cancelled> {
        let triangles = triangles(sheet);
        let samples = triangles.par_iter().map(|&corners| {
            progress.check()?;
            Ok(self.sample(sheet, corners))
        });
        let samples = samples.collect::<Result<Vec<_>, Cancelled>>()?;
        let even = self.even.as_ref().map(|even| {
            let squares = Squares::new(sheet, even.crosses, even.squares);
            (Springs::new(sheet, even.springs), squares)
        });
        let problem = Problem {
            samples: &samples,
            calls: &self.calls(sheet, progress)?,
            wishes: &self.wishes(sheet, progress)?,
            anchor: self.anchor,
            even: even.as_ref(),
        };
        let steps = problem.solve(sheet, progress)?;
        for v in sheet.vertex_ids() {
            let wanted = sheet.position(v) + steps[v].clamp_length_max(self.reach / 2.0);
            if self.squareness > 0.0 {
                sheet.lift(v, wanted);
            } else {
                lift_towards(sheet, v, wanted, GUARDED_QUALITY);
            }
        }
        if self.squareness > 0.0 {
            sheet.turn(&normals(sheet, &triangles));
        }
        Ok(())
    }

    fn sample(&self, sheet: &Sheet, corners: [VertexId; 3]) -> Samples {
        let [a, b, c] = corners.map(|v| sheet.position(v));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let mut samples = Samples {
            corners,
            normals: [[0.0; 3]; N_SAMPLES],
            gaps: [0.0; N_SAMPLES],
        };
        let mut hint = None;
        for (k, [u, v, w]) in SAMPLES.into_iter().enumerate() {
            let x = a * u + b * v + c * w;
            let foot = self
                .target
                .closest_agreeing_near(x, normal, self.reach, hint);
            if let Some(foot) = foot {
                hint = Some(foot.face);
                let plane = self.target.normal(foot.face);
                // Where the face does not follow the surface, as over a tip, the plane says little.
                let plane_weight = normal.dot(plane);
                samples.normals[k] = (plane * plane_weight).as_vec3().to_array();
                samples.gaps[k] = plane_weight * plane.dot(foot.position - x);
            }
        }
        samples
    }

    /// The calls of all sites, which together weigh as much as all samples, sorted by triangle.
    fn calls(&self, sheet: &Sheet, progress: &Progress) -> Result<Vec<Call>, Cancelled> {
        if self.sites.is_empty() {
            return Ok(Vec::new());
        }
        let skin = Skin::new(sheet, progress)?;
        let root = ((N_SAMPLES * skin.corners.len()) as f64 / self.sites.len() as f64).sqrt();
        let call = |site: &Site| {
            progress.check()?;
            let Some(foot) = skin.closest(site, FARTHEST_CALL * self.reach) else {
                return Ok(None);
            };
            let triangle = foot.face.index();
            let way = (site.position - foot.position).normalize_or(skin.normal(triangle));
            Ok(Some(Call {
                triangle: triangle as u32,
                weights: foot.weights,
                way: way * root,
                gap: root * foot.distance_squared.sqrt(),
            }))
        };
        let calls: Result<Vec<_>, Cancelled> = self.sites.par_iter().map(call).collect();
        let mut calls: Vec<Call> = calls?.into_iter().flatten().collect();
        calls.sort_by_key(|call| call.triangle);
        Ok(calls)
    }

    /// The way of every vertex, along the surface, to the mean of where its quads were squares, and
    /// the way back to the surface.
    fn wishes(&self, sheet: &Sheet, progress: &Progress) -> Result<VertexMap<Wish>, Cancelled> {
        let wish = |v: usize| {
            progress.check()?;
            let v = VertexId::from_index(v);
            let steps = sheet.ring(v).iter().map(|&face| {
                let face = &sheet.faces()[face];
                square_corner(sheet, face, v) - sheet.position(v)
            });
            let (sum, n) = steps.fold((DVec3::ZERO, 0.0), |(sum, n), step| (sum + step, n + 1.0));
            let step = sum / n;
            let normal = sheet.point(v).normal;
            Ok(Wish {
                step: step - normal * normal.dot(step),
                weight: self.squareness * n,
                back: self.way_back(sheet.position(v), normal),
            })
        };
        if self.squareness > 0.0 {
            let wishes = (0..sheet.n_vertices()).into_par_iter().map(wish);
            let wishes = wishes.collect::<Result<Vec<_>, Cancelled>>()?;
            Ok(VertexMap::from_vec(wishes))
        } else {
            Ok(VertexMap::filled(sheet.n_vertices(), Wish::default()))
        }
    }

    /// The way back from a point that is too far off the surface to where it no longer is.
    fn way_back(&self, x: DVec3, normal: DVec3) -> DVec3 {
        let foot = self.target.closest_agreeing(x, normal, self.reach);
        let way = foot.map_or(DVec3::ZERO, |foot| foot.position - x);
        let beyond = way.length() - FARTHEST_OFF * self.reach;
        way.normalize_or_zero() * beyond.max(0.0)
    }
}

/// Where a vertex is when its quad becomes the square that is nearest to it.
fn square_corner(sheet: &Sheet, face: &Face, vertex: VertexId) -> DVec3 {
    let corner = face.find(vertex).expect("a ring's faces have the vertex");
    let points = [0, 1, 2, 3].map(|i| sheet.position(face.corner(corner, i)));
    let [here, next, far, before] = points;
    (here + next + far + before) / 4.0 + spoke(&points).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::project::project;
    use crate::deform::sites;
    use crate::elementary::exp;
    use crate::measure::vertex_normals;
    use crate::mesh::{FaceId, TriangleMesh};
    use crate::shapes;
    use crate::sphere::quad_sphere;
    use crate::sphere_map::SphereMap;

    /// Quads on a sphere with a spike, fitted; how high they reach and their mean quality.
    fn fitted(n_sites: usize, squareness: f64) -> [f64; 2] {
        let round = shapes::sphere(24);
        let sphere = round.positions().iter().copied().collect();
        let spike = |p: &DVec3| *p * (1.0 + 0.3 * exp(40.0 * (p.z - 1.0)));
        let pointed = round.positions().iter().map(spike).collect();
        let mesh = TriangleMesh::new(pointed, round.faces().to_vec()).unwrap();
        let target = Target::new(mesh.clone(), &Progress::none()).unwrap();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let mut sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([5, 5, 5]));
        let edge = sheet.mean_edge();
        project(&mut sheet, &target, edge, &Progress::none()).unwrap();
        let anchor = Anchor {
            along: 0.02,
            ..Anchor::default()
        };
        let fit = Fit {
            target: &target,
            reach: edge,
            anchor,
            sites: &sites::spread(&target, n_sites),
            squareness,
            even: None,
        };
        fit.straddle(&mut sheet, 4, &Progress::none()).unwrap();
        let heights = sheet.vertex_ids().map(|v| sheet.position(v).z);
        let n_faces = sheet.faces().len();
        let qualities = (0..n_faces).map(|f| sheet.quality(FaceId::from_index(f)));
        let mean = qualities.sum::<f64>() / n_faces as f64;
        [heights.fold(0.0, f64::max), mean]
    }

    #[test]
    fn what_the_faces_miss_calls_upon_them() {
        let [[without, _], [with, _]] = [0, 2_000].map(|n| fitted(n, 0.25));
        assert!(with > without + 0.03, "{with} {without}");
    }

    #[test]
    fn vertices_far_off_the_surface_are_called_back() {
        let ball = shapes::sphere(24);
        let sphere = ball.positions().iter().copied().collect();
        let target = Target::new(ball.clone(), &Progress::none()).unwrap();
        let map = SphereMap::prove(ball, sphere).unwrap();
        let sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([5, 5, 5]));
        let fit = Fit {
            target: &target,
            reach: sheet.mean_edge(),
            anchor: Anchor::default(),
            sites: &[],
            squareness: 0.25,
            even: None,
        };
        // Where faces stand across the surface nothing else pulls.
        let stepped = |v: VertexId, off: f64| {
            let normal = sheet.point(v).normal;
            let x = sheet.position(v) + normal * (off * fit.reach);
            let mut wishes = VertexMap::filled(sheet.n_vertices(), Wish::default());
            wishes[v].back = fit.way_back(x, normal);
            let problem = Problem {
                samples: &[],
                calls: &[],
                wishes: &wishes,
                anchor: fit.anchor,
                even: None,
            };
            let steps = problem.solve(&sheet, &Progress::none()).unwrap();
            steps[v].dot(normal) / fit.reach
        };
        for v in [VertexId(0), VertexId(31), VertexId(100)] {
            let steps = [-0.9, -0.6, -0.3, 0.3, 0.6, 1.1].map(|off| stepped(v, off));
            assert!(steps[0] > 0.4 && steps[0] < 0.56, "{steps:?}");
            assert!(steps[1] > 0.15 && steps[1] < 0.26, "{steps:?}");
            assert!(steps[4] < -0.15 && steps[4] > -0.26, "{steps:?}");
            let mut near_or_lost = [2, 3, 5].map(|i| steps[i]).into_iter();
            assert!(near_or_lost.all(|step| step == 0.0), "{steps:?}");
        }
    }

    #[test]
    fn quads_become_squares_while_they_are_fitted() {
        let [[_, little], [_, much]] = [0.01, 1.0].map(|squareness| fitted(2_000, squareness));
        assert!(much > little + 0.01, "{much} {little}");
    }
}
