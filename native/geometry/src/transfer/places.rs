//! The place of the old surface that belongs to each vertex, corner and face of the new one.

use std::collections::HashSet;

use glam::DVec3;
use rayon::prelude::*;

use super::Source;
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh};
use crate::nearest::{Bvh, Closest, closest_on_triangle};
use crate::progress::{Cancelled, Progress};

/// Faces between two looks at the progress: some milliseconds of work where each lies on a thousand
/// triangles.
const FACES: usize = 32;
/// The same for vertices.
const VERTICES: usize = 2048;
/// A corner looks for its place among triangles no farther from the middle of its face than this
/// many times the farthest corner: below, the place of a corner that lies off the surface is missed;
/// above, only time grows.
const REACH: f64 = 1.25;

/// Cosine of the angle to the face's normal from which on a triangle is of the other side: 120°.
/// Below, the way round a thin limb leads to the far side of a cut; above, a face that lies across a
/// sharp edge misses what is behind the edge.
const BEHIND: f64 = -0.5;
/// A triangle farther from the middle must be nearer to a corner by more than this share of the
/// squared reach.
const CLEARLY_NEARER: f64 = 1e-12;

/// Places on the old surface.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Places {
    /// Of every vertex.
    pub vertices: Vec<Closest>,
    /// For each set of cuts, of every corner of every face: on the same side of the cuts as the
    /// middle of the face.
    pub corners: Vec<Vec<Closest>>,
    /// The triangle under the middle of every face.
    pub faces: Vec<FaceId>,
}

/// Finds the places of an output on the surface that it was made of.
///
/// Data that is cut along edges, as texture coordinates are along seams, is taken at the corners of
/// faces, each from one side of the cuts alone. `cuts` has sets of them, each with both halves of
/// each such edge. `tree` is that of the mesh. Without an old face there are no places. Costs a walk
/// over the triangles below every face for every set.
///
/// # Errors
/// When cancelled.
pub fn places(
    (old, tree): (&TriangleMesh, &Bvh),
    cuts: &[HalfedgeMap<bool>],
    output: &PolygonMesh,
    progress: &Progress,
) -> Result<Places, Cancelled> {
    let mut places = Places {
        corners: vec![Vec::new(); cuts.len()],
        ..Places::default()
    };
    let Some(source) = Source::new(tree) else {
        return Ok(places);
    };
    let mut normals = vec![DVec3::ZERO; output.n_vertices()];
    let mut reach = vec![0.0f64; output.n_vertices()];
    let faces: Vec<FaceId> = output.face_ids().collect();
    for chunk in faces.chunks(FACES) {
        progress.at(places.faces.len() as f64 / faces.len() as f64)?;
        let found = chunk.par_iter().map(|&id| {
            let face = Face::new(output, id);
            let under = source.at(face.middle, face.normal, face.radius);
            let corners = cuts.iter().map(|set| face.places(under, old, set));
            let corners: Vec<_> = corners.collect();
            (face, under.face, corners)
        });
        let found: Vec<_> = found.collect();
        for (&id, (face, under, corners)) in chunk.iter().zip(found) {
            for v in output.face(id) {
                normals[v.index()] += face.normal;
                reach[v.index()] = reach[v.index()].max(face.radius);
            }
            places.faces.push(under);
            for (all, corners) in places.corners.iter_mut().zip(corners) {
                all.extend(corners);
            }
        }
    }
    let vertices: Vec<_> = output
        .positions()
        .iter()
        .zip(normals.iter().zip(&reach))
        .collect();
    for chunk in vertices.chunks(VERTICES) {
        progress.check()?;
        let place =
            |&(&p, (&normal, &reach)): &(&DVec3, (&DVec3, &f64))| source.at(p, normal, reach);
        places.vertices.par_extend(chunk.par_iter().map(place));
    }
    Ok(places)
}

/// A face of the output.
struct Face {
    corners: Vec<DVec3>,
    middle: DVec3,
    /// Along the normal, twice as long as its area.
    normal: DVec3,
    /// How far the farthest corner is from the middle.
    radius: f64,
}

impl Face {
    fn new(output: &PolygonMesh, face: FaceId) -> Self {
        let corners = output.face(face).iter().map(|&v| output.position(v));
        let corners: Vec<DVec3> = corners.collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let ahead = corners.iter().cycle().skip(1);
        let normal = corners.iter().zip(ahead);
        let normal = normal.map(|(&a, &b)| (a - middle).cross(b - middle)).sum();
        let radius = corners.iter().map(|p| p.distance(middle));
        Self {
            middle,
            normal,
            radius: radius.fold(0.0, f64::max),
            corners,
        }
    }

    /// The places of the corners, as seen from the one under the middle.
    fn places(&self, under: Closest, old: &TriangleMesh, cuts: &HalfedgeMap<bool>) -> Vec<Closest> {
        let patch = self.patch(under.face, old, cuts);
        // On an edge both sides are as near but for rounding; the first is the nearer to the middle.
        let clearly = CLEARLY_NEARER * self.radius.powi(2);
        let nearer = |best: Closest, next: Closest| {
            if next.distance_squared < best.distance_squared - clearly {
                next
            } else {
                best
            }
        };
        let place = |&corner: &DVec3| {
            let on = |&face: &FaceId| closest_on_triangle(corner, old.triangle(face)).of(face);
            patch.iter().map(on).reduce(nearer).unwrap_or(under)
        };
        self.corners.iter().map(place).collect()
    }

    /// The triangles around the one under the middle that can be reached without crossing a cut or
    /// going behind the face, in the order of the steps from it.
    fn patch(&self, under: FaceId, old: &TriangleMesh, cuts: &HalfedgeMap<bool>) -> Vec<FaceId> {
        let reach = (REACH * self.radius).powi(2);
        let is_near =
            |face| closest_on_triangle(self.middle, old.triangle(face)).distance_squared <= reach;
        let is_behind = |face| {
            let [a, b, c] = old.triangle(face);
            let normal = (b - a).cross(c - a);
            normal.dot(self.normal) < BEHIND * normal.length() * self.normal.length()
        };
        let mut seen = HashSet::from([under]);
        let mut patch = vec![under];
        let mut n_done = 0;
        while let Some(&face) = patch.get(n_done) {
            n_done += 1;
            let first = old.halfedge(face);
            let ways = [first, first.next(), first.prev()].into_iter();
            let beyond = ways.filter(|&h| !cuts[h]).filter_map(|h| old.twin(h));
            for next in beyond.map(HalfedgeId::face) {
                if seen.insert(next) && is_near(next) && !is_behind(next) {
                    patch.push(next);
                }
            }
        }
        patch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    fn found(old: &TriangleMesh, cuts: &[HalfedgeMap<bool>], new: &TriangleMesh) -> Places {
        let output = shapes::polygons(new);
        let tree = Bvh::of_mesh(old);
        places((old, &tree), cuts, &output, &Progress::none()).unwrap()
    }

    fn uncut(mesh: &TriangleMesh) -> HalfedgeMap<bool> {
        HalfedgeMap::filled(3 * mesh.n_faces(), false)
    }

    #[test]
    fn a_mesh_finds_itself() {
        for (name, mesh) in shapes::closed(6) {
            let places = found(&mesh, &[uncut(&mesh)], &mesh);
            assert_eq!(places.faces, mesh.face_ids().collect::<Vec<_>>(), "{name}");
            let corners = mesh.face_ids().flat_map(|f| mesh.triangle(f));
            for (place, corner) in places.corners[0].iter().zip(corners) {
                assert!(place.position.distance(corner) < 1e-9, "{name}");
            }
            for (place, &p) in places.vertices.iter().zip(mesh.positions()) {
                assert!(place.position.distance(p) < 1e-9, "{name}");
            }
        }
    }

    #[test]
    fn corners_stay_on_the_side_of_the_cut_that_their_face_is_on() {
        let [fine, coarse] = [20, 7].map(|n| shapes::mapped_cube(n, DVec3::normalize_or_zero));
        let is_right =
            |mesh: &TriangleMesh, face| mesh.triangle(face).iter().sum::<DVec3>().x > 0.0;
        let cut = |h| {
            let twin = fine.twin(h).expect("a sphere is closed");
            is_right(&fine, FaceId::from_index(h.face().index())) != is_right(&fine, twin.face())
        };
        let cuts: HalfedgeMap<bool> = fine.halfedge_ids().map(cut).collect();
        // Data that is not cut there is taken across.
        let places = found(&fine, &[cuts, uncut(&fine)], &coarse);
        let mut n_across = 0;
        for (i, [cut, uncut]) in places.corners[0]
            .iter()
            .zip(&places.corners[1])
            .map(<[_; 2]>::from)
            .enumerate()
        {
            let side = is_right(&fine, places.faces[i / 3]);
            assert_eq!(is_right(&fine, cut.face), side);
            let corner = coarse.triangle(FaceId::from_index(i / 3))[i % 3];
            let is_across = (corner.x > 0.05) != side && corner.x.abs() > 0.05;
            assert!(!is_across || is_right(&fine, uncut.face) != side);
            n_across += usize::from(is_across);
        }
        assert!(n_across > 10, "no face lies across the cut");
    }

    #[test]
    fn no_way_leads_round_a_limb_to_the_far_side_of_a_cut() {
        let round = |p: DVec3| {
            let (flat, z) = (p.with_z(0.0), 4.0 * p.z);
            let radius = p.x.abs().max(p.y.abs());
            (flat.normalize_or_zero() * radius).with_z(z)
        };
        let limb = shapes::mapped_cube(8, round);
        let on_seam = |p: DVec3| p.y.abs() < 1e-9 && p.x > 0.9;
        let cut = |h| [limb.origin(h), limb.target(h)].map(|v| limb.position(v));
        let cut = |h| cut(h).into_iter().all(on_seam);
        let cuts: HalfedgeMap<bool> = limb.halfedge_ids().map(cut).collect();
        // Three of these would go round the limb; the cut lies near the far side of this one.
        let [low, high] = [DVec3::new(-0.32, -0.95, 0.0), DVec3::new(0.98, 0.2, 0.0)];
        let corners = [(low, -1.5), (high, -1.5), (high, 1.5), (low, 1.5)];
        let corners = corners.map(|(flat, z)| flat.with_z(z));
        let face = PolygonMesh::from_faces(corners.to_vec(), &[[0, 1, 2, 3]]).unwrap();
        let tree = Bvh::of_mesh(&limb);
        let places = places((&limb, &tree), &[cuts], &face, &Progress::none()).unwrap();
        for place in &places.corners[0] {
            let of = limb.triangle(place.face).iter().sum::<DVec3>();
            assert!(of.y < 0.0, "{} is beyond the cut", place.position);
        }
    }

    #[test]
    fn without_an_old_surface_there_are_no_places() {
        let output = shapes::polygons(&shapes::sphere(3));
        let old = TriangleMesh::new(Vec::new(), Vec::new()).unwrap();
        let nothing = places(
            (&old, &Bvh::new(&[])),
            &[uncut(&old)],
            &output,
            &Progress::none(),
        );
        let wanted = Places {
            corners: vec![Vec::new()],
            ..Places::default()
        };
        assert_eq!(nothing, Ok(wanted));
    }
}
