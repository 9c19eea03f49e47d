//! Orbflow's graph network: reads the collapse hierarchy of a mesh and proposes points of the sphere
//! for its coarse levels.
//!
//! ```text
//! hierarchy ─ pyramid ─▶ levels, features ─ net ─▶ 500 directions ─▶ embed repairs, grows, proves
//! ```
//!
//! [`NetworkPredictor`] plugs the network into [`embed`](orbflow_geometry::embed), which repairs,
//! grows and relaxes whatever it proposes. Training, on burn, is a crate of its own.

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

pub use predictor::NetworkPredictor;
