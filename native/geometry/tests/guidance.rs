//! One suite for every predictor of guidance, and what the pipeline makes of what they propose.

mod common;

use common::guided::{check, framed, shapes};
use glam::DVec3;
use orbflow_geometry::elementary::sin_cos;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::guidance::{
    BadGuidance, Guidance, GuidanceError, GuidancePredictor, NoGuidance, Recognised, Strength,
    Stroke,
};
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh, VertexMap, bounds};
use orbflow_geometry::pipeline::{
    Error, GuideOutcome, Input, Kind, Mirror, Remeshed, Settings, remesh,
};
use orbflow_geometry::progress::{CancelToken, Progress};

/// A ring across the z axis, of a share of the mesh's width, at a share of its height.
#[derive(Debug)]
struct Ring {
    height: f64,
    density: bool,
}

fn ring(mesh: &TriangleMesh, height: f64) -> Stroke {
    let [low, high] = bounds(mesh.positions());
    let radius = (high.x - low.x) / 2.0;
    let centre = (low + high) / 2.0;
    let point = |i: u32| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / 48.0);
        centre + DVec3::new(radius * cos, radius * sin, height * (high.z - low.z))
    };
    Stroke {
        points: (0..48).map(point).collect(),
        is_closed: true,
        strength: Strength::Exact,
    }
}

impl GuidancePredictor for Ring {
    fn name(&self) -> &'static str {
        "ring"
    }

    fn propose(&self, mesh: &TriangleMesh, of: &Progress<'_>) -> Result<Guidance, GuidanceError> {
        of.check()?;
        let finer = |p: &DVec3| f64::from(u8::from(p.z > 0.2));
        Ok(Guidance {
            strokes: vec![ring(mesh, self.height)],
            density: (self.density).then(|| mesh.positions().iter().map(finer).collect()),
            recognised: Some(Recognised {
                kind: "rod".to_owned(),
                confidence: 0.75,
            }),
        })
    }
}

/// What is no use.
#[derive(Debug)]
struct Bad(fn(&TriangleMesh) -> Guidance);

/// A proposal, and what is said of it.
type Useless = (fn(&TriangleMesh) -> Guidance, &'static str);

impl GuidancePredictor for Bad {
    fn name(&self) -> &'static str {
        "bad"
    }

    fn propose(&self, mesh: &TriangleMesh, _: &Progress<'_>) -> Result<Guidance, GuidanceError> {
        Ok(self.0(mesh))
    }
}

#[derive(Debug)]
struct Unable;

impl GuidancePredictor for Unable {
    fn name(&self) -> &'static str {
        "unable"
    }

    fn propose(&self, _: &TriangleMesh, of: &Progress<'_>) -> Result<Guidance, GuidanceError> {
        of.check()?;
        let reason = "no weights".to_owned();
        Err(GuidanceError::Failed { reason })
    }
}

fn rod() -> PolygonMesh {
    PolygonMesh::from(&common::capsule(4.0, 8))
}

fn quads() -> Settings {
    Settings {
        faces: 240,
        mirror: Mirror::Off,
        threads: 1,
        ..Settings::default()
    }
}

fn run(guidance: &dyn GuidancePredictor, guides: &[Stroke]) -> Remeshed {
    let rod = rod();
    let input = Input {
        guidance,
        guides,
        ..Input::new(&rod)
    };
    remesh(input, &quads(), &Solver::default(), &Progress::none()).expect("a rod flows")
}

#[test]
fn every_predictor_keeps_the_promises() {
    for (name, mesh) in shapes() {
        assert_eq!(
            check(&mesh, &NoGuidance),
            Some(Guidance::default()),
            "{name}"
        );
        let guidance = check(
            &mesh,
            &Ring {
                height: 0.1,
                density: true,
            },
        );
        assert_eq!(guidance.map(|g| g.strokes.len()), Some(1), "{name}");
        assert_eq!(check(&mesh, &Unable), None, "{name}");
    }
}

#[test]
fn nobody_and_somebody_who_is_no_use_change_nothing() {
    let plain = run(&NoGuidance, &[]);
    assert_eq!(plain.report.guidance, None);
    let bad: [Useless; 4] = [
        (
            |mesh| Guidance {
                density: Some(VertexMap::filled(mesh.n_vertices() + 1, 0.5)),
                ..Guidance::default()
            },
            "densities for",
        ),
        (
            |mesh| Guidance {
                density: Some(VertexMap::filled(mesh.n_vertices(), f64::NAN)),
                ..Guidance::default()
            },
            "has the density NaN",
        ),
        (
            |mesh| {
                let mut stroke = ring(mesh, 0.0);
                stroke.points[3].x = f64::INFINITY;
                Guidance {
                    strokes: vec![stroke],
                    ..Guidance::default()
                }
            },
            "stroke 0 is",
        ),
        (
            |mesh| {
                let mut stroke = ring(mesh, 0.0);
                stroke.points.truncate(2);
                Guidance {
                    strokes: vec![stroke],
                    ..Guidance::default()
                }
            },
            "stroke 0 has 2 points; 3 are needed",
        ),
    ];
    let bad = bad.map(|(propose, why)| (Bad(propose), why));
    let each = bad
        .iter()
        .map(|(bad, why)| (bad as &dyn GuidancePredictor, *why));
    for (predictor, why) in each.chain([(&Unable as &dyn GuidancePredictor, "no weights")]) {
        let made = run(predictor, &[]);
        assert_eq!(made.mesh, plain.mesh, "{why}");
        let asked = made.report.guidance.expect("somebody was asked");
        assert_eq!(asked.predictor, predictor.name());
        let refused = asked.parts[0].refused.clone().expect("it is no use");
        assert!(refused.contains(why), "{refused}");
    }
}

#[test]
fn a_proposed_ring_is_laid_and_told_of_as_proposed() {
    let made = run(
        &Ring {
            height: 0.1,
            density: false,
        },
        &[],
    );
    let [guide] = &made.report.guides[..] else {
        panic!("{:?}", made.report.guides);
    };
    assert!(
        guide.is_proposed && guide.outcome == GuideOutcome::Laid,
        "{guide:?}"
    );
    let asked = made.report.guidance.expect("somebody was asked");
    assert_eq!((asked.parts.len(), asked.parts[0].n_strokes), (1, 1));
    let recognised = asked.parts[0]
        .recognised
        .clone()
        .expect("it was taken for one");
    assert_eq!(recognised.kind, "rod");
}

#[test]
fn what_the_artist_drew_stays_alone_in_its_place() {
    let mesh = framed(&common::capsule(4.0, 8));
    let [low, high] = bounds(common::capsule(4.0, 8).positions());
    let (centre, diagonal) = ((low + high) / 2.0, (high - low).length());
    for (height, n_wanted) in [(0.11, 1), (-0.2, 2)] {
        let mut drawn = ring(&mesh, height);
        for p in &mut drawn.points {
            *p = *p * diagonal + centre;
        }
        let made = run(
            &Ring {
                height: 0.1,
                density: false,
            },
            &[drawn],
        );
        let proposed: Vec<bool> = made.report.guides.iter().map(|g| g.is_proposed).collect();
        assert_eq!(proposed, [false, true][..n_wanted], "{height}");
    }
}

#[test]
fn quads_are_smaller_where_a_density_is_proposed() {
    let above = |made: &Remeshed| {
        let places = made.mesh.positions().iter();
        places.filter(|p| p.z > 1.5).count()
    };
    let plain = above(&run(&NoGuidance, &[]));
    let denser = above(&run(
        &Ring {
            height: -0.2,
            density: true,
        },
        &[],
    ));
    assert!(denser as f64 > 1.3 * plain as f64, "{plain} {denser}");
}

#[test]
fn triangles_ask_nobody_and_a_cancelled_run_ends() {
    let rod = rod();
    let input = Input {
        guidance: &Unable,
        ..Input::new(&rod)
    };
    let triangles = Settings {
        kind: Kind::Triangles,
        ..quads()
    };
    let made = remesh(input, &triangles, &Solver::default(), &Progress::none());
    assert_eq!(made.expect("nobody is asked").report.guidance, None);
    let token = CancelToken::new();
    token.cancel();
    let progress = Progress::new(token, &|_, _| {});
    let cancelled = remesh(input, &quads(), &Solver::default(), &progress);
    assert!(matches!(cancelled, Err(Error::Cancelled(_))));
}

#[test]
fn a_confidence_beyond_certainty_is_no_use() {
    let mesh = common::sphere(3);
    let recognised = |confidence: f64| Guidance {
        recognised: Some(Recognised {
            kind: "ball".to_owned(),
            confidence,
        }),
        ..Guidance::default()
    };
    assert_eq!(recognised(1.0).check(&mesh), Ok(()));
    let error = recognised(1.5).check(&mesh);
    assert_eq!(error, Err(BadGuidance::Confidence { value: 1.5 }));
}
