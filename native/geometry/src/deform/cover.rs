//! What each face of a sheet covers of the map's surface, which its corners alone do not tell.
//!
//! A flat face over the tip of a limb looks small and regular however long the limb is. Samples of
//! the surface know better: each belongs to the face that covers it on the sphere.

use glam::DVec3;

use super::sheet::Sheet;
use crate::measure::area_vector;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, Id};
use crate::sphere_map::{SphereMap, SurfacePoint, triple_product};

/// Samples that a face of average area gets. With two, areas are too rough to steer by.
const SAMPLES_PER_FACE: f64 = 4.0;
/// Finest cut of one face of the map, so that one huge face does not get all samples.
const FINEST: u32 = 24;
/// Faces that a sample crosses at most to find its own: between two rounds it crosses one or two.
const LONGEST_WALK: usize = 64;

/// A face that covers this many times its own area begins to count as lying over a tip; below 1.2
/// the roughness of the samples would count.
const LEAST_EXCESS: f64 = 1.3;
/// And from this many times on it does nothing but shrink there.
const FULL_EXCESS: f64 = 2.0;

/// A piece of the surface.
struct Sample {
    direction: DVec3,
    position: DVec3,
    area: f64,
    face: FaceId,
}

/// The part of the surface that a face covers.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Part {
    pub area: f64,
    /// The middle of the part; only its product with the area is summed up before [`Cover::update`] ends.
    pub centre: DVec3,
}

/// The surface in samples, and the part of each face.
pub(super) struct Cover {
    samples: Vec<Sample>,
    parts: FaceMap<Part>,
}

impl Cover {
    /// Samples the map's surface and gives each sample to the face that covers it.
    pub fn new(map: &SphereMap, sheet: &Sheet) -> Self {
        let owners = owners(map, sheet);
        let areas: Vec<f64> = map
            .mesh()
            .face_ids()
            .map(|f| area_vector(map.mesh().triangle(f)).length())
            .collect();
        let piece = areas.iter().sum::<f64>() / (SAMPLES_PER_FACE * sheet.faces().len() as f64);
        let mut samples = Vec::new();
        for face in map.mesh().face_ids() {
            let area = areas[face.index()];
            let cuts =
                ((area / piece.max(f64::MIN_POSITIVE)).sqrt().ceil() as u32).clamp(1, FINEST);
            samples.extend(middles(cuts).map(|weights| {
                let place = SurfacePoint { face, weights };
                Sample {
                    direction: map.sphere_position(place),
                    position: map.surface_position(place),
                    area: area / f64::from(cuts * cuts),
                    face: owners[face],
                }
            }));
        }
        let mut cover = Self {
            samples,
            parts: FaceMap::filled(sheet.faces().len(), Part::default()),
        };
        cover.update(sheet);
        cover
    }

    /// Gives the samples to the faces that cover them now.
    pub fn update(&mut self, sheet: &Sheet) {
        self.parts.as_mut_slice().fill(Part::default());
        for sample in &mut self.samples {
            sample.face = walk(sheet, sample.face, sample.direction);
            let part = &mut self.parts[sample.face];
            part.area += sample.area;
            part.centre += sample.position * sample.area;
        }
        for part in self.parts.as_mut_slice() {
            part.centre /= part.area.max(f64::MIN_POSITIVE);
        }
    }

    /// How much a face hides: 0 where it covers about its own area, 1 over a tip.
    pub fn hidden(&self, sheet: &Sheet, face: FaceId) -> f64 {
        ((self.excess(sheet, face) - LEAST_EXCESS) / (FULL_EXCESS - LEAST_EXCESS)).clamp(0.0, 1.0)
    }

    /// How many times its own area a face covers.
    pub fn excess(&self, sheet: &Sheet, face: FaceId) -> f64 {
        self.parts[face].area / sheet.area(face).max(f64::MIN_POSITIVE)
    }

    /// What a face covers; nothing when no sample hit it.
    pub fn part(&self, face: FaceId) -> &Part {
        &self.parts[face]
    }
}

/// For every face of the map, a face of the sheet that is not far away on the sphere.
fn owners(map: &SphereMap, sheet: &Sheet) -> FaceMap<FaceId> {
    let mut owners = FaceMap::filled(map.mesh().n_faces(), None);
    let mut queue = Vec::new();
    for v in sheet.vertex_ids() {
        let face = sheet.point(v).place.face;
        if owners[face].is_none() {
            owners[face] = sheet.ring(v).first().copied();
            queue.push(face);
        }
    }
    let mut next = 0;
    while let Some(&face) = queue.get(next) {
        next += 1;
        for i in 0..3 {
            let twin = map.mesh().twin(HalfedgeId(face.0 * 3 + i));
            let beyond = twin.expect("a sphere map has no border").face();
            if owners[beyond].is_none() {
                owners[beyond] = owners[face];
                queue.push(beyond);
            }
        }
    }
    owners
        .iter()
        .map(|owner| owner.unwrap_or(FaceId(0)))
        .collect()
}

/// The middles of the n² equal pieces of a triangle.
fn middles(n: u32) -> impl Iterator<Item = [f64; 3]> {
    let third = 1.0 / f64::from(3 * n);
    (0..n).flat_map(move |i| {
        (0..n - i).flat_map(move |j| {
            let upright = [3 * i + 1, 3 * j + 1];
            let turned = [3 * i + 2, 3 * j + 2];
            let is_inside = i + j + 1 < n;
            [Some(upright), is_inside.then_some(turned)]
                .into_iter()
                .flatten()
                .map(move |[a, b]| {
                    let [a, b] = [f64::from(a) * third, f64::from(b) * third];
                    [a, b, 1.0 - a - b]
                })
        })
    })
}

/// The face that covers a direction, from edge to edge; the last one if the walk gets lost.
fn walk(sheet: &Sheet, start: FaceId, direction: DVec3) -> FaceId {
    let mut at = start;
    for _ in 0..LONGEST_WALK {
        let face = &sheet.faces()[at];
        let edges = (0..face.corners().len()).map(|i| [face.corner(i, 0), face.corner(i, 1)]);
        let beyond = edges
            .map(|[a, b]| {
                let [p, q] = [a, b].map(|v| sheet.point(v).sphere);
                (triple_product(p, q, direction), [a, b])
            })
            .min_by(|x, y| x.0.total_cmp(&y.0));
        let next = match beyond {
            Some((product, [a, b])) if product < 0.0 => sheet.face_left_of(b, a),
            _ => None,
        };
        match next {
            Some(next) => at = next,
            None => return at,
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{total_area, vertex_normals};
    use crate::shapes;
    use crate::sphere::quad_sphere;

    #[test]
    fn the_pieces_of_a_triangle_are_all_of_it() {
        for n in 1..5 {
            let all: Vec<_> = middles(n).collect();
            assert_eq!(all.len() as u32, n * n);
            let sum = all
                .iter()
                .fold([0.0; 3], |s, w| [s[0] + w[0], s[1] + w[1], s[2] + w[2]]);
            assert!(
                sum.iter()
                    .all(|s| (s * 3.0 - f64::from(n * n)).abs() < 1e-9),
                "{sum:?}"
            );
        }
    }

    #[test]
    fn parts_add_up_to_the_surface_and_lie_under_their_faces() {
        let mesh = shapes::sphere(12);
        let sphere = mesh
            .positions()
            .iter()
            .map(|p| p.normalize_or(DVec3::Z))
            .collect();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([5, 6, 7]));
        let cover = Cover::new(&map, &sheet);
        let total: f64 = cover.parts.iter().map(|part| part.area).sum();
        assert!((total - total_area(map.mesh())).abs() < 1e-9);
        for (id, face) in sheet.faces().iter_ids() {
            let middle: DVec3 = face
                .corners()
                .iter()
                .map(|&v| sheet.position(v))
                .sum::<DVec3>()
                / 4.0;
            assert!(cover.part(id).centre.distance(middle) < 0.15);
        }
    }
}
