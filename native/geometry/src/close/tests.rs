use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::elementary::direction;
use crate::measure::total_area;
use crate::mesh::FaceId;
use crate::random::Random;
use crate::shapes;

/// A closed mesh with faces cut out round some of its faces, the largest piece of it.
fn open(mesh: &TriangleMesh, seed: u64, sizes: &[usize]) -> TriangleMesh {
    let mut random = Random::new(seed);
    let mut is_kept = vec![true; mesh.n_faces()];
    for size in sizes.iter().map(|&size| size.min(mesh.n_faces() / 8)) {
        let mut patch = vec![FaceId::from_index(random.below(mesh.n_faces()))];
        for i in 0..size {
            let start = mesh.halfedge(patch[i]);
            let sides = [start, start.next(), start.prev()].map(|h| mesh.twin(h).unwrap().face());
            let new = sides.into_iter().filter(|f| !patch.contains(f));
            patch.extend(new.collect::<Vec<_>>());
        }
        for face in &patch[..size] {
            is_kept[face.index()] = false;
        }
    }
    // What touches in a vertex only is more than a surface may: the gap takes all that is there.
    loop {
        let kept = mesh.face_ids().filter(|f| is_kept[f.index()]);
        match TriangleMesh::of_faces(mesh.positions(), kept.map(|f| mesh.face(f))) {
            Ok((opened, _)) => {
                let pieces = opened.components(&Progress::none()).unwrap();
                return pieces
                    .into_iter()
                    .max_by_key(TriangleMesh::n_faces)
                    .unwrap();
            }
            Err(_) => thin_out(mesh, &mut is_kept),
        }
    }
}

/// Takes the faces away round every vertex whose faces are more than one fan.
fn thin_out(mesh: &TriangleMesh, is_kept: &mut [bool]) {
    for v in mesh.vertex_ids() {
        let fan: Vec<usize> = mesh.outgoing(v).map(|h| h.face().index()).collect();
        let n_ends =
            (0..fan.len()).filter(|&i| is_kept[fan[i]] && !is_kept[fan[(i + 1) % fan.len()]]);
        if n_ends.count() > 1 {
            for f in fan {
                is_kept[f] = false;
            }
        }
    }
}

fn closed(mesh: &TriangleMesh, settings: &Settings) -> Closed {
    close(mesh, settings, &Progress::none()).unwrap()
}

/// Every way to close a mesh without filling a loop.
fn ways() -> [Settings; 3] {
    [Way::Measured, Way::Cap, Way::Double].map(|way| Settings {
        way,
        ..Settings::default()
    })
}

fn filled(fill: Fill) -> Settings {
    Settings {
        fill,
        ..Settings::default()
    }
}

fn edges(mesh: &TriangleMesh, is_one: impl Fn(HalfedgeId) -> bool) -> Vec<[VertexId; 2]> {
    let chosen = mesh.halfedge_ids().filter(|&h| is_one(h));
    let ends = chosen.map(|h| split::key(mesh.origin(h), mesh.target(h)));
    let mut ends: Vec<_> = ends.collect();
    ends.sort_unstable();
    ends.dedup();
    ends
}

/// All that is promised of a closed mesh.
fn check(mesh: &TriangleMesh, closed: &Closed) {
    let made = &closed.mesh;
    made.check().unwrap();
    assert!(made.is_closed());
    assert_eq!((made.euler_number(), made.face_components().1), (2, 1));
    assert_eq!(&made.faces()[..mesh.n_faces()], mesh.faces());
    assert_eq!(&made.positions()[..mesh.n_vertices()], mesh.positions());
    let n_real = closed.is_real.iter().filter(|real| **real).count();
    assert!(closed.is_real.as_slice()[..n_real].iter().all(|real| *real));
    assert!(n_real >= mesh.n_faces());
    let mut corners: Vec<_> = made.faces().to_vec();
    for face in &mut corners {
        face.sort_unstable();
    }
    corners.sort_unstable();
    assert!(corners.windows(2).all(|pair| pair[0] != pair[1]));
    let n_loops = mesh.border_loops().len();
    assert_eq!(
        closed.n_filled + closed.n_capped + closed.n_doubled,
        n_loops
    );
    if closed.n_filled == 0 {
        let border = closed.border();
        let old = edges(mesh, |h| mesh.twin(h).is_none());
        assert_eq!(edges(made, |h| border[h]), old);
        assert_eq!(n_real, mesh.n_faces());
    }
    let [low, high] = crate::mesh::bounds(mesh.positions());
    let is_inside = |p: &DVec3| p.cmpge(low).all() && p.cmple(high).all();
    assert!(made.positions().iter().all(is_inside));
}

/// A deep vessel below a loop.
pub fn vessel(rim: &[DVec3], depth: f64) -> TriangleMesh {
    let n = rim.len() as u32;
    let down = DVec3::NEG_Z * depth;
    let centre = rim.iter().sum::<DVec3>() / f64::from(n) + down * 1.1;
    let mut positions = rim.to_vec();
    positions.extend(rim.iter().map(|&p| p + down));
    positions.push(centre);
    let walls = (0..n).flat_map(|i| {
        let [a, b, c, d] = [i, (i + 1) % n, n + (i + 1) % n, n + i];
        [[a, d, b], [b, d, c], [d, 2 * n, c]]
    });
    let faces = walls.map(|face| face.map(VertexId)).collect();
    TriangleMesh::new(positions, faces).unwrap()
}

/// The corners of a polygon with points along its sides.
pub fn sampled(corners: &[[f64; 2]], step: f64) -> Vec<DVec3> {
    let mut points = Vec::new();
    for (i, &[x, y]) in corners.iter().enumerate() {
        let from = DVec3::new(x, y, 0.0);
        let [x, y] = corners[(i + 1) % corners.len()];
        let to = DVec3::new(x, y, 0.0);
        let n = (from.distance(to) / step).ceil().max(1.0);
        points.extend((0..n as u32).map(|k| from.lerp(to, f64::from(k) / n)));
    }
    points
}

/// A circle of so many points, every second one nearer to its middle by a share.
pub fn star(n: u32, depth: f64) -> Vec<DVec3> {
    let point = |i: u32| {
        let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        direction(angle) * (1.0 - depth * f64::from(i % 2))
    };
    (0..n).map(|i| point(i).extend(0.0)).collect()
}

#[test]
fn loops_on_a_line_or_in_a_point_are_closed() {
    for n in [3, 4, 7, 100, 300] {
        for shape in 0..4 {
            let point = |i: u32| match shape {
                0 => DVec3::X * f64::from(i),
                1 => DVec3::X * f64::from(i.min(n - i)),
                2 => DVec3::ZERO,
                _ => DVec3::X * f64::from(i.min(n - i) / 3),
            };
            let rim: Vec<DVec3> = (0..n).map(point).collect();
            for depth in [0.0, 5.0] {
                let mesh = vessel(&rim, depth);
                for settings in ways() {
                    check(&mesh, &closed(&mesh, &settings));
                }
            }
        }
    }
}

#[test]
fn sheets_are_doubled_and_vessels_are_capped() {
    let square = sampled(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], 0.1);
    let flat = vessel(&square, 0.0);
    let two_loops = |depth: f64| {
        let tube = vessel(&star(40, 0.0), depth);
        let walls = tube.faces().iter().filter(|f| !f.contains(&VertexId(80)));
        TriangleMesh::of_faces(tube.positions(), walls.copied())
            .unwrap()
            .0
    };
    let ball = shapes::sphere(12);
    let upper = ball
        .face_ids()
        .filter(|&f| ball.triangle(f).iter().sum::<DVec3>().z > 0.0);
    let upper = upper.map(|f| ball.face(f));
    let hemisphere = TriangleMesh::of_faces(ball.positions(), upper).unwrap().0;
    let cases = [
        (flat, 1),
        (vessel(&square, 2.0), 0),
        (two_loops(4.0), 0),
        (hemisphere, 0),
        (
            vessel(
                &sampled(&[[0., 0.], [9., 0.], [9., 0.2], [0., 0.2]], 0.1),
                0.0,
            ),
            1,
        ),
    ];
    for (i, (mesh, n_doubled)) in cases.into_iter().enumerate() {
        let closed = closed(&mesh, &Settings::default());
        check(&mesh, &closed);
        assert_eq!(closed.n_doubled, n_doubled, "{i}");
        if n_doubled == 1 {
            let [once, twice] = [&mesh, &closed.mesh].map(total_area);
            assert!((twice / once - 2.0).abs() < 1e-12, "{i}");
        }
    }
}

#[test]
fn a_plate_with_five_windows_is_doubled_and_they_are_closed_on_both_sides() {
    let n = 12;
    let position = |i: u32| DVec3::new(f64::from(i % (n + 1)), f64::from(i / (n + 1)), 0.0);
    let positions: Vec<DVec3> = (0..(n + 1) * (n + 1)).map(position).collect();
    let windows = [[2, 2], [2, 8], [8, 2], [8, 8], [5, 5]];
    let is_solid = |[x, y]: &[u32; 2]| {
        !windows
            .iter()
            .any(|[a, b]| (*a..a + 2).contains(x) && (*b..b + 2).contains(y))
    };
    let squares = (0..n).flat_map(|y| (0..n).map(move |x| [x, y]));
    let faces = squares.filter(is_solid).flat_map(|[x, y]| {
        let a = y * (n + 1) + x;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]].map(|face| face.map(VertexId))
    });
    let mesh = TriangleMesh::of_faces(&positions, faces).unwrap().0;
    let closed = closed(&mesh, &Settings::default());
    check(&mesh, &closed);
    assert_eq!((closed.n_capped, closed.n_doubled), (5, 1));
    let area = f64::from(n * n);
    assert!((total_area(&closed.mesh) / area - 2.0).abs() < 1e-12);
}

#[test]
fn one_triangle_and_two_are_closed() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
    for faces in [vec![[0, 1, 2]], vec![[0, 1, 2], [0, 2, 3]]] {
        let faces = faces.into_iter().map(|f| f.map(VertexId));
        let mesh = TriangleMesh::of_faces(&points, faces).unwrap().0;
        for fill in [Fill::None, Fill::All] {
            check(&mesh, &closed(&mesh, &filled(fill)));
        }
    }
}

#[test]
fn short_loops_are_filled_for_good_and_are_no_border() {
    let mesh = open(&shapes::blob(3, 10), 5, &[1, 1, 40]);
    assert_eq!(mesh.border_loops().len(), 3);
    let mut lengths: Vec<f64> = mesh
        .border_loops()
        .iter()
        .map(|b| length(&mesh, b))
        .collect();
    lengths.sort_by(f64::total_cmp);
    let closed = closed(&mesh, &filled(Fill::UpTo(lengths[1])));
    check(&mesh, &closed);
    assert_eq!((closed.n_filled, closed.n_capped), (2, 1));
    let border = closed.border();
    let longest = mesh
        .border_loops()
        .into_iter()
        .max_by(|a, b| length(&mesh, a).total_cmp(&length(&mesh, b)));
    assert_eq!(
        edges(&closed.mesh, |h| border[h]).len(),
        longest.unwrap().len()
    );
    let all = super::tests::closed(&mesh, &filled(Fill::All));
    assert!(all.is_real.iter().all(|real| *real) && all.border().iter().all(|b| !b));
}

#[test]
fn what_is_closed_stays_and_what_cannot_be_closed_is_told() {
    let ball = shapes::sphere(4);
    let same = closed(&ball, &Settings::default());
    assert_eq!(same.mesh, ball);
    let message = |mesh: &TriangleMesh| {
        close(mesh, &Settings::default(), &Progress::none())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(&shapes::torus(8, 5)),
        "1 handles; they must be cut before borders are closed"
    );
    let moved = ball.positions().iter().map(|&p| p + 3.0);
    let positions = ball.positions().iter().copied().chain(moved).collect();
    let shift = ball.n_vertices() as u32;
    let again = ball
        .faces()
        .iter()
        .map(|f| f.map(|v| VertexId(v.0 + shift)));
    let two = TriangleMesh::new(
        positions,
        ball.faces().iter().copied().chain(again).collect(),
    );
    assert_eq!(
        message(&two.unwrap()),
        "2 components; one at a time can be closed"
    );
}

#[test]
fn a_cancelled_mesh_is_not_closed() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let mesh = vessel(&star(9, 0.0), 1.0);
    let refused = close(&mesh, &Settings::default(), &Progress::silent(token));
    assert_eq!(refused, Err(Error::Cancelled(Cancelled)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_opened_mesh_is_closed(
        (which, n) in (0_usize..5, 3_u32..9),
        seed in any::<u64>(),
        sizes in prop::collection::vec(1_usize..60, 1..5),
        power in prop::sample::select(vec![-300, -30, 0, 30, 300]),
    ) {
        let (_, mesh) = shapes::closed(n).swap_remove(which);
        let mesh = open(&mesh, seed, &sizes);
        let scale = 10_f64.powi(power);
        let mesh = mesh.with_positions(mesh.positions().iter().map(|&p| p * scale).collect());
        for settings in ways() {
            let first = closed(&mesh, &settings);
            check(&mesh, &first);
            prop_assert_eq!(&first, &closed(&mesh, &settings));
        }
        check(&mesh, &closed(&mesh, &filled(Fill::All)));
    }
}
