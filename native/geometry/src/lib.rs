//! Orbflow's core.

pub mod clean;
pub mod decimate;
pub mod deform;
pub mod embed;
pub mod hierarchy;
pub mod measure;
pub mod mesh;
pub mod nearest;
pub mod pipeline;
pub mod progress;
pub mod random;
pub mod score;
pub mod sparse;
pub mod sphere;
pub mod sphere_map;
pub mod transfer;

#[cfg(test)]
extern crate self as orbflow_geometry;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod shapes;

#[cfg(test)]
mod tests {
    use crate::shapes;

    #[test]
    fn the_test_shapes_are_closed_and_of_genus_zero() {
        for (name, mesh) in shapes::closed(6) {
            assert!(mesh.is_closed(), "{name}");
            assert_eq!(mesh.euler_number(), 2, "{name}");
            assert_eq!(mesh.n_faces(), 6 * 6 * 6 * 2, "{name}");
        }
    }
}
