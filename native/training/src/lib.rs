//! Trains Orbflow's graph network. Not part of the wheel.
//!
//! ```text
//! shapes, files ─ collect ─▶ samples ─ run: batch ─ network ─ loss ─ AdamW ─▶ checkpoint, log, weights
//! ```
//!
//! There are no targets: the [`loss`] is the distortion of the proposed map. What was tried and
//! what it reached is in `docs/training.md`.

pub mod collect;
pub mod evaluate;
pub mod loss;
pub mod net;
pub mod parts;
pub mod run;
pub mod sample;
mod schedule;
pub mod shapes;
