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

/// No firm edges.
fn kept(kept: &HalfedgeMap<bool>) -> Stay<'_> {
    Stay { kept, firm: None }
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
        let paired = pair(&map, kept(&none(&map)), &Progress::none()).unwrap();
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

/// Some faces and all that hang on to them, up to a number, for a few seeds: patches with borders of
/// any kind. On both sides of each edge of a border it is marked.
fn borders(mesh: &TriangleMesh, seed: u64) -> HalfedgeMap<bool> {
    let mut random = crate::random::Random::new(seed);
    let mut patch = vec![0; mesh.n_faces()];
    for number in 1..4 {
        let mut open = vec![crate::mesh::FaceId(random.below(mesh.n_faces()) as u32)];
        for _ in 0..=random.below(mesh.n_faces() / 4) {
            let at = random.below(open.len());
            let face = open[at];
            patch[face.index()] = number;
            let first = mesh.halfedge(face);
            let around = [first, first.next(), first.prev()].map(|h| mesh.twin(h).unwrap().face());
            open.extend(around);
        }
    }
    let side = |h: HalfedgeId| patch[h.face().index()];
    let edges = mesh.halfedge_ids();
    edges
        .map(|h| side(h) != side(mesh.twin(h).unwrap()))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_quad_lies_across_firm_edges_whatever_their_patches_are(seed in 0..1000_u64, n in 2..9_u32) {
        let map = radial_map(shapes::blob(seed, n));
        let firm = borders(map.mesh(), seed);
        let stay = Stay { kept: &none(&map), firm: Some(&firm) };
        let paired = pair(&map, stay, &Progress::none()).unwrap();
        let n_firm = firm.iter().filter(|is_firm| **is_firm).count() / 2;
        prop_assert!(n_firm > 0);
        // Each is an edge of faces that cover the sphere once, so that none lies across it.
        prop_assert_eq!(paired.firm.len(), n_firm);
        prop_assert_eq!(check_cover(&paired.quads, paired.quads.positions()), Ok(()));
        let four = split(&paired);
        prop_assert_eq!(four.firm.len(), 2 * n_firm);
        prop_assert_eq!(check_cover(&four.quads, four.quads.positions()), Ok(()));
        prop_assert_eq!(four.quads.n_quads(), four.quads.n_faces());
    }
}

#[test]
fn a_straight_firm_edge_keeps_two_quads_on_either_side_of_its_vertices() {
    // Two halves of a box, of as many triangles each.
    let map = radial_map(shapes::mapped_cube(8, |p| p));
    let mesh = map.mesh();
    let middle = |h: HalfedgeId| mesh.triangle(h.face()).iter().sum::<DVec3>().x > 0.0;
    let firm = mesh
        .halfedge_ids()
        .map(|h| middle(h) != middle(mesh.twin(h).unwrap()));
    let firm: HalfedgeMap<bool> = firm.collect();
    let stay = Stay {
        kept: &none(&map),
        firm: Some(&firm),
    };
    let paired = pair(&map, stay, &Progress::none()).unwrap();
    assert_eq!(
        (paired.firm.len(), paired.quads.n_quads()),
        (32, paired.quads.n_faces())
    );
    let n = n_at(&paired.quads);
    assert!(paired.firm.iter().flatten().all(|v| n[v.index()] >= 4));
}

#[test]
fn edges_that_are_to_stay_stay() {
    let map = radial_map(shapes::mapped_cube(6, |p| p));
    let mesh = map.mesh();
    let is_sharp = |h| crate::measure::dihedral_angle(mesh, h).abs() > 1.0;
    let sharp: HalfedgeMap<bool> = mesh.halfedge_ids().map(is_sharp).collect();
    let paired = pair(&map, kept(&sharp), &Progress::none()).unwrap();
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
    let pairs = pair(&map, kept(&none(&map)), &Progress::none())
        .unwrap()
        .quads;
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
    let four = split(&pair(&map, kept(&none(&map)), &Progress::none()).unwrap()).quads;
    assert_eq!((four.n_faces(), four.n_quads()), (8, 8));
    assert_eq!(check_cover(&four, four.positions()), Ok(()));
}

#[test]
fn a_cancelled_pairing_says_so() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let map = radial_map(shapes::sphere(4));
    let result = pair(&map, kept(&none(&map)), &Progress::silent(token));
    assert_eq!(result, Err(Error::Cancelled(Cancelled)));
}
