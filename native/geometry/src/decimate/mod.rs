//! Fewer faces: down to a tetrahedron with a record of every step, or down to a number.
//!
//! [`collapse_to_tetrahedron`] removes the vertices of a closed mesh of genus 0 by half-edge
//! collapses, which keep their goal in place, until four are left; `embed` undoes the record on the
//! sphere (Praun & Hoppe 2003). Which collapse comes first is a matter of quadrics, lengths and
//! angles; whether it may come is a matter of topology alone, so that every such mesh gets down,
//! whatever its shape.
//!
//! [`simplify`] collapses edges into the place of least quadric error (Garland & Heckbert 1997)
//! until a number of faces is left, for meshes of any genus with or without border.
//!
//! Both work in rounds. A round takes the cheapest collapses that do not touch each other, so that
//! costs can be computed in parallel, and the result does not depend on the number of threads.

mod fan;
mod frame;
mod merge;
mod quadric;
mod rings;
mod rounds;
mod simplify;
mod tetrahedron;

pub use simplify::{Error, Report, Settings, Simplified, simplify};
pub use tetrahedron::{CollapseError, collapse_to_tetrahedron};
