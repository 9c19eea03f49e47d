//! Collects the records of a hierarchy.

use std::collections::BTreeSet;

use super::{CollapseHierarchy, HierarchyError};
use crate::mesh::{Id, TriangleMesh, VertexId};

/// Collects collapses in the order in which they are made.
#[derive(Clone, Debug, Default)]
pub struct HierarchyBuilder {
    pub(super) vertices: Vec<VertexId>,
    pub(super) starts: Vec<u32>,
    pub(super) rings: Vec<VertexId>,
    pub(super) rounds: Vec<u32>,
}

impl HierarchyBuilder {
    /// An empty record.
    pub fn new() -> Self {
        Self {
            starts: vec![0],
            rounds: vec![0],
            ..Self::default()
        }
    }

    /// Records the collapse of `vertex` into `ring[0]`.
    pub fn push(&mut self, vertex: VertexId, ring: &[VertexId]) {
        self.vertices.push(vertex);
        self.rings.extend_from_slice(ring);
        self.starts.push(self.rings.len() as u32);
    }

    /// Ends a round of independent collapses; an empty round is not kept.
    pub fn end_round(&mut self) {
        let n = self.vertices.len() as u32;
        if self.rounds.last() != Some(&n) {
            self.rounds.push(n);
        }
    }

    /// Joins the records with the mesh that they start from and the tetrahedron that they end in.
    ///
    /// # Errors
    /// In debug builds, when undoing the records does not give the mesh back.
    pub fn build(
        mut self,
        mesh: TriangleMesh,
        base: [[VertexId; 3]; 4],
    ) -> Result<CollapseHierarchy, HierarchyError> {
        self.end_round();
        let Self {
            vertices,
            starts,
            rings,
            rounds,
        } = self;
        let hierarchy = CollapseHierarchy {
            mesh,
            base,
            vertices,
            starts,
            rings,
            rounds,
        };
        #[cfg(debug_assertions)]
        hierarchy.check()?;
        Ok(hierarchy)
    }

    /// The same for records that are not our own: everything is checked, in release builds too.
    ///
    /// # Errors
    /// The first record that cannot be.
    pub fn build_checked(
        self,
        mesh: TriangleMesh,
        base: [[VertexId; 3]; 4],
    ) -> Result<CollapseHierarchy, HierarchyError> {
        let n_vertices = mesh.n_vertices();
        check_base(&base, n_vertices)?;
        for (index, &vertex) in self.vertices.iter().enumerate() {
            let ring = &self.rings[self.starts[index] as usize..self.starts[index + 1] as usize];
            let n_ring = ring.len();
            let all = ring.iter().chain([&vertex]);
            let wrong = all.copied().find(|v| v.index() >= n_vertices);
            if let Some(vertex) = wrong.or((n_ring < 3).then_some(vertex)) {
                return Err(HierarchyError::NoSuchCollapse {
                    index,
                    vertex,
                    n_ring,
                    n_vertices,
                });
            }
        }
        let hierarchy = self.build(mesh, base)?;
        hierarchy.check()?;
        hierarchy.check_rounds()?;
        Ok(hierarchy)
    }
}

fn check_base(base: &[[VertexId; 3]; 4], n_vertices: usize) -> Result<(), HierarchyError> {
    let corners: BTreeSet<VertexId> = base.iter().flatten().copied().collect();
    let n_corners = corners.len();
    let is_there = corners.iter().all(|v| v.index() < n_vertices);
    let of_face = |face: &[VertexId; 3]| face.iter().collect::<BTreeSet<_>>().len();
    if n_corners == 4 && is_there && base.iter().all(|face| of_face(face) == 3) {
        return Ok(());
    }
    Err(HierarchyError::NoTetrahedron { n_corners })
}
