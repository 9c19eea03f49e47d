//! Which triangles share which edges, however many.

use crate::mesh::{FaceId, HalfedgeId, Id, VertexId};

/// The halfedges of each edge. Halfedge `3 f + i` leaves corner `i` of triangle `f`, as in a mesh.
pub(super) struct Edges {
    /// The edge of each halfedge.
    edge: Vec<u32>,
    /// Where the halfedges of each edge start in `halfedges`.
    starts: Vec<u32>,
    halfedges: Vec<HalfedgeId>,
    /// How many triangles of each edge have not been dropped.
    n_faces: Vec<u32>,
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
            n_faces: starts.windows(2).map(|w| w[1] - w[0]).collect(),
            starts,
            halfedges: entries.into_iter().map(|(_, h)| HalfedgeId(h)).collect(),
        }
    }

    /// The halfedges of each edge, edge after edge.
    pub(super) fn runs(&self) -> impl Iterator<Item = &[HalfedgeId]> {
        let run = |w: &[u32]| &self.halfedges[w[0] as usize..w[1] as usize];
        self.starts.windows(2).map(run)
    }

    /// The triangles that have an edge for themselves.
    pub(super) fn lonely_faces(&self) -> Vec<FaceId> {
        let mut lonely: Vec<FaceId> = self
            .runs()
            .filter(|run| run.len() == 1)
            .map(|run| run[0].face())
            .collect();
        lonely.sort_unstable();
        lonely.dedup();
        lonely
    }

    /// Drops a triangle and returns all that were at its edges that have one triangle left.
    pub(super) fn drop_face(&mut self, face: FaceId) -> Vec<FaceId> {
        let mut lonely = Vec::new();
        for h in halfedges(face) {
            let edge = self.edge[h.index()] as usize;
            self.n_faces[edge] -= 1;
            if self.n_faces[edge] == 1 {
                let [from, to] = [self.starts[edge], self.starts[edge + 1]];
                let run = &self.halfedges[from as usize..to as usize];
                lonely.extend(run.iter().map(|h| h.face()));
            }
        }
        lonely
    }
}

const NONE: u32 = u32::MAX;

/// The other halfedge at the edge of each halfedge.
#[derive(Clone)]
pub(super) struct Twins(Vec<u32>);

impl Twins {
    /// Nothing but borders, of so many halfedges.
    pub(super) fn none(n: usize) -> Self {
        Self(vec![NONE; n])
    }

    /// Makes two halfedges each other's twins.
    pub(super) fn link(&mut self, g: HalfedgeId, h: HalfedgeId) {
        self.0[g.index()] = h.0;
        self.0[h.index()] = g.0;
    }

    /// Makes two twins borders.
    pub(super) fn part(&mut self, pair: [HalfedgeId; 2]) {
        for h in pair {
            self.0[h.index()] = NONE;
        }
    }

    /// Those of some of the triangles only; a triangle is kept with its neighbours or goes with them.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        let mut n = 0;
        let shift: Vec<u32> = is_kept
            .iter()
            .map(|&kept| {
                n += u32::from(!kept);
                3 * n
            })
            .collect();
        let old = std::mem::take(&mut self.0);
        let kept = old.chunks_exact(3).zip(is_kept).filter(|(_, kept)| **kept);
        let renamed = |&twin: &u32| match twin {
            NONE => NONE,
            twin => twin - shift[twin as usize / 3],
        };
        self.0 = kept.flat_map(|(of, _)| of.iter().map(renamed)).collect();
    }

    /// The other halfedge at the same edge, if there is one.
    pub(super) fn of(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        Some(self.0[h.index()])
            .filter(|&t| t != NONE)
            .map(HalfedgeId)
    }

    /// Tells that the corners of a triangle were turned from `a b c` to `a c b`: the sides a→b and
    /// c→a change places.
    pub(super) fn turn_face(&mut self, face: FaceId) {
        let [first, last] = [face.index() * 3, face.index() * 3 + 2];
        self.0.swap(first, last);
        for h in [first, last] {
            if let Some(twin) = self.of(HalfedgeId::from_index(h)) {
                self.0[twin.index()] = h as u32;
            }
        }
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
