use glam::DVec3;

use super::*;
use crate::elementary::{cos, sin};
use crate::mesh::Id;

fn octahedron() -> (TriangleMesh, VertexMap<DVec3>) {
    let sphere = vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::NEG_X,
        DVec3::NEG_Y,
        DVec3::NEG_Z,
    ];
    let positions = sphere
        .iter()
        .map(|&s| s * DVec3::new(2.0, 1.0, 3.0))
        .collect();
    let faces = [
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    let faces = faces.map(|f: [u32; 3]| f.map(VertexId)).to_vec();
    (
        TriangleMesh::new(positions, faces).unwrap(),
        VertexMap::from_vec(sphere),
    )
}

#[test]
fn every_direction_is_found_where_it_is() {
    let (mesh, sphere) = octahedron();
    let map = SphereMap::prove(mesh, sphere).unwrap();
    for i in 0..500 {
        let t = f64::from(i);
        let direction = DVec3::new(sin(t * 0.7), cos(t * 1.3), sin(t * 2.1) * 0.8);
        let Some(direction) = direction.try_normalize() else {
            continue;
        };
        let place = map.locate(direction);
        assert!(
            map.sphere_position(place).distance(direction) < 1e-12,
            "{direction}"
        );
        let again = map.locate_near(direction, FaceId::from_index(i as usize % 8));
        assert!(
            map.surface_position(again)
                .distance(map.surface_position(place))
                < 1e-12
        );
    }
}

#[test]
fn sphere_point_plus_interpolated_offset_is_the_surface_point() {
    let (mesh, sphere) = octahedron();
    let map = SphereMap::prove(mesh, sphere).unwrap();
    let place = SurfacePoint {
        face: FaceId(3),
        weights: [0.2, 0.5, 0.3],
    };
    let chord = weighted(map.sphere_triangle(place.face), place.weights);
    let offset = weighted(
        map.mesh().face(place.face).map(|v| map.offsets()[v]),
        place.weights,
    );
    assert!((chord + offset).distance(map.surface_position(place)) < 1e-15);
}

#[test]
fn what_is_not_a_bijection_is_refused() {
    let (mesh, sphere) = octahedron();
    let turned = |f: fn(&mut VertexMap<DVec3>)| {
        let mut sphere = sphere.clone();
        f(&mut sphere);
        SphereMap::prove(mesh.clone(), sphere).unwrap_err()
    };
    let folded = turned(|s| s[VertexId(2)] = DVec3::NEG_Z);
    assert!(
        matches!(
            folded,
            NotABijection::Folded {
                n_folds: 4,
                n_faces: 8,
                ..
            }
        ),
        "{folded}"
    );
    let mirrored = turned(|s| s.as_mut_slice().iter_mut().for_each(|p| p.x = -p.x));
    assert!(
        matches!(mirrored, NotABijection::Folded { n_folds: 8, .. }),
        "{mirrored}"
    );
    let nan = turned(|s| s[VertexId(1)] = DVec3::NAN);
    assert!(
        matches!(
            nan,
            NotABijection::NotOnSphere {
                vertex: VertexId(1),
                ..
            }
        ),
        "{nan}"
    );
    let short = SphereMap::prove(mesh.clone(), VertexMap::filled(3, DVec3::X)).unwrap_err();
    assert!(
        matches!(
            short,
            NotABijection::WrongNumber {
                n_points: 3,
                n_vertices: 6
            }
        ),
        "{short}"
    );
}

#[test]
fn degree_counts_coverings() {
    let (mesh, sphere) = octahedron();
    assert_eq!(degree(mesh.faces(), &sphere), 1);
    let total: f64 = mesh
        .faces()
        .iter()
        .map(|f| solid_angle(sphere[f[0]], sphere[f[1]], sphere[f[2]]))
        .sum();
    assert!((total - 4.0 * PI).abs() < 1e-12);
}

#[test]
fn the_sign_is_exact_where_rounding_would_decide() {
    // Three points on one great circle, the last lifted by the least amount there is.
    let [a, b] = [DVec3::X, DVec3::new(0.6, 0.8, 0.0)];
    let flat = DVec3::new(-0.28, 0.96, 0.0);
    assert!(!is_positive(a, b, flat));
    assert!(is_positive(a, b, flat + DVec3::Z * f64::MIN_POSITIVE));
    assert!(!is_positive(a, b, flat - DVec3::Z * f64::MIN_POSITIVE));
}
