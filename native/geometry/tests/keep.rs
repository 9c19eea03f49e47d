//! Faces that are kept come back bit for bit, and what is made of the others joins them.

mod common;

use std::collections::BTreeMap;

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::{Topology, topology};
use orbflow_geometry::mesh::{FaceId, Id, PolygonMesh, TriangleMesh, VertexId};
use orbflow_geometry::pipeline::{Error, Input, Remeshed, Settings, remesh};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;
use proptest::prelude::*;

/// A mesh of squares cut in two, whole again.
fn quads(mesh: &TriangleMesh) -> PolygonMesh {
    let faces: Vec<[u32; 4]> = mesh
        .faces()
        .chunks_exact(2)
        .map(|pair| {
            let [one, other] = [pair[0], pair[1]];
            let at = (0..3)
                .find(|&i| !other.contains(&one[i]))
                .expect("two triangles of a square");
            let far = other
                .into_iter()
                .find(|v| !one.contains(v))
                .expect("another corner");
            [one[at], one[(at + 1) % 3], far, one[(at + 2) % 3]].map(|v| v.0)
        })
        .collect();
    PolygonMesh::from_faces(mesh.positions().to_vec(), &faces).expect("squares of a mesh")
}

fn middle(mesh: &PolygonMesh, face: &[VertexId]) -> DVec3 {
    face.iter().map(|&v| mesh.position(v)).sum::<DVec3>() / face.len() as f64
}

fn flags(mesh: &PolygonMesh, is_kept: impl Fn(DVec3) -> bool) -> Vec<bool> {
    mesh.faces()
        .map(|face| is_kept(middle(mesh, face)))
        .collect()
}

fn settings(faces: usize) -> Settings {
    Settings {
        faces,
        ..Settings::default()
    }
}

fn run(mesh: &PolygonMesh, keep: &[bool], settings: &Settings) -> Result<Remeshed, Error> {
    let input = Input {
        keep_faces: Some(keep),
        ..Input::new(mesh)
    };
    remesh(input, settings, &Solver::default(), &Progress::none())
}

fn shape(mesh: &PolygonMesh) -> Topology {
    topology(mesh, &Progress::none()).expect("nobody cancels")
}

/// What is kept is at the end, bit for bit and in order; nothing is open that was not.
fn check(mesh: &PolygonMesh, keep: &[bool], made: &Remeshed) {
    let kept = mesh.faces().zip(keep).filter(|(_, kept)| **kept);
    let kept: Vec<&[VertexId]> = kept.map(|(face, _)| face).collect();
    assert!(made.kept_faces >= kept.len());
    let out = &made.mesh;
    let stayed: Vec<&[VertexId]> = out.faces().skip(out.n_faces() - made.kept_faces).collect();
    let bits = |mesh: &PolygonMesh, face: &[VertexId]| -> Vec<[u64; 3]> {
        let places = face.iter().map(|&v| mesh.position(v));
        places.map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    let stayed: Vec<_> = stayed.into_iter().map(|face| bits(out, face)).collect();
    let mut rest = stayed.iter();
    for face in kept {
        let face = bits(mesh, face);
        assert!(rest.any(|other| *other == face), "a kept face is gone");
    }
    let [before, after] = [mesh, out].map(shape);
    let figures = |t: &Topology| (t.n_borders, t.genus, t.n_components, t.closed);
    assert_eq!(figures(&after), figures(&before));
    assert!(!has_doubles(out), "two vertices at one place");
}

fn has_doubles(mesh: &PolygonMesh) -> bool {
    let mut first = BTreeMap::new();
    let mut used = mesh.corners().to_vec();
    used.sort_unstable();
    used.dedup();
    used.iter().any(|&v| {
        first
            .insert(mesh.position(v).to_array().map(f64::to_bits), v)
            .is_some()
    })
}

fn n_triangles(mesh: &PolygonMesh) -> usize {
    mesh.faces().filter(|face| face.len() == 3).count()
}

#[test]
fn a_cap_of_hand_made_quads_comes_back_and_is_joined_by_quads() {
    let mesh = quads(&common::sphere(12));
    let keep = flags(&mesh, |p| p.z > 0.6);
    let made = run(&mesh, &keep, &settings(500)).unwrap();
    check(&mesh, &keep, &made);
    assert_eq!(n_triangles(&made.mesh), 0);
    let told = made.report.kept_faces.unwrap();
    assert_eq!(told.n_faces, keep.iter().filter(|&&kept| kept).count());
    assert_eq!((told.n_triangles, told.n_stayed), (0, 0));
    assert!(told.n_edges > 20);
    let n = made.mesh.n_faces();
    assert!(n.abs_diff(500) <= 50, "{n} faces");
    // The line goes in steps: beside a corner of one a quad may be left without room.
    assert!(made.report.parts[0].deform.n_inverted <= 1);
}

#[test]
fn finer_and_coarser_faces_than_those_that_are_kept_join_them() {
    let mesh = quads(&common::blob(3, 12));
    let keep = flags(&mesh, |p| p.x > 0.4);
    let n_kept = keep.iter().filter(|&&kept| kept).count();
    for n_more in [100, 900] {
        let made = run(&mesh, &keep, &settings(n_kept + n_more)).unwrap();
        check(&mesh, &keep, &made);
        assert_eq!(n_triangles(&made.mesh), 0, "{n_more}");
    }
}

#[test]
fn two_regions_with_something_between_them_are_joined() {
    let mesh = quads(&common::capsule(3.0, 8));
    let keep = flags(&mesh, |p| p.z.abs() > 1.6);
    let made = run(&mesh, &keep, &settings(350)).unwrap();
    check(&mesh, &keep, &made);
    assert_eq!(n_triangles(&made.mesh), 0);
    assert_eq!(made.report.parts.len(), 1);
    assert_eq!(made.report.parts[0].deform.n_inverted, 0);
}

#[test]
fn a_band_that_is_kept_leaves_two_parts_that_join_it() {
    let mesh = quads(&common::capsule(3.0, 8));
    let keep = flags(&mesh, |p| p.z.abs() < 0.9);
    let made = run(&mesh, &keep, &settings(350)).unwrap();
    check(&mesh, &keep, &made);
    assert_eq!(made.report.parts.len(), 2);
}

#[test]
fn a_region_at_an_open_border_joins_what_is_left_of_the_border() {
    let sphere = quads(&common::sphere(12));
    let faces: Vec<Vec<u32>> = sphere
        .faces()
        .filter(|face| middle(&sphere, face).z < 0.5)
        .map(|face| face.iter().map(|v| v.0).collect())
        .collect();
    let open = PolygonMesh::from_faces(sphere.positions().to_vec(), &faces).unwrap();
    let keep = flags(&open, |p| p.x > 0.3 && p.z > -0.3);
    let made = run(&open, &keep, &settings(600)).unwrap();
    check(&open, &keep, &made);
    assert_eq!(n_triangles(&made.mesh), 0);
}

#[test]
fn triangles_that_are_kept_with_an_odd_border_cost_a_triangle_and_are_told_of() {
    let mesh = common::polygons(&common::sphere(9));
    let keep: Vec<bool> = (0..mesh.n_faces()).map(|i| i == 40).collect();
    let made = run(&mesh, &keep, &settings(300)).unwrap();
    check(&mesh, &keep, &made);
    let told = made.report.kept_faces.unwrap();
    assert_eq!(told.n_triangles % 2, 1);
    assert!(
        made.report
            .warnings
            .iter()
            .any(|w| w.text.contains("beside kept faces"))
    );
}

#[test]
fn what_cannot_be_kept_is_said_with_numbers() {
    let mesh = quads(&common::sphere(4));
    let text =
        |keep: &[bool], settings: &Settings| run(&mesh, keep, settings).unwrap_err().to_string();
    assert_eq!(
        text(&[true; 3], &settings(100)),
        "3 flags of faces to keep for 96 faces"
    );
    assert_eq!(
        text(&[true; 96], &settings(200)),
        "all 96 faces are kept: nothing is left to remesh"
    );
    let mut most = [true; 96];
    most[0] = false;
    assert_eq!(
        text(&most, &settings(96)),
        "95 faces are kept, but 96 were asked for in all: at least 99 are needed"
    );
    let solid = Settings {
        solid: true,
        ..settings(200)
    };
    assert_eq!(
        text(&most, &solid),
        "95 faces are to be kept, but a solid is made anew all over"
    );
}

#[test]
fn a_region_that_is_a_whole_part_stays_and_nothing_is_kept_changes_nothing() {
    let [one, other] = [common::sphere(6), common::sphere(8)];
    let mut positions = one.positions().to_vec();
    positions.extend(other.positions().iter().map(|p| *p + DVec3::X * 3.0));
    let first = one.n_vertices() as u32;
    let faces = one.faces().iter().map(|f| f.map(|v| v.0));
    let faces = faces.chain(other.faces().iter().map(|f| f.map(|v| v.0 + first)));
    let faces: Vec<[u32; 3]> = faces.collect();
    let mesh = PolygonMesh::from_faces(positions, &faces).unwrap();
    let keep: Vec<bool> = (0..mesh.n_faces()).map(|i| i < one.n_faces()).collect();
    let made = run(&mesh, &keep, &settings(one.n_faces() + 200)).unwrap();
    check(&mesh, &keep, &made);
    assert_eq!(made.report.kept_faces.unwrap().n_edges, 0);
    let none = vec![false; mesh.n_faces()];
    let plain = remesh(
        Input::new(&mesh),
        &settings(200),
        &Solver::default(),
        &Progress::none(),
    );
    assert_eq!(
        run(&mesh, &none, &settings(200)).unwrap().mesh,
        plain.unwrap().mesh
    );
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let mesh = quads(&common::blob(5, 6));
    let keep = flags(&mesh, |p| p.y > 0.5);
    let with = |threads| {
        let settings = Settings {
            threads,
            ..settings(200)
        };
        run(&mesh, &keep, &settings).unwrap().mesh
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn corners_and_vertices_of_what_is_kept_come_from_themselves() {
    let mesh = quads(&common::sphere(8));
    let keep = flags(&mesh, |p| p.z > 0.4);
    let input = Input {
        keep_faces: Some(&keep),
        cuts: Some(&[Vec::new()]),
        ..Input::new(&mesh)
    };
    let made = remesh(input, &settings(400), &Solver::default(), &Progress::none()).unwrap();
    let origins = made.origins.unwrap();
    let kept: Vec<usize> = (0..keep.len()).filter(|&i| keep[i]).collect();
    let n_made = made.mesh.n_faces() - kept.len();
    for (k, &face) in kept.iter().enumerate() {
        let new = FaceId::from_index(n_made + k);
        assert_eq!(origins.faces[new.index()], FaceId::from_index(face));
        let [was, is] = [mesh.starts()[face], made.mesh.starts()[new.index()]];
        for (i, v) in made.mesh.face(new).iter().enumerate() {
            let corner = origins.corners[0][is as usize + i];
            assert_eq!(corner.corners[0], was + i as u32);
            assert!(corner.weights[0] >= 1.0);
            let vertex = origins.vertices[v.index()];
            assert!(vertex.weights[0] >= 1.0);
            let from = mesh.corners()[vertex.corners[0] as usize];
            assert_eq!(mesh.position(from), made.mesh.position(*v));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3, ..ProptestConfig::default() })]

    #[test]
    fn any_region_of_any_ball_comes_back_and_the_ball_is_closed_again(
        seed in any::<u64>(), n_more in 80_usize..250, n_spots in 1_usize..3, are_quads in any::<bool>()
    ) {
        let ball = common::blob(seed, 6);
        let mesh = if are_quads { quads(&ball) } else { common::polygons(&ball) };
        let mut random = Random::new(seed);
        let mut way = || {
            let p = DVec3::new(random.unit(), random.unit(), random.unit()) * 2.0 - 1.0;
            p.normalize_or(DVec3::Z)
        };
        let spots: Vec<DVec3> = (0..n_spots).map(|_| way()).collect();
        let keep = flags(&mesh, |p| spots.iter().any(|way| way.dot(p.normalize_or(DVec3::Z)) > 0.8));
        prop_assume!(keep.contains(&true));
        let n_kept = keep.iter().filter(|&&kept| kept).count();
        let made = run(&mesh, &keep, &settings(n_kept + n_more)).unwrap();
        check(&mesh, &keep, &made);
        let told = made.report.kept_faces.unwrap();
        prop_assert_eq!(told.n_stayed, 0);
    }
}
