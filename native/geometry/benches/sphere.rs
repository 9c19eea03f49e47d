//! Making primitives: fixed ones, turned ones, and triangles that are even on a surface.

use orbflow_geometry::mesh::VertexMap;
use orbflow_geometry::progress::Progress;
use orbflow_geometry::sphere::{
    Adaptive, Settings, SpreadSettings, adaptive, icosphere, icosphere_frequency, quad_sphere,
    quad_sphere_counts, spread,
};
use orbflow_geometry::sphere_map::SphereMap;

#[path = "../tests/common/mod.rs"]
mod shapes;

fn main() {
    divan::main();
}

/// A body with limbs of 19,200 faces on the sphere that it was made from.
fn body() -> SphereMap {
    let sphere = VertexMap::from_vec(shapes::sphere(40).positions().to_vec());
    SphereMap::prove(shapes::limbs(1, 40), sphere).expect("one cube, mapped twice")
}

#[divan::bench(args = [6_000, 400_000], max_time = 5)]
fn adaptive_triangles(bencher: divan::Bencher, n_faces: usize) {
    let map = body();
    let settings = Settings {
        n_faces,
        ..Settings::default()
    };
    bencher.bench(|| -> Adaptive {
        adaptive(&map, &settings, &Progress::none()).expect("there is room")
    });
}

#[divan::bench(args = [2_000, 400_000], max_time = 5)]
fn turned_quad_sphere(bencher: divan::Bencher, n_faces: usize) {
    let map = body();
    let primitive = quad_sphere(quad_sphere_counts(n_faces));
    let settings = SpreadSettings::default();
    bencher.bench(|| spread(&map, &primitive, &settings, &Progress::none()));
}

#[divan::bench(args = [2_000, 400_000], max_time = 5)]
fn fixed_quads(n_faces: usize) -> usize {
    quad_sphere(quad_sphere_counts(n_faces)).n_faces()
}

#[divan::bench(args = [2_000, 400_000], max_time = 5)]
fn fixed_triangles(n_faces: usize) -> usize {
    icosphere(icosphere_frequency(n_faces)).n_faces()
}
