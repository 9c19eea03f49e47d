use glam::DVec3;

use super::*;
use crate::measure::{corner_angle, feature_lines};
use crate::mesh::{HalfedgeId, TriangleMesh};
use crate::progress::CancelToken;
use crate::shapes;

/// A map of a test shape: all of them are cubes mapped point by point, as the sphere is.
fn map_of(mesh: TriangleMesh, n: u32) -> SphereMap {
    let sphere = VertexMap::from_vec(shapes::sphere(n).positions().to_vec());
    SphereMap::prove(mesh, sphere).unwrap()
}

fn make(map: &SphereMap, n_faces: usize) -> PolygonMesh {
    let settings = Settings {
        n_faces,
        ..Settings::default()
    };
    let made = adaptive(map, &settings, &Progress::none()).unwrap();
    assert_eq!(made.report.n_faces, made.primitive.n_faces());
    made.primitive
}

/// Edge length variation and mean smallest angle (in degrees) of the triangles on the surface.
fn evenness(map: &SphereMap, primitive: &PolygonMesh) -> [f64; 2] {
    let on_surface = |&p: &DVec3| map.surface_position(map.locate(p));
    let positions: Vec<DVec3> = primitive.positions().iter().map(on_surface).collect();
    let mut lengths = Vec::new();
    let mut smallest = Vec::new();
    for face in primitive.faces() {
        let corners = [0, 1, 2].map(|i| positions[face[i].index()]);
        let side = |i: usize| corners[(i + 1) % 3] - corners[i % 3];
        lengths.extend([0, 1, 2].map(|i| side(i).length()));
        let angles = [0, 1, 2].map(|i| corner_angle(corners, i).to_degrees());
        smallest.push(angles.into_iter().fold(f64::INFINITY, f64::min));
    }
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let middle = mean(&lengths);
    let squares: Vec<f64> = lengths.iter().map(|l| (l - middle).powi(2)).collect();
    [mean(&squares).sqrt() / middle, mean(&smallest)]
}

#[test]
fn triangles_are_even_on_every_surface() {
    for (name, mesh) in shapes::closed(24) {
        let map = map_of(mesh, 24);
        let primitive = make(&map, 2000);
        assert_eq!(primitive.n_faces(), 2000);
        assert_eq!(
            check_cover(&primitive, primitive.positions()),
            Ok(()),
            "{name}"
        );
        let [variation, angle] = evenness(&map, &primitive);
        assert!(
            variation < 0.15 && angle > 49.0,
            "{name}: {variation} {angle}"
        );
    }
}

#[test]
fn every_small_budget_is_met_exactly() {
    let map = map_of(shapes::limbs(5, 8), 8);
    for n_faces in (0..60).chain([99, 100, 3001]) {
        let primitive = make(&map, n_faces);
        assert_eq!(primitive.n_faces(), n_faces.max(4) / 2 * 2, "{n_faces}");
        assert_eq!(
            check_cover(&primitive, primitive.positions()),
            Ok(()),
            "{n_faces}"
        );
    }
}

#[test]
fn more_faces_than_the_surface_has_are_met() {
    let map = map_of(shapes::cuboid(1), 1);
    let primitive = make(&map, 2000);
    assert_eq!(check_cover(&primitive, primitive.positions()), Ok(()));
    let [variation, angle] = evenness(&map, &primitive);
    assert!(variation < 0.15 && angle > 49.0, "{variation} {angle}");
}

#[test]
fn a_wish_for_density_is_followed() {
    let map = map_of(shapes::sphere(16), 16);
    let wish = |p: &DVec3| if p.z > 0.0 { 4.0 } else { 1.0 };
    let density = map.mesh().positions().iter().map(wish).collect();
    let settings = Settings {
        n_faces: 2000,
        ..Settings::default()
    };
    let made = sized(&map, (&density, &[]), &settings, &Progress::none()).unwrap();
    let upper = made.primitive.positions().iter().filter(|p| p.z > 0.0);
    let share = upper.count() as f64 / made.report.n_vertices as f64;
    assert!((0.76..0.84).contains(&share), "{share}");
}

#[test]
fn equal_seeds_give_equal_meshes_and_others_do_not() {
    let map = map_of(shapes::blob(4, 10), 10);
    let with_seed = |seed| {
        let settings = Settings {
            n_faces: 400,
            seed,
            ..Settings::default()
        };
        let made = adaptive(&map, &settings, &Progress::none());
        made.unwrap().primitive
    };
    assert_eq!(with_seed(1), with_seed(1));
    assert_ne!(with_seed(1), with_seed(2));
}

#[test]
fn a_raised_flag_stops_it() {
    let map = map_of(shapes::sphere(4), 4);
    let token = CancelToken::new();
    token.cancel();
    let stopped = adaptive(&map, &Settings::default(), &Progress::silent(token));
    assert_eq!(stopped.unwrap_err(), AdaptiveError::Cancelled(Cancelled));
}

#[test]
fn loops_nearer_to_each_other_than_triangles_are_long_keep_their_sides() {
    let map = map_of(shapes::sphere(24), 24);
    let mesh = map.mesh();
    let height = |p: DVec3| (p / p.abs().max_element()).z;
    let is_inside = |h: HalfedgeId| {
        let middle = height(mesh.triangle(h.face()).iter().sum::<DVec3>() / 3.0);
        (0.17..0.33).contains(&middle)
    };
    let twin = |h| mesh.twin(h).unwrap();
    let edges = mesh.halfedge_ids();
    let band = edges.map(|h| is_inside(h) != is_inside(twin(h)));
    let lines = feature_lines(mesh, &band.collect());
    let density = VertexMap::filled(mesh.n_vertices(), 1.0);
    let settings = Settings {
        n_faces: 40,
        ..Settings::default()
    };
    let wish = (&density, &lines[..]);
    let made = sized(&map, wish, &settings, &Progress::none()).unwrap();
    assert_eq!(made.n_apart, 0);
    assert_eq!(
        check_cover(&made.primitive, made.primitive.positions()),
        Ok(())
    );
    // Two caps and the band between them.
    let faces = made.primitive.faces().map(|f| [f[0], f[1], f[2]]).collect();
    let net = TriangleMesh::new(made.primitive.positions().to_vec(), faces).unwrap();
    let mut groups = crate::groups::Groups::new(net.n_faces());
    for h in net.halfedge_ids() {
        let [a, b] = [net.origin(h), net.target(h)];
        if made.on_lines.binary_search(&[a.min(b), a.max(b)]).is_err() {
            groups.link(h.face().index(), net.twin(h).unwrap().face().index());
        }
    }
    assert_eq!(groups.numbered().1, 3);
}
