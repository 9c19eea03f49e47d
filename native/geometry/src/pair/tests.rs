//! What pairing promises, on blobs and limbs.

use proptest::prelude::*;

use super::*;
use crate::mesh::TriangleMesh;
use crate::shapes;
use crate::sphere_map::check_cover;

/// A map by radial projection, for shapes that are star-shaped from the origin.
fn radial_map(mesh: TriangleMesh) -> SphereMap {
    let sphere = mesh.positions().iter();
    let sphere = sphere.map(|p| p.normalize_or(DVec3::Z)).collect();
    SphereMap::prove(mesh, sphere).unwrap()
}

fn none(map: &SphereMap) -> HalfedgeMap<bool> {
    HalfedgeMap::filled(3 * map.mesh().n_faces(), false)
}

fn n_at(quads: &PolygonMesh) -> Vec<usize> {
    let mut n = vec![0; quads.n_vertices()];
    for &v in quads.corners() {
        n[v.0 as usize] += 1;
    }
    n
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn pairs_and_their_quarters_cover_the_sphere_with_quads_alone(seed in 0..1000_u64, n in 2..9_u32) {
        let map = radial_map(shapes::blob(seed, n));
        let paired = pair(&map, &none(&map), &Progress::none()).unwrap();
        let pairs = &paired.quads;
        let n_pairs = map.mesh().n_faces() / 2;
        prop_assert!(pairs.n_faces() <= n_pairs && pairs.n_faces() * 20 >= 19 * n_pairs);
        let four = split(&paired).quads;
        prop_assert_eq!(four.n_faces(), 4 * pairs.n_faces());
        for quads in [pairs, &four] {
            prop_assert_eq!(quads.n_quads(), quads.n_faces());
            // Closed and of genus 0: V − E + F = 2 with 2 E = 4 F.
            prop_assert_eq!(quads.n_vertices(), quads.n_faces() + 2);
            prop_assert_eq!(check_cover(quads, quads.positions()), Ok(()));
        }
        prop_assert!(n_at(pairs).iter().all(|&n| n >= 3));
    }
}

#[test]
fn edges_that_are_to_stay_stay() {
    let map = radial_map(shapes::mapped_cube(6, |p| p));
    let mesh = map.mesh();
    let is_sharp = |h| crate::measure::dihedral_angle(mesh, h).abs() > 1.0;
    let kept: HalfedgeMap<bool> = mesh.halfedge_ids().map(is_sharp).collect();
    let paired = pair(&map, &kept, &Progress::none()).unwrap();
    let four = split(&paired);
    for (found, n) in [(paired, 12 * 6), (four, 2 * 12 * 6)] {
        assert_eq!(found.kept.len(), n);
        for [a, b] in found.kept {
            // Along an edge of the box one coordinate alone changes.
            let on_box = |v| {
                let p: DVec3 = found.quads.position(v);
                p / p.abs().max_element()
            };
            let along = (on_box(a) - on_box(b)).abs();
            let n_still = along.to_array().into_iter().filter(|x| *x < 1e-9).count();
            assert_eq!(n_still, 2, "{along}");
        }
    }
}

#[test]
fn regular_triangles_become_squares() {
    let map = radial_map(shapes::cuboid(8));
    let pairs = pair(&map, &none(&map), &Progress::none()).unwrap().quads;
    let regular = n_at(&pairs).iter().filter(|&&n| n == 4).count();
    assert!(10 * regular > 9 * pairs.n_vertices(), "{regular}");
}

#[test]
fn the_fewest_triangles_become_quads() {
    let tetrahedron = TriangleMesh::new(
        vec![
            DVec3::ONE,
            DVec3::new(1.0, -1.0, -1.0),
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::new(-1.0, -1.0, 1.0),
        ],
        [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
            .map(|f| f.map(crate::mesh::VertexId))
            .to_vec(),
    )
    .unwrap();
    let map = radial_map(tetrahedron);
    let four = split(&pair(&map, &none(&map), &Progress::none()).unwrap()).quads;
    assert_eq!((four.n_faces(), four.n_quads()), (8, 8));
    assert_eq!(check_cover(&four, four.positions()), Ok(()));
}

#[test]
fn a_cancelled_pairing_says_so() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let map = radial_map(shapes::sphere(4));
    let result = pair(&map, &none(&map), &Progress::silent(token));
    assert_eq!(result, Err(Error::Cancelled(Cancelled)));
}
