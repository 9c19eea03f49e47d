//! The part of a mesh that is on the sphere while vertices come and go: rings, points, colours.

use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;

use crate::hierarchy::{Collapse, CollapseHierarchy};
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// How many rings a thread copies at least.
const LEAST_CHUNK: usize = 512;
/// The colour of vertices that are not there.
const NOT_THERE: u32 = u32::MAX;

/// The neighbours of a vertex: a cache line where there are no more than usual.
type Ring = SmallVec<[VertexId; 12]>;

/// Vertices with points on the sphere, and the mesh that they make.
#[derive(Clone, Debug)]
pub struct Partial {
    /// The point of every vertex that is there.
    pub sphere: VertexMap<DVec3>,
    /// The neighbours of every vertex that is there, counter-clockwise; nothing for the others.
    rings: VertexMap<Ring>,
    /// No two neighbours have the same colour.
    colours: VertexMap<u32>,
    n_there: usize,
}

impl Partial {
    /// The coarsest level of a hierarchy, on the corners of a regular tetrahedron.
    pub fn tetrahedron(hierarchy: &CollapseHierarchy) -> Self {
        let n = hierarchy.n_vertices();
        let mut partial = Self {
            sphere: VertexMap::filled(n, DVec3::ZERO),
            rings: VertexMap::filled(n, Ring::new()),
            colours: VertexMap::filled(n, NOT_THERE),
            n_there: 4,
        };
        let corners = [
            DVec3::new(1.0, 1.0, 1.0),
            DVec3::new(1.0, -1.0, -1.0),
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::new(-1.0, -1.0, 1.0),
        ];
        // The first face of the base is (0, 1, 2), which these corners see counter-clockwise.
        let vertices = &hierarchy.coarse_to_fine()[..4];
        for (colour, (&v, corner)) in vertices.iter().zip(corners).enumerate() {
            partial.sphere[v] = corner / 3.0_f64.sqrt();
            partial.colours[v] = colour as u32;
            partial.rings[v] = ring_in(&hierarchy.base(), v).into();
        }
        partial
    }

    /// A whole mesh.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn whole(
        mesh: &TriangleMesh,
        sphere: VertexMap<DVec3>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let n = mesh.n_vertices();
        // A ring that stays empty after a cancellation is never seen.
        let ring = |i| match progress.check() {
            Ok(()) => mesh.neighbours(VertexId::from_index(i)).collect(),
            Err(Cancelled) => Ring::new(),
        };
        let rings = (0..n)
            .into_par_iter()
            .with_min_len(LEAST_CHUNK)
            .map(ring)
            .collect();
        let mut partial = Self {
            sphere,
            rings: VertexMap::from_vec(rings),
            colours: VertexMap::filled(n, NOT_THERE),
            n_there: n,
        };
        for v in mesh.vertex_ids() {
            progress.check()?;
            partial.colours[v] = partial.free_colour(partial.ring(v));
        }
        Ok(partial)
    }

    /// How many vertices are there.
    pub fn n_there(&self) -> usize {
        self.n_there
    }

    /// The vertices that are there, and their colours.
    pub fn there(&self) -> impl Iterator<Item = (VertexId, u32)> {
        let colours = self.colours.iter_ids().map(|(v, &colour)| (v, colour));
        colours.filter(|&(_, colour)| colour != NOT_THERE)
    }

    /// The neighbours of a vertex, counter-clockwise; none when it is not there.
    pub fn ring(&self, vertex: VertexId) -> &[VertexId] {
        &self.rings[vertex]
    }

    /// The ring of a vertex, starting at one of its neighbours.
    pub fn ring_from(&self, vertex: VertexId, first: VertexId) -> Vec<VertexId> {
        let mut ring = self.rings[vertex].to_vec();
        ring.rotate_left(self.place(vertex, first));
        ring
    }

    /// Whether collapsing a vertex into a neighbour keeps a closed surface: they have two common
    /// neighbours, and three vertices would be left besides.
    pub fn is_legal(&self, vertex: VertexId, into: VertexId) -> bool {
        let common = self.rings[vertex]
            .iter()
            .filter(|v| self.rings[into].contains(v));
        self.n_there > 4 && common.count() == 2
    }

    /// The sphere points of a ring, the first again at the end.
    pub fn closed_ring(&self, ring: &[VertexId]) -> Vec<DVec3> {
        let around = ring.iter().chain(ring.first());
        around.map(|&v| self.sphere[v]).collect()
    }

    /// Undoes a collapse: the faces of `ring[0]` along the ring become the fan of the new vertex.
    pub fn insert(&mut self, collapse: Collapse<'_>, position: DVec3) {
        let Collapse { vertex, ring } = collapse;
        let [first, last] = [1, ring.len() - 1];
        let old = ring[0];
        let at = self.place(old, ring[first]);
        let fan = &mut self.rings[old];
        // Only the first and the last of the ring stay neighbours of the old vertex.
        fan.rotate_left(at);
        fan.drain(1..last - 1);
        fan.insert(1, vertex);
        for &middle in &ring[first + 1..last] {
            let at = self.place(middle, old);
            self.rings[middle][at] = vertex;
        }
        let at = self.place(ring[first], old);
        self.rings[ring[first]].insert(at, vertex);
        let at = self.place(ring[last], old);
        self.rings[ring[last]].insert(at + 1, vertex);
        self.colours[vertex] = self.free_colour(ring);
        self.rings[vertex] = Ring::from_slice(ring);
        self.sphere[vertex] = position;
        self.n_there += 1;
    }

    /// Collapses a vertex into the first of its ring; the link condition must hold.
    pub fn collapse(&mut self, Collapse { vertex, ring }: Collapse<'_>) {
        let last = ring.len() - 1;
        let old = ring[0];
        let at = self.place(old, vertex);
        self.rings[old].remove(at);
        self.rings[old].insert_from_slice(at, &ring[2..last]);
        for &middle in &ring[2..last] {
            let at = self.place(middle, vertex);
            self.rings[middle][at] = old;
        }
        for side in [ring[1], ring[last]] {
            let at = self.place(side, vertex);
            self.rings[side].remove(at);
        }
        self.rings[vertex].clear();
        self.colours[vertex] = NOT_THERE;
        // It has new neighbours, and one of them may have its colour.
        self.colours[old] = self.free_colour(self.ring(old));
        self.n_there -= 1;
    }

    /// Where `neighbour` stands in the ring of `vertex`.
    fn place(&self, vertex: VertexId, neighbour: VertexId) -> usize {
        let found = self.rings[vertex].iter().position(|&v| v == neighbour);
        found.expect("rings of a checked hierarchy name each other")
    }

    /// The smallest colour that none of the ring has.
    fn free_colour(&self, ring: &[VertexId]) -> u32 {
        let free = |&colour: &u32| ring.iter().all(|&v| self.colours[v] != colour);
        let found = (0..NOT_THERE).find(free);
        found.expect("a ring has fewer vertices than there are colours")
    }
}

/// The neighbours of a vertex in a closed list of faces, counter-clockwise.
fn ring_in(faces: &[[VertexId; 3]], vertex: VertexId) -> Vec<VertexId> {
    let edge = |f: &[VertexId; 3]| {
        let i = f.iter().position(|&v| v == vertex)?;
        Some((f[(i + 1) % 3], f[(i + 2) % 3]))
    };
    let edges: Vec<_> = faces.iter().filter_map(edge).collect();
    let mut ring: Vec<VertexId> = edges.first().map(|e| e.0).into_iter().collect();
    while ring.len() < edges.len() {
        let last = ring[ring.len() - 1];
        let next = edges.iter().find(|e| e.0 == last);
        ring.push(next.expect("the faces are closed").1);
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    /// Rings name each other in the right direction, and neighbours differ in colour.
    fn check(partial: &Partial) {
        for (v, colour) in partial.there() {
            let ring = partial.ring(v);
            assert!(ring.len() >= 3, "{v}");
            for (i, &r) in ring.iter().enumerate() {
                let back = partial.ring(r);
                let at = partial.place(r, v);
                assert_eq!(
                    back[(at + 1) % back.len()],
                    ring[(i + ring.len() - 1) % ring.len()]
                );
                assert_ne!(colour, partial.colours[r], "{v} {r}");
            }
        }
    }

    #[test]
    fn collapses_and_their_undoing_keep_rings_and_colours_right() {
        let mesh = shapes::blob(1, 5);
        let n = mesh.n_vertices();
        let whole =
            Partial::whole(&mesh, VertexMap::filled(n, DVec3::Z), &Progress::none()).unwrap();
        check(&whole);
        let mut partial = whole.clone();
        let mut removed = Vec::new();
        for v in mesh.vertex_ids() {
            let ring = partial.ring(v).to_vec();
            let Some(&into) = ring.iter().find(|&&u| partial.is_legal(v, u)) else {
                continue;
            };
            let ring = partial.ring_from(v, into);
            let vertex = v;
            partial.collapse(Collapse {
                vertex,
                ring: &ring,
            });
            removed.push((v, ring));
            check(&partial);
        }
        assert!(removed.len() > n / 2 && partial.n_there() == n - removed.len());
        for (vertex, ring) in removed.iter().rev() {
            let vertex = *vertex;
            partial.insert(Collapse { vertex, ring }, DVec3::Z);
            check(&partial);
        }
        for v in mesh.vertex_ids() {
            assert_eq!(partial.ring_from(v, whole.ring(v)[0]), whole.ring(v));
        }
    }
}
