//! Points spread over a surface.

use glam::DVec3;

use crate::mesh::{FaceId, Id, VertexMap};
use crate::random::Random;
use crate::sphere_map::{SphereMap, SurfacePoint};

/// Draws `n` places with a density in proportion to `density`, in the
/// order of a curve that fills the sphere.
///
/// Stratified: the surface is cut along the curve into n pieces of equal weight, and each gets one
/// place. Independent places would differ from the wanted numbers by their square root over
/// long ranges, which relaxation is slow to even out.
pub fn sample(
    map: &SphereMap,
    density: &VertexMap<f64>,
    n: usize,
    random: &mut Random,
) -> Vec<SurfacePoint> {
    let mesh = map.mesh();
    let middle = |face| map.sphere_triangle(face).into_iter().sum::<DVec3>();
    let mut order: Vec<(u64, FaceId)> = mesh
        .face_ids()
        .map(|f| (along_curve(middle(f)), f))
        .collect();
    order.sort_unstable();
    let weight = |face| {
        let [a, b, c] = mesh.triangle(face);
        let area = (b - a).cross(c - a).length();
        area * mesh.face(face).map(|v| density[v]).into_iter().sum::<f64>()
    };
    let total: f64 = order.iter().map(|&(_, face)| weight(face)).sum();
    let mut places = Vec::with_capacity(n);
    let mut passed = 0.0;
    for &(_, face) in &order {
        passed += weight(face);
        while places.len() < n && (places.len() as f64 + 0.5) / n as f64 * total <= passed {
            places.push(inside(face, random));
        }
    }
    // Rounding may have left the last place out.
    while places.len() < n {
        places.push(inside(
            FaceId::from_index(random.below(mesh.n_faces())),
            random,
        ));
    }
    places
}

/// A place in a face, evenly spread.
pub fn inside(face: FaceId, random: &mut Random) -> SurfacePoint {
    let root = random.unit().sqrt();
    let share = random.unit();
    SurfacePoint {
        face,
        weights: [1.0 - root, root * (1.0 - share), root * share],
    }
}

/// How far along a curve that fills the sphere a direction lies: the side of the cube, then the
/// bits of both coordinates in turn (Morton 1966).
fn along_curve(direction: DVec3) -> u64 {
    let size = direction.abs();
    let axis = size.max_position();
    let scale = size[axis].max(f64::MIN_POSITIVE);
    let cell = |i: usize| {
        let share = (direction[(axis + i) % 3] / scale).mul_add(0.5, 0.5);
        spread_bits((share * f64::from(1 << 20)) as u64)
    };
    let side = 2 * axis as u64 + u64::from(direction[axis] < 0.0);
    side << 44 | cell(1) << 1 | cell(2)
}

/// Puts a zero bit before each of the lower 32 bits.
fn spread_bits(x: u64) -> u64 {
    let x = (x | x << 16) & 0x0000_ffff_0000_ffff;
    let x = (x | x << 8) & 0x00ff_00ff_00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333_3333_3333;
    (x | x << 1) & 0x5555_5555_5555_5555
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn every_part_of_the_surface_gets_its_share() {
        let sphere = VertexMap::from_vec(shapes::sphere(16).positions().to_vec());
        let map = SphereMap::prove(shapes::cuboid(16), sphere).unwrap();
        let density = VertexMap::filled(map.mesh().n_vertices(), 1.0);
        let places = sample(&map, &density, 4000, &mut Random::new(1));
        assert_eq!(places.len(), 4000);
        // The sides of the box have areas 0.8, 0.6 and 0.48.
        for (axis, half, area) in [(0, 0.5, 0.48), (1, 0.4, 0.6), (2, 0.3, 0.8)] {
            let on_side = |&&at: &&SurfacePoint| map.surface_position(at)[axis] > half - 1e-9;
            let found = places.iter().filter(on_side).count() as f64;
            let wanted = 4000.0 * area / 3.76;
            // Independent places would miss by 26 in the mean.
            assert!((found - wanted).abs() < 6.0, "{axis}: {found} {wanted}");
        }
    }

    #[test]
    fn places_inside_a_face_have_the_centroid_of_the_face() {
        let mut random = Random::new(2);
        let mut sum = [0.0; 3];
        for _ in 0..3000 {
            let weights = inside(FaceId(0), &mut random).weights;
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (total, weight) in sum.iter_mut().zip(weights) {
                *total += weight / 3000.0;
            }
        }
        assert!(sum.iter().all(|w| (w - 1.0 / 3.0).abs() < 0.02), "{sum:?}");
    }
}
