//! The halfedges of quads: the one from a quad's corner `i` to the next is number 4 · quad + `i`.

/// The next halfedge of the same quad.
pub fn next(h: usize) -> usize {
    h / 4 * 4 + (h + 1) % 4
}

/// The vertex that a halfedge ends at.
pub fn end(quads: &[[u32; 4]], h: usize) -> u32 {
    quads[h / 4][(h + 1) % 4]
}

/// The halfedges that leave each vertex.
pub struct Leaving {
    starts: Vec<usize>,
    halfedges: Vec<usize>,
}

impl Leaving {
    /// Sorts the halfedges of quads by the vertices that they leave.
    pub fn new(quads: &[[u32; 4]], n_vertices: usize) -> Self {
        let mut starts = vec![0; n_vertices + 1];
        for &v in quads.iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..n_vertices {
            starts[v + 1] += starts[v];
        }
        let mut free = starts.clone();
        let mut halfedges = vec![0; 4 * quads.len()];
        for (h, &v) in quads.iter().flatten().enumerate() {
            halfedges[free[v as usize]] = h;
            free[v as usize] += 1;
        }
        Self { starts, halfedges }
    }

    /// How many vertices there are.
    pub fn n_vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// Those that leave a vertex, in order.
    pub fn of(&self, vertex: usize) -> &[usize] {
        &self.halfedges[self.starts[vertex]..self.starts[vertex + 1]]
    }

    /// The other side of each halfedge; none when edges do not match.
    pub fn twins(&self, quads: &[[u32; 4]]) -> Option<Vec<usize>> {
        (0..4 * quads.len()).map(|h| self.twin(quads, h)).collect()
    }

    /// The other side of a halfedge; none at a border.
    pub fn twin(&self, quads: &[[u32; 4]], h: usize) -> Option<usize> {
        let start = quads[h / 4][h % 4];
        let mut across = self.of(end(quads, h) as usize).iter();
        across.find(|&&t| end(quads, t) == start).copied()
    }
}

/// How many quads each vertex has.
pub fn valences(quads: &[[u32; 4]], n_vertices: usize) -> Vec<usize> {
    let mut valences = vec![0; n_vertices];
    for &v in quads.iter().flatten() {
        valences[v as usize] += 1;
    }
    valences
}
