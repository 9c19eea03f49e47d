//! Mirror symmetry of parts with borders and handles.

mod common;

use std::collections::HashSet;

use glam::DVec3;
use orbflow_geometry::elementary::{cos, sin, sin_cos};
use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::topology;
use orbflow_geometry::mesh::{PolygonMesh, VertexId};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::pipeline::{Fault, Input, Mirror, Mirrored, Remeshed, Settings, remesh};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;

fn run(mesh: &PolygonMesh, mirror: Mirror, faces: usize) -> Remeshed {
    let settings = Settings {
        faces,
        mirror,
        ..Settings::default()
    };
    let (solver, quiet) = (Solver::default(), Progress::none());
    remesh(Input::new(mesh), &settings, &solver, &quiet).expect("an open mesh can be done")
}

/// Squares over a grid of steps from -1 to 1, closed in either direction or not.
fn grid([across, along]: [(u32, bool); 2], place: impl Fn(f64, f64) -> DVec3) -> PolygonMesh {
    let n_points = |(n, is_closed): (u32, bool)| n + u32::from(!is_closed);
    let [n, m] = [across, along].map(n_points);
    let share = |i: u32, (n, _): (u32, bool)| 2.0 * f64::from(i) / f64::from(n) - 1.0;
    let all = (0..m).flat_map(|j| (0..n).map(move |i| [i, j]));
    let positions = all.map(|[i, j]| place(share(i, across), share(j, along)));
    let id = |i: u32, j: u32| (j % m) * n + i % n;
    let faces = (0..along.0).flat_map(|j| (0..across.0).map(move |i| [i, j]));
    let faces: Vec<[u32; 4]> = faces
        .map(|[i, j]| [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)])
        .collect();
    PolygonMesh::from_faces(positions.collect(), &faces).expect("a grid is a mesh")
}

/// A point of a circle, from the share of a round.
fn round(share: f64, radius: f64) -> [f64; 2] {
    let (s, c) = sin_cos(std::f64::consts::PI * share);
    [radius * s, radius * c]
}

/// Some of the faces of a cube that is blown up, those whose middles are not in a window.
fn with_windows(
    n: u32,
    place: impl Fn(DVec3) -> DVec3,
    is_window: impl Fn(DVec3) -> bool,
) -> PolygonMesh {
    let flat = common::mapped_cube(n, |p| p);
    let faces = flat.faces().iter().filter(|face| {
        // Of both halves of a square the same: it is cut otherwise than its image.
        let [a, b, c] = face.map(|v| flat.position(v));
        !is_window(a.min(b).min(c).midpoint(a.max(b).max(c)))
    });
    let mut names = vec![u32::MAX; flat.n_vertices()];
    let mut positions = Vec::new();
    let mut name = |v: VertexId| {
        let name = &mut names[v.0 as usize];
        if *name == u32::MAX {
            *name = positions.len() as u32;
            positions.push(place(flat.position(v)));
        }
        *name
    };
    let faces: Vec<[u32; 3]> = faces.map(|face| face.map(&mut name)).collect();
    PolygonMesh::from_faces(positions, &faces).expect("faces of a mesh")
}

/// Holds that a result is its own image vertex by vertex and face by face, with edges in the plane.
fn assert_symmetric(mesh: &PolygonMesh, axis: usize, what: &str) {
    let [low, high] = mesh.bounds();
    let size = low.distance(high);
    let flipped = |mut p: DVec3| {
        p[axis] = -p[axis];
        p
    };
    let tree = Bvh::of_points(mesh.positions());
    let image = |v: &VertexId| {
        let found = tree.closest(flipped(mesh.position(*v)));
        let off = found.distance_squared.sqrt() / size;
        assert!(off < 1e-9, "{what}: {v} is {off:e} off");
        VertexId(found.face.0)
    };
    let key = |face: &mut dyn Iterator<Item = VertexId>| {
        let mut key: Vec<VertexId> = face.collect();
        let least = (0..key.len())
            .min_by_key(|&i| key[i])
            .expect("a face has corners");
        key.rotate_left(least);
        key
    };
    let all: HashSet<Vec<VertexId>> = mesh.faces().map(|f| key(&mut f.iter().copied())).collect();
    for face in mesh.faces() {
        let there = key(&mut face.iter().rev().map(image));
        assert!(all.contains(&there), "{what}: {face:?} has no image");
    }
    let lies = |v: &VertexId| mesh.position(*v)[axis].abs() < 1e-9 * size;
    let in_plane = |face: &[VertexId]| {
        let next = face.iter().cycle().skip(1);
        face.iter()
            .zip(next)
            .filter(|(a, b)| lies(a) && lies(b))
            .count()
    };
    assert!(mesh.faces().map(in_plane).sum::<usize>() >= 4, "{what}");
}

fn assert_done(mesh: &PolygonMesh, (mirror, faces): (Mirror, usize), what: &str) -> Remeshed {
    let made = run(mesh, mirror, faces);
    let part = &made.report.parts[0];
    assert_eq!(part.mirrored, Some(Mirrored::Used), "{what}");
    assert_eq!(part.deform.n_inverted, 0, "{what}");
    let quiet = Progress::none();
    let [was, is] = [mesh, &made.mesh].map(|mesh| topology(mesh, &quiet).expect("nobody cancels"));
    assert_eq!(
        (is.n_borders, is.genus),
        (was.n_borders, was.genus),
        "{what}"
    );
    assert!(
        is.n_faces.abs_diff(faces) <= 4 + faces / 33,
        "{what}: {}",
        is.n_faces
    );
    assert_eq!(is.n_quads, is.n_faces, "{what}");
    let axis = made.report.plane.expect("it is symmetric").axis;
    assert_symmetric(&made.mesh, axis, what);
    made
}

#[test]
fn sheets_tubes_and_tori_come_out_as_their_own_image() {
    // Thicker and higher above than below, so that there is one plane.
    let disc = grid([(16, false), (16, false)], |x, y| {
        let [p, q] = [
            x * (1.0 - y * y / 2.0).sqrt(),
            y * (1.0 - x * x / 2.0).sqrt(),
        ];
        DVec3::new(p, q * (1.0 + 0.2 * q), 0.3 * q * q * q)
    });
    let tube = grid([(24, true), (12, false)], |u, h| {
        let [x, y] = round(u, 1.0 + 0.2 * h);
        DVec3::new(x, y * (1.0 + 0.1 * y), 2.0 * h)
    });
    let ring = grid([(32, true), (6, false)], |u, w| {
        let [x, y] = round(u, 1.5 + 0.5 * w);
        DVec3::new(x, y * (1.0 + 0.1 * y), 0.2 * y)
    });
    let torus = grid([(32, true), (12, true)], |u, w| {
        let [out, up] = round(w, 0.5);
        let [x, y] = round(u, 1.5 + out);
        DVec3::new(x, y * (1.0 + 0.1 * y), up * (1.0 + 0.2 * up))
    });
    let shapes = [
        ("disc", disc, 120),
        ("tube", tube, 160),
        ("ring", ring, 120),
        ("torus", torus, 160),
    ];
    for (what, mesh, faces) in shapes {
        assert_done(&mesh, (Mirror::Auto, faces), what);
    }
}

#[test]
fn a_shirt_keeps_its_four_borders_and_its_symmetry() {
    let shirt = with_windows(
        12,
        |p| {
            let sleeve = 0.8 * (p.x.abs() - 0.6).max(0.0);
            DVec3::new(
                p.x * (1.0 + sleeve),
                0.4 * p.y * (1.0 + 0.1 * p.y),
                p.z - sleeve,
            )
        },
        |p| {
            let is_sleeve = p.x.abs() > 0.99 && p.z > 0.0;
            let is_neck = p.z > 0.99 && p.x.abs() < 0.4 && p.y.abs() < 0.6;
            is_sleeve || is_neck || p.z < -0.99
        },
    );
    let made = assert_done(&shirt, (Mirror::Auto, 160), "shirt");
    assert_eq!(made.report.output.n_borders, 4);
}

/// A wavy sheet that reaches a little farther to the right.
fn lopsided() -> PolygonMesh {
    grid([(18, false), (12, false)], |x, y| {
        let x = 0.1 + x;
        DVec3::new(x, y * (1.0 + 0.2 * x.abs()), 0.3 * cos(2.0 * x))
    })
}

#[test]
fn a_named_plane_makes_an_open_part_its_own_image_from_its_positive_side() {
    let mesh = lopsided();
    let made = assert_done(&mesh, (Mirror::X, 120), "sheet");
    assert!(!made.report.plane.unwrap().was_symmetric);
    let [low, high] = made.mesh.bounds();
    assert!((low.x + high.x).abs() < 1e-9 && (high.x - 1.1).abs() < 0.01);
    let is_told = |fault: &Fault| matches!(fault, Fault::MirrorReplaced { axis: "x", .. });
    assert!(made.report.warnings.iter().any(|w| is_told(&w.what)));
    let auto = run(&mesh, Mirror::Auto, 120);
    assert_eq!(auto.report.plane.map(|plane| plane.axis), Some(1));
}

#[test]
fn a_named_plane_that_leaves_two_arms_apart_is_refused_and_says_why() {
    // A sheet bent to a horseshoe whose arms both point to the right.
    let mesh = grid([(32, false), (4, false)], |u, w| {
        let [s, c] = round(0.5 * u, 1.0 + 0.2 * w);
        let arm = if u.abs() > 0.8 {
            3.0 * (u.abs() - 0.8)
        } else {
            0.0
        };
        DVec3::new(0.2 - c + arm, s, 0.1 * s)
    });
    let made = run(&mesh, Mirror::X, 120);
    let Some(Mirrored::Refused { reason }) = &made.report.parts[0].mirrored else {
        panic!("{:?}", made.report.parts[0].mirrored);
    };
    assert!(
        reason.contains("hangs together only across the plane"),
        "{reason}"
    );
    assert!(
        made.report
            .warnings
            .iter()
            .any(|w| matches!(w.what, Fault::Mirror { .. }))
    );
    assert_eq!(made.report.output.n_borders, 1);
}

#[test]
fn of_two_open_parts_beside_the_plane_one_is_the_image_of_the_other() {
    let boot = grid([(16, true), (8, false)], |u, h| {
        let [x, y] = round(u, 0.5 + 0.1 * h * h);
        DVec3::new(1.5 + x + 0.2 * h, y * (1.0 + 0.2 * x), h)
    });
    let mut positions = boot.positions().to_vec();
    let n = positions.len() as u32;
    positions.extend(boot.positions().iter().map(|p| DVec3::new(-p.x, p.y, p.z)));
    let own = boot.faces().map(|face| face.iter().map(|v| v.0).collect());
    let images = boot
        .faces()
        .map(|face| face.iter().rev().map(|v| v.0 + n).collect());
    let faces: Vec<Vec<u32>> = own.chain(images).collect();
    let made = run(
        &PolygonMesh::from_faces(positions, &faces).unwrap(),
        Mirror::Auto,
        160,
    );
    let told: Vec<_> = made
        .report
        .parts
        .iter()
        .map(|part| part.mirrored.clone())
        .collect();
    assert_eq!(told, [None, Some(Mirrored::Image { of: 0 })]);
    assert_eq!(made.report.output.n_borders, 4);
}

#[test]
fn random_symmetric_meshes_with_windows_stay_symmetric_and_keep_their_shape() {
    for seed in 0..3 {
        let mut random = Random::new(seed);
        let mut number = |from: f64, to: f64| from + (to - from) * random.unit();
        let waves =
            [(); 4].map(|()| DVec3::new(number(0.5, 3.0), number(-3.0, 3.0), number(-3.0, 3.0)));
        let size = number(0.25, 0.55);
        let side = number(-0.3, 0.3);
        let (has_top, has_sides) = (number(0.0, 1.0) < 0.7, number(0.0, 1.0) < 0.7);
        let place = |p: DVec3| {
            let s = p.normalize_or(DVec3::Z);
            let even = DVec3::new(s.x.abs(), s.y, s.z);
            s * (1.0
                + waves
                    .iter()
                    .map(|wave| 0.06 * sin(wave.dot(even)))
                    .sum::<f64>())
        };
        let is_window = |p: DVec3| {
            let is_top = has_top && p.z > 0.99 && p.x.abs() < size && p.y.abs() < 0.5;
            let is_side =
                has_sides && p.x.abs() > 0.99 && (p.y - side).abs() < 0.4 && p.z.abs() < size;
            is_top || is_side || p.z < -0.99
        };
        let mesh = with_windows(10, place, is_window);
        assert_done(&mesh, (Mirror::Auto, 120), &format!("seed {seed}"));
    }
}
