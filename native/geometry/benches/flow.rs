//! Passes of the flow of a body with limbs: field, metric, rounding, search, reading, fit.

#[path = "../tests/common/mod.rs"]
mod shapes;

use divan::Bencher;
use glam::DVec2;
use orbflow_geometry::flow::complex::Complex;
use orbflow_geometry::flow::covariance::Dense;
use orbflow_geometry::flow::drag::State;
use orbflow_geometry::flow::field::{self, OrientationField};
use orbflow_geometry::flow::place::place;
use orbflow_geometry::flow::rounding::Rounding;
use orbflow_geometry::flow::search::{Quantised, quantise};
use orbflow_geometry::flow::singularities::tidy;
use orbflow_geometry::flow::{Settings, cones, conformal, grid, periods, sizes, wish};
use orbflow_geometry::mesh::{FaceMap, HalfedgeMap, TriangleMesh, VertexMap};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::sphere_map::SphereMap;
use orbflow_geometry::{decimate, embed};

fn main() {
    divan::main();
}

/// So many quads are wanted.
const SIZES: [usize; 2] = [2_000, 8_000];

/// About 8,000 triangles.
fn body() -> TriangleMesh {
    shapes::limbs(1, 26)
}

fn sizes(mesh: &TriangleMesh, n_quads: usize) -> FaceMap<f64> {
    let settings = Settings::new(n_quads).sizes;
    sizes::sizes(mesh, n_quads, &settings, &Progress::none()).expect("a body has sizes")
}

fn dressed(mesh: &TriangleMesh, n_quads: usize) -> OrientationField {
    let (settings, quiet) = (Settings::new(n_quads), Progress::none());
    let mut field = field::orient(mesh, &settings.field, &quiet).expect("a sphere has a field");
    tidy(mesh, &mut field, &sizes(mesh, n_quads));
    field::settle(mesh, &mut field, &settings.field, &quiet).expect("not cancelled");
    field
}

fn wished(mesh: &TriangleMesh, field: &OrientationField, n_quads: usize) -> HalfedgeMap<DVec2> {
    let sizes = sizes(mesh, n_quads);
    wish::wish(mesh, field, &sizes, &Progress::none()).expect("a field has a wish")
}

fn reduced(mesh: &TriangleMesh, n_quads: usize) -> Complex {
    let field = dressed(mesh, n_quads);
    let wish = wished(mesh, &field, n_quads);
    flat(mesh, &field, wish)
}

fn flat(mesh: &TriangleMesh, field: &OrientationField, wish: HalfedgeMap<DVec2>) -> Complex {
    let quiet = Progress::none();
    let complex =
        conformal::flatten(mesh, field, wish, &[], &quiet).expect("cones add up to a sphere");
    let none = VertexMap::filled(mesh.n_vertices(), false);
    cones::keep_cones(complex, &none, &quiet).expect("not cancelled")
}

fn whole(mesh: &TriangleMesh, n_quads: usize) -> Quantised {
    let (complex, settings) = (reduced(mesh, n_quads), Settings::new(n_quads).search);
    quantise(complex, n_quads, &settings, &Progress::none()).expect("some rounding is reached")
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn field_and_its_tidying(bencher: Bencher, n_quads: usize) {
    let mesh = body();
    bencher.bench(|| dressed(&mesh, n_quads));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn wish_and_metric(bencher: Bencher, n_quads: usize) {
    let mesh = body();
    let field = dressed(&mesh, n_quads);
    bencher.bench(|| flat(&mesh, &field, wished(&mesh, &field, n_quads)));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn one_rounding(bencher: Bencher, n_quads: usize) {
    let mut complex = reduced(&body(), n_quads);
    let basis = periods::choose(&mut complex).expect("a sphere has free periods");
    let start = State::new(&complex, basis.start);
    let covariance = Dense::energy(&complex).inverse();
    bencher.bench(|| {
        Rounding::new(start.clone(), basis.wish.clone(), covariance.clone())
            .round()
            .expect("it is reached")
    });
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn search(bencher: Bencher, n_quads: usize) {
    let complex = reduced(&body(), n_quads);
    let settings = Settings::new(n_quads).search;
    let run = |complex| quantise(complex, n_quads, &settings, &Progress::none());
    bencher
        .with_inputs(|| complex.clone())
        .bench_values(|complex| run(complex).expect("some rounding is reached"));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn reading(bencher: Bencher, n_quads: usize) {
    let whole = whole(&body(), n_quads);
    bencher.bench(|| grid::read(&whole.complex).expect("its periods are whole"));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn fit(bencher: Bencher, n_quads: usize) {
    let map = embedded(body());
    let grid = whole(map.mesh(), n_quads).grid;
    let quads = (grid.n_vertices, &grid.quads[..]);
    bencher
        .bench(|| place(&map, quads, &grid.cells, &[], &Progress::none()).expect("it is solvable"));
}

fn embedded(mesh: TriangleMesh) -> SphereMap {
    let quiet = Progress::none();
    let hierarchy = decimate::collapse_to_tetrahedron(mesh, &quiet).expect("closed, genus 0");
    let (solver, settings) = (embed::Solver::default(), embed::Settings::default());
    let embedded = embed::embed(&hierarchy, &solver, &settings, &quiet);
    embedded.expect("the solver embeds it").map
}
