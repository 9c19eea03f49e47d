use glam::DVec3;

use super::*;
use crate::embed::Solver;
use crate::measure;
use crate::pipeline::{Input, Mirror, Remeshed, remesh};
use crate::shapes::{CUBE_QUADS, open_tube as tube};
use crate::sphere_map::check_cover;

fn made(mesh: &PolygonMesh, settings: &Settings) -> Remeshed {
    remesh(
        Input::new(mesh),
        settings,
        &Solver::default(),
        &Progress::none(),
    )
    .unwrap()
}

fn asked(faces: usize) -> Settings {
    Settings {
        faces,
        ..Settings::default()
    }
}

/// A moulding: a profile of ten steps, drawn along x; seen from outside.
fn moulding() -> PolygonMesh {
    let profile = [
        (0.0, 0.0),
        (0.0, 0.08),
        (0.05, 0.08),
        (0.05, 0.12),
        (0.1, 0.12),
        (0.1, 0.2),
    ];
    let points = profile.iter();
    let points = points.flat_map(|&(y, z)| [0.0, 3.0].map(|x| DVec3::new(x, y, z)));
    let faces: Vec<[u32; 4]> = (0..5).map(|i| [0, 1, 3, 2].map(|k| 2 * i + k)).collect();
    PolygonMesh::from_faces(points.collect(), &faces).unwrap()
}

fn cube(size: DVec3) -> PolygonMesh {
    let corner = |i: u32| {
        let bit = |bit: u32| f64::from(i >> bit & 1) - 0.5;
        DVec3::new(bit(0), bit(1), bit(2)) * size
    };
    PolygonMesh::from_faces((0..8).map(corner).collect(), &CUBE_QUADS).unwrap()
}

fn off(made: &Remeshed, mesh: &PolygonMesh) -> f64 {
    let target = Prepared::new(mesh, &Progress::none()).unwrap();
    let tree = crate::nearest::Bvh::of_mesh(&target.mesh);
    let places = target.frame.enter(made.mesh.positions());
    let gaps = places.iter().map(|&p| tree.closest(p).distance_squared);
    gaps.fold(0.0, f64::max).sqrt()
}

#[test]
fn a_moulding_stays_the_sheet_that_it_is_at_any_count() {
    let mesh = moulding();
    for faces in [60, 200, 1_000] {
        let made = made(&mesh, &asked(faces));
        let part = &made.report.parts[0];
        assert_eq!(
            part.flow,
            Some(Flowed::Own {
                n_strips: 6,
                n_taken: 0
            }),
            "{faces}"
        );
        assert!(made.mesh.n_faces().abs_diff(faces) * 20 <= faces);
        assert!(off(&made, &mesh) < 1e-12);
        let topology = measure::topology(&made.mesh, &Progress::none()).unwrap();
        assert_eq!((topology.n_borders, topology.genus), (1, Some(0)));
        assert_eq!(part.deform.n_inverted, 0);
    }
}

#[test]
fn a_box_is_cut_by_its_lengths_its_own_image_and_on_the_sphere() {
    let mesh = cube(DVec3::new(3.0, 2.0, 1.0));
    let made = made(&mesh, &asked(22 * 16));
    assert_eq!(made.mesh.n_faces(), 22 * 16);
    assert_eq!(made.report.parts[0].mirrored, Some(Mirrored::Used));
    assert_eq!(check_cover(&made.mesh, &made.sphere), Ok(()));
    assert_eq!(made.report.parts[0].embedding.degree, 1);
    let images = images(&made.mesh, 0);
    assert!(images.is_some());
}

#[test]
fn triangles_of_quads_are_cut_as_the_quads_are() {
    let quads = cube(DVec3::ONE);
    let cut = quads
        .faces()
        .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
    let faces: Vec<Vec<u32>> = cut.map(|f| f.iter().map(|v| v.0).collect()).collect();
    let mesh = PolygonMesh::from_faces(quads.positions().to_vec(), &faces).unwrap();
    let [one, other] = [&quads, &mesh].map(|mesh| made(mesh, &asked(96)).mesh);
    assert_eq!((one.n_faces(), other.n_faces()), (96, 96));
    for p in one.positions() {
        let near = |q: &DVec3| p.distance(*q) < 1e-12;
        assert!(other.positions().iter().any(near), "{p}");
    }
}

#[test]
fn new_quads_are_made_where_that_is_asked_for_or_own_ones_would_be_too_many() {
    let flow = |mesh: &PolygonMesh, settings: &Settings| {
        made(mesh, settings).report.parts[0].flow.clone().unwrap()
    };
    let new = Settings {
        own_quads: false,
        ..asked(96)
    };
    assert!(matches!(flow(&cube(DVec3::ONE), &new), Flowed::Used { .. }));
    let fine = made(&cube(DVec3::ONE), &asked(6 * 400)).mesh;
    let fewer = flow(&fine, &asked(96));
    assert!(matches!(fewer, Flowed::Used { .. }), "{fewer:?}");
}

#[test]
fn strips_are_taken_out_of_quads_that_are_finer_than_asked_for() {
    let closed = made(&cube(DVec3::ONE), &asked(384)).mesh;
    for (mesh, faces, n_borders) in [(closed, 150, 0), (tube([24, 9]), 96, 2)] {
        let n_came = mesh.n_faces();
        let fewer = made(&mesh, &asked(faces));
        let n = fewer.mesh.n_faces();
        assert!(n.abs_diff(faces) * 8 <= faces, "{n}");
        let flow = fewer.report.parts[0].flow.as_ref();
        assert!(
            matches!(flow, Some(Flowed::Own { n_taken, .. }) if *n_taken >= n_came - n - n / 8),
            "{flow:?}"
        );
        // A vertex in the plane of symmetry lies between its places on both sides.
        assert!(off(&fewer, &mesh) < 1e-3);
        assert_eq!(fewer.report.parts[0].deform.n_inverted, 0);
        let topology = measure::topology(&fewer.mesh, &Progress::none()).unwrap();
        assert_eq!((topology.n_borders, topology.genus), (n_borders, Some(0)));
    }
}

#[test]
fn a_fan_of_triangles_is_no_pole_of_quads() {
    // A tube of sixteen sides whose lower end is closed by a fan.
    let tube = tube([16, 5]);
    let middle = tube.n_vertices() as u32;
    let faces = tube.faces().map(|f| f.iter().map(|v| v.0).collect());
    let fan = (0..16).map(|i| vec![middle, (i + 1) % 16, i]);
    let faces: Vec<Vec<u32>> = faces.chain(fan).collect();
    let points = tube.positions().iter().copied().chain([DVec3::ZERO]);
    let mesh = PolygonMesh::from_faces(points.collect(), &faces).unwrap();
    let made = made(&mesh, &asked(mesh.n_faces()));
    let flow = made.report.parts[0].flow.as_ref();
    assert!(!matches!(flow, Some(Flowed::Own { .. })), "{flow:?}");
}

#[test]
fn as_many_quads_as_came_in_stay_what_they_were_in_every_part() {
    // A rod of many quads beside a slab of few: by area the rod would get next to none.
    let rod = tube([12, 20]);
    let slab = cube(DVec3::new(60.0, 60.0, 1.0));
    let n = rod.n_vertices() as u32;
    let away = slab.positions().iter().map(|&p| p + DVec3::X * 50.0);
    let points: Vec<DVec3> = rod.positions().iter().copied().chain(away).collect();
    let named = |mesh: &PolygonMesh, by: u32| -> Vec<Vec<u32>> {
        let faces = mesh.faces();
        faces
            .map(|f| f.iter().map(|v| v.0 + by).collect())
            .collect()
    };
    let both = [named(&rod, 0), named(&slab, n)].concat();
    let mesh = PolygonMesh::from_faces(points, &both).unwrap();
    let made = made(&mesh, &asked(both.len()));
    assert_eq!(made.mesh.n_faces(), both.len());
    assert_eq!(made.report.parts[0].n_faces, 240);
    for p in mesh.positions() {
        let near = |q: &DVec3| p.distance(*q) < 1e-9;
        assert!(made.mesh.positions().iter().any(near), "{p}");
    }
}

#[test]
fn a_half_of_a_named_plane_that_is_no_image_gets_new_quads() {
    let mut points = cube(DVec3::ONE).positions().to_vec();
    points[0].x -= 0.3;
    let mesh = cube(DVec3::ONE).with_positions(points);
    let settings = Settings {
        mirror: Mirror::X,
        ..asked(96)
    };
    let made = made(&mesh, &settings);
    let flow = made.report.parts[0].flow.as_ref();
    assert!(!matches!(flow, Some(Flowed::Own { .. })), "{flow:?}");
}
