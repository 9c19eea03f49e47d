//! One suite for every predictor: whatever it proposes, a valid map comes out, and the report says
//! what had to be done.

mod common;

use common::conformance::{check, hierarchies};
use glam::DVec3;
use orbflow_geometry::elementary::{atan2, hypot, sin_cos};
use orbflow_geometry::embed::{OffsetPredictor, PredictError, Proposal, Settings, Solver, embed};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::{Id, VertexMap};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;

/// A predictor that bends what the solver proposes: `bend` maps the points of a valid map.
struct Bent(&'static str, fn(usize, DVec3) -> DVec3);

impl OffsetPredictor for Bent {
    fn name(&self) -> &'static str {
        self.0
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        let Proposal { sphere, .. } = Solver::default().propose(hierarchy, progress)?;
        let bent = sphere.iter_ids().map(|(v, &p)| self.1(v.index(), p));
        Ok(Proposal {
            sphere: bent.collect(),
            n_proposed: hierarchy.n_vertices(),
            n_relaxations: 0,
        })
    }
}

fn random_direction(seed: usize) -> DVec3 {
    let mut random = Random::new(seed as u64);
    let point = DVec3::new(random.unit(), random.unit(), random.unit());
    point * 2.0 - 1.0
}

/// Twice around the axis: no folds but at the poles, and degree 2.
fn twice_around(p: DVec3) -> DVec3 {
    let (sine, cosine) = sin_cos(2.0 * atan2(p.y, p.x));
    let radius = hypot(p.x, p.y);
    DVec3::new(radius * cosine, radius * sine, p.z)
}

const BENT: &[Bent] = &[
    Bent("identity", |_, p| p),
    Bent("not a number", |_, _| DVec3::NAN),
    Bent(
        "some not a number",
        |i, p| if i % 9 == 0 { DVec3::NAN } else { p },
    ),
    Bent(
        "infinite",
        |i, p| if i % 7 == 0 { DVec3::INFINITY } else { p },
    ),
    Bent("zero", |_, _| DVec3::ZERO),
    Bent("one point", |_, _| DVec3::new(0.6, 0.0, 0.8)),
    Bent("of any length", |i, p| {
        p * 10.0_f64.powi(i as i32 % 500 - 250)
    }),
    Bent("random", |i, _| random_direction(i)),
    Bent("a tenth random", |i, p| {
        if i % 10 == 3 { random_direction(i) } else { p }
    }),
    Bent("noisy", |i, p| p + random_direction(i) * 0.15),
    Bent("mirrored", |_, p| p.with_x(-p.x)),
    Bent("mirrored and noisy", |i, p| random_direction(i) * 0.05 - p),
    Bent("folded in half", |_, p| p.with_z(p.z.abs())),
    Bent("flattened", |_, p| p.with_z(0.0)),
    Bent("rounded", |_, p| (p * 4.0).round()),
    Bent("twice around", |_, p| twice_around(p)),
];

/// What another predictor proposes, for a coarse level alone.
struct Coarse<'a>(&'a Bent, usize);

impl OffsetPredictor for Coarse<'_> {
    fn name(&self) -> &'static str {
        "coarse"
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        let proposal = self.0.propose(hierarchy, progress)?;
        let n_proposed = self.1;
        Ok(Proposal {
            n_proposed,
            ..proposal
        })
    }
}

/// Too few points, or too many.
struct Miscounted(usize);

impl OffsetPredictor for Miscounted {
    fn name(&self) -> &'static str {
        "miscounted"
    }

    fn propose(&self, of: &CollapseHierarchy, _: &Progress) -> Result<Proposal, PredictError> {
        Ok(Proposal {
            sphere: VertexMap::filled(self.0, DVec3::Z),
            n_proposed: of.n_vertices(),
            n_relaxations: 0,
        })
    }
}

#[test]
fn the_solver_needs_no_repair() {
    for (name, hierarchy) in hierarchies() {
        for solver in [Solver::default(), Solver::BRISK] {
            let report = check(&hierarchy, &solver);
            assert_eq!(report.proposal.n_folds, 0, "{name}");
            assert!(report.proposal.n_relaxations > 0, "{name}");
        }
    }
}

#[test]
fn nonsense_still_ends_in_a_valid_map() {
    for (name, hierarchy) in hierarchies() {
        let reference = check(&hierarchy, &Solver::default());
        for bent in BENT {
            let report = check(&hierarchy, bent);
            // What was repaired is as good a map as what was never broken.
            let message = format!("{name} {}: {report:?}", bent.0);
            assert!(report.energy < reference.energy + 0.05, "{message}");
        }
        for n in [0, 1, hierarchy.n_vertices() + 5] {
            assert!(check(&hierarchy, &Miscounted(n)).repair.fell_back_to_solver);
        }
    }
}

#[test]
fn a_proposal_for_a_coarse_level_is_grown_to_a_valid_map() {
    for (name, hierarchy) in hierarchies() {
        let reference = check(&hierarchy, &Solver::default());
        for bent in BENT {
            for n_coarse in [0, 4, 30, hierarchy.n_vertices() / 2] {
                let report = check(&hierarchy, &Coarse(bent, n_coarse));
                let message = format!("{name} {} at {n_coarse}: {report:?}", bent.0);
                assert_eq!(report.proposal.n_vertices, n_coarse.max(4), "{message}");
                assert!(report.energy < reference.energy + 0.05, "{message}");
            }
        }
    }
}

#[test]
fn small_faults_are_repaired_where_they_are() {
    let fault = |name: &str| BENT.iter().find(|bent| bent.0 == name).unwrap();
    for (name, hierarchy) in hierarchies() {
        let n = hierarchy.n_vertices();
        let local = check(&hierarchy, fault("a tenth random")).repair;
        assert!(
            !local.fell_back_to_solver && (1..n / 4).contains(&local.n_moved),
            "{name}"
        );
        let mirrored = check(&hierarchy, fault("mirrored")).repair;
        assert!(
            mirrored.mirrored && mirrored.n_moved == 0,
            "{name} {mirrored:?}"
        );
    }
}

#[test]
fn a_map_that_covers_the_sphere_twice_is_given_up() {
    let twice = BENT.iter().find(|bent| bent.0 == "twice around").unwrap();
    for (name, hierarchy) in hierarchies() {
        let report = check(&hierarchy, twice);
        assert_eq!(report.proposal.degree, 2, "{name}");
        assert!(report.repair.fell_back_to_solver, "{name}");
    }
}

#[test]
fn what_a_predictor_cannot_do_is_an_error() {
    struct Unable;
    impl OffsetPredictor for Unable {
        fn name(&self) -> &'static str {
            "unable"
        }
        fn propose(&self, _: &CollapseHierarchy, _: &Progress) -> Result<Proposal, PredictError> {
            let reason = "no weights".to_owned();
            Err(PredictError::Failed { reason })
        }
    }
    let (_, hierarchy) = &hierarchies()[0];
    let error = embed(hierarchy, &Unable, &Settings::default(), &Progress::none()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the predictor has no proposal: no weights"
    );
}
