//! Closes open parts and parts with handles, so that a sphere covers them.

pub mod handles;
