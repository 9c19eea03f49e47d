//! Surfaces that share edges: what goes on there is done, what ends there stays.

use glam::DVec3;
use orbflow_geometry::pipeline::Settings;

use super::mixed::{kinds, remesh, sphere, walled_box};
use super::{refused, stays};

#[test]
fn a_box_with_a_wall_is_done_and_the_wall_stays() {
    let mesh = walled_box(DVec3::ZERO).mesh();
    let result = remesh(&mesh, &sphere(100)).unwrap();
    stays(&result, &mesh, [10]);
    let report = &result.report;
    assert_eq!((report.parts.len(), report.kept.len()), (1, 1));
    assert_eq!((report.clean.n_shared_edges, report.clean.n_sheets), (4, 2));
    let told = "4 edges of three or more faces parted into 2 sheets";
    assert!(report.clean.sentences().contains(&told.to_owned()));
    let reason = &report.kept[0].reasons[0];
    assert_eq!((kinds(&report.kept[0]).len(), reason.edges.len()), (1, 4));
    assert!(
        reason
            .text
            .starts_with("1 border loop, 4 border edges (4 of them where 3"),
        "{}",
        reason.text
    );
    let strict = Settings {
        strict: true,
        ..sphere(100)
    };
    assert_eq!(refused(&mesh, &strict).0.len(), 1);
}
