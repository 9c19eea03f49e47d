//! Strips of quads that make up for odd edges.

use super::sheet::Sheet;
use super::{Border, Grafting};
use crate::mesh::VertexId;

/// The same borders with loops that have as many edges as the borders but for an even number, where
/// a strip of quads leads from an odd one to another or to one of which nothing stays.
pub fn evened<'a>(
    _grafting: &mut Grafting,
    _sheet: &mut Sheet,
    pairs: Vec<(&'a Border, Vec<VertexId>)>,
) -> Vec<(&'a Border, Vec<VertexId>)> {
    pairs
}
