//! Spheres deformed into a body with limbs, and the preparation of the target.

#[path = "../tests/common/mod.rs"]
mod shapes;

use orbflow_geometry::progress::Progress;
use orbflow_geometry::{decimate, deform, embed, sphere};

fn main() {
    divan::main();
}

#[divan::bench(args = [8, 40])]
fn target(bencher: divan::Bencher, n: u32) {
    let mesh = shapes::limbs(1, n);
    bencher.bench(|| deform::Target::new(mesh.clone(), &Progress::none()).expect("not cancelled"));
}

#[divan::bench(args = [2_000, 6_000])]
fn quads(bencher: divan::Bencher, n_faces: usize) {
    let quiet = Progress::none();
    let mesh = shapes::limbs(1, 26);
    let hierarchy =
        decimate::collapse_to_tetrahedron(mesh.clone(), &quiet).expect("closed, genus 0");
    let solver = embed::Solver::default();
    let embedded = embed::embed(&hierarchy, &solver, &embed::Settings::default(), &quiet);
    let map = embedded.expect("the solver embeds it").map;
    let target = deform::Target::new(mesh, &quiet).expect("not cancelled");
    let primitive = sphere::quad_sphere(sphere::quad_sphere_counts(n_faces));
    let settings = deform::Settings::default();
    bencher.bench(|| {
        deform::deform(&map, &primitive, &target, &settings, &quiet).expect("a sphere of quads")
    });
}
