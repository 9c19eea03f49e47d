//! Rods of known shapes.
