//! The thesis's pipeline: it can learn a shape by heart, and what it says is measured as ours is.

use orbflow_geometry::progress::Progress;
use orbflow_training::evaluate::rebuilt::Rebuilt;
use orbflow_training::sample::{Sample, training_level};
use orbflow_training::shapes::shape;
use orbflow_training::thesis::chamfer;
use orbflow_training::thesis::target::ThesisError;
use orbflow_training::thesis::{Example, Settings, Thesis};

#[test]
fn training_brings_one_shape_nearer_to_its_target() {
    let hierarchy = training_level(shape(5), 2_000).unwrap();
    let sample = Sample::of("shape 5".to_owned(), &hierarchy, &[500, 100]).unwrap();
    let example = Example::new(&sample, &hierarchy).unwrap();
    let settings = Settings {
        width: 24,
        n_steps: 300,
        rate: 5e-3,
        dropout: 0.0,
        chamfer: chamfer::Settings {
            n_steps: 100,
            ..chamfer::Settings::default()
        },
        ..Settings::default()
    };
    let trained = |n_steps| {
        let settings = Settings {
            n_steps,
            ..settings.clone()
        };
        Thesis::trained(std::slice::from_ref(&example), settings, &Progress::none()).unwrap()
    };
    let vertices = sample.mesh.positions();
    let untrained = trained(0);
    let target = untrained.target(&example, vertices).unwrap();
    let away = |thesis: &Thesis| {
        let found = thesis.predicted(&example, vertices).surface;
        let corners = found.iter().flatten().zip(target.surface.iter().flatten());
        corners.map(|(p, q)| p.distance(*q)).sum::<f64>()
    };
    let (before, after) = (away(&untrained), away(&trained(300)));
    // Slowly: the numbers of the mesh say nothing of those of the sphere.
    assert!(after < 0.75 * before, "{before} to {after}");
    // The targets lie on the shape, in the frame of the sample, at least mostly.
    let rebuilt = Rebuilt::of(&target.surface, &sample.mesh);
    assert!(rebuilt.precision_pct[1] > 30.0, "{rebuilt:?}");
    let quality = sample.quality(&target.directions);
    assert!(quality.folds_pct < 50.0, "{quality:?}");
}

#[test]
fn a_level_with_too_few_vertices_is_refused() {
    let hierarchy = training_level(shape(5), 400).unwrap();
    let sample = Sample::of(String::new(), &hierarchy, &[150, 50]).unwrap();
    let refused = Example::new(&sample, &hierarchy).err().unwrap();
    assert_eq!(refused, ThesisError::Small { found: 202 });
}
