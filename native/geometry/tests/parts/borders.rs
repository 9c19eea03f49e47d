//! Borders are no reason to leave a part, but where there can be none.

use glam::DVec3;
use orbflow_geometry::embed::Solver;
use orbflow_geometry::measure::topology;
use orbflow_geometry::pipeline::{self, Borders, Error, Flaw, Input, Settings};
use orbflow_geometry::progress::Progress;

use super::mixed::{Mixed, ball, kinds, remesh, settings, sphere};
use super::refused;

#[test]
fn borders_are_no_reason_but_for_primitives_that_have_none() {
    let mut open = Mixed::default();
    open.add(&ball(3), DVec3::ZERO, 1.0);
    open.faces.pop();
    let mesh = open.mesh();
    let filled = Settings {
        borders: Borders::Fill,
        ..sphere(60)
    };
    let (kept, text) = refused(&mesh, &sphere(60));
    assert_eq!(kinds(&kept[0]), ["border"]);
    let Flaw::Border { n_loops, n_edges } = kept[0].reasons[0].flaw else {
        panic!("{kept:?}");
    };
    assert_eq!(
        (n_loops, n_edges, kept[0].reasons[0].edges.len()),
        (1, 3, 3)
    );
    let words =
        "1 border loop, 3 border edges: the quad-sphere primitive has no borders; choose flow";
    assert!(text.starts_with(words), "{text}");
    for wanted in [filled, settings(60)] {
        let result = remesh(&mesh, &wanted).unwrap();
        let found = topology(&result.mesh, &Progress::none()).unwrap();
        let n_filled = usize::from(wanted.borders == Borders::Fill);
        assert_eq!((found.n_borders, found.genus), (1 - n_filled, Some(0)));
        let opened = result.report.parts[0].opened.unwrap();
        assert_eq!((opened.n_borders, opened.n_filled), (1, n_filled));
        assert_eq!(result.filled.is_empty(), n_filled == 0);
        assert!(result.report.kept.is_empty());
    }
}

#[test]
fn the_embedding_alone_refuses_and_the_decimation_takes_borders() {
    let mut mixed = Mixed::default();
    mixed.add(&ball(4), DVec3::ZERO, 1.0);
    mixed.add_faces(
        &[[3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 1.0]],
        &[&[0, 1, 2]],
    );
    let mesh = mixed.mesh();
    let embedded = pipeline::embed(&mesh, 1, &Solver::default(), &Progress::none());
    match embedded {
        Err(Error::Refused { kept, n_parts }) => {
            assert_eq!((kept.len(), n_parts), (1, 2));
            assert_eq!(kinds(&kept[0]), ["border", "flat"]);
            let text = &kept[0].reasons[0].text;
            assert!(
                text.contains("only meshes without borders can be embedded"),
                "{text}"
            );
        }
        other => panic!("{other:?}"),
    }
    let decimated = pipeline::decimate(Input::new(&mesh), 40, &Progress::none()).unwrap();
    assert!(decimated.mesh.n_faces() <= 41);
}
