//! A run stops wherever it is told to, and says so.

mod common;

use std::sync::atomic::{AtomicUsize, Ordering};

use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::topology;
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh};
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::pipeline::{self, Input, Kind, Settings};
use orbflow_geometry::progress::{CancelToken, Cancelled, Progress};
use orbflow_geometry::score::{self, score};

/// Runs a verb that tells whether it was cancelled, with a listener that raises the flag at the
/// `last` report; how many reports there were.
fn stopped_at(last: usize, verb: &dyn Fn(&Progress) -> bool) -> (usize, bool) {
    let token = CancelToken::new();
    let n_reports = AtomicUsize::new(0);
    let listener = |_: &str, _: f64| {
        if n_reports.fetch_add(1, Ordering::SeqCst) + 1 == last {
            token.cancel();
        }
    };
    let is_cancelled = verb(&Progress::new(token.clone(), &listener));
    (n_reports.into_inner(), is_cancelled)
}

/// Stops a verb at each of its reports (at most 60 of them, spread evenly).
fn stops_everywhere(name: &str, verb: &dyn Fn(&Progress) -> bool) {
    let (n_reports, is_cancelled) = stopped_at(usize::MAX, verb);
    assert!(!is_cancelled, "{name} was not asked to stop");
    assert!(n_reports > 4, "{name} reports {n_reports} times");
    for last in (1..=n_reports).step_by(n_reports.div_ceil(60)) {
        let (heard, is_cancelled) = stopped_at(last, verb);
        assert!(is_cancelled, "{name} went on after report {last}");
        // One thread: nothing is reported after the flag is up.
        assert_eq!(heard, last, "{name}");
    }
}

fn settings(kind: Kind) -> Settings {
    Settings {
        faces: 200,
        kind,
        threads: 1,
        ..Settings::default()
    }
}

fn mesh() -> PolygonMesh {
    common::polygons(&common::blob(3, 9))
}

#[test]
fn remeshing_stops_at_every_report() {
    let mesh = mesh();
    let materials = vec![0; mesh.n_faces()];
    for kind in [Kind::Triangles, Kind::Quads] {
        let (settings, predictor) = (settings(kind), Solver::default());
        let input = Input {
            materials: Some(&materials),
            ..Input::new(&mesh)
        };
        stops_everywhere("remesh", &|progress| {
            let result = pipeline::remesh(input, &settings, &predictor, progress);
            result.is_err_and(|error| error.is_cancelled())
        });
    }
}

#[test]
fn embedding_decimating_and_scoring_stop_at_every_report() {
    let mesh = mesh();
    stops_everywhere("embed", &|progress| {
        let result = pipeline::embed(&mesh, 1, &Solver::default(), progress);
        result.is_err_and(|error| error.is_cancelled())
    });
    stops_everywhere("decimate", &|progress| {
        let result = pipeline::decimate(Input::new(&mesh), 40, progress);
        result.is_err_and(|error| error.is_cancelled())
    });
    let settings = score::Settings::default();
    stops_everywhere("score", &|progress| {
        let result = score(&mesh, &mesh, &settings, progress);
        result == Err(score::Error::Cancelled(Cancelled))
    });
}

#[test]
fn what_is_built_for_large_meshes_stops_when_asked_to() {
    let token = CancelToken::new();
    token.cancel();
    let progress = Progress::silent(token);
    let mesh = common::blob(1, 4);
    let built = TriangleMesh::build(mesh.positions().to_vec(), mesh.faces().to_vec(), &progress);
    assert_eq!(built, Err(Cancelled));
    assert_eq!(Bvh::build_of_mesh(&mesh, &progress).err(), Some(Cancelled));
    let counted = topology(&common::polygons(&mesh), &progress);
    assert_eq!(counted, Err(Cancelled));
}
