//! Points where surfaces touch.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::SharedLine;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};

/// A vertex of the input at which several fans of faces meet, each with a vertex of its own now.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SharedPoint {
    /// The input's vertex.
    pub vertex: VertexId,
    /// The component and the vertex of each fan in the mesh taken apart.
    pub fans: Vec<Fan>,
}

/// A fan of faces at a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Fan {
    /// The component of the mesh taken apart.
    pub sheet: usize,
    /// Its vertex.
    pub vertex: VertexId,
}

/// The vertices of the input that have become several, but for those inside lines.
pub(in super::super) fn points(
    (mesh, origin, place): (
        &TriangleMesh,
        &VertexMap<VertexId>,
        impl Fn(VertexId) -> DVec3,
    ),
    lines: [&[SharedLine]; 2],
) -> Vec<SharedPoint> {
    // Centres of polygons and middles of edges lie elsewhere.
    let is_there = |&(v, of): &(VertexId, &VertexId)| mesh.position(v) == place(*of);
    let mut names: Vec<(VertexId, VertexId)> = origin
        .iter_ids()
        .filter(is_there)
        .map(|(v, &of)| (of, v))
        .collect();
    names.sort_unstable();
    let copies = names.chunk_by(|a, b| a.0 == b.0);
    let copies: BTreeMap<VertexId, Vec<VertexId>> = copies
        .filter(|run| run.len() > 1)
        .map(|run| (run[0].0, run.iter().map(|&(_, v)| v).collect()))
        .collect();
    if copies.is_empty() {
        return Vec::new();
    }
    let lines = lines.into_iter().flatten();
    let inside: BTreeSet<VertexId> = lines.flat_map(SharedLine::inner).copied().collect();
    let component = mesh.face_components().0;
    let fan = |vertex: VertexId| {
        let face = mesh.outgoing(vertex).next().map(HalfedgeId::face)?;
        let sheet = component[face.index()] as usize;
        Some(Fan { sheet, vertex })
    };
    let copies = copies.into_iter().filter(|(v, _)| !inside.contains(v));
    copies
        .map(|(vertex, of_one)| SharedPoint {
            vertex,
            fans: of_one.into_iter().filter_map(fan).collect(),
        })
        .collect()
}

impl SharedLine {
    /// Its vertices but for its ends.
    fn inner(&self) -> &[VertexId] {
        if self.is_closed {
            &self.vertices
        } else {
            &self.vertices[1..self.vertices.len() - 1]
        }
    }
}
