//! The mesh while its borders are closed, one after the other.

use std::collections::HashSet;
use std::ops::Range;

use glam::DVec3;

use super::frame::Frame;
use super::membrane::refine;
use super::patch::Patch;
use super::split::key;
use super::start;
use super::tube::Tubes;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// No place in a loop.
const NONE: u32 = u32::MAX;

/// The mesh that was given and what has been added to it.
pub struct Sheet<'a> {
    pub mesh: &'a TriangleMesh,
    pub positions: Vec<DVec3>,
    pub faces: Vec<[VertexId; 3]>,
    /// How many faces are real: those that were given and those that fill borders for good.
    pub n_real: usize,
    /// Which faces are tubes between loops and their caps.
    pub tubes: Vec<Range<usize>>,
    /// The place of each vertex in the loop that is being closed.
    places: VertexMap<u32>,
}

impl<'a> Sheet<'a> {
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        Self {
            mesh,
            positions: mesh.positions().to_vec(),
            faces: mesh.faces().to_vec(),
            n_real: mesh.n_faces(),
            tubes: Vec::new(),
            places: VertexMap::filled(mesh.n_vertices(), NONE),
        }
    }

    /// Where a halfedge of the mesh starts and ends.
    pub fn ends(&self, h: HalfedgeId) -> [VertexId; 2] {
        [self.mesh.origin(h), self.mesh.target(h)]
    }

    /// Closes a loop by a membrane, at the end of a tube where it gets one.
    pub fn cap(
        &mut self,
        border: &[HalfedgeId],
        tubes: &Tubes,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        // The faces beyond an edge run through it the other way.
        let ring = border.iter().rev().map(|&h| self.mesh.origin(h));
        let ring: Vec<VertexId> = ring.collect();
        let chords = self.chords(&ring);
        let end = self.end_of_tube(&ring, tubes);
        let is_flush = end.is_none();
        let (ring, chords) = match end {
            Some(end) => (end, HashSet::new()),
            None => (ring, chords),
        };
        let points: Vec<DVec3> = ring.iter().map(|v| self.positions[v.index()]).collect();
        let frame = Frame::of(&points);
        let points: Vec<DVec3> = points.into_iter().map(|p| frame.inside(p)).collect();
        progress.check()?;
        let mut patch = Patch::new(&points, &start::triangles(&points), chords);
        if self.mesh.n_faces() == 1 && is_flush {
            let [a, b, c] = [0, 1, 2].map(|i| points[i]);
            patch.split_face(0, (a + b + c) / 3.0);
        }
        refine(&mut patch, progress)?;
        let first = self.positions.len();
        let inner = patch.inner().map(|v| frame.outside(patch.positions[v]));
        self.positions.extend(inner);
        let name = |v: VertexId| match ring.get(v.index()) {
            Some(&of_ring) => of_ring,
            None => VertexId::from_index(first + v.index() - ring.len()),
        };
        self.faces.extend(patch.faces().map(|face| face.map(name)));
        Ok(())
    }

    /// The pairs of places in a loop that an inner edge of the mesh joins.
    fn chords(&mut self, ring: &[VertexId]) -> HashSet<[VertexId; 2]> {
        for (place, &v) in ring.iter().enumerate() {
            self.places[v] = place as u32;
        }
        let mut chords = HashSet::new();
        for &v in ring {
            for h in self
                .mesh
                .outgoing(v)
                .filter(|&h| self.mesh.twin(h).is_some())
            {
                let [a, b] = self.ends(h).map(|v| self.places[v]);
                if b != NONE {
                    chords.insert(key(VertexId(a), VertexId(b)));
                }
            }
        }
        for &v in ring {
            self.places[v] = NONE;
        }
        chords
    }
}

#[cfg(test)]
mod tests;
