//! Orbflow's graph network: reads the collapse hierarchy of a mesh and proposes points of the sphere
//! for its coarse levels.
//!
//! ```text
//! hierarchy ─ pyramid ─▶ levels, features ─ net ─▶ 500 directions ─▶ embed repairs, grows, proves
//! ```
//!
//! [`NetworkPredictor`] plugs the network into [`embed`](orbflow_geometry::embed), which repairs,
//! grows and relaxes whatever it proposes; [`AutoPredictor`] asks it where that saves time. Training,
//! on burn, is a crate of its own.

mod auto;
pub mod features;
pub mod frame;
pub mod gated;
mod layers;
pub mod neighbours;
pub mod net;
mod predictor;
pub mod pyramid;
pub mod relaxation;
pub mod weights;

pub use auto::AutoPredictor;
pub use predictor::NetworkPredictor;
