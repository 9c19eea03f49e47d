use super::super::tests::{sampled, star, vessel};
use super::*;
use crate::elementary::sin;
use crate::measure::total_area;

/// The cap of a loop as a mesh of its own.
fn cap_of(rim: &[DVec3]) -> TriangleMesh {
    let mesh = vessel(rim, 1.0);
    let mut sheet = Sheet::new(&mesh);
    let border = mesh.border_loops().remove(0);
    sheet
        .cap(&border, &Tubes::default(), &Progress::none())
        .unwrap();
    let added = sheet.faces[mesh.n_faces()..].iter().copied();
    let (cap, sources) = TriangleMesh::of_faces(&sheet.positions, added).unwrap();
    assert_eq!(cap.euler_number(), 1);
    let around: Vec<VertexId> = cap.border_loops()[0]
        .iter()
        .map(|&h| sources[cap.origin(h).index()])
        .collect();
    let first = border
        .iter()
        .position(|&h| mesh.target(h) == around[0])
        .unwrap();
    let wanted = (0..border.len()).map(|i| (first + border.len() - i) % border.len());
    let wanted: Vec<VertexId> = wanted.map(|i| mesh.target(border[i])).collect();
    assert_eq!(around, wanted);
    cap
}

fn polygon_area(points: &[DVec3]) -> f64 {
    let next = points.iter().cycle().skip(1);
    let twice: DVec3 = points.iter().zip(next).map(|(p, q)| p.cross(*q)).sum();
    twice.length() / 2.0
}

/// Planar loops: convex and not, coarse and fine, even and not.
fn planar() -> Vec<(&'static str, Vec<DVec3>)> {
    let l = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 3.], [0., 3.]];
    let c = [
        [0., 0.],
        [3., 0.],
        [3., 1.],
        [1., 1.],
        [1., 2.],
        [3., 2.],
        [3., 3.],
        [0., 3.],
    ];
    let zigzag = (0..40).map(|i| [f64::from(i), f64::from(i % 2) * 3.0]);
    let back = (0..40)
        .rev()
        .map(|i| [f64::from(i), f64::from(i % 2) * 3.0 + 0.4]);
    let zigzag: Vec<[f64; 2]> = zigzag.chain(back).collect();
    let mut uneven = sampled(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], 2.0);
    uneven.extend((1..100).map(|i| DVec3::new(0.0, 1.0 - f64::from(i) * 0.01, 0.0)));
    vec![
        ("triangle", star(3, 0.0)),
        ("quad", star(4, 0.0)),
        ("disc", star(60, 0.0)),
        ("star", star(50, 0.8)),
        ("l", sampled(&l, 0.1)),
        ("c", sampled(&c, 0.15)),
        (
            "slit",
            sampled(&[[0., 0.], [10., 0.], [10., 0.01], [0., 0.01]], 0.1),
        ),
        (
            "zigzag",
            zigzag.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect(),
        ),
        ("uneven", uneven),
    ]
}

#[test]
fn caps_of_planar_loops_have_the_area_of_the_loop_however_it_lies() {
    let turn = glam::DQuat::from_xyzw(0.1, 0.7, -0.1, 0.7);
    for (name, rim) in planar() {
        let turned: Vec<DVec3> = rim.iter().map(|&p| turn * p + DVec3::X).collect();
        for rim in [&rim, &turned] {
            let cap = cap_of(rim);
            let around: Vec<DVec3> = rim.iter().map(|&p| p - rim[0]).collect();
            let share = total_area(&cap) / polygon_area(&around);
            assert!((share - 1.0).abs() < 1e-6, "{name}: {share}");
            let n = cap.n_faces();
            assert!(n < 6 * rim.len() + 6, "{name}: {n} of {}", rim.len());
        }
    }
}

#[test]
fn a_slit_is_zipped_rather_than_fanned() {
    let point = |i: u32| f64::from(i.min(200 - i));
    let rim = (0..200).map(|i| DVec3::new(point(i), 0.0, sin(point(i) * 0.1)));
    let cap = cap_of(&rim.collect::<Vec<_>>());
    let length = |h| {
        cap.position(cap.origin(h))
            .distance(cap.position(cap.target(h)))
    };
    let longest = cap.halfedge_ids().map(length).fold(0.0, f64::max);
    assert!(longest < 3.0, "{longest}");
    assert!(total_area(&cap) < 0.5);
}

#[test]
fn a_cap_of_a_saddle_has_hardly_more_area_than_its_graph() {
    let height = |p: DVec3| 0.3 * (p.x * p.x - p.y * p.y);
    let rim = star(120, 0.0);
    let rim: Vec<DVec3> = rim.iter().map(|&p| p.with_z(height(p))).collect();
    // The integral of sqrt(1 + 0.36 r²) over the disc; the least area is a little below.
    let graph = std::f64::consts::PI * (1.36_f64.powi(3).sqrt() - 1.0) / (1.5 * 0.36);
    let share = total_area(&cap_of(&rim)) / graph;
    assert!((0.97..1.005).contains(&share), "{share}");
}

#[test]
fn caps_grow_with_their_loops_and_not_with_their_areas() {
    for n in [500, 2_000, 4_000] {
        let n_faces = cap_of(&star(n, 0.0)).n_faces();
        assert!(n_faces < 5 * n as usize, "{n}: {n_faces}");
    }
}

#[test]
fn a_loop_that_crosses_itself_when_seen_from_anywhere_has_a_cap() {
    let mut random = crate::random::Random::new(4);
    let mut point = || DVec3::new(random.unit(), random.unit(), random.unit());
    for n in [4, 30, 300] {
        let cap = cap_of(&(0..n).map(|_| point()).collect::<Vec<_>>());
        assert!(cap.n_faces() >= n - 2);
    }
}
