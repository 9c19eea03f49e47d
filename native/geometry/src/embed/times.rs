//! What the stages of an embedding cost.

use std::time::Instant;

use serde::Serialize;

/// Time that passed in each stage, in milliseconds: the collapse and the proof are not in it.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Times {
    /// The proposal; the solver's is its whole growth.
    pub propose_ms: f64,
    /// Mending it, or making the solver's map where it was given up.
    pub repair_ms: f64,
    /// Growing the vertices that were not proposed, and the sweeps that finish the map.
    pub relax_ms: f64,
}

/// Runs something and adds the time that passed.
pub fn timed<T>(sum_ms: &mut f64, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let value = run();
    *sum_ms += start.elapsed().as_secs_f64() * 1e3;
    value
}
