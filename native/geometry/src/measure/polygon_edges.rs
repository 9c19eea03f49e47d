//! The edges of a polygon mesh, whatever its faces are.

use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

const NONE: u32 = u32::MAX;

/// The edges of a polygon mesh and how its corners hang together.
///
/// Corner c stands for the halfedge from its vertex to that of the next corner of its face. Nothing
/// is assumed: edges may have any number of faces, and faces may run through them as they like.
#[derive(Clone, Debug)]
pub struct PolygonEdges {
    /// The two ends of each edge, the smaller id first.
    pub ends: Vec<[VertexId; 2]>,
    /// How many halfedges each edge has.
    pub n_sides: Vec<u32>,
    /// The edge of each corner's halfedge.
    pub of_corner: Vec<u32>,
    /// The face of each corner.
    pub face_of: Vec<u32>,
    next: Vec<u32>,
    twins: Vec<u32>,
}

impl PolygonEdges {
    /// Finds the edges, sorted by their ends. Linear but for the sorting around each vertex.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(mesh: &PolygonMesh, progress: &Progress) -> Result<Self, Cancelled> {
        let (next, face_of) = next_corners(mesh);
        progress.check()?;
        let (bucket_ends, mut entries) = by_smaller_end(mesh, &next, progress)?;
        let mut edges = Self {
            ends: Vec::new(),
            n_sides: Vec::new(),
            of_corner: vec![NONE; next.len()],
            face_of,
            twins: vec![NONE; next.len()],
            next,
        };
        let mut start = 0;
        for (vertex, &end) in (0..).map(VertexId).zip(&bucket_ends) {
            progress.check()?;
            let bucket = &mut entries[start..end as usize];
            start = end as usize;
            bucket.sort_unstable();
            for run in bucket.chunk_by(|a, b| a.0 == b.0) {
                edges.add([vertex, run[0].0], run, mesh.corners());
            }
        }
        Ok(edges)
    }

    fn add(&mut self, ends: [VertexId; 2], run: &[Side], corners: &[VertexId]) {
        for &(_, corner) in run {
            self.of_corner[corner as usize] = self.ends.len() as u32;
        }
        if let [(_, a), (_, b)] = *run
            && corners[a as usize] != corners[b as usize]
        {
            self.twins[a as usize] = b;
            self.twins[b as usize] = a;
        }
        self.ends.push(ends);
        self.n_sides.push(run.len() as u32);
    }

    /// How many edges there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no edge.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// How many corners, and so halfedges, there are.
    pub fn n_corners(&self) -> usize {
        self.next.len()
    }

    /// The corner that follows in the same face.
    pub fn next(&self, corner: usize) -> usize {
        self.next[corner] as usize
    }

    /// The opposite halfedge where an edge has exactly two, running in opposite directions.
    pub fn twin(&self, corner: usize) -> Option<usize> {
        Some(self.twins[corner])
            .filter(|&twin| twin != NONE)
            .map(|twin| twin as usize)
    }

    /// Whether each of `n_vertices` vertices lies on an edge that has not exactly two halfedges.
    pub fn border_vertices(&self, n_vertices: usize) -> Vec<bool> {
        let mut is_border = vec![false; n_vertices];
        for (ends, &n_sides) in self.ends.iter().zip(&self.n_sides) {
            if n_sides != 2 {
                for v in ends {
                    is_border[v.index()] = true;
                }
            }
        }
        is_border
    }

    /// How many edges meet at each of `n_vertices` vertices.
    pub fn valences(&self, n_vertices: usize) -> Vec<u32> {
        let mut valences = vec![0; n_vertices];
        for v in self.ends.iter().flatten() {
            valences[v.index()] += 1;
        }
        valences
    }
}

/// A halfedge as the smaller end of its edge sees it: the larger end, and the corner.
type Side = (VertexId, u32);

/// The halfedges by the smaller end of their edge, each with the larger end, and where those of
/// each vertex end.
fn by_smaller_end(
    mesh: &PolygonMesh,
    next: &[u32],
    progress: &Progress,
) -> Result<(Vec<u32>, Vec<Side>), Cancelled> {
    let corners = mesh.corners();
    let ends = |(corner, &next): (&VertexId, &u32)| {
        let other = corners[next as usize];
        [*corner.min(&other), *corner.max(&other)]
    };
    let mut places = vec![0_u32; mesh.n_vertices() + 1];
    for [smaller, _] in corners.iter().zip(next).map(ends) {
        places[smaller.index() + 1] += 1;
    }
    progress.check()?;
    for v in 1..places.len() {
        places[v] += places[v - 1];
    }
    // Each start moves on as its vertex's halfedges come and becomes their end.
    let mut entries = vec![(VertexId(0), 0); corners.len()];
    for (c, [smaller, larger]) in (0..).zip(corners.iter().zip(next).map(ends)) {
        progress.check()?;
        let place = &mut places[smaller.index()];
        entries[*place as usize] = (larger, c);
        *place += 1;
    }
    places.pop();
    Ok((places, entries))
}

fn next_corners(mesh: &PolygonMesh) -> (Vec<u32>, Vec<u32>) {
    let mut next: Vec<u32> = (1..=mesh.corners().len() as u32).collect();
    let mut face_of = Vec::with_capacity(next.len());
    for (face, range) in (0..).zip(mesh.starts().windows(2)) {
        next[range[1] as usize - 1] = range[0];
        face_of.resize(range[1] as usize, face);
    }
    (next, face_of)
}
