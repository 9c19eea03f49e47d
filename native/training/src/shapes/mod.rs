//! Endless closed shapes of genus 0 to train on, made from a seed.

mod implicit;
mod march;

use glam::DVec3;
use orbflow_geometry::mesh::TriangleMesh;
use orbflow_geometry::random::Random;

use crate::parts::split;
pub use implicit::Solid;
pub use march::{Surface, march};

/// Points of the grid along a side: a thin rod is still two cells thick.
const GRID: usize = 64;
/// Half of the side of the grid; what reaches beyond is cut off, by `BALL`.
const HALF: f64 = 1.4;
/// The ball that every solid is cut to, so that it stays closed.
const BALL: f64 = 1.3;

/// The shape of a seed: the same for ever. Its largest part of genus 0 is taken.
pub fn shape(seed: u64) -> TriangleMesh {
    let mut random = Random::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    loop {
        let solid = Solid::random(&mut random);
        let cut = |p: DVec3| solid.at(p).max(p.length() - BALL);
        let Surface { positions, faces } = march(cut, HALF, GRID);
        let Ok(mesh) = TriangleMesh::new(positions, faces) else {
            continue;
        };
        let parts = split(&mesh).usable;
        let largest = parts.into_iter().max_by_key(TriangleMesh::n_faces);
        if let Some(part) = largest.filter(|part| part.n_faces() >= 1_000) {
            return part;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_closed_different_and_repeatable() {
        let shapes: Vec<TriangleMesh> = (0..6).map(shape).collect();
        for (seed, mesh) in shapes.iter().enumerate() {
            assert!(mesh.is_closed() && mesh.euler_number() == 2, "{seed}");
        }
        assert_ne!(shapes[0].n_faces(), shapes[1].n_faces());
        assert_eq!(shape(3), shapes[3]);
    }
}
