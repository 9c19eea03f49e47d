//! What is not as it was to be is said, and what is as it was to be is not.

mod common;

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::mesh::PolygonMesh;
use orbflow_geometry::pipeline::{Fault, Input, Kind, Mirror, Settings, Through, Warning, remesh};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::score;

fn settings() -> Settings {
    Settings {
        faces: 200,
        ..Settings::default()
    }
}

fn warnings(mesh: &PolygonMesh, settings: &Settings) -> Vec<Warning> {
    let made = remesh(
        Input::new(mesh),
        settings,
        &Solver::default(),
        &Progress::none(),
    );
    made.expect("a closed mesh can be done").report.warnings
}

/// A ball with a horn on one side, from −1 to 2.2 along x.
fn horned(shift: f64) -> PolygonMesh {
    let ball = common::sphere(10);
    let drawn = |p: &DVec3| *p + DVec3::X * (4.0 * (p.x - 0.7).max(0.0) + shift);
    let positions = ball.positions().iter().map(drawn).collect();
    common::polygons(&ball.with_positions(positions))
}

#[test]
fn balls_and_rods_have_nothing_to_warn_of_with_a_score_and_without() {
    for mesh in [common::sphere(10), common::capsule(2.0, 8)] {
        let mesh = common::polygons(&mesh);
        let scored = Settings {
            score: Some(score::Settings::default()),
            ..settings()
        };
        for wanted in [settings(), scored] {
            assert_eq!(warnings(&mesh, &wanted), []);
        }
    }
}

#[test]
fn a_side_that_was_replaced_is_said_and_grave_where_the_shape_is_another() {
    let mesh = horned(0.0);
    let wanted = Settings {
        mirror: Mirror::X,
        ..settings()
    };
    let told = warnings(&mesh, &wanted);
    let [far, replaced] = &told[..] else {
        panic!("{told:?}");
    };
    assert!(far.grave && matches!(far.what, Fault::Far { in_edges, .. } if in_edges > 2.0));
    assert!(!replaced.grave && replaced.text.contains("not symmetric across x"));
    // The horn is 1.2 long, the diagonal √(3.2² + 2² + 2²).
    let is_right = |off: f64| (off / (120.0 / 18.24_f64.sqrt()) - 1.0).abs() < 0.05;
    assert!(
        matches!(replaced.what, Fault::MirrorReplaced { axis: "x", off_pct } if is_right(off_pct)),
        "{replaced:?}"
    );
}

#[test]
fn the_middle_of_the_box_is_taken_where_the_origin_is_no_middle() {
    let wanted = Settings {
        mirror: Mirror::X,
        ..settings()
    };
    let plane = |mesh: &PolygonMesh| {
        let made = remesh(
            Input::new(mesh),
            &wanted,
            &Solver::default(),
            &Progress::none(),
        );
        made.unwrap().report.plane.unwrap()
    };
    // The origin cuts it, but only just.
    let beside = plane(&horned(0.9));
    assert_eq!(
        (beside.through, beside.was_symmetric),
        (Through::Middle, false)
    );
    assert!((beside.at - 1.5).abs() < 0.02, "{beside:?}");
    assert_eq!(plane(&horned(0.2)).through, Through::Origin);
}

#[test]
fn what_was_refused_and_what_is_off_in_count_is_said() {
    let ball = common::polygons(&common::sphere(8));
    let triangles = Settings {
        kind: Kind::Triangles,
        mirror: Mirror::X,
        ..settings()
    };
    let told = warnings(&ball, &triangles);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(matches!(&told[0].what, Fault::Mirror { n_parts: 1, .. }) && !told[0].grave);
    // No closed mesh of quads has seven.
    let few = Settings {
        faces: 7,
        ..settings()
    };
    let told = warnings(&ball, &few);
    let is_count =
        |w: &Warning| matches!(w.what, Fault::Count { n_asked: 7, n_faces } if n_faces != 7);
    assert!(told.iter().any(is_count), "{told:?}");
}
