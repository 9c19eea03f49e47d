//! Trains Orbflow's graph network. Not part of the wheel.
//!
//! ```text
//! seeds, files ─ sources ─ prepare ─▶ set ─▶ samples ─ run: batch ─ network ─ loss ─ AdamW ─▶ checkpoint, log, weights
//!                                      └──▶ evaluate ─▶ report
//! ```
//!
//! The network has no targets: its [`loss`] is the distortion of the proposed map. Targets in a set are
//! those of the [`thesis`]. What was tried and what it reached is in `docs/training.md`.

mod checkpoint;
pub mod curve;
pub mod engine;
pub mod evaluate;
mod licence;
pub mod load;
mod log;
pub mod loss;
pub mod net;
mod optimizer;
pub mod parts;
pub mod prepare;
pub mod run;
pub mod sample;
mod schedule;
pub mod set;
pub mod settings;
pub mod shapes;
mod sources;
pub mod thesis;
mod tree;
pub mod whole;
mod zips;
