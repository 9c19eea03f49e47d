//! Building a tree of triangles, and closest points on them: far, near, and one beside the other.

use glam::DVec3;
use orbflow_geometry::mesh::TriangleMesh;
use orbflow_geometry::nearest::Bvh;
use orbflow_geometry::random::Random;

#[path = "../tests/common/mod.rs"]
mod shapes;

fn main() {
    divan::main();
}

/// A body with limbs of about this many faces.
fn body(n_faces: usize) -> TriangleMesh {
    shapes::limbs(1, (n_faces as f64 / 12.0).sqrt() as u32)
}

fn triangles(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    mesh.face_ids().map(|face| mesh.triangle(face)).collect()
}

/// Points of the surface in the order of faces, moved away by up to `far`.
fn near(mesh: &TriangleMesh, n: usize, far: f64) -> Vec<DVec3> {
    let mut random = Random::new(1);
    let step = mesh.n_faces() as f64 / n as f64;
    let mut shift = || (random.unit() * 2.0 - 1.0) * far;
    let mut at = |i: usize| {
        let face = mesh
            .face_ids()
            .nth((i as f64 * step) as usize)
            .expect("below the count");
        let [a, b, c] = mesh.triangle(face);
        (a + b + c) / 3.0 + DVec3::new(shift(), shift(), shift())
    };
    (0..n).map(&mut at).collect()
}

#[divan::bench(args = [40_000, 1_000_000], max_time = 5)]
fn build(bencher: divan::Bencher, n_faces: usize) {
    let triangles = triangles(&body(n_faces));
    bencher.bench_local(|| Bvh::new(&triangles));
}

/// The time of 10,000 queries.
#[divan::bench(args = [40_000, 1_000_000], max_time = 3)]
fn closest_near_the_surface(bencher: divan::Bencher, n_faces: usize) {
    let mesh = body(n_faces);
    let tree = Bvh::of_mesh(&mesh);
    let points = near(&mesh, 10_000, 0.05);
    bencher.bench_local(|| {
        points
            .iter()
            .map(|&p| tree.closest(p).distance_squared)
            .sum::<f64>()
    });
}

/// The time of 10,000 queries.
#[divan::bench(args = [40_000, 1_000_000], max_time = 3)]
fn closest_in_any_order(bencher: divan::Bencher, n_faces: usize) {
    let mesh = body(n_faces);
    let tree = Bvh::of_mesh(&mesh);
    let mut points = near(&mesh, 10_000, 0.05);
    let mut random = Random::new(2);
    for i in 0..points.len() {
        points.swap(i, random.below(i + 1));
    }
    bencher.bench_local(|| {
        points
            .iter()
            .map(|&p| tree.closest(p).distance_squared)
            .sum::<f64>()
    });
}

/// The time of 10,000 queries.
#[divan::bench(args = [40_000, 1_000_000], max_time = 3)]
fn closest_with_a_hint(bencher: divan::Bencher, n_faces: usize) {
    let mesh = body(n_faces);
    let tree = Bvh::of_mesh(&mesh);
    let points = near(&mesh, 10_000, 0.05);
    bencher.bench_local(|| {
        let start = (0.0, tree.closest(points[0]).face);
        let add = |(sum, hint), &p: &DVec3| {
            let found = tree.closest_near(p, hint);
            (sum + found.distance_squared, found.face)
        };
        points.iter().fold(start, add)
    });
}

/// The time of 10,000 queries.
#[divan::bench(args = [40_000], max_time = 3)]
fn closest_from_far_away(bencher: divan::Bencher, n_faces: usize) {
    let mesh = body(n_faces);
    let tree = Bvh::of_mesh(&mesh);
    let points = near(&mesh, 10_000, 5.0);
    bencher.bench_local(|| {
        points
            .iter()
            .map(|&p| tree.closest(p).distance_squared)
            .sum::<f64>()
    });
}
