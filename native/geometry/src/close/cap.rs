//! The mesh while its borders are closed, one after the other.

use std::collections::HashSet;
use std::ops::Range;

use glam::DVec3;

use super::frame::Frame;
use super::membrane::refine;
use super::patch::Patch;
use super::split::key;
use super::start;
use crate::measure::area_vector;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// A loop has a tube if its area is no less than this share of the square of its length: a circle has
/// 0.16, a slit none.
const LEAST_OPEN: f64 = 0.01;
/// How often the ways of a tube are smoothed along its loop.
const N_SMOOTHINGS: usize = 3;
/// A tube has this many rows of faces at most.
const MOST_ROWS: usize = 8;

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

    /// Closes a loop by a membrane, at the end of a tube of some length.
    pub fn cap(
        &mut self,
        (border, tube): (&[HalfedgeId], f64),
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        // The faces beyond an edge run through it the other way.
        let ring = border.iter().rev().map(|&h| self.mesh.origin(h));
        let ring: Vec<VertexId> = ring.collect();
        let chords = self.chords(&ring);
        let (ring, chords) = match self.end_of_tube(&ring, tube) {
            Some(end) => (end, HashSet::new()),
            None => (ring, chords),
        };
        let points: Vec<DVec3> = ring.iter().map(|v| self.positions[v.index()]).collect();
        let frame = Frame::of(&points);
        let points: Vec<DVec3> = points.into_iter().map(|p| frame.inside(p)).collect();
        progress.check()?;
        let mut patch = Patch::new(&points, &start::triangles(&points), chords);
        if self.mesh.n_faces() == 1 && tube == 0.0 {
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

    /// Adds a tube that goes on from a loop across it, and returns its other end; none where it has no
    /// length or the loop encloses nothing.
    fn end_of_tube(&mut self, ring: &[VertexId], length: f64) -> Option<Vec<VertexId>> {
        let points: Vec<DVec3> = ring.iter().map(|v| self.positions[v.index()]).collect();
        let next = |i: usize| (i + 1) % points.len();
        let round: f64 = (0..points.len())
            .map(|i| points[i].distance(points[next(i)]))
            .sum();
        if length <= 0.0 {
            return None;
        }
        let ways = self.ways_across(ring, &points)?;
        let rows = length * points.len() as f64 / round;
        let n_rows = (rows.round() as usize).clamp(1, MOST_ROWS);
        let step = length / n_rows as f64;
        let first = self.faces.len();
        let mut last = ring.to_vec();
        for row in 1..=n_rows {
            let start = self.positions.len();
            let moved = points.iter().zip(&ways);
            let moved = moved.map(|(p, way)| p + way * (step * row as f64));
            self.positions.extend(moved);
            let end: Vec<VertexId> = (start..self.positions.len())
                .map(VertexId::from_index)
                .collect();
            for i in 0..points.len() {
                let [a, b, c, d] = [last[i], last[next(i)], end[next(i)], end[i]];
                self.faces.extend([[a, b, c], [a, c, d]]);
            }
            last = end;
        }
        self.tubes.push(first..self.faces.len());
        Some(last)
    }

    /// Which way a tube goes on from each vertex of a loop: across the loop, but where it runs that way
    /// itself, as along a slit, across the surface. None where the loop encloses nothing.
    fn ways_across(&self, ring: &[VertexId], points: &[DVec3]) -> Option<Vec<DVec3>> {
        let n = points.len();
        let middle = points.iter().sum::<DVec3>() / n as f64;
        let sides = (0..n).map(|i| [points[i], points[(i + 1) % n]]);
        let round: f64 = sides.clone().map(|[a, b]| a.distance(b)).sum();
        let across: DVec3 = sides.map(|[a, b]| (a - middle).cross(b - middle)).sum();
        if across.length() < LEAST_OPEN * round * round {
            return None;
        }
        let across = across.normalize_or_zero();
        let way = |i: usize| {
            let along = (points[(i + 1) % n] - points[(i + n - 1) % n]).normalize_or_zero();
            let aside = across - along * across.dot(along);
            let faces = self.mesh.outgoing(ring[i]).map(HalfedgeId::face);
            let normal: DVec3 = faces.map(|f| area_vector(self.mesh.triangle(f))).sum();
            aside + normal.normalize_or_zero() * (1.0 - aside.length())
        };
        let mut ways: Vec<DVec3> = (0..n).map(way).collect();
        for _ in 0..N_SMOOTHINGS {
            let mean = |i: usize| ways[(i + n - 1) % n] + 2.0 * ways[i] + ways[(i + 1) % n];
            ways = (0..n).map(|i| mean(i) / 4.0).collect();
        }
        Some(
            ways.into_iter()
                .map(|way| way.try_normalize().unwrap_or(across))
                .collect(),
        )
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
