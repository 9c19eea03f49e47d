//! Small meshes with one thing wrong; the files and the random meshes are in `tests/`.

use glam::DVec3;

use super::*;
use crate::elementary::{cos, sin};
use crate::shapes::CUBE_QUADS;

fn cube_points() -> Vec<DVec3> {
    let bit = |i: u32, b: u32| f64::from(i >> b & 1);
    (0..8)
        .map(|i| DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2)))
        .collect()
}

fn cube_quads() -> Vec<Vec<u32>> {
    CUBE_QUADS.map(|f| f.to_vec()).to_vec()
}

fn cleaned(positions: Vec<DVec3>, faces: &[Vec<u32>]) -> Result<Cleaned, Error> {
    clean(
        &PolygonMesh::from_faces(positions, faces).unwrap(),
        &Progress::none(),
    )
}

fn message(positions: Vec<DVec3>, faces: &[Vec<u32>]) -> String {
    cleaned(positions, faces).unwrap_err().to_string()
}

#[track_caller]
fn assert_closed(cleaned: &Cleaned, euler: i64) {
    assert!(cleaned.mesh.is_closed());
    assert_eq!(cleaned.mesh.euler_number(), euler);
    assert_eq!(cleaned.source.len(), cleaned.mesh.n_faces());
}

#[test]
fn a_clean_mesh_stays_as_it_is() {
    let result = cleaned(cube_points(), &cube_quads()).unwrap();
    assert_closed(&result, 2);
    assert_eq!(
        (result.report, result.mesh.n_faces()),
        (Report::default(), 12)
    );
    assert_eq!(result.mesh.positions(), cube_points());
    assert!(result.source.iter().map(|f| f.0).eq((0..12).map(|i| i / 2)));
}

#[test]
fn nothing_and_next_to_nothing_are_refused() {
    assert_eq!(
        message(cube_points(), &[]),
        "the mesh has no faces (8 vertices)"
    );
    assert_eq!(
        message(cube_points(), &[vec![0, 1, 2]]),
        "the faces use 3 different points; at least 4 are needed"
    );
    let no_area = "the mesh has no area: each of its 6 faces is a point or a line";
    assert_eq!(message(vec![DVec3::ONE; 8], &cube_quads()), no_area);
    let line = (0..8)
        .map(|i| DVec3::new(0.1, 0.7, 1.3) * f64::from(i))
        .collect();
    assert_eq!(message(line, &cube_quads()), no_area);
}

#[test]
fn two_quads_at_a_vertex_of_two_faces_are_cut_differently() {
    // Both quads would be cut between their corners 0 and 2, whose edge would have four faces.
    let mut positions = cube_points();
    positions.push(DVec3::new(0.5, 0.5, 0.0));
    let mut faces = cube_quads();
    faces[0] = vec![0, 2, 3, 8];
    faces.push(vec![0, 8, 3, 1]);
    let result = cleaned(positions, &faces).unwrap();
    assert_closed(&result, 2);
}

#[test]
fn large_polygons_keep_corners_on_straight_lines() {
    let mut positions = cube_points();
    positions.push(DVec3::new(0.5, 0.0, 0.0));
    let mut faces = cube_quads();
    faces[0] = vec![0, 2, 3, 1, 8];
    faces[2] = vec![0, 8, 1, 5, 4];
    assert_closed(&cleaned(positions, &faces).unwrap(), 2);
}

#[test]
fn a_flat_triangle_that_closes_a_crack_stays() {
    let mut positions = cube_points();
    positions.push(DVec3::new(0.5, 0.0, 0.0));
    let mut faces = cube_quads();
    faces[0] = vec![0, 2, 3, 1, 8];
    faces.push(vec![0, 8, 1]);
    let result = cleaned(positions, &faces).unwrap();
    assert_closed(&result, 2);
    assert_eq!(result.report.n_flat_dropped, 0);
}

#[test]
fn flat_fins_and_degenerate_faces_are_dropped() {
    let mut positions = cube_points();
    positions.push(DVec3::new(0.5, 0.0, 0.0));
    let mut faces = cube_quads();
    faces.extend([
        vec![0, 8, 1],
        vec![0, 0, 1],
        vec![2, 2, 2],
        vec![5, 5, 7, 5],
    ]);
    let result = cleaned(positions, &faces).unwrap();
    assert_closed(&result, 2);
    let Report {
        n_flat_dropped,
        n_degenerate,
        ..
    } = result.report;
    assert_eq!((n_flat_dropped, n_degenerate), (1, 3));
    assert_eq!(result.mesh.n_vertices(), 8);
}

#[test]
fn triangles_back_to_back_enclose_nothing_and_are_dropped() {
    let mut positions = cube_points();
    positions.extend([3.0, 4.0, 5.0].map(|x| DVec3::new(x, x * x, 0.0)));
    let mut faces = cube_quads();
    faces.extend([vec![8, 9, 10], vec![10, 9, 8]]);
    let result = cleaned(positions.clone(), &faces).unwrap();
    assert_closed(&result, 2);
    assert_eq!(result.report.n_doubled, 2);
    let doubled = [vec![8, 9, 10], vec![10, 9, 8], vec![0, 1, 2], vec![0, 2, 1]];
    assert!(message(positions, &doubled).ends_with("at least 4 are needed"));
}

#[test]
fn an_edge_of_three_faces_is_named() {
    let mut positions = cube_points();
    positions.push(-DVec3::ONE);
    let mut faces = cube_quads();
    faces.push(vec![1, 0, 8]);
    assert_eq!(
        message(positions, &faces),
        "3 faces meet at the edge between vertices 0 and 1; at most 2 can"
    );
}

#[test]
fn boxes_that_touch_along_an_edge_stay_apart() {
    let mut positions = cube_points();
    positions.extend(cube_points().iter().map(|p| *p + DVec3::new(1.0, 1.0, 0.0)));
    let mut faces = cube_quads();
    faces.extend(
        cube_quads()
            .iter()
            .map(|f| f.iter().map(|v| v + 8).collect()),
    );
    let result = cleaned(positions, &faces).unwrap();
    assert_closed(&result, 4);
    assert_eq!(result.report.n_welded, 0);
    assert_eq!(result.mesh.face_components().1, 2);
}

#[test]
fn boxes_that_touch_at_a_vertex_are_split_there() {
    let mut positions = cube_points();
    positions.extend(cube_points().iter().map(|p| *p + DVec3::ONE));
    let mut faces = cube_quads();
    faces.extend(
        cube_quads()
            .iter()
            .map(|f| f.iter().map(|v| v + 8).collect()),
    );
    let result = cleaned(positions, &faces).unwrap();
    assert_closed(&result, 4);
    assert_eq!((result.report.n_welded, result.report.n_split), (1, 1));
    assert_eq!(
        result.report.sentences(),
        ["1 duplicate vertex welded", "1 vertex added where fans met"]
    );
}

#[test]
fn the_smaller_part_of_the_faces_is_turned() {
    for n_turned in 1..=2 {
        let mut faces = cube_quads();
        for face in &mut faces[..n_turned] {
            face.reverse();
        }
        let result = cleaned(cube_points(), &faces).unwrap();
        assert_closed(&result, 2);
        assert_eq!(result.report.n_reoriented, 2 * n_turned);
        let clean = cleaned(cube_points(), &cube_quads()).unwrap();
        let signed = |mesh: &TriangleMesh| -> f64 {
            let corners = |f: &[VertexId; 3]| f.map(|v| mesh.position(v));
            mesh.faces()
                .iter()
                .map(corners)
                .map(|[a, b, c]| a.dot(b.cross(c)))
                .sum()
        };
        assert!((signed(&result.mesh) - signed(&clean.mesh)).abs() < 1e-12);
    }
}

#[test]
fn a_moebius_strip_is_refused() {
    let n = 12;
    let positions = (0..2 * n)
        .map(|i| {
            let turn = f64::from(i / 2) / f64::from(n) * std::f64::consts::TAU;
            let across = f64::from(i % 2) - 0.5;
            let radius = 2.0 + across * cos(turn / 2.0);
            DVec3::new(
                radius * cos(turn),
                radius * sin(turn),
                across * sin(turn / 2.0),
            )
        })
        .collect();
    let rung = |i: u32| if i < n { [2 * i, 2 * i + 1] } else { [1, 0] };
    let faces: Vec<Vec<u32>> = (0..n)
        .map(|i| vec![rung(i)[0], rung(i + 1)[0], rung(i + 1)[1], rung(i)[1]])
        .collect();
    let text = message(positions, &faces);
    assert!(text.starts_with("the surface cannot be oriented"), "{text}");
}

#[test]
fn a_cancelled_job_stops() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let mesh = PolygonMesh::from_faces(cube_points(), &cube_quads()).unwrap();
    let result = clean(&mesh, &Progress::silent(token));
    assert_eq!(result, Err(Error::Cancelled(Cancelled)));
}

#[test]
fn blocks_that_share_an_edge_part_there() {
    // Two cubes with the edge's vertices 3 and 7 in common.
    let mut positions = cube_points();
    positions.extend(cube_points().iter().map(|p| *p + DVec3::new(1.0, 1.0, 0.0)));
    let shared = |v: u32| match v {
        0 => 3,
        4 => 7,
        _ => v + 8,
    };
    let mut faces = cube_quads();
    let others = cube_quads().into_iter();
    faces.extend(others.map(|f| f.into_iter().map(shared).collect::<Vec<u32>>()));
    let result = cleaned(positions.clone(), &faces).unwrap();
    assert_closed(&result, 4);
    assert_eq!(
        (result.mesh.face_components().1, result.report.n_split),
        (2, 2)
    );
    // Inside out, what lies between the blocks is their inside, and neither end of the edge splits.
    for face in &mut faces {
        face.reverse();
    }
    let text = message(positions, &faces);
    assert!(
        text.starts_with("4 faces meet at the edge between vertices 3 and 7"),
        "{text}"
    );
}

#[test]
fn a_part_that_shares_an_edge_leaves_the_others_apart() {
    let mut positions = cube_points();
    positions.extend([3.0, 4.0, 5.0].map(|x| DVec3::new(x, x * x, 0.0)));
    positions.push(DVec3::new(4.0, 1.0, 7.0));
    positions.push(DVec3::new(4.0, 1.0, 9.0));
    let mut faces = cube_quads();
    faces.splice(2..2, [vec![8, 9, 10], vec![8, 9, 11], vec![9, 8, 12]]);
    let mesh = PolygonMesh::from_faces(positions, &faces).unwrap();
    let apart = take_apart(&mesh, None, &Progress::none()).unwrap();
    assert!(apart.tangles.is_empty());
    let parts = apart.mesh.components(&Progress::none()).unwrap();
    let closed: Vec<usize> = parts
        .iter()
        .filter(|part| part.is_closed())
        .map(TriangleMesh::n_faces)
        .collect();
    assert_eq!((apart.mesh.n_faces(), closed), (15, vec![12]));
    let [line] = &apart.shared[..] else {
        panic!("{:?}", apart.shared);
    };
    assert_eq!((line.n_faces, line.is_closed), (3, false));
    assert_eq!(line.vertices, [8, 9].map(VertexId));
}
