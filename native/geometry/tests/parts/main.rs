//! Meshes of several parts: what can be done is done, the rest stays as it was and is named.

mod borders;
mod carried;
#[path = "../common/mod.rs"]
mod common;
mod mixed;
mod sheets;

use glam::DVec3;
use mixed::{
    Mixed, ball, cube, kinds, moebius_strip, remesh, settings, sphere, split_along, touching_blocks,
};
use orbflow_geometry::embed::{OffsetPredictor, PredictError, Proposal, Solver};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::measure::topology;
use orbflow_geometry::mesh::{FaceId, Id, PolygonMesh};
use orbflow_geometry::pipeline::{
    self, Error, Fault, Flaw, Input, Kind, Mirror, Outcome, Remeshed, Settings, SmallParts,
};
use orbflow_geometry::progress::Progress;
use proptest::prelude::*;

fn refused(mesh: &PolygonMesh, settings: &Settings) -> (Vec<pipeline::Kept>, String) {
    match remesh(mesh, settings) {
        Err(error) => {
            let text = error.to_string();
            match error {
                Error::Refused { kept, .. } => (kept, text),
                other => panic!("{other}"),
            }
        }
        Ok(_) => panic!("it was not refused"),
    }
}

/// Whether the last faces of a result are faces of the input, bit for bit and in order.
fn stays(result: &Remeshed, mesh: &PolygonMesh, faces: impl IntoIterator<Item = usize>) {
    let faces: Vec<usize> = faces.into_iter().collect();
    assert_eq!(result.kept_faces, faces.len());
    let first = result.mesh.n_faces() - faces.len();
    for (i, &face) in faces.iter().enumerate() {
        let bits = |mesh: &PolygonMesh, face| {
            let corners = mesh.face(FaceId::from_index(face)).iter();
            let corners = corners.map(|&v| mesh.position(v).to_array().map(f64::to_bits));
            corners.collect::<Vec<_>>()
        };
        assert_eq!(
            bits(&result.mesh, first + i),
            bits(mesh, face),
            "face {face}"
        );
    }
}

#[test]
fn a_stray_triangle_stays_and_the_box_is_done() {
    let mut mixed = Mixed::default();
    mixed.add_faces(
        &[[3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 1.0]],
        &[&[0, 1, 2]],
    );
    mixed.add(&cube(3), DVec3::ZERO, 1.0);
    let mesh = mixed.mesh();
    let result = remesh(&mesh, &settings(100)).unwrap();
    stays(&result, &mesh, [0]);
    let kept = &result.report.kept;
    assert_eq!((kept.len(), kept[0].part, kept[0].n_faces), (1, 0, 1));
    assert_eq!(kinds(&kept[0]), ["flat"]);
    let reason = &kept[0].reasons[0];
    assert!(
        reason.text.starts_with("the faces use 3 different points"),
        "{}",
        reason.text
    );
    assert_eq!(
        (reason.edges.len(), reason.faces.len(), reason.place[0]),
        (0, 1, 3.0)
    );
    let made = result.mesh.n_faces() - 1;
    // Of all counts only some make a cube.
    assert!(made.abs_diff(100) <= 12, "{made}");
    assert_eq!(result.report.parts.len(), 1);
    assert_eq!(result.sphere.len(), result.mesh.n_vertices());
    assert_eq!(result.sphere[result.mesh.n_vertices() - 1], DVec3::ZERO);
    let strict = Settings {
        strict: true,
        ..settings(100)
    };
    let (kept, text) = refused(&mesh, &strict);
    assert_eq!(kept.len(), 1);
    assert!(
        text.starts_with("1 of 2 parts cannot be done: part 1: the faces use 3"),
        "{text}"
    );
}

#[test]
fn every_reason_of_every_part_is_told_when_none_can_be_done() {
    let mut mixed = Mixed::default();
    let mut torus = Mixed::default();
    torus.add(&common::torus(8, 6), DVec3::ZERO, 1.0);
    torus.faces.pop();
    mixed.append(&torus);
    mixed.add(&common::torus(8, 6), DVec3::X * 9.0, 1.0);
    mixed.append(&moebius_strip(DVec3::X * 20.0));
    let (kept, text) = refused(&mixed.mesh(), &sphere(100));
    let all: Vec<_> = kept.iter().map(kinds).collect();
    assert_eq!(
        all,
        [
            vec!["border", "handles"],
            vec!["handles"],
            vec!["one-sided", "border"]
        ]
    );
    assert!(
        text.starts_with("none of the 3 parts can be done: part 1: 1 border loop"),
        "{text}"
    );
    for words in [
        "; genus 1: ",
        "part 2: genus 1",
        "the surface cannot be oriented",
    ] {
        assert!(text.contains(words), "{text}");
    }
    // A loop of a handle is told, closed.
    let handle = &kept[1].reasons[0];
    assert!(handle.edges.len() >= 3 && matches!(handle.flaw, Flaw::Handles { genus: 1 }));
    assert_eq!(kept[2].reasons[0].edges.len(), 1);
    assert_eq!(kept[2].reasons[1].edges.len(), 24);
}

#[test]
fn specks_stay_within_a_third_of_the_count_or_go() {
    let mut mixed = Mixed::default();
    mixed.add(&ball(6), DVec3::ZERO, 1.0);
    for i in 0..20 {
        mixed.add(&ball(1), DVec3::new(f64::from(i) * 0.1, 1.4, 0.0), 0.01);
    }
    let mesh = mixed.mesh();
    let n_ball = ball(6).n_faces();
    let result = remesh(&mesh, &settings(100)).unwrap();
    assert_eq!(result.report.parts.len(), 1);
    // They have more than a third of the faces asked for.
    assert!(result.report.parts[0].n_faces.abs_diff(67) <= 3);
    assert_eq!(counted(&result), Some((100, result.mesh.n_faces())));
    stays(&result, &mesh, n_ball..mesh.n_faces());
    assert_eq!(result.report.kept.len(), 20);
    for (i, kept) in result.report.kept.iter().enumerate() {
        assert_eq!(
            (kept.part, kinds(kept).join(" ")),
            (i + 1, "small".to_owned())
        );
        assert!(
            kept.reasons[0]
                .text
                .contains("of 100 faces; 6 are the fewest")
        );
    }
    let drop = Settings {
        small_parts: SmallParts::Drop,
        // Small parts do not make a strict run fail.
        strict: true,
        ..settings(100)
    };
    let result = remesh(&mesh, &drop).unwrap();
    assert_eq!((result.kept_faces, result.report.kept.len()), (0, 20));
    assert!(result.mesh.n_faces().abs_diff(100) <= 3);
    let one = remesh(&mesh, &settings(800)).unwrap();
    assert!(
        one.mesh.n_faces().abs_diff(800) <= 16,
        "{}",
        one.mesh.n_faces()
    );
    assert_eq!(counted(&one), None);
    assert_eq!(result.report.kept[3].outcome, Outcome::Dropped);
}

/// How many faces were asked for and how many there are, where a warning says so.
fn counted(result: &Remeshed) -> Option<(usize, usize)> {
    let warnings = result.report.warnings.iter();
    let mut counts = warnings.filter_map(|warning| match warning.what {
        Fault::Count { n_asked, n_faces } => Some((n_asked, n_faces)),
        _ => None,
    });
    counts.next()
}

#[test]
fn parts_are_small_by_their_share_or_by_a_size() {
    let mut mixed = Mixed::default();
    mixed.add(&ball(5), DVec3::ZERO, 1.0);
    mixed.add(&ball(2), DVec3::X * 2.0, 0.3);
    // Small and flat is merely small.
    mixed.add_faces(
        &[[0.0, 2.0, 0.0], [0.1, 2.0, 0.0], [0.0, 2.1, 0.0]],
        &[&[0, 1, 2]],
    );
    let mesh = mixed.mesh();
    let many = remesh(&mesh, &settings(200)).unwrap().report;
    assert_eq!((many.parts.len(), many.kept.len()), (2, 1));
    assert_eq!(kinds(&many.kept[0]), ["flat"]);
    let sized = Settings {
        small_size: 25.0,
        strict: true,
        ..settings(200)
    };
    let few = remesh(&mesh, &sized).unwrap().report;
    assert_eq!((few.parts.len(), few.kept.len()), (1, 2));
    assert_eq!(kinds(&few.kept[1]), ["flat", "small"]);
    assert!(
        few.kept[0].reasons[0].text.starts_with("it measures 2"),
        "{:?}",
        few.kept
    );
    let all = Settings {
        small_size: 100.0,
        ..settings(200)
    };
    let (kept, text) = refused(&mesh, &all);
    assert_eq!(kept.len(), 3);
    assert!(
        text.starts_with("none of the 3 parts can be done: part 1: it measures"),
        "{text}"
    );
}

#[test]
fn equal_parts_get_the_fewest_faces_each_when_they_are_too_many() {
    let mut mixed = Mixed::default();
    for i in 0..12 {
        mixed.add(
            &cube(2),
            DVec3::X * 3.0 * f64::from(i),
            1.0 + 0.03 * f64::from(i),
        );
    }
    // A cube that is its own image in a plane through it has ten quads.
    let settings = Settings {
        mirror: Mirror::Off,
        ..settings(30)
    };
    let result = remesh(&mixed.mesh(), &settings).unwrap();
    assert_eq!(
        (result.report.parts.len(), result.report.kept.len()),
        (12, 0)
    );
    assert_eq!(result.mesh.n_faces(), 72);
}

#[test]
fn blocks_that_touch_are_parts_that_touch_again_at_the_edge() {
    let mesh = touching_blocks();
    let result = remesh(&mesh, &settings(200)).unwrap();
    let found = topology(&result.mesh, &Progress::none()).unwrap();
    // Four faces meet there.
    assert!(found.closed && !found.manifold, "{found:?}");
    assert_eq!((found.n_components, result.report.parts.len()), (1, 2));
    let rejoined = result.report.rejoined.unwrap();
    assert_eq!((rejoined.n_shared_lines, rejoined.n_left), (1, 0));
    assert!(result.report.kept.is_empty());
}

/// Embeds nothing with more than so many vertices.
struct Picky(usize);

impl OffsetPredictor for Picky {
    fn name(&self) -> &'static str {
        "picky"
    }

    fn propose(
        &self,
        hierarchy: &CollapseHierarchy,
        progress: &Progress,
    ) -> Result<Proposal, PredictError> {
        let n = hierarchy.mesh().n_vertices();
        if n > self.0 {
            let reason = format!("{n} vertices are too many");
            return Err(PredictError::Failed { reason });
        }
        Solver::default().propose(hierarchy, progress)
    }
}

#[test]
fn a_part_whose_run_fails_stays_as_it_was() {
    let [small, large] = [ball(3), ball(5)];
    let mut mixed = Mixed::default();
    mixed.add(&small, DVec3::X * 4.0, 1.0);
    mixed.add(&large, DVec3::ZERO, 1.0);
    mixed.add(&small, DVec3::X * 8.0, 1.0);
    let mesh = mixed.mesh();
    let materials: Vec<i32> = (0..mesh.n_faces() as i32).collect();
    let input = Input {
        materials: Some(&materials),
        ..Input::new(&mesh)
    };
    let run = |n| pipeline::remesh(input, &settings(90), &Picky(n), &Progress::none());
    let result = run(small.n_vertices()).unwrap();
    let from = small.n_faces();
    stays(&result, &mesh, from..from + large.n_faces());
    let kept = &result.report.kept;
    assert_eq!((kept.len(), kept[0].part), (1, 1));
    assert_eq!(kinds(&kept[0]), ["failed"]);
    assert!(kept[0].reasons[0].text.ends_with("vertices are too many"));
    // New faces take nothing from what stays, though it is nearest in places.
    let new = &result.materials.unwrap()[..result.mesh.n_faces() - large.n_faces()];
    let of_large = from as i32..(from + large.n_faces()) as i32;
    assert!(new.iter().all(|material| !of_large.contains(material)));
    match run(3) {
        Err(Error::Refused { kept, .. }) => assert_eq!(kept.len(), 3),
        other => panic!("{other:?}"),
    }
}

#[test]
fn seams_that_nearly_close_are_welded_up_to_the_distance() {
    for gap in [0.0, 1e-7, 9e-6, 3e-5] {
        let mesh = split_along(&ball(6), gap);
        let diagonal = mesh.bounds()[0].distance(mesh.bounds()[1]);
        // Halves that are not welded have borders, which this primitive has not.
        let wanted = sphere(100);
        let result = remesh(&mesh, &wanted);
        if gap > 1e-5 {
            let Err(error) = result else {
                panic!("a gap of {gap} was welded");
            };
            assert!(error.to_string().contains("are not welded"), "{error}");
            continue;
        }
        let clean = result.unwrap().report.clean;
        if gap > 0.0 {
            assert!(clean.n_seam_welded >= 24, "{clean:?}");
            let off = (clean.weld_distance / diagonal / gap - 1.0).abs();
            assert!(off < 0.01, "{clean:?}");
            assert!(
                clean.sentences()[0].contains("border points welded"),
                "{clean:?}"
            );
        } else {
            assert_eq!((clean.n_seam_welded, clean.weld_distance), (0, 0.0));
        }
        let off = Settings {
            weld: None,
            ..wanted
        };
        assert_eq!(remesh(&mesh, &off).is_ok(), gap == 0.0);
    }
}

#[test]
fn sizes_out_of_range_are_refused() {
    let mesh = common::polygons(&ball(2));
    for (weld, small_size) in [
        (Some(-1e-9), 0.0),
        (Some(0.02), 0.0),
        (Some(f64::NAN), 0.0),
        (None, -1.0),
        (None, 100.5),
        (None, f64::INFINITY),
    ] {
        let wrong = Settings {
            weld,
            small_size,
            ..settings(50)
        };
        let error = remesh(&mesh, &wrong).unwrap_err();
        assert!(matches!(error, Error::SizeOutOfRange { .. }), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn scraps_come_back_bit_for_bit_and_the_rest_is_done(
        seed: u64, n_scraps in 0..6_usize, exponent in -200..200_i32, shape in 0..3_usize,
    ) {
        let size = 2_f64.powi(exponent);
        let solid = vec![ball(3), cube(3), common::blob(seed, 4)].swap_remove(shape);
        let (mesh, scraps) = Mixed::scattered(&solid, n_scraps, size, seed);
        let wanted = Settings { kind: Kind::Triangles, ..settings(60) };
        let result = remesh(&mesh, &wanted).unwrap();
        stays(&result, &mesh, scraps.iter().copied());
        prop_assert_eq!(result.report.kept.len(), n_scraps);
        prop_assert!(result.report.kept.windows(2).all(|w| w[0].part < w[1].part));
        let made = result.mesh.n_faces() - scraps.len();
        prop_assert!(made.abs_diff(60) <= 2, "{}", made);
        let again = remesh(&mesh, &Settings { threads: 2, ..wanted }).unwrap();
        prop_assert_eq!(&again.mesh, &result.mesh);
        prop_assert_eq!(&again.report.kept, &result.report.kept);
    }
}
