use glam::DVec3;

use super::*;
use crate::elementary::sin_cos;
use crate::embed::Solver;
use crate::mesh::PolygonMesh;
use crate::pipeline::{Kind, Mirror, Remeshed, remesh};
use crate::shapes;

/// A ring of some radius across an axis that is turned from z towards x.
fn ring(radius: f64, turned: f64) -> Stroke {
    let (tilt, upright) = sin_cos(turned);
    let point = |i: u32| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / 60.0);
        radius * DVec3::new(upright * cos, sin, tilt * cos)
    };
    Stroke {
        points: (0..60).map(point).collect(),
        is_closed: true,
        strength: Strength::Exact,
    }
}

fn quads(faces: usize) -> Settings {
    Settings {
        faces,
        mirror: Mirror::Off,
        ..Settings::default()
    }
}

fn run(mesh: &PolygonMesh, guides: &[Stroke], settings: &Settings) -> Result<Remeshed, Error> {
    let input = Input {
        guides,
        ..Input::new(mesh)
    };
    remesh(input, settings, &Solver::default(), &Progress::none())
}

fn outcomes(made: &Remeshed) -> Vec<GuideOutcome> {
    made.report
        .guides
        .iter()
        .map(|guide| guide.outcome)
        .collect()
}

fn ball() -> PolygonMesh {
    shapes::polygons(&shapes::sphere(16))
}

#[test]
fn edges_lie_on_exact_rings_that_cross_and_turn_along_those_to_follow() {
    let exact = [ring(1.0, 0.4), ring(1.0, 0.4 + std::f64::consts::FRAC_PI_2)];
    let follow = exact.clone().map(|stroke| Stroke {
        strength: Strength::Follow,
        ..stroke
    });
    let laid = run(&ball(), &exact, &quads(400)).unwrap();
    assert_eq!(outcomes(&laid), [GuideOutcome::Laid; 2]);
    assert!(
        laid.report.warnings.is_empty(),
        "{:?}",
        laid.report.warnings
    );
    let turned = run(&ball(), &follow, &quads(400)).unwrap();
    for guide in turned.report.guides {
        assert!(guide.angle.is_some_and(|angle| angle < 6.0), "{guide:?}");
    }
}

#[test]
fn a_ring_aslant_on_a_limb_is_laid_and_the_same_for_any_number_of_threads() {
    let capsule = shapes::polygons(&shapes::capsule(4.0, 10));
    let stroke = ring(1.1, 0.2);
    let made = [1, 2].map(|threads| {
        let settings = Settings {
            threads,
            ..quads(300)
        };
        run(&capsule, std::slice::from_ref(&stroke), &settings).unwrap()
    });
    assert_eq!(outcomes(&made[0]), [GuideOutcome::Laid]);
    assert_eq!(made[0].mesh, made[1].mesh);
}

#[test]
fn an_open_stroke_on_a_sheet_gets_edges_to_its_ends() {
    let n = 12;
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for y in 0..=n {
        for x in 0..=n {
            points.push(DVec3::new(f64::from(x), f64::from(y), 0.0));
        }
    }
    for y in 0..n {
        for x in 0..n {
            let a = y * (n + 1) + x;
            faces.push([a, a + 1, a + n + 2, a + n + 1]);
        }
    }
    let sheet = PolygonMesh::from_faces(points, &faces).unwrap();
    let stroke = Stroke {
        points: vec![DVec3::new(2.0, 4.0, 0.2), DVec3::new(9.0, 5.0, 0.0)],
        is_closed: false,
        strength: Strength::Exact,
    };
    let made = run(&sheet, &[stroke], &quads(150)).unwrap();
    assert_eq!(
        outcomes(&made),
        [GuideOutcome::Laid],
        "{:?}",
        made.report.guides
    );
    assert_eq!(made.report.output.n_borders, 1);
}

#[test]
fn a_stroke_far_off_is_named_and_changes_nothing() {
    let far = run(&ball(), &[ring(1.6, 0.0)], &quads(150)).unwrap();
    let plain = run(&ball(), &[], &quads(150)).unwrap();
    assert_eq!(far.mesh, plain.mesh);
    assert_eq!(outcomes(&far), [GuideOutcome::Lost]);
    let texts: Vec<&str> = far
        .report
        .warnings
        .iter()
        .map(|w| w.text.as_str())
        .collect();
    assert!(
        texts[0].starts_with("guide 0 is lost: it is 17."),
        "{texts:?}"
    );
    assert!(!far.report.warnings[0].grave);
    let strict = Settings {
        strict: true,
        ..quads(150)
    };
    let refused = run(&ball(), &[ring(1.6, 0.0)], &strict);
    assert!(matches!(refused, Err(Error::Unsound { .. })));
}

#[test]
fn what_is_no_line_or_has_no_quads_is_refused_with_its_numbers() {
    let mut broken = ring(1.0, 0.0);
    broken.points[7].y = f64::NAN;
    let short = Stroke {
        points: vec![DVec3::X, DVec3::Y],
        ..ring(1.0, 0.0)
    };
    let one_place = Stroke {
        points: vec![DVec3::X; 4],
        ..ring(1.0, 0.0)
    };
    let triangles = Settings {
        kind: Kind::Triangles,
        ..quads(150)
    };
    let cases = [
        (broken, quads(150), "point 7 of guide 0 is ("),
        (
            short,
            quads(150),
            "guide 0 has 2 points; it needs 3 at least",
        ),
        (
            one_place,
            quads(150),
            "the 4 points of guide 0 are all in one place",
        ),
        (
            ring(1.0, 0.0),
            triangles,
            "guides are for quads that flow, but the adaptive primitive",
        ),
    ];
    for (stroke, settings, text) in cases {
        let error = run(&ball(), &[stroke], &settings).unwrap_err().to_string();
        assert!(error.starts_with(text), "{error}");
    }
}

#[test]
fn a_ring_on_one_side_is_met_on_both_where_quads_are_mirrored() {
    let settings = Settings {
        mirror: Mirror::X,
        ..quads(400)
    };
    let stroke = Stroke {
        points: (ring(0.45, 0.0).points.iter())
            .map(|p| DVec3::new(0.89, p.x, p.y))
            .collect(),
        ..ring(1.0, 0.0)
    };
    let other = Stroke {
        points: stroke
            .points
            .iter()
            .map(|p| DVec3::new(-p.x, p.y, p.z))
            .collect(),
        ..stroke.clone()
    };
    let one = run(&ball(), std::slice::from_ref(&stroke), &settings).unwrap();
    assert_eq!(
        outcomes(&one),
        [GuideOutcome::Laid],
        "{:?}",
        one.report.guides
    );
    let two = run(&ball(), &[stroke, other], &settings).unwrap();
    assert_eq!(two.mesh, one.mesh);
    assert_eq!(outcomes(&two), [GuideOutcome::Laid; 2]);
}

#[test]
fn a_ring_aslant_to_every_plane_leaves_no_symmetry_to_keep() {
    let settings = Settings {
        mirror: Mirror::Auto,
        ..quads(400)
    };
    let axis = |guides: &[Stroke]| {
        let made = run(&ball(), guides, &settings).unwrap();
        (outcomes(&made), made.report.plane.map(|plane| plane.axis))
    };
    assert_eq!(axis(&[ring(1.0, 0.4)]), (vec![GuideOutcome::Laid], Some(1)));
    let mut aslant = ring(1.0, 0.4);
    for p in &mut aslant.points {
        // A quarter of a right angle about z.
        let (sin, cos) = sin_cos(std::f64::consts::PI / 8.0);
        *p = DVec3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z);
    }
    assert_eq!(axis(&[aslant]), (vec![GuideOutcome::Laid], None));
}
