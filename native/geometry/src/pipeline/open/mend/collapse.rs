//! Takes one quad out: two of its opposite corners become one.

use glam::DVec3;

use super::{around, beside};
use crate::measure::PolygonEdges;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// The corners of quads and what hangs on them.
pub struct Corners<'a> {
    mesh: &'a PolygonMesh,
    around: Vec<Vec<FaceId>>,
    is_border: Vec<bool>,
    is_corner: &'a dyn Fn(DVec3) -> bool,
}

/// Two opposite corners: the first stays.
#[derive(Clone, Copy)]
pub struct Way {
    stays: VertexId,
    goes: VertexId,
}

impl<'a> Corners<'a> {
    pub fn new(
        mesh: &'a PolygonMesh,
        is_corner: &'a dyn Fn(DVec3) -> bool,
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let edges = PolygonEdges::new(mesh, progress)?;
        Ok(Self {
            around: around(mesh),
            is_border: edges.border_vertices(mesh.n_vertices()),
            mesh,
            is_corner,
        })
    }

    /// The ways in which a quad can go so that the surface stays one.
    pub fn ways(&self, face: FaceId) -> Vec<Way> {
        let Ok([a, b, c, d]) = <[VertexId; 4]>::try_from(self.mesh.face(face)) else {
            return Vec::new();
        };
        let diagonals = [([a, c], [b, d]), ([b, d], [a, c])];
        let can =
            |(joined, others): &([VertexId; 2], [VertexId; 2])| self.can(face, *joined, *others);
        let way = |([a, b], _): ([VertexId; 2], _)| {
            let [stays, goes] = if self.is_border[b.index()] {
                [b, a]
            } else {
                [a, b]
            };
            Way { stays, goes }
        };
        diagonals.into_iter().filter(can).map(way).collect()
    }

    fn can(&self, face: FaceId, joined: [VertexId; 2], others: [VertexId; 2]) -> bool {
        let [a, b] = joined;
        let has_room = |v: VertexId| {
            let least = match self.is_border[v.index()] {
                true if (self.is_corner)(self.mesh.position(v)) => 1,
                true => 2,
                false => 3,
            };
            self.around[v.index()].len() > least
        };
        let around = |v: VertexId| self.around[v.index()].iter();
        let is_shared = around(a).any(|&f| f != face && self.around[b.index()].contains(&f));
        let ends = |v: VertexId| -> Vec<VertexId> {
            let beside = around(v).filter_map(|&f| beside(self.mesh.face(f), v));
            beside.flatten().collect()
        };
        let of_b = ends(b);
        let mut common = ends(a).into_iter().filter(|v| of_b.contains(v));
        let both = self.is_border[a.index()] && self.is_border[b.index()];
        !both
            && !is_shared
            && others.iter().all(|&v| has_room(v))
            && common.all(|v| others.contains(&v))
    }

    /// The mesh without a quad, and what became of each vertex.
    pub fn collapsed(
        &self,
        gone: FaceId,
        Way { stays, goes }: Way,
    ) -> (PolygonMesh, VertexMap<VertexId>) {
        let mesh = self.mesh;
        let name = |v: VertexId| match v {
            v if v == goes => stays,
            v => v,
        };
        let moved = |v: VertexId| VertexId(v.0 - u32::from(v > goes));
        let ids = (0..mesh.n_vertices()).map(VertexId::from_index);
        let names: VertexMap<VertexId> = ids.map(|v| moved(name(v))).collect();
        let faces = mesh.face_ids().filter(|&face| face != gone);
        let faces: Vec<Vec<u32>> = faces
            .map(|face| mesh.face(face).iter().map(|&v| names[v].0).collect())
            .collect();
        let mut positions = mesh.positions().to_vec();
        if !self.is_border[stays.index()] {
            positions[stays.index()] = mesh.position(stays).midpoint(mesh.position(goes));
        }
        positions.remove(goes.index());
        let mesh = PolygonMesh::from_faces(positions, &faces);
        (mesh.expect("fewer faces of a mesh are one"), names)
    }
}
