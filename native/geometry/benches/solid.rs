//! Making shells one closed surface: balls that intersect, on coarse and on fine grids.

use glam::DVec3;
use orbflow_geometry::mesh::{TriangleMesh, VertexId};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::solid::{Settings, Shells, Winding, solidify};
use orbflow_geometry::sphere::icosphere;

fn main() {
    divan::main();
}

/// Balls in a row, each a third of its width from the next.
fn balls(n: u32) -> TriangleMesh {
    let ball = icosphere(24);
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for i in 0..n {
        let first = positions.len() as u32;
        let by = DVec3::X * (f64::from(i) * 2.0 / 3.0);
        positions.extend(ball.positions().iter().map(|&p| p + by));
        let named = |face: &[VertexId]| [0, 1, 2].map(|k| VertexId(face[k].0 + first));
        faces.extend(ball.faces().map(named));
    }
    TriangleMesh::new(positions, faces).expect("balls are surfaces")
}

#[divan::bench(args = [0.04, 0.02, 0.01])]
fn solid(bencher: divan::Bencher, cell: f64) {
    let surfaces = balls(15);
    let shells = Shells {
        surfaces: &surfaces,
        loose: &[],
        lines: &[],
    };
    bencher.bench(|| solidify(&shells, &Settings { cell }, &Progress::none()));
}

#[divan::bench]
fn winding(bencher: divan::Bencher) {
    let mesh = balls(15);
    let triangles: Vec<_> = mesh.face_ids().map(|face| mesh.triangle(face)).collect();
    let winding = Winding::new(&triangles);
    bencher.bench(|| winding.number(DVec3::new(1.3, 1.2, 0.1)));
}
