//! Which triangles share which edges, while triangles are being dropped.

use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// The halfedges of each edge, however many there are. Halfedge `3 f + i` leaves corner `i` of
/// triangle `f`, as in a mesh.
pub(super) struct Edges {
    /// The edge of each halfedge.
    edge: Vec<u32>,
    /// Where the halfedges of each edge start in `halfedges`.
    starts: Vec<u32>,
    halfedges: Vec<HalfedgeId>,
    /// How many triangles of each edge are kept.
    n_kept: Vec<u32>,
    is_kept: Vec<bool>,
}

impl Edges {
    pub(super) fn new(faces: &[[VertexId; 3]]) -> Self {
        let (bucket_starts, mut entries) = by_smaller_end(faces);
        let mut edge = vec![0; entries.len()];
        let mut starts = Vec::with_capacity(entries.len() / 2 + 1);
        for bucket in bucket_starts.windows(2) {
            let [from, to] = [bucket[0], bucket[1]];
            let bucket = &mut entries[from as usize..to as usize];
            bucket.sort_unstable();
            let mut start = from;
            for run in bucket.chunk_by(|x, y| x.0 == y.0) {
                for entry in run {
                    edge[entry.1 as usize] = starts.len() as u32;
                }
                starts.push(start);
                start += run.len() as u32;
            }
        }
        starts.push(entries.len() as u32);
        Self {
            edge,
            n_kept: starts.windows(2).map(|w| w[1] - w[0]).collect(),
            starts,
            halfedges: entries.into_iter().map(|(_, h)| HalfedgeId(h)).collect(),
            is_kept: vec![true; faces.len()],
        }
    }

    /// All halfedges that ever were at each edge, edge after edge.
    pub(super) fn runs(&self) -> impl Iterator<Item = &[HalfedgeId]> {
        let run = |w: &[u32]| &self.halfedges[w[0] as usize..w[1] as usize];
        self.starts.windows(2).map(run)
    }

    /// The halfedges of kept triangles at the edge of a halfedge.
    pub(super) fn around(&self, h: HalfedgeId) -> impl Iterator<Item = HalfedgeId> {
        let edge = self.edge[h.index()] as usize;
        let [from, to] = [self.starts[edge], self.starts[edge + 1]];
        let run = &self.halfedges[from as usize..to as usize];
        run.iter().copied().filter(|h| self.is_kept(h.face()))
    }

    /// The one other halfedge at the edge of a halfedge, if there is one.
    pub(super) fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.around(h).find(|&other| other != h)
    }

    /// How many kept triangles meet at the edge of a halfedge.
    pub(super) fn n_faces(&self, h: HalfedgeId) -> usize {
        self.n_kept[self.edge[h.index()] as usize] as usize
    }

    /// A halfedge of the first edge with more than two kept triangles.
    pub(super) fn crowded(&self) -> Option<HalfedgeId> {
        let edge = self.n_kept.iter().position(|&n| n > 2)?;
        Some(self.halfedges[self.starts[edge] as usize])
    }

    /// The triangles that have an edge for themselves.
    pub(super) fn lonely_faces(&self) -> impl Iterator<Item = FaceId> {
        let faces = (0..self.is_kept.len()).map(FaceId::from_index);
        faces.filter(|&face| halfedges(face).any(|h| self.n_faces(h) == 1))
    }

    pub(super) fn is_kept(&self, face: FaceId) -> bool {
        self.is_kept[face.index()]
    }

    /// Drops a triangle and returns those that have an edge for themselves now.
    pub(super) fn drop_face(&mut self, face: FaceId) -> Vec<FaceId> {
        self.is_kept[face.index()] = false;
        let mut lonely = Vec::new();
        for h in halfedges(face) {
            let edge = self.edge[h.index()] as usize;
            self.n_kept[edge] -= 1;
            if self.n_kept[edge] == 1 {
                lonely.extend(self.around(h).map(HalfedgeId::face));
            }
        }
        lonely
    }

    /// Tells that the corners of a triangle were turned from `a b c` to `a c b`.
    pub(super) fn turn_face(&mut self, face: FaceId) {
        // Corner 0 keeps its vertex: the sides a→b and c→a change places, b→c stays.
        let [first, last] = [face.index() * 3, face.index() * 3 + 2];
        for (h, new) in [(first, last), (last, first)] {
            let edge = self.edge[h] as usize;
            let [from, to] = [self.starts[edge], self.starts[edge + 1]];
            let run = &mut self.halfedges[from as usize..to as usize];
            let old = HalfedgeId::from_index(h);
            // A triangle with two different corners at each edge is at the edge once.
            if let Some(entry) = run.iter_mut().find(|entry| **entry == old) {
                *entry = HalfedgeId::from_index(new);
            }
        }
        self.edge.swap(first, last);
    }

    /// The values of the kept triangles.
    pub(super) fn kept<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let pairs = values.iter().zip(&self.is_kept);
        pairs.filter(|(_, kept)| **kept).map(|(v, _)| *v).collect()
    }
}

/// The three halfedges of a triangle.
pub(super) fn halfedges(face: FaceId) -> impl Iterator<Item = HalfedgeId> {
    (0..3).map(move |i| HalfedgeId(face.0 * 3 + i))
}

/// The larger end and the halfedge of every side, sorted by the smaller end only, and where the
/// sides of each smaller end start.
fn by_smaller_end(faces: &[[VertexId; 3]]) -> (Vec<u32>, Vec<(u32, u32)>) {
    let sides = || {
        faces
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| (a.min(b).index(), a.max(b).0))
    };
    let n_vertices = sides().map(|side| side.1 as usize + 1).max().unwrap_or(0);
    let mut starts = vec![0; n_vertices + 1];
    for (small, _) in sides() {
        starts[small + 1] += 1;
    }
    for v in 0..n_vertices {
        starts[v + 1] += starts[v];
    }
    let mut next = starts.clone();
    let mut entries = vec![(0, 0); 3 * faces.len()];
    for (h, (small, large)) in sides().enumerate() {
        entries[next[small] as usize] = (large, h as u32);
        next[small] += 1;
    }
    (starts, entries)
}
