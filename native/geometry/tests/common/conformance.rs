//! What holds for every predictor, whatever it proposes.

use orbflow_geometry::decimate::collapse_to_tetrahedron;
use orbflow_geometry::embed::{Embedded, OffsetPredictor, RepairReport, Report, Settings, embed};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::progress::Progress;
use orbflow_geometry::sphere_map::{degree, folded_faces};

/// The shapes of the suite, collapsed.
pub fn hierarchies() -> Vec<(&'static str, CollapseHierarchy)> {
    let collapse =
        |mesh| collapse_to_tetrahedron(mesh, &Progress::none()).expect("the shapes are closed");
    let shapes = super::closed(7).into_iter();
    shapes.map(|(name, mesh)| (name, collapse(mesh))).collect()
}

/// What every predictor must lead to.
pub fn check(hierarchy: &CollapseHierarchy, predictor: &dyn OffsetPredictor) -> Report {
    let settings = Settings::default();
    let Embedded { map, report } = embed(hierarchy, predictor, &settings, &Progress::none())
        .expect("every proposal is repaired");
    let predictor = predictor.deputy(hierarchy).unwrap_or(predictor);
    let faces = hierarchy.mesh().faces();
    assert!(folded_faces(faces, map.sphere()).is_empty());
    assert_eq!(degree(faces, map.sphere()), 1);
    assert_eq!((report.n_folds, report.degree), (0, 1));
    assert_eq!(report.n_vertices, hierarchy.n_vertices());
    assert_eq!(report.predictor, predictor.name());
    assert!(report.energy.is_finite() && report.proposal.energy.is_finite());
    assert!((0.0..=100.0).contains(&report.proposal.folds_pct));
    assert!(report.n_relaxations >= report.proposal.n_relaxations);
    let was_valid = report.proposal.n_folds == 0 && report.proposal.degree == 1;
    let untouched = report.repair == RepairReport::default();
    assert_eq!(was_valid, untouched, "{report:?}");
    assert_eq!(report.weights.as_ref(), predictor.weights());
    let times = report.times;
    for each_ms in [times.propose_ms, times.relax_ms] {
        assert!(each_ms.is_finite() && each_ms > 0.0, "{times:?}");
    }
    assert!(was_valid || times.repair_ms > 0.0, "{times:?}");
    report
}
