use proptest::prelude::*;

use super::*;
use crate::progress::CancelToken;
use crate::random::Random;
use crate::shapes;

fn brute_force(p: DVec3, triangles: &[[DVec3; 3]]) -> Closest {
    let all = (0..)
        .map(FaceId)
        .zip(triangles)
        .map(|(face, &t)| closest_on_triangle(p, t).of(face));
    all.min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared))
        .unwrap()
}

fn points(random: &mut Random, n: usize, size: f64) -> Vec<DVec3> {
    let mut unit = || random.unit() * 2.0 - 1.0;
    (0..n)
        .map(|_| DVec3::new(unit(), unit(), unit()) * size)
        .collect()
}

fn triangles_of(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    mesh.face_ids().map(|f| mesh.triangle(f)).collect()
}

#[test]
fn the_tree_finds_what_testing_every_triangle_finds() {
    for (name, mesh) in shapes::closed(7) {
        let triangles = triangles_of(&mesh);
        let tree = Bvh::of_mesh(&mesh);
        let mut random = Random::new(1);
        for size in [0.3, 3.0, 1e4] {
            for p in points(&mut random, 300, size) {
                let wanted = brute_force(p, &triangles);
                assert_eq!(tree.closest(p), wanted, "{name} {p}");
                let hint = FaceId(random.below(triangles.len()) as u32);
                assert_eq!(tree.closest_near(p, hint), wanted, "{name} {p} from {hint}");
            }
        }
        for &p in mesh.positions() {
            let found = tree.closest(p);
            assert_eq!(found, brute_force(p, &triangles), "{name}: a vertex");
            assert!(found.distance_squared < 1e-30);
        }
    }
}

#[test]
fn coordinates_of_any_size_are_searched_alike() {
    let mesh = shapes::limbs(4, 6);
    for (size, shift) in [
        (1e-30, 0.0),
        (1e30, 0.0),
        (1.0, 1e6),
        (1e-70, 0.0),
        (1e70, 0.0),
    ] {
        let place = |p: DVec3| p * size + shift;
        let triangles: Vec<_> = triangles_of(&mesh)
            .into_iter()
            .map(|t| t.map(place))
            .collect();
        let tree = Bvh::new(&triangles);
        for p in points(&mut Random::new(2), 200, 2.0) {
            assert_eq!(
                tree.closest(place(p)),
                brute_force(place(p), &triangles),
                "{size} {p}"
            );
        }
    }
}

#[test]
fn points_segments_and_needles_are_triangles_too() {
    let mut random = Random::new(3);
    let corners = points(&mut random, 60, 1.0);
    let mut triangles = Vec::new();
    for c in corners.chunks(3) {
        let middle = c[0].lerp(c[1], 0.4);
        triangles.push([c[0]; 3]);
        triangles.push([c[0], c[1], c[1]]);
        triangles.push([c[0], c[1], middle]);
        triangles.push([c[0], c[1], middle + c[2] * 1e-9]);
    }
    let tree = Bvh::new(&triangles);
    for p in points(&mut random, 300, 1.5) {
        let found = tree.closest(p);
        assert_eq!(found, brute_force(p, &triangles));
        assert!(found.position.is_finite() && found.weights.iter().all(|w| *w >= 0.0));
    }
}

#[test]
fn of_equal_triangles_the_first_is_found() {
    let triangle = [DVec3::X, DVec3::Y, DVec3::Z];
    let tree = Bvh::new(&[triangle; 50]);
    for p in points(&mut Random::new(4), 50, 2.0) {
        assert_eq!(tree.closest(p).face, FaceId(0));
        assert_eq!(
            tree.closest_where(p, 100.0, |f| f.0 >= 17).map(|c| c.face),
            Some(FaceId(17))
        );
    }
}

#[test]
fn a_filter_and_a_distance_limit_what_is_found() {
    let mesh = shapes::blob(5, 8);
    let tree = Bvh::of_mesh(&mesh);
    let up = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).z > 0.0;
    let mut random = Random::new(5);
    for p in points(&mut random, 300, 1.5) {
        let faces_up = |face: FaceId| up(mesh.triangle(face));
        let found = tree.closest_where(p, f64::INFINITY, faces_up).unwrap();
        let up: Vec<_> = mesh.face_ids().filter(|&f| faces_up(f)).collect();
        let of_up: Vec<_> = up.iter().map(|&f| mesh.triangle(f)).collect();
        let wanted = brute_force(p, &of_up);
        assert_eq!(
            found,
            Closest {
                face: up[wanted.face.index()],
                ..wanted
            }
        );
        let limit = found.distance_squared;
        assert_eq!(tree.closest_where(p, limit, faces_up), Some(found));
        assert_eq!(tree.closest_where(p, limit * 0.999, faces_up), None);
        for hint in [found.face, FaceId(random.below(mesh.n_faces()) as u32)].map(Some) {
            let near = |limit| tree.closest_where_near(p, limit, hint, faces_up);
            assert_eq!(near(limit), Some(found));
            assert_eq!(near(limit * 0.999), None);
        }
    }
}

#[test]
fn no_triangle_means_nothing_is_found() {
    let tree = Bvh::new(&[]);
    assert_eq!(
        tree.closest_where(DVec3::ZERO, f64::INFINITY, |_| true),
        None
    );
    tree.visit_overlaps(DVec3::NEG_INFINITY, DVec3::INFINITY, |face| {
        panic!("{face}")
    });
}

#[test]
fn a_raised_flag_stops_the_building() {
    let token = CancelToken::new();
    token.cancel();
    let triangles = [[DVec3::X, DVec3::Y, DVec3::Z]; 3];
    assert!(Bvh::build(&triangles, &Progress::silent(token)).is_err());
}

#[test]
fn overlapping_boxes_are_each_visited_once() {
    let mesh = shapes::limbs(6, 8);
    let tree = Bvh::of_mesh(&mesh);
    for p in points(&mut Random::new(6), 100, 3.0) {
        let [low, high] = [p.min(p * 0.5 + 0.2), p.max(p * 0.5 + 0.2)];
        let mut found = Vec::new();
        tree.visit_overlaps(low, high, |face| found.push(face));
        found.sort_unstable();
        let touches = |&f: &FaceId| {
            let [a, b, c] = mesh.triangle(f);
            a.min(b).min(c).cmple(high).all() && a.max(b).max(c).cmpge(low).all()
        };
        assert_eq!(found, mesh.face_ids().filter(touches).collect::<Vec<_>>());
    }
}

#[test]
fn a_box_that_only_touches_is_visited() {
    let mesh = shapes::mapped_cube(2, |p| p * 0.1 + 0.7);
    let tree = Bvh::of_mesh(&mesh);
    let mut n = 0;
    let corner = DVec3::splat(0.1 + 0.7);
    tree.visit_overlaps(corner, DVec3::ONE, |_| n += 1);
    assert!(n >= 3, "{n}");
}

fn coordinate() -> impl Strategy<Value = DVec3> {
    let n = || prop_oneof![Just(0.0), Just(1.0), -2.0..2.0];
    (n(), n(), n()).prop_map(DVec3::from)
}

proptest! {
    #[test]
    fn no_sample_of_a_triangle_is_closer_than_its_closest_point(
        p in coordinate(), a in coordinate(), b in coordinate(), c in coordinate(),
    ) {
        let found = closest_on_triangle(p, [a, b, c]);
        let sum: f64 = found.weights.iter().sum();
        prop_assert!((sum - 1.0).abs() < 1e-12 && found.weights.iter().all(|w| *w >= 0.0));
        let [u, v, w] = found.weights;
        prop_assert!((a * u + b * v + c * w).distance(found.position) < 1e-12);
        for i in 0..=20 {
            for j in 0..=20 - i {
                let [v, w] = [f64::from(i) / 20.0, f64::from(j) / 20.0];
                let sample = a * (1.0 - v - w) + b * v + c * w;
                let far = p.distance_squared(sample);
                prop_assert!(far >= found.distance_squared - 1e-12, "{sample}");
            }
        }
    }
}
