//! What quads have to heed besides the shape.

use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, VertexMap};
use crate::mirror::Doubled;

/// What of a surface's triangles the quads have to heed besides the shape.
#[derive(Clone, Copy, Debug)]
pub struct Guides<'a> {
    /// Edges that are lines whatever their angle, on both sides of each.
    pub lines: &'a HalfedgeMap<bool>,
    /// Those of them that somebody marked: they stay lines where sharp edges are not clear.
    pub marked: &'a HalfedgeMap<bool>,
    /// Those of them that have to be met, such as borders: closed lines, or ones that end in others.
    pub firm: Option<&'a FirmEdges>,
    /// Those of the lines that somebody drew where the surface has no edge: chords may lie on both
    /// sides of them.
    pub drawn: Option<&'a HalfedgeMap<bool>>,
    /// Edges that are no lines, and the field turns along.
    pub turned: Option<&'a HalfedgeMap<bool>>,
    /// That the surface is its own image in a plane, and the quads shall be.
    pub mirror: Option<&'a Doubled>,
}

/// Edges along which quads have to lie.
#[derive(Clone, PartialEq, Debug)]
pub struct FirmEdges {
    /// Which edges they are, on both sides of each.
    pub is_on: HalfedgeMap<bool>,
    /// Where two of them make a corner of quads.
    pub is_corner: VertexMap<bool>,
    /// Loops of them, two and two, along which as many quads shall lie.
    pub twins: Vec<[Vec<HalfedgeId>; 2]>,
    /// What of the surface counts, where they part it from what does not.
    pub real: Option<Real>,
    /// Whether lines of them may end anywhere, as strokes do.
    pub may_end: bool,
}

/// What of a surface counts when quads are counted.
#[derive(Clone, PartialEq, Debug)]
pub struct Real {
    /// Which of its faces.
    pub is_real: FaceMap<bool>,
    /// How many quads are wanted there.
    pub n_quads: usize,
}
