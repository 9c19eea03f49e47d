//! Time of the embedding: the solver alone, and a repair of a proposal that a tenth is noise of.

#[path = "../tests/common/mod.rs"]
mod common;

use divan::Bencher;
use glam::DVec3;
use orbflow_geometry::decimate::collapse_to_tetrahedron;
use orbflow_geometry::embed::{
    OffsetPredictor, PredictError, Proposal, Settings, Solver, embed, even,
};
use orbflow_geometry::hierarchy::CollapseHierarchy;
use orbflow_geometry::mesh::Id;
use orbflow_geometry::progress::Progress;
use orbflow_geometry::random::Random;

fn main() {
    divan::main();
}

/// A body with limbs and about 6 n² vertices.
fn limbs(n: u32) -> CollapseHierarchy {
    collapse_to_tetrahedron(common::limbs(2, n), &Progress::none()).expect("limbs are closed")
}

/// A proposal made beforehand.
struct Given(Proposal);

impl OffsetPredictor for Given {
    fn name(&self) -> &'static str {
        "given"
    }

    fn propose(&self, _: &CollapseHierarchy, _: &Progress) -> Result<Proposal, PredictError> {
        Ok(self.0.clone())
    }
}

/// About 1,000, 10,000, 50,000 and 100,000 vertices.
const SIZES: [u32; 4] = [13, 41, 91, 129];

#[divan::bench(args = SIZES, sample_count = 5)]
fn solver(bencher: Bencher, n: u32) {
    let hierarchy = limbs(n);
    let (settings, progress) = (Settings::default(), Progress::none());
    bencher.bench(|| embed(&hierarchy, &Solver::default(), &settings, &progress));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn even_map(bencher: Bencher, n: u32) {
    let hierarchy = limbs(n);
    bencher.bench(|| even(&hierarchy, &Progress::none()));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn repair(bencher: Bencher, n: u32) {
    let hierarchy = limbs(n);
    let (settings, progress) = (Settings::default(), Progress::none());
    let proposal = Solver::default().propose(&hierarchy, &progress);
    let mut proposal = proposal.expect("limbs have a map");
    let mut random = Random::new(1);
    for v in proposal.sphere.ids().filter(|v| v.index() % 10 == 0) {
        let noise = DVec3::new(random.unit(), random.unit(), random.unit());
        proposal.sphere[v] = noise * 2.0 - 1.0;
    }
    let given = Given(proposal);
    bencher.bench(|| embed(&hierarchy, &given, &settings, &progress));
}
