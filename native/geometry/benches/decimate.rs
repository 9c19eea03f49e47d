//! Both decimations of a body with limbs: down to a tetrahedron, and to a number of faces.

use orbflow_geometry::decimate::{Settings, collapse_to_tetrahedron, simplify};
use orbflow_geometry::mesh::TriangleMesh;
use orbflow_geometry::progress::Progress;

#[path = "../tests/common/mod.rs"]
mod shapes;

fn main() {
    divan::main();
}

/// A body with limbs of about this many vertices.
fn body(n_vertices: usize) -> TriangleMesh {
    shapes::limbs(1, (n_vertices as f64 / 6.0).sqrt() as u32)
}

#[divan::bench(args = [10_000, 50_000, 100_000], max_time = 5)]
fn to_a_tetrahedron(bencher: divan::Bencher, n_vertices: usize) {
    let mesh = body(n_vertices);
    bencher
        .with_inputs(|| mesh.clone())
        .bench_values(|mesh| collapse_to_tetrahedron(mesh, &Progress::none()));
}

#[divan::bench(args = [50_000, 500_000], max_time = 10)]
fn to_20_000_faces(bencher: divan::Bencher, n_vertices: usize) {
    let mesh = body(n_vertices);
    let settings = Settings { n_faces: 20_000 };
    bencher.bench(|| simplify(&mesh, &settings, &Progress::none()));
}
