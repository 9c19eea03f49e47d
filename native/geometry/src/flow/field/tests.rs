use super::*;
use crate::elementary::{angle_to, argument};
use crate::flow::complex::Turn;
use crate::mesh::FaceId;
use crate::shapes;

fn field_of(mesh: &TriangleMesh) -> OrientationField {
    orient(mesh, &Settings::default(), &Progress::none()).unwrap()
}

#[test]
fn every_shape_has_a_consistent_field() {
    for (name, mesh) in shapes::closed(10) {
        let field = field_of(&mesh);
        assert_eq!(field.check(&mesh), Ok(()), "{name}");
        for face in mesh.face_ids() {
            let direction = field.directions[face];
            assert!((direction.length() - 1.0).abs() < 1e-12);
            let normal = crate::measure::face_normal(&mesh, face);
            assert!(direction.dot(normal).abs() < 1e-9, "{name}");
        }
    }
}

#[test]
fn a_box_is_singular_at_its_corners_alone() {
    let mesh = shapes::cuboid(10);
    let field = field_of(&mesh);
    for (v, &index) in field.indices.iter_ids() {
        let p = mesh.position(v).abs();
        let is_corner = p.distance(DVec3::new(0.5, 0.4, 0.3)) < 1e-9;
        assert_eq!(index, i32::from(is_corner), "{p}");
    }
}

#[test]
fn turns_compare_the_crosses_of_neighbours() {
    let mesh = shapes::blob(3, 16);
    let field = field_of(&mesh);
    let charts = Charts::new(&mesh);
    let axes = axes(&mesh);
    let mut worst: f64 = 0.0;
    for h in mesh.halfedge_ids() {
        let twin = mesh.twin(h).unwrap();
        let in_frame = |h: HalfedgeId| {
            let Axes { u, v, .. } = axes[h.face()];
            let d = field.directions[h.face()];
            glam::DVec2::new(d.dot(u), -d.dot(v)).rotate(charts.edge(h))
        };
        let across = -in_frame(h).turned(field.turns[h]);
        worst = worst.max(angle_to(across, in_frame(twin)).abs());
    }
    assert!(worst <= TAU / 8.0 + 1e-9, "{worst}");
}

#[test]
fn a_rod_is_followed_along_and_around() {
    let mesh = shapes::capsule(8.0, 24);
    let field = field_of(&mesh);
    for face in mesh.face_ids() {
        let height = mesh
            .triangle(face)
            .iter()
            .map(|p| p.z.abs())
            .fold(0.0, f64::max);
        if height < 3.0 {
            let along = field.directions[face].z.abs();
            assert!(!(0.05..0.9987).contains(&along), "{along}");
        }
    }
}

#[test]
fn open_meshes_and_rings_are_refused() {
    let ring = shapes::torus(8, 6);
    let refused = FieldError::NotASphere {
        n_borders: 0,
        euler: 0,
    };
    let settings = Settings::default();
    assert_eq!(orient(&ring, &settings, &Progress::none()), Err(refused));
}

#[test]
fn a_cancelled_field_is_not_made() {
    let token = crate::progress::CancelToken::new();
    token.cancel();
    let cancelled = orient(
        &shapes::sphere(4),
        &Settings::default(),
        &Progress::silent(token),
    );
    assert_eq!(cancelled, Err(FieldError::Cancelled(Cancelled)));
}

#[test]
fn residuals_and_corners_make_the_indices() {
    for (name, mesh) in shapes::closed(10) {
        let mut field = field_of(&mesh);
        let charts = Charts::new(&mesh);
        assert_eq!(
            turns::indices(&mesh, &charts, &field.residuals),
            field.indices
        );
        let before = total_unrest(&field);
        settle(&mesh, &mut field, &Settings::default(), &Progress::none()).unwrap();
        assert_eq!(
            turns::indices(&mesh, &charts, &field.residuals),
            field.indices
        );
        assert!(total_unrest(&field) < 1.1 * before, "{name}");
    }
}

fn total_unrest(field: &OrientationField) -> f64 {
    field.residuals.iter().map(|r| r * r).sum()
}

#[test]
fn crosses_follow_a_singularity_that_was_moved() {
    let mesh = shapes::sphere(12);
    let mut field = field_of(&mesh);
    let size = crate::measure::total_area(&mesh).sqrt();
    let sizes = FaceMap::filled(mesh.n_faces(), 0.3 * size);
    crate::flow::singularities::tidy(&mesh, &mut field, &sizes);
    let before = total_unrest(&field);
    settle(&mesh, &mut field, &Settings::default(), &Progress::none()).unwrap();
    assert!(total_unrest(&field) < before);
    // The residuals are still those of the directions, up to whole quarters.
    let axes = axes(&mesh);
    let angles = mesh
        .face_ids()
        .map(|f| argument(in_chart(field.directions[f], &axes[f])));
    let (_, nearest) = turns::match_crosses(&mesh, &Charts::new(&mesh), &angles.collect());
    for (a, b) in field.residuals.iter().zip(&nearest) {
        let off = (a - b).rem_euclid(1.0);
        assert!(off.min(1.0 - off) < 1e-9, "{a} {b}");
    }
}

/// The mesh turned, scaled and with vertices, faces and corners numbered anew, and where the
/// vertices went.
fn renumbered(mesh: &TriangleMesh) -> (TriangleMesh, Vec<VertexId>) {
    let mut random = crate::random::Random::new(5);
    let mut order: Vec<usize> = (0..mesh.n_vertices()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.below(i + 1));
    }
    let new: Vec<VertexId> = order.iter().map(|&i| VertexId(i as u32)).collect();
    let turn = glam::DMat3::from_rotation_x(0.7) * glam::DMat3::from_rotation_z(2.1) * 30.0;
    let mut positions = vec![DVec3::ZERO; order.len()];
    for (&at, &p) in order.iter().zip(mesh.positions()) {
        positions[at] = turn * p;
    }
    let mut faces: Vec<[VertexId; 3]> = mesh
        .faces()
        .iter()
        .map(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|v| new[v.0 as usize]);
            [[a, b, c], [b, c, a], [c, a, b]][random.below(3)]
        })
        .collect();
    let third = faces.len() / 3;
    faces.rotate_left(third);
    (TriangleMesh::new(positions, faces).unwrap(), new)
}

#[test]
fn singularities_do_not_depend_on_numbers_pose_or_size() {
    for mesh in [shapes::blob(6, 12), shapes::limbs(3, 12), shapes::cuboid(9)] {
        let (other, new) = renumbered(&mesh);
        let [one, two] = [field_of(&mesh), field_of(&other)];
        for v in mesh.vertex_ids() {
            assert_eq!(one.indices[v], two.indices[new[v.0 as usize]]);
        }
    }
}

#[test]
fn degenerate_faces_have_a_direction_too() {
    let mesh = shapes::sphere(8);
    let mut positions = mesh.positions().to_vec();
    let [a, b, c] = mesh.face(FaceId(40));
    positions[a.0 as usize] = positions[b.0 as usize];
    positions[c.0 as usize] = positions[b.0 as usize];
    let mesh = mesh.with_positions(positions);
    let field = field_of(&mesh);
    assert_eq!(field.check(&mesh), Ok(()));
    assert!(
        field
            .directions
            .iter()
            .all(|d| (d.length() - 1.0).abs() < 1e-9)
    );
}

#[test]
fn sizes_that_overflow_are_refused_and_others_make_no_difference() {
    let mesh = shapes::sphere(4);
    let scaled =
        |size: f64| mesh.with_positions(mesh.positions().iter().map(|p| *p * size).collect());
    let settings = Settings::default();
    for size in [1e300, 1e-200] {
        let refused = orient(&scaled(size), &settings, &Progress::none());
        assert!(matches!(refused, Err(FieldError::Size { .. })), "{size}");
    }
    let one = orient(&mesh, &settings, &Progress::none()).unwrap();
    for size in [1e-50, 1e50] {
        let other = orient(&scaled(size), &settings, &Progress::none()).unwrap();
        assert_eq!(one.indices, other.indices, "{size}");
    }
}
