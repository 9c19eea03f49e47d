//! A damaged mesh ends in one of finite positions or in an error.
#![no_main]

#[path = "../../geometry/tests/common/mod.rs"]
mod common;

use libfuzzer_sys::fuzz_target;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::pipeline::{Input, Settings, remesh};
use orbflow_geometry::progress::Progress;

fuzz_target!(|bytes: &[u8]| {
    let Some(mesh) = common::edits::damaged(bytes) else {
        return;
    };
    let settings = Settings {
        faces: 60,
        threads: 1,
        ..Settings::default()
    };
    let solver = Solver::default();
    if let Ok(remeshed) = remesh(Input::new(&mesh), &settings, &solver, &Progress::none()) {
        assert!(remeshed.report.output.n_faces > 0);
        assert!(remeshed.mesh.positions().iter().all(|p| p.is_finite()));
    }
});
