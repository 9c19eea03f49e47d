//! A training step of six shapes and the default network, on every engine of this build.

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

#[divan::bench(args = ENGINES.iter().copied(), sample_count = 20)]
fn step(bencher: Bencher, engine: Engine) {
    let settings = Settings::default();
    let n = settings.batch;
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
