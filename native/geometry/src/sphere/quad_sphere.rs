//! The surface of a divided cuboid, blown up to the sphere: nothing but quads.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

use glam::DVec3;

use crate::elementary::tan;
use crate::mesh::PolygonMesh;

/// Builds the quad sphere with `a` × `b` × `c` divisions along x, y and z: 2 (ab + bc + ca) quads,
/// 8 vertices of valence 3 (the fewest that a closed quad mesh of genus 0 without higher valences
/// can have), all others of valence 4.
///
/// Divisions are evenly spaced in angle, which keeps the quads' areas within a ratio of 1.5 when
/// a = b = c. A division of 0 is taken as 1.
pub fn quad_sphere(counts: [u32; 3]) -> PolygonMesh {
    let counts = counts.map(|n| n.max(1));
    let mut vertices = Numbering::default();
    let mut faces = Vec::new();
    for axis in 0..3 {
        let [n_u, n_v] = [counts[(axis + 1) % 3], counts[(axis + 2) % 3]];
        for side in [0, counts[axis]] {
            let mut at = |u, v| {
                let mut place = [0; 3];
                place[axis] = side;
                place[(axis + 1) % 3] = u;
                place[(axis + 2) % 3] = v;
                vertices.number(place)
            };
            for u in 0..n_u {
                for v in 0..n_v {
                    let around = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
                    let [p, q, r, s] = around;
                    faces.push(if side == 0 { [p, s, r, q] } else { around });
                }
            }
        }
    }
    let positions = vertices
        .places
        .iter()
        .map(|&place| on_sphere(place, counts));
    PolygonMesh::from_faces(positions.collect(), &faces).expect("the indices are those given out")
}

/// The divisions whose quad sphere has a number of faces within 2 %, as cubic as possible; the
/// nearest number possible where that is out of reach (below about 100 faces).
pub fn quad_sphere_counts(n_faces: usize) -> [u32; 3] {
    let wanted = n_faces.max(6) as f64;
    let side = (wanted / 6.0).sqrt();
    // Eight steps around the cube's side always hold a count within 2 % where there is one.
    let low = (side as u32).saturating_sub(8).max(1);
    let high = side as u32 + 8;
    let mut best = ([1; 3], [f64::INFINITY; 3]);
    for a in low..=high {
        for b in a..=high {
            let [x, y] = [f64::from(a), f64::from(b)];
            let c = ((wanted / 2.0 - x * y) / (x + y)).round();
            if c < y {
                continue;
            }
            let error = (2.0 * (x * y + (x + y) * c) - wanted).abs() / wanted;
            let cost = [(error - 0.02).max(0.0), c / x, error];
            if cost < best.1 {
                best = ([a, b, c as u32], cost);
            }
        }
    }
    best.0
}

/// Numbers the grid points of a cuboid's surface in the order in which they are asked for.
#[derive(Default)]
struct Numbering {
    numbers: HashMap<[u32; 3], u32>,
    places: Vec<[u32; 3]>,
}

impl Numbering {
    fn number(&mut self, place: [u32; 3]) -> u32 {
        *self.numbers.entry(place).or_insert_with(|| {
            self.places.push(place);
            self.places.len() as u32 - 1
        })
    }
}

/// A grid point of the cuboid's surface, at even angles on the cube's side, on the sphere.
fn on_sphere(place: [u32; 3], counts: [u32; 3]) -> DVec3 {
    let coordinate = |i: usize| {
        let share = 2.0 * f64::from(place[i]) / f64::from(counts[i]) - 1.0;
        tan(FRAC_PI_4 * share)
    };
    DVec3::new(coordinate(0), coordinate(1), coordinate(2)).normalize_or(DVec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Id;
    use crate::sphere_map::check_cover;

    #[test]
    fn every_division_covers_the_sphere_with_eight_irregular_vertices() {
        for [a, b, c] in [[1, 1, 1], [1, 2, 3], [4, 4, 4], [5, 2, 9], [17, 18, 19]] {
            let mesh = quad_sphere([a, b, c]);
            let n_faces = 2 * (a * b + b * c + c * a) as usize;
            assert_eq!((mesh.n_faces(), mesh.n_quads()), (n_faces, n_faces));
            assert_eq!(mesh.n_vertices(), n_faces + 2);
            assert_eq!(check_cover(&mesh, mesh.positions()), Ok(()));
            let mut valence = vec![0; mesh.n_vertices()];
            mesh.corners().iter().for_each(|v| valence[v.index()] += 1);
            assert_eq!(valence.iter().filter(|&&n| n == 3).count(), 8);
            assert!(valence.iter().all(|&n| n == 3 || n == 4));
        }
    }

    #[test]
    fn any_count_is_met_within_two_percent() {
        let count = |n: usize| {
            let [a, b, c] = quad_sphere_counts(n).map(|x| x as usize);
            (2 * (a * b + b * c + c * a), c as f64 / a as f64)
        };
        let sizes = (100..3000).chain((3000..200_000).step_by(977));
        for n in sizes.chain([1_000_000, 4_000_000]) {
            let (found, aspect) = count(n);
            let error = found.abs_diff(n) as f64 / n as f64;
            assert!(error <= 0.02, "{n}: {found}");
            assert!(aspect <= if n < 1000 { 6.0 } else { 1.5 }, "{n}: {aspect}");
        }
        assert_eq!(
            [0, 6, 24, 54, 2400].map(|n| count(n).0),
            [6, 6, 24, 54, 2400]
        );
        assert_eq!(quad_sphere_counts(2400), [20; 3]);
    }

    #[test]
    fn quads_are_even() {
        let mesh = quad_sphere([16; 3]);
        let areas = mesh.faces().map(|f| {
            let [p, q, r, s] = [0, 1, 2, 3].map(|i| mesh.position(f[i]));
            (r - p).cross(s - q).length()
        });
        let [low, high] = areas.fold([f64::INFINITY, 0.0f64], |[l, h], x| [l.min(x), h.max(x)]);
        assert!(high / low < 1.5, "{}", high / low);
    }
}
