//! What holds for every predictor of guidance, whatever it proposes.

use orbflow_geometry::guidance::{Guidance, GuidanceError, GuidancePredictor};
use orbflow_geometry::mesh::{TriangleMesh, bounds};
use orbflow_geometry::progress::{CancelToken, Progress};

/// The shapes of the suite in the frame of work: a diagonal of 1 about the origin.
pub fn shapes() -> Vec<(&'static str, TriangleMesh)> {
    let shapes = super::closed(7).into_iter();
    shapes.map(|(name, mesh)| (name, framed(&mesh))).collect()
}

/// A mesh in the frame of work.
pub fn framed(mesh: &TriangleMesh) -> TriangleMesh {
    let [low, high] = bounds(mesh.positions());
    let (centre, diagonal) = ((low + high) / 2.0, (high - low).length());
    let positions = mesh.positions().iter();
    mesh.with_positions(positions.map(|&p| (p - centre) / diagonal).collect())
}

/// What every predictor must keep to on a shape; its proposal, if it has one.
pub fn check(mesh: &TriangleMesh, predictor: &dyn GuidancePredictor) -> Option<Guidance> {
    let ask = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads can be had");
        pool.install(|| predictor.propose(mesh, &Progress::none()))
    };
    let [one, again, two] = [1, 1, 2].map(ask);
    assert_eq!(one, again);
    assert_eq!(one, two);
    let token = CancelToken::new();
    token.cancel();
    let progress = Progress::new(token, &|_, _| {});
    let cancelled = predictor.propose(mesh, &progress);
    let is_cancelled = matches!(cancelled, Err(GuidanceError::Cancelled(_)));
    let is_nothing = cancelled == Ok(Guidance::default());
    assert!(is_cancelled || is_nothing, "{cancelled:?}");
    match one {
        Ok(guidance) => {
            assert_eq!(guidance.check(mesh), Ok(()));
            let is_idle = guidance == Guidance::default();
            assert!(is_idle || !predictor.is_empty());
            Some(guidance)
        }
        Err(error) => {
            assert!(matches!(error, GuidanceError::Failed { .. }), "{error}");
            None
        }
    }
}
