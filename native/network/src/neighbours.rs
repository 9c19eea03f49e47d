//! Who is next to whom: the edges of a level as a symmetric compressed table.

use orbflow_geometry::mesh::{Id, VertexId};

/// The neighbours of every vertex. Symmetric: i is next to j whenever j is next to i.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Neighbours {
    starts: Vec<u32>,
    of_all: Vec<u32>,
}

impl Neighbours {
    /// The edges of a closed mesh whose vertices are below `n`.
    pub fn of_faces(n: usize, faces: &[[VertexId; 3]]) -> Self {
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(3 * faces.len());
        for face in faces {
            for (v, w) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (face[i], face[j])) {
                edges.push((v.index() as u32, w.index() as u32));
            }
        }
        // A closed oriented mesh has each edge once in either direction.
        edges.sort_unstable();
        let mut starts = vec![0; n + 1];
        for &(v, _) in &edges {
            starts[v as usize + 1] += 1;
        }
        for v in 0..n {
            starts[v + 1] += starts[v];
        }
        let of_all = edges.into_iter().map(|(_, w)| w).collect();
        Self { starts, of_all }
    }

    /// Graphs side by side, each numbered after the one before it.
    pub fn joined<'a>(graphs: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut joined = Self {
            starts: vec![0],
            of_all: Vec::new(),
        };
        for graph in graphs {
            let n_before = joined.n_vertices() as u32;
            let n_edges = joined.of_all.len() as u32;
            joined
                .starts
                .extend(graph.starts[1..].iter().map(|s| s + n_edges));
            joined
                .of_all
                .extend(graph.of_all.iter().map(|v| v + n_before));
        }
        joined
    }

    /// How many vertices there are.
    pub fn n_vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// The neighbours of one vertex, ascending.
    pub fn of(&self, vertex: usize) -> &[u32] {
        &self.of_all[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// Where the neighbours of each vertex start in all of them, with the end of the last; and all.
    pub fn table(&self) -> [&[u32]; 2] {
        [&self.starts, &self.of_all]
    }

    /// Every edge in both directions, as the vertices it leaves and those it reaches.
    pub fn pairs(&self) -> [Vec<i64>; 2] {
        let from = (0..self.n_vertices()).flat_map(|v| self.of(v).iter().map(move |_| v as i64));
        let to = self.of_all.iter().map(|&v| i64::from(v));
        [from.collect(), to.collect()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_graphs_keep_their_edges() {
        let faces = [[0, 2, 1], [0, 1, 3], [2, 0, 3], [1, 2, 3]].map(|f| f.map(VertexId));
        let one = Neighbours::of_faces(4, &faces);
        assert_eq!((one.of(0), one.of(3)), (&[1, 2, 3][..], &[0, 1, 2][..]));
        let two = Neighbours::joined([&one, &one]);
        assert_eq!((two.n_vertices(), two.of(5)), (8, &[4, 6, 7][..]));
        assert_eq!(two.pairs()[0].len(), 24);
    }
}
