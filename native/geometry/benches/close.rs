//! Closing borders: one long loop, and the double of a sheet.

use glam::DVec3;
use orbflow_geometry::close::{Settings, Way, close};
use orbflow_geometry::elementary::direction;
use orbflow_geometry::mesh::{TriangleMesh, VertexId};
use orbflow_geometry::progress::Progress;

fn main() {
    divan::main();
}

/// A cone whose border has so many edges.
fn cone(n: u32) -> TriangleMesh {
    let angle = |i: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    let rim = (0..n).map(|i| direction(angle(i)).extend(0.0));
    let faces = (0..n).map(|i| [i, (i + 1) % n, n].map(VertexId)).collect();
    let positions = rim.chain([DVec3::NEG_Z * 9.0]).collect();
    TriangleMesh::new(positions, faces).expect("a cone is a surface")
}

#[divan::bench(args = [100, 2_000, 10_000])]
fn cap(bencher: divan::Bencher, n: u32) {
    run(bencher, n, Way::Cap);
}

#[divan::bench(args = [10_000])]
fn double(bencher: divan::Bencher, n: u32) {
    run(bencher, n, Way::Double);
}

fn run(bencher: divan::Bencher, n: u32, way: Way) {
    let mesh = cone(n);
    let settings = Settings {
        way,
        ..Settings::default()
    };
    bencher.bench(|| close(&mesh, &settings, &Progress::none()));
}
