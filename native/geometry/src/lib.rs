//! Orbflow's core.

pub mod hierarchy;
pub mod mesh;
pub mod progress;
pub mod sphere_map;
