//! The collapse hierarchy: a closed mesh of genus 0, recorded on its way down to a tetrahedron.
//!
//! Each half-edge collapse v → u removes the vertex v and keeps u where it is. The record is v and
//! the ring of its neighbours, counter-clockwise and rotated so that `ring[0]` is u. Undoing it
//! replaces the faces (u, `ring[i]`, `ring[i + 1]`) by the fan of v. Records come in rounds of
//! collapses that are independent of each other: no two vertices of a round are neighbours, and no
//! face is touched by two of them, so a round can be undone in any order or at once.
//!
//! `decimate` makes it; predictors read it; `embed` undoes it on the sphere (Praun & Hoppe 2003).

mod builder;

use std::ops::Range;

use thiserror::Error;

use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
pub use builder::HierarchyBuilder;

/// A recorded half-edge collapse, seen from the hierarchy that holds it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Collapse<'a> {
    /// The vertex that was removed.
    pub vertex: VertexId,
    /// Its neighbours at that time, counter-clockwise; the first is the one it collapsed into.
    pub ring: &'a [VertexId],
}

/// A closed mesh of genus 0 and the collapses that lead from it to a tetrahedron.
#[derive(Clone, Debug)]
pub struct CollapseHierarchy {
    mesh: TriangleMesh,
    base: [[VertexId; 3]; 4],
    vertices: Vec<VertexId>,
    starts: Vec<u32>,
    rings: Vec<VertexId>,
    rounds: Vec<u32>,
}

/// Why records do not make a [`CollapseHierarchy`].
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum HierarchyError {
    /// Undoing all collapses does not give the mesh back.
    #[error(
        "undoing {n_collapses} collapses gives {n_faces} faces of which {n_wrong} are not in the mesh of {n_wanted} faces"
    )]
    DoesNotUndo {
        /// How many records there are.
        n_collapses: usize,
        /// How many faces the replay ends with.
        n_faces: usize,
        /// How many of them the mesh does not have.
        n_wrong: usize,
        /// How many faces the mesh has.
        n_wanted: usize,
    },
    /// A ring does not lie around a fan at the time of its undoing.
    #[error("collapse {index} of vertex {vertex} cannot be undone: its ring is not there")]
    RingMissing {
        /// Which record.
        index: usize,
        /// The vertex it removed.
        vertex: VertexId,
    },
    /// A record names a vertex that the mesh does not have, or has too short a ring.
    #[error(
        "collapse {index} names vertex {vertex} with a ring of {n_ring}, in a mesh of {n_vertices} vertices"
    )]
    NoSuchCollapse {
        /// Which record.
        index: usize,
        /// The vertex out of range, or the one with the short ring.
        vertex: VertexId,
        /// How many neighbours the record has.
        n_ring: usize,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// The four faces at the end are no tetrahedron.
    #[error("the coarsest level is no tetrahedron: its faces have {n_corners} different corners")]
    NoTetrahedron {
        /// How many corners there are.
        n_corners: usize,
    },
    /// Two collapses of a round depend on each other.
    #[error("collapse {index} of vertex {vertex} touches another of its round")]
    Dependent {
        /// Which record.
        index: usize,
        /// The vertex it removed.
        vertex: VertexId,
    },
}

impl CollapseHierarchy {
    /// The finest mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// How many vertices the finest mesh has.
    pub fn n_vertices(&self) -> usize {
        self.mesh.n_vertices()
    }

    /// The faces of the tetrahedron at the coarsest level.
    pub fn base(&self) -> [[VertexId; 3]; 4] {
        self.base
    }

    /// How many collapses were recorded: the number of vertices less four.
    pub fn n_collapses(&self) -> usize {
        self.vertices.len()
    }

    /// One collapse, in the order in which they were made: 0 is the first.
    pub fn collapse(&self, index: usize) -> Collapse<'_> {
        let [start, end] = [self.starts[index], self.starts[index + 1]];
        Collapse {
            vertex: self.vertices[index],
            ring: &self.rings[start as usize..end as usize],
        }
    }

    /// The collapses in the order of undoing, coarse to fine.
    pub fn undone(&self) -> impl DoubleEndedIterator<Item = Collapse<'_>> {
        (0..self.n_collapses()).rev().map(|i| self.collapse(i))
    }

    /// How many rounds of independent collapses there are.
    pub fn n_rounds(&self) -> usize {
        self.rounds.len() - 1
    }

    /// The collapses of one round, as a range of indices; round 0 was made first.
    pub fn round(&self, round: usize) -> Range<usize> {
        self.rounds[round] as usize..self.rounds[round + 1] as usize
    }

    /// The vertices from coarse to fine: four of the tetrahedron, then in the order of undoing.
    pub fn coarse_to_fine(&self) -> Vec<VertexId> {
        let [a, b, c] = self.base[0];
        let d = self.base[1..]
            .iter()
            .flatten()
            .copied()
            .find(|v| ![a, b, c].contains(v));
        let mut order = vec![a, b, c, d.expect("a tetrahedron has four vertices")];
        order.extend(self.vertices.iter().rev());
        order
    }

    /// The faces of the level at which `n_vertices` (at least 4) are left.
    ///
    /// # Errors
    /// [`HierarchyError::RingMissing`] when the records contradict each other.
    pub fn faces_at(&self, n_vertices: usize) -> Result<Vec<[VertexId; 3]>, HierarchyError> {
        let n_undone = n_vertices.clamp(4, self.n_vertices()) - 4;
        // The fan of each vertex, as face indices; faces are rewritten in place.
        let mut faces: Vec<[VertexId; 3]> = self.base.to_vec();
        let mut fans: VertexMap<Vec<u32>> = VertexMap::filled(self.n_vertices(), Vec::new());
        for (f, corners) in self.base.iter().enumerate() {
            for &v in corners {
                fans[v].push(f as u32);
            }
        }
        for index in (0..self.n_collapses()).rev().take(n_undone) {
            let Collapse { vertex, ring } = self.collapse(index);
            let missing = HierarchyError::RingMissing { index, vertex };
            let old = ring[0];
            for i in 1..ring.len() - 1 {
                let corners = [old, ring[i], ring[i + 1]];
                let of = |&f: &u32| same_triangle(faces[f as usize], corners);
                let Some(at) = fans[old].iter().position(of) else {
                    return Err(missing);
                };
                let face = fans[old].swap_remove(at);
                faces[face as usize] = [vertex, ring[i], ring[i + 1]];
                fans[vertex].push(face);
            }
            for (a, b) in [(old, ring[1]), (ring[ring.len() - 1], old)] {
                let face = faces.len() as u32;
                faces.push([vertex, a, b]);
                for v in [vertex, a, b] {
                    fans[v].push(face);
                }
            }
        }
        Ok(faces)
    }

    /// Checks that undoing every collapse gives the finest mesh back.
    ///
    /// # Errors
    /// What is contradictory.
    pub fn check(&self) -> Result<(), HierarchyError> {
        let canonical = |face: &[VertexId; 3]| {
            let first = (0..3).min_by_key(|&i| face[i]).unwrap_or(0);
            [0, 1, 2].map(|i| face[(first + i) % 3])
        };
        let replayed = self.faces_at(self.n_vertices())?;
        let wanted: std::collections::HashSet<_> =
            self.mesh.faces().iter().map(canonical).collect();
        let n_wrong = replayed
            .iter()
            .filter(|face| !wanted.contains(&canonical(face)))
            .count();
        if n_wrong == 0 && replayed.len() == wanted.len() {
            return Ok(());
        }
        Err(HierarchyError::DoesNotUndo {
            n_collapses: self.n_collapses(),
            n_faces: replayed.len(),
            n_wrong,
            n_wanted: wanted.len(),
        })
    }

    /// Checks that no two vertices of a round are neighbours when they are removed.
    fn check_rounds(&self) -> Result<(), HierarchyError> {
        let mut round_of = VertexMap::filled(self.n_vertices(), usize::MAX);
        for round in 0..self.n_rounds() {
            for index in self.round(round) {
                round_of[self.vertices[index]] = round;
            }
        }
        for round in 0..self.n_rounds() {
            for index in self.round(round) {
                let Collapse { vertex, ring } = self.collapse(index);
                if ring.iter().any(|&v| round_of[v] == round) {
                    return Err(HierarchyError::Dependent { index, vertex });
                }
            }
        }
        Ok(())
    }
}

/// Whether two triangles have the same corners in the same direction.
fn same_triangle(face: [VertexId; 3], corners: [VertexId; 3]) -> bool {
    (0..3).any(|k| (0..3).all(|i| face[(k + i) % 3] == corners[i]))
}

impl Collapse<'_> {
    /// The vertex that the removed one collapsed into.
    pub fn into_vertex(&self) -> VertexId {
        self.ring[0]
    }

    /// The index of the removed vertex, for arrays of floats.
    pub fn index(&self) -> usize {
        self.vertex.index()
    }
}

#[cfg(test)]
mod tests;
