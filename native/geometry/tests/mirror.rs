//! Mirror symmetry: what comes out is its own image, or the report says why not.

mod common;

use std::sync::Mutex;

use glam::DVec3;
use orbflow_geometry::elementary::{cos, exp, sin};
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh, VertexId};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::pipeline::{
    Error, Input, Kind, Mirror, Mirrored, Primitive, Remeshed, Settings, Through, remesh,
};
use orbflow_geometry::progress::{CancelToken, Progress};

fn settings(mirror: Mirror) -> Settings {
    Settings {
        faces: 500,
        mirror,
        ..Settings::default()
    }
}

fn run(mesh: &PolygonMesh, settings: &Settings) -> Remeshed {
    let (solver, quiet) = (Solver::default(), Progress::none());
    remesh(Input::new(mesh), settings, &solver, &quiet).expect("a closed mesh can be done")
}

fn flipped(mut p: DVec3, axis: usize, at: f64) -> DVec3 {
    p[axis] = 2.0 * at - p[axis];
    p
}

/// A bumpy ball that is its own image across x.
fn even_blob(n: u32) -> TriangleMesh {
    common::mapped_cube(n, |p| {
        let s = p.normalize_or(DVec3::Z);
        let bumps = sin(3.0 * s.x.abs() + 1.0) + sin(4.0 * s.y + 0.5) * cos(2.0 * s.z);
        s * (1.0 + 0.15 * bumps)
    })
}

/// A ball with two arms, a head and a tail, its own image across x.
fn even_limbs(n: u32) -> TriangleMesh {
    let limbs = [
        (DVec3::new(0.9, 0.3, -0.3), 2.0),
        (DVec3::new(-0.9, 0.3, -0.3), 2.0),
        (DVec3::Y, 1.2),
        (DVec3::new(0.0, -0.5, 0.8), 1.6),
    ];
    common::mapped_cube(n, |p| {
        let s = p.normalize_or(DVec3::Z);
        let grow = |(axis, length): &(DVec3, f64)| {
            length * exp(-(1.0 - axis.normalize_or(DVec3::Y).dot(s)) * 12.0)
        };
        s * (1.0 + limbs.iter().map(grow).sum::<f64>())
    })
}

/// How far the farthest vertex is from the image of another, in diagonals, and how many lie in the
/// plane.
fn off(mesh: &PolygonMesh, axis: usize, at: f64) -> (f64, usize) {
    let [low, high] = mesh.bounds();
    let diagonal = low.distance(high);
    let tree = Bvh::of_points(mesh.positions());
    let images = mesh.positions().iter().map(|&p| flipped(p, axis, at));
    let far = images.map(|p| tree.closest(p).distance_squared.sqrt());
    let in_plane = mesh.positions().iter();
    let in_plane = in_plane.filter(|p| (p[axis] - at).abs() < 1e-6 * diagonal);
    (far.fold(0.0, f64::max) / diagonal, in_plane.count())
}

#[test]
fn symmetric_shapes_come_out_symmetric_with_vertices_in_the_plane() {
    let shapes = [even_blob(16), even_limbs(16), common::capsule(5.0, 14)];
    for (i, mesh) in shapes.iter().enumerate() {
        let mesh = common::polygons(mesh);
        for mirror in [Mirror::Auto, Mirror::X] {
            let made = run(&mesh, &settings(mirror));
            assert_eq!(made.report.parts[0].mirrored, Some(Mirrored::Used), "{i}");
            let plane = made.report.plane.unwrap();
            assert!(plane.was_symmetric && plane.through == Through::Origin);
            let (far, n_in_plane) = off(&made.mesh, 0, 0.0);
            assert!(far < 1e-6, "shape {i}: {far:e}");
            assert!(n_in_plane >= 10, "shape {i}: {n_in_plane} in the plane");
            let n = made.mesh.n_faces();
            assert!(n.abs_diff(500) <= 10 && made.mesh.n_quads() == n, "{n}");
        }
    }
}

#[test]
fn a_plane_beside_the_origin_goes_through_the_middle_of_the_box() {
    let moved = even_limbs(14);
    let positions = moved.positions().iter().map(|&p| p * 3.0 + 20.0);
    let mesh = common::polygons(&moved.with_positions(positions.collect()));
    let made = run(&mesh, &settings(Mirror::Auto));
    let plane = made.report.plane.unwrap();
    assert_eq!((plane.axis, plane.through), (0, Through::Middle));
    assert!((plane.at - 20.0).abs() < 1e-6);
    assert!(off(&made.mesh, 0, plane.at).0 < 1e-6);
}

#[test]
fn a_shape_without_symmetry_stays_as_it_is_unless_an_axis_is_named() {
    let mesh = common::polygons(&common::blob(3, 14));
    let [off_, auto] = [Mirror::Off, Mirror::Auto].map(|m| run(&mesh, &settings(m)));
    assert_eq!(auto.mesh, off_.mesh);
    assert_eq!(auto.report.plane, None);
    let made = run(&mesh, &settings(Mirror::Y));
    assert!(!made.report.plane.unwrap().was_symmetric);
    assert_eq!(made.report.parts[0].mirrored, Some(Mirrored::Used));
    assert!(off(&made.mesh, 1, 0.0).0 < 1e-6);
}

#[test]
fn unasked_only_what_is_symmetric_to_the_vertex_is_mirrored() {
    let even = even_blob(12);
    let plane = |mesh: &TriangleMesh, mirror: Mirror| {
        let wanted = settings(mirror);
        run(&common::polygons(mesh), &wanted).report.plane
    };
    assert_eq!(Settings::default().mirror, Mirror::Auto);
    assert_eq!(plane(&even, Mirror::Auto).map(|plane| plane.axis), Some(0));
    let mut positions = even.positions().to_vec();
    let side = positions.iter().position(|p| p.x > 0.5).unwrap();
    positions[side] *= 1.002;
    let nearly = even.with_positions(positions);
    assert_eq!(plane(&nearly, Mirror::Auto), None);
    let named = plane(&nearly, Mirror::X).unwrap();
    assert!(named.was_symmetric);
    let triangles = Settings {
        kind: Kind::Triangles,
        ..settings(Mirror::Auto)
    };
    let made = run(&common::polygons(&even), &triangles);
    assert_eq!(
        (made.report.plane, made.report.parts[0].mirrored.clone()),
        (None, None)
    );
}

#[test]
fn what_is_painted_on_one_side_alone_is_not_mirrored_unasked() {
    // It is its own image across z as well.
    let even = even_blob(12);
    let mesh = common::polygons(&even);
    let axis = |density: &[f64], marked: &[[VertexId; 2]]| {
        let input = Input {
            density: Some(density),
            marked,
            ..Input::new(&mesh)
        };
        let (solver, quiet) = (Solver::default(), Progress::none());
        let made = remesh(input, &settings(Mirror::Auto), &solver, &quiet).unwrap();
        made.report.plane.map(|plane| plane.axis)
    };
    let density = |is_small: &dyn Fn(DVec3) -> bool| -> Vec<f64> {
        let values = mesh.positions().iter().map(|&p| f64::from(is_small(p)));
        values.collect()
    };
    assert_eq!(axis(&density(&|p| p.x.abs() > 0.6), &[]), Some(0));
    assert_eq!(axis(&density(&|p| p.x > 0.6), &[]), Some(2));
    // Some edges on the side of positive x, and their images.
    let images = Bvh::of_points(mesh.positions());
    let is_out = |v: VertexId| even.position(v).x > 0.6;
    let side = even
        .faces()
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let side = side.filter(|&[a, b]| a < b && is_out(a) && is_out(b));
    let side: Vec<[VertexId; 2]> = side.take(6).collect();
    let image = |v: VertexId| VertexId(images.closest(flipped(even.position(v), 0, 0.0)).face.0);
    let both: Vec<[VertexId; 2]> = side
        .iter()
        .map(|e| e.map(image))
        .chain(side.clone())
        .collect();
    let nowhere = density(&|_| false);
    assert_ne!(axis(&nowhere, &side), Some(0));
    assert_eq!(axis(&nowhere, &both), Some(0));
}

#[test]
fn of_two_parts_beside_the_plane_one_is_the_image_of_the_other() {
    let mesh = common::blob(5, 10);
    let right: Vec<DVec3> = mesh
        .positions()
        .iter()
        .map(|&p| p + DVec3::X * 3.0)
        .collect();
    let left = right.iter().map(|&p| flipped(p, 0, 0.0));
    let n = right.len() as u32;
    let faces = mesh.faces().iter().map(|f| f.map(|v| v.0));
    let images = mesh
        .faces()
        .iter()
        .map(|f| [f[0].0 + n, f[2].0 + n, f[1].0 + n]);
    let faces: Vec<_> = faces.chain(images).collect();
    let positions = right.iter().copied().chain(left).collect();
    let both = PolygonMesh::from_faces(positions, &faces).unwrap();
    let made = run(&both, &settings(Mirror::Auto));
    assert_eq!(made.report.parts[0].mirrored, None);
    assert_eq!(
        made.report.parts[1].mirrored,
        Some(Mirrored::Image { of: 0 })
    );
    assert!(off(&made.mesh, 0, 0.0).0 < 1e-6);
    assert!(made.report.output.closed);
}

#[test]
fn other_primitives_say_that_they_are_not_symmetric() {
    let mesh = common::polygons(&even_blob(8));
    let wanted = Settings {
        kind: Kind::Triangles,
        ..settings(Mirror::X)
    };
    let made = run(&mesh, &wanted);
    let told = made.report.parts[0].mirrored.clone();
    assert!(matches!(told, Some(Mirrored::Refused { .. })), "{told:?}");
}

#[test]
fn other_primitives_keep_both_sides_of_a_mesh_that_is_not_symmetric() {
    let mesh = common::polygons(&common::limbs(4, 8));
    for kind in [Kind::Triangles, Kind::Quads] {
        let [named, off] = [Mirror::X, Mirror::Off].map(|mirror| Settings {
            kind,
            primitive: (kind == Kind::Quads).then_some(Primitive::QuadSphere),
            ..settings(mirror)
        });
        assert_eq!(run(&mesh, &named).mesh, run(&mesh, &off).mesh, "{kind:?}");
    }
}

#[test]
fn threads_change_nothing_progress_rises_and_a_cancelled_run_says_so() {
    let mesh = common::polygons(&even_limbs(12));
    let [one, two] = [1, 2].map(|threads| {
        let wanted = Settings {
            threads,
            ..settings(Mirror::Auto)
        };
        run(&mesh, &wanted).mesh
    });
    assert_eq!(one, two);
    let heard = Mutex::new(Vec::new());
    let listener = |_: &str, share: f64| heard.lock().unwrap().push(share);
    let progress = Progress::new(CancelToken::new(), &listener);
    let wanted = settings(Mirror::Auto);
    remesh(Input::new(&mesh), &wanted, &Solver::default(), &progress).unwrap();
    let shares = heard.into_inner().unwrap();
    let fall = shares.windows(2).find(|w| w[0] > w[1] + 1e-9);
    assert_eq!(fall, None);
    let token = CancelToken::new();
    token.cancel();
    let cancelled = remesh(
        Input::new(&mesh),
        &settings(Mirror::Auto),
        &Solver::default(),
        &Progress::silent(token),
    );
    assert!(matches!(cancelled, Err(Error::Cancelled(_))));
}
