//! A training step of the default network on a few and on many shapes, on every engine of this
//! build.

use divan::Bencher;
use orbflow_training::engine::Engine;
use orbflow_training::run::Training;
use orbflow_training::sample::Sample;
use orbflow_training::settings::Settings;
use orbflow_training::shapes::shape;

fn main() {
    divan::main();
}

const ENGINES: &[Engine] = &[
    Engine::Flex,
    #[cfg(feature = "ndarray")]
    Engine::NdArray,
    #[cfg(feature = "wgpu")]
    Engine::Wgpu,
    #[cfg(feature = "cuda")]
    Engine::Cuda,
];

fn cases() -> impl Iterator<Item = (Engine, usize)> {
    let sizes = [6, 48];
    ENGINES
        .iter()
        .flat_map(move |&engine| sizes.map(|n| (engine, n)))
}

#[divan::bench(args = cases(), sample_count = 10)]
fn step(bencher: Bencher, (engine, n): (Engine, usize)) {
    let settings = Settings::default();
    let sample = |seed| Sample::new(String::new(), shape(seed), &settings.sizes.levels);
    let samples = (0..n as u64).map(|seed| sample(seed).expect("made shapes are closed"));
    let samples: Vec<Sample> = samples.collect();
    let samples: Vec<&Sample> = samples.iter().collect();
    let device = engine.open().expect("its device is there");
    let mut training = Training::new(settings, &device);
    // The first step compiles kernels.
    training.learn(&samples, &vec![0; n]);
    bencher.bench_local(|| training.learn(&samples, &vec![0; n]));
}
