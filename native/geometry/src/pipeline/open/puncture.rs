//! Borders shorter than a few quads: they are opened once there are quads.
//!
//! A line of so few edges leaves a flow no choice, and none is needed: where the border is, one quad
//! goes, or the four round a vertex, and what was round them moves onto the border.

use glam::DVec3;

use super::Opening;
use super::mend::around;
use crate::deform::Deformed;
use crate::measure::{PolygonEdges, Polyline};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// A border is a puncture up to this length, in edges of quads.
pub const LONGEST: f64 = 8.0;
/// And if the circle as long as it has no larger share of the part's area.
pub const LARGEST: f64 = 0.1;
/// From this length on, in edges of quads, it gets eight edges in place of four.
const EIGHT: f64 = 5.5;
/// At how many places of the border it is tried where the first vertex goes.
const N_TURNS: usize = 32;

/// A border to be opened.
pub struct Puncture {
    /// It, the faces on the left.
    line: Polyline,
    middle: DVec3,
    /// How many edges it gets.
    n_edges: usize,
}

impl Puncture {
    pub fn new(line: Polyline, edge: f64) -> Self {
        let n = 64;
        let at = |i: usize| line.point(line.length() * i as f64 / n as f64);
        let middle = (0..n).map(at).sum::<DVec3>() / n as f64;
        let n_edges = if line.length() < EIGHT * edge { 4 } else { 8 };
        Self {
            line,
            middle,
            n_edges,
        }
    }

    /// It, piece by piece.
    pub fn pieces(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.line.pieces()
    }

    /// Where vertices in a row belong that have what goes on their left.
    fn places(&self, now: &[DVec3]) -> Vec<DVec3> {
        let n = now.len();
        let whole = self.line.length();
        let at = |turn: usize| {
            let first = whole * turn as f64 / (n * N_TURNS) as f64;
            // The border has the faces that stay on its left.
            let place = |i: usize| (first - whole * i as f64 / n as f64).rem_euclid(whole);
            (0..n)
                .map(|i| self.line.point(place(i)))
                .collect::<Vec<_>>()
        };
        let off = |places: &Vec<DVec3>| -> f64 {
            places
                .iter()
                .zip(now)
                .map(|(a, b)| a.distance_squared(*b))
                .sum()
        };
        let all = (0..n * N_TURNS).map(at);
        let best = all.min_by(|a, b| off(a).total_cmp(&off(b)));
        best.unwrap_or_else(|| now.to_vec())
    }
}

impl Opening {
    /// Quads with their punctures; or which has no room.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn punctured(
        &self,
        opened: Deformed,
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        if self.punctures.is_empty() {
            return Ok(Ok(opened));
        }
        let mesh = &opened.mesh;
        let edges = PolygonEdges::new(mesh, progress)?;
        let mut is_taken = edges.border_vertices(mesh.n_vertices());
        let mut positions = mesh.positions().to_vec();
        let mut is_kept = vec![true; mesh.n_faces()];
        let around = around(mesh);
        for (i, puncture) in self.punctures.iter().enumerate() {
            if puncture.line.length() <= 0.0 {
                return Ok(Err("a border has no length".to_owned()));
            }
            let places = puncture.rings(mesh, &around);
            let free = places
                .into_iter()
                .find(|(ring, _)| ring.iter().all(|v| !is_taken[v.index()]));
            let Some((ring, gone)) = free else {
                let n = self.punctures.len();
                return Ok(Err(format!(
                    "there is no room for border {i} of {n} short ones"
                )));
            };
            let now: Vec<DVec3> = ring.iter().map(|&v| mesh.position(v)).collect();
            for (&v, place) in ring.iter().zip(puncture.places(&now)) {
                is_taken[v.index()] = true;
                positions[v.index()] = place;
            }
            for face in gone {
                is_kept[face.index()] = false;
            }
        }
        let moved = opened.moved(positions);
        Ok(Ok(moved.only(&is_kept, progress)?))
    }
}

impl Puncture {
    /// Rings of vertices, counterclockwise, and the faces inside them that go, nearest first.
    fn rings(
        &self,
        mesh: &PolygonMesh,
        around: &[Vec<FaceId>],
    ) -> Vec<(Vec<VertexId>, Vec<FaceId>)> {
        let away = |ring: &[VertexId]| {
            let sum: DVec3 = ring.iter().map(|&v| mesh.position(v)).sum();
            (sum / ring.len() as f64).distance_squared(self.middle)
        };
        let mut rings: Vec<(Vec<VertexId>, Vec<FaceId>)> = match self.n_edges {
            4 => mesh
                .face_ids()
                .map(|f| (mesh.face(f).to_vec(), vec![f]))
                .collect(),
            _ => (0..mesh.n_vertices())
                .filter(|&v| around[v].len() == 4)
                .filter_map(|v| {
                    Some((
                        ring(mesh, VertexId::from_index(v), &around[v])?,
                        around[v].clone(),
                    ))
                })
                .collect(),
        };
        rings.sort_by(|a, b| away(&a.0).total_cmp(&away(&b.0)));
        rings
    }
}

/// The eight vertices round one of four quads, counterclockwise; none where they do not close.
fn ring(mesh: &PolygonMesh, middle: VertexId, faces: &[FaceId]) -> Option<Vec<VertexId>> {
    // From one neighbour of the vertex over the far corner to the next.
    let piece = |face: &FaceId| {
        let corners = mesh.face(*face);
        let i = corners.iter().position(|&v| v == middle)?;
        let at = |k: usize| corners[(i + k) % corners.len()];
        (corners.len() == 4).then(|| [at(1), at(2), at(3)])
    };
    let pieces: Vec<[VertexId; 3]> = faces.iter().map(piece).collect::<Option<_>>()?;
    let mut ring = Vec::with_capacity(2 * pieces.len());
    let mut at = pieces.first()?[0];
    for _ in 0..pieces.len() {
        let piece = pieces.iter().find(|piece| piece[0] == at)?;
        ring.extend([piece[0], piece[1]]);
        at = piece[2];
    }
    (at == ring[0]).then_some(ring)
}
