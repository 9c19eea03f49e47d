use glam::{DMat3, DVec3};

use super::*;
use crate::elementary::{cos, sin};
use crate::progress::CancelToken;
use crate::shapes;

/// The surface of a cube, n × n quads a side, mapped.
fn quad_cube(n: u32, map: impl Fn(DVec3) -> DVec3) -> PolygonMesh {
    let triangles = shapes::mapped_cube(n, map);
    // Two triangles in a row are a quad, cut at its first or at its second corner.
    let quad = |pair: &[[crate::mesh::VertexId; 3]]| {
        let [[a, b, c], second] = [pair[0], pair[1]];
        let d = second.into_iter().find(|v| ![a, b, c].contains(v)).unwrap();
        if second.contains(&a) {
            [a.0, b.0, c.0, d.0]
        } else {
            [a.0, b.0, d.0, c.0]
        }
    };
    let faces: Vec<_> = triangles.faces().chunks(2).map(quad).collect();
    PolygonMesh::from_faces(triangles.positions().to_vec(), &faces).unwrap()
}

fn quad_sphere(n: u32) -> PolygonMesh {
    quad_cube(n, |p| p.normalize_or(DVec3::Z))
}

/// Quads on a torus; with twist k, going once around the tube moves k quads along.
fn torus([n_around, n_tube]: [u32; 2], twist: u32) -> PolygonMesh {
    use std::f64::consts::TAU;
    let turn = f64::from(twist) / f64::from(n_tube);
    let positions = (0..n_around * n_tube).map(|k| {
        let [i, j] = [k / n_tube, k % n_tube].map(f64::from);
        let [a, b] = [
            TAU * (i + turn * j) / f64::from(n_around),
            TAU * j / f64::from(n_tube),
        ];
        let r = 1.0 + 0.4 * cos(b);
        DVec3::new(r * cos(a), r * sin(a), 0.4 * sin(b))
    });
    let at = |i, j| (i + twist * (j / n_tube)) % n_around * n_tube + j % n_tube;
    let quad = |i, j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    let faces: Vec<_> = (0..n_around * n_tube)
        .map(|k| quad(k / n_tube, k % n_tube))
        .collect();
    PolygonMesh::from_faces(positions.collect(), &faces).unwrap()
}

fn scored(input: &PolygonMesh, output: &PolygonMesh) -> Score {
    let settings = Settings {
        n_samples: 4000,
        ..Settings::default()
    };
    score(input, output, &settings, &Progress::none()).unwrap()
}

fn moved(mesh: &PolygonMesh, map: impl Fn(DVec3) -> DVec3) -> PolygonMesh {
    mesh.with_positions(mesh.positions().iter().map(|&p| map(p)).collect())
}

#[test]
fn a_mesh_scored_against_itself_is_perfect() {
    let mesh = torus([60, 24], 0);
    let settings = Settings {
        target: Some(1440),
        n_samples: 4000,
        seed: 3,
    };
    let found = score(&mesh, &mesh, &settings, &Progress::none()).unwrap();
    assert!(found.same_topology && found.manifold && found.closed);
    assert_eq!(
        (found.genus, found.components, found.borders),
        (Some(1), 1, 0)
    );
    assert_eq!(
        (found.faces, found.vertices, found.triangles),
        (1440, 1440, 2880)
    );
    assert_eq!(
        (found.count_error_pct, found.self_intersections),
        (Some(0.0), 0)
    );
    assert!(
        found.distance.chamfer_pct < 1e-6 && found.flow.alignment_deg.is_some_and(|off| off < 1.0)
    );
    assert!(found.distance.f1_at_half_pct > 99.999 && found.distance.normal_consistency > 0.999);
    assert_eq!(found.flow.irregular_pct, Some(0.0));
}

#[test]
fn a_quad_sphere_has_three_families_of_strips_and_chains_between_its_poles() {
    let mesh = quad_sphere(10);
    let found = scored(&mesh, &mesh);
    let strips = Strips {
        strips: Some(30),
        strip_median: Some(40.0),
        spiral_pct: Some(0.0),
    };
    assert_eq!(found.strips, strips);
    // 27 loops of 40 edges, and 12 edges of the cube, 10 long.
    let wanted = [(27.0 * 40.0 + 12.0 * 10.0) / 39.0, 40.0, 90.0];
    let chains = found.chains;
    let found_chains = [
        chains.chain_mean,
        chains.chain_median,
        chains.loop_edges_pct,
    ];
    for (found, wanted) in found_chains.into_iter().zip(wanted) {
        assert!(found.is_some_and(|found| (found - wanted).abs() < 1e-12));
    }
    assert!(
        found
            .flow
            .irregular_pct
            .is_some_and(|pct| (pct - 800.0 / 602.0).abs() < 1e-12)
    );
}

#[test]
fn a_twisted_torus_joins_its_short_loops_into_one_spiral() {
    let found = scored(&torus([40, 16], 0), &torus([40, 16], 1));
    assert!(found.same_topology);
    assert_eq!(
        (found.strips.strips, found.strips.spiral_pct),
        (Some(17), Some(0.0))
    );
    let median = found.chains.chain_edge_median;
    assert!(median.is_some_and(|median| (median - (320.0 + 20.0)).abs() < 1e-12));
}

#[test]
fn concentric_spheres_are_as_far_apart_as_their_radii() {
    let sphere = quad_sphere(30);
    let found = scored(&sphere, &moved(&sphere, |p| p * 1.02)).distance;
    let wanted = 100.0 * 0.02 / (2.0 * 3f64.sqrt());
    assert!((found.chamfer_pct / wanted - 1.0).abs() < 0.02, "{found:?}");
    assert!(
        (found.hausdorff_pct / wanted - 1.0).abs() < 0.1,
        "{found:?}"
    );
    assert!(found.f1_at_half_pct < 1e-9 && found.normal_consistency > 0.999);
}

#[test]
fn overlapping_spheres_cross_and_distant_ones_do_not() {
    let ball = quad_sphere(8);
    let pair = |shift: DVec3| {
        let n = ball.n_vertices() as u32;
        let positions = ball.positions().iter().copied();
        let positions = positions
            .chain(ball.positions().iter().map(|&p| p + shift))
            .collect();
        let faces: Vec<Vec<u32>> = [0, n]
            .into_iter()
            .flat_map(|by| {
                ball.faces()
                    .map(move |f| f.iter().map(|v| v.0 + by).collect())
            })
            .collect();
        PolygonMesh::from_faces(positions, &faces).unwrap()
    };
    let found = scored(&ball, &pair(DVec3::X * 3.0));
    assert_eq!((found.self_intersections, found.components), (0, 2));
    let found = scored(&ball, &pair(DVec3::new(1.03, 0.01, 0.02)));
    assert!(found.self_intersections >= 40 && !found.same_topology);
}

#[test]
fn the_edges_of_a_box_are_found_where_they_are() {
    let cube = |n| quad_cube(n, |p| p);
    let f1 = scored(&cube(8), &cube(3)).feature_f1_pct;
    assert!(f1.is_some_and(|f1| (f1 - 100.0).abs() < 1e-9), "{f1:?}");
    assert_eq!(scored(&quad_sphere(8), &cube(3)).feature_f1_pct, None);
    assert_eq!(scored(&cube(8), &quad_sphere(8)).feature_f1_pct, Some(0.0));
}

#[test]
fn an_output_in_far_smaller_units_is_scored_too() {
    let cube = quad_cube(4, |p| p);
    for size in [1e4, 1e30] {
        let score = scored(&cube, &moved(&cube, |p| p * size));
        let found = [Some(score.distance.f1_at_1_pct), score.feature_f1_pct];
        assert_eq!(found, [Some(0.0); 2], "{size}");
    }
}

#[test]
fn a_symmetric_sphere_has_no_asymmetry_and_a_turned_one_about_a_third() {
    let sphere = quad_sphere(20);
    assert!(scored(&sphere, &sphere).asymmetry.is_some_and(|a| a < 1e-6));
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_y(0.4);
    let turned = scored(&sphere, &moved(&sphere, |p| turn * p)).asymmetry;
    assert!(
        turned.is_some_and(|a| (a - 0.38).abs() < 0.06),
        "{turned:?}"
    );
}

#[test]
fn scaled_shifted_or_with_axes_exchanged_the_score_stays() {
    let [input, output] = [7, 5].map(|n| shapes::polygons(&shapes::blob(1, n)));
    let (one, quads) = (scored(&input, &output), quad_sphere(6));
    let aligned = |input: &PolygonMesh, quads: &PolygonMesh| {
        let found = scored(input, quads).flow;
        found.alignment_deg.unwrap()
    };
    let off = aligned(&input, &quads);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * a.abs().max(0.01);
    for (size, shift) in [(1e-30, 0.0), (1e30, 0.0), (1.0, 50.0)] {
        let place = |p: DVec3| DVec3::new(p.y, p.z, p.x) * size + shift;
        let [input, output, quads] = [&input, &output, &quads].map(|mesh| moved(mesh, place));
        let other = scored(&input, &output);
        assert!(close(off, aligned(&input, &quads)), "{size} {shift}");
        assert!(close(one.shape.edge_cv, other.shape.edge_cv), "{other:?}");
        assert!(
            close(one.distance.chamfer_pct, other.distance.chamfer_pct),
            "{other:?}"
        );
        assert!(close(
            one.distance.normal_consistency,
            other.distance.normal_consistency
        ));
        assert_eq!(
            (one.chains, one.feature_f1_pct),
            (other.chains, other.feature_f1_pct)
        );
    }
}

#[test]
fn figures_of_quads_are_none_without_quads() {
    let triangles = shapes::polygons(&shapes::sphere(6));
    let found = scored(&quad_sphere(6), &triangles);
    assert_eq!((found.flow, found.chains, found.strips), Default::default());
    assert_eq!(
        (found.shape.inverted, found.shape.jacobian_min),
        (None, None)
    );
    let quads = scored(&triangles, &quad_sphere(6));
    assert_eq!(
        (quads.shape.inverted, quads.flow.high_valence),
        (Some(0), Some(0))
    );
}

#[test]
fn a_polygon_is_where_its_triangles_are_however_concave_it_is() {
    // A prism over the letter U, its lids one polygon each or cut into squares.
    let outline = [
        [0, 0],
        [3, 0],
        [3, 3],
        [2, 3],
        [2, 1],
        [1, 1],
        [1, 3],
        [0, 3],
    ];
    let lid = |z: f64| outline.map(|[x, y]: [i32; 2]| DVec3::new(f64::from(x), f64::from(y), z));
    let positions: Vec<DVec3> = [0.0, 1.0].into_iter().flat_map(lid).collect();
    let walls = (0..8).map(|i| vec![i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8]);
    let lids = |pieces: &[Vec<u32>]| {
        let top = pieces.iter().map(|p| p.iter().map(|v| v + 8).collect());
        let bottom = pieces.iter().map(|p| p.iter().rev().copied().collect());
        let faces: Vec<Vec<u32>> = walls.clone().chain(top).chain(bottom).collect();
        PolygonMesh::from_faces(positions.clone(), &faces).unwrap()
    };
    let whole = lids(&[(0..8).collect()]);
    let cut = lids(&[vec![0, 5, 6, 7], vec![0, 1, 4, 5], vec![1, 2, 3, 4]]);
    for (a, b) in [(&whole, &cut), (&cut, &whole)] {
        let found = scored(a, b).distance;
        assert!(
            found.hausdorff_pct < 1e-9 && found.normal_consistency > 0.999_999,
            "{found:?}"
        );
    }
}

#[test]
fn the_topology_is_that_of_the_cleaned_input() {
    let ball = quad_sphere(4);
    let faces: Vec<[u32; 4]> = (0..ball.n_faces() as u32)
        .map(|f| [0, 1, 2, 3].map(|i| 4 * f + i))
        .collect();
    let corners = ball.corners().iter().map(|&v| ball.position(v)).collect();
    let soup = PolygonMesh::from_faces(corners, &faces).unwrap();
    let progress = Progress::none();
    let topology = crate::measure::topology(&ball, &progress).unwrap();
    let cleaned = Reference {
        mesh: &soup,
        topology: Some(topology),
    };
    let settings = Settings {
        n_samples: 100,
        ..Settings::default()
    };
    assert!(
        score(cleaned, &ball, &settings, &progress)
            .unwrap()
            .same_topology
    );
    assert!(
        !score(&soup, &ball, &settings, &progress)
            .unwrap()
            .same_topology
    );
}

#[test]
fn threads_do_not_change_a_bit() {
    let [input, output] = [12, 9].map(|n| shapes::polygons(&shapes::limbs(1, n)));
    let with = |n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        pool.install(|| scored(&input, &output))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn what_has_no_area_is_refused() {
    let sphere = quad_sphere(3);
    let flat = moved(&sphere, |_| DVec3::ONE);
    let fails = |a: &PolygonMesh, b: &PolygonMesh, settings| {
        score(a, b, &settings, &Progress::none()).unwrap_err()
    };
    let settings = Settings::default();
    assert_eq!(
        fails(&flat, &sphere, settings),
        Error::FlatInput { n_faces: 54 }
    );
    assert_eq!(
        fails(&sphere, &flat, settings),
        Error::FlatOutput { n_faces: 54 }
    );
    let empty = PolygonMesh::default();
    assert_eq!(
        fails(&sphere, &empty, settings),
        Error::FlatOutput { n_faces: 0 }
    );
    let none = Settings {
        n_samples: 0,
        ..settings
    };
    assert_eq!(fails(&sphere, &sphere, none), Error::NoSamples);
    let none = Settings {
        target: Some(0),
        ..settings
    };
    assert_eq!(fails(&sphere, &sphere, none), Error::NoTarget);
}

#[test]
fn some_faces_without_area_leave_every_figure_finite() {
    let sphere = quad_sphere(4);
    let mut faces: Vec<Vec<u32>> = sphere
        .faces()
        .map(|f| f.iter().map(|v| v.0).collect())
        .collect();
    faces.extend([vec![0, 1, 1], vec![2, 2, 2, 2], vec![0, 1, 0, 1, 0]]);
    let broken = PolygonMesh::from_faces(sphere.positions().to_vec(), &faces).unwrap();
    for (a, b) in [(&sphere, &broken), (&broken, &sphere)] {
        let text = serde_json::to_string(&scored(a, b)).unwrap();
        let n_none = text.matches("null").count();
        let wanted = serde_json::to_string(&scored(&sphere, &sphere)).unwrap();
        // Not a number is written as null: there are no more of them than without the broken faces.
        assert!(n_none <= wanted.matches("null").count() + 1, "{text}");
    }
}

#[test]
fn a_raised_flag_stops_it() {
    let sphere = quad_sphere(3);
    let token = CancelToken::new();
    token.cancel();
    let found = score(
        &sphere,
        &sphere,
        &Settings::default(),
        &Progress::silent(token),
    );
    assert_eq!(found, Err(Error::Cancelled(Cancelled)));
}
