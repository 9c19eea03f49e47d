//! Vertices that become one.

use std::collections::BTreeSet;

use glam::DVec3;

use super::Line;
use super::chain::Chain;
use crate::groups::Groups;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};

/// Vertices that become one.
pub(super) struct Joining<'a> {
    pub(super) mesh: &'a PolygonMesh,
    pub(super) groups: Groups,
    /// The faces at all vertices of the group of each first vertex, in order.
    pub(super) faces: Vec<Vec<FaceId>>,
    /// Where the group of each first vertex lies.
    pub(super) places: Vec<DVec3>,
    /// Vertices that were joined.
    pub(super) joined: BTreeSet<usize>,
}

impl<'a> Joining<'a> {
    pub(super) fn new(mesh: &'a PolygonMesh) -> Self {
        let mut faces = vec![Vec::new(); mesh.n_vertices()];
        for face in mesh.face_ids() {
            for v in mesh.face(face) {
                faces[v.index()].push(face);
            }
        }
        Self {
            mesh,
            groups: Groups::new(mesh.n_vertices()),
            faces,
            places: mesh.positions().to_vec(),
            joined: BTreeSet::new(),
        }
    }

    /// Joins those chains of a line that have equally many vertices; these, if they are those of all
    /// its sheets.
    pub(super) fn all_of(&mut self, line: &Line, chains: &[Chain]) -> Option<Vec<VertexId>> {
        let mut chains: Vec<&Chain> = chains.iter().collect();
        chains.sort_by_key(|chain| (chain.vertices.len(), !chain.is_border));
        // Most alike; of equally many the longest.
        let alike = chains
            .chunk_by(|a, b| a.vertices.len() == b.vertices.len())
            .max_by_key(|alike| alike.len())?;
        let n = alike[0].vertices.len();
        let may_join = (alike.len() > 1 || line.stays) && n >= line.fewest();
        let joins = may_join && self.join(line, alike);
        let are_all = joins && alike.len() == line.strands.len();
        are_all.then(|| alike[0].vertices.clone())
    }

    /// Joins chains of equally many vertices on a line, unless a face would lose a corner.
    fn join(&mut self, line: &Line, chains: &[&Chain]) -> bool {
        let n = chains[0].vertices.len();
        let sets: Vec<Vec<VertexId>> = (0..n)
            .map(|i| chains.iter().map(|chain| chain.vertices[i]).collect())
            .collect();
        let goals: Vec<DVec3> = if line.stays {
            line.between_posts(n)
        } else {
            (0..n).map(|i| self.goal(line, chains, i)).collect()
        };
        self.unite(&sets, &goals)
    }

    /// Makes one vertex of some at a point, unless a face would lose a corner.
    pub(super) fn touch(&mut self, place: DVec3, vertices: &[VertexId]) -> bool {
        !vertices.is_empty() && self.unite(&[vertices.to_vec()], &[place])
    }

    fn unite(&mut self, sets: &[Vec<VertexId>], goals: &[DVec3]) -> bool {
        let mut after = self.groups.clone();
        let mut hit: Vec<usize> = Vec::new();
        for set in sets {
            for v in set {
                hit.push(after.root(v.index()));
                after.link(set[0].index(), v.index());
            }
        }
        hit.sort_unstable();
        hit.dedup();
        let mut corners: Vec<(usize, FaceId)> = Vec::new();
        for &was in &hit {
            let now = after.root(was);
            corners.extend(self.faces[was].iter().map(|&face| (now, face)));
        }
        corners.sort_unstable();
        if corners.windows(2).any(|w| w[0] == w[1]) {
            return false;
        }
        self.groups = after;
        for was in hit {
            self.faces[was].clear();
        }
        for of_one in corners.chunk_by(|a, b| a.0 == b.0) {
            self.faces[of_one[0].0] = of_one.iter().map(|&(_, face)| face).collect();
        }
        for (set, &goal) in sets.iter().zip(goals) {
            let root = self.groups.root(set[0].index());
            self.places[root] = goal;
            self.joined.insert(root);
        }
        true
    }

    /// Where some vertices of chains are joined: on the line, in the middle of the sheets that end
    /// there, or go on, with counts that were not changed.
    fn goal(&mut self, line: &Line, chains: &[&Chain], i: usize) -> DVec3 {
        let last = chains[0].vertices.len() - 1;
        match (line.is_closed, i) {
            (false, 0) => return line.points[0],
            (false, i) if i == last => return line.points[line.points.len() - 1],
            _ => {}
        }
        let key = |chain: &Chain| (chain.is_changed, !chain.is_border);
        let best = chains.iter().map(|chain| key(chain)).min();
        let counting = chains.iter().filter(|chain| Some(key(chain)) == best);
        let (mut sum, mut n) = (DVec3::ZERO, 0.0);
        for chain in counting {
            sum += self.places[self.groups.root(chain.vertices[i].index())];
            n += 1.0;
        }
        line.closest(sum / n)
    }

    /// The mesh with its vertices joined, and what they are called.
    pub(super) fn joined(mut self) -> (PolygonMesh, VertexMap<VertexId>) {
        let roots: Vec<usize> = (0..self.places.len())
            .map(|v| self.groups.root(v))
            .collect();
        let (group, n) = self.groups.numbered();
        let mut positions = vec![DVec3::ZERO; n];
        for (&group, root) in group.iter().zip(roots) {
            positions[group as usize] = self.places[root];
        }
        let name = VertexMap::from_vec(group.into_iter().map(VertexId).collect());
        let corners = self.mesh.corners().iter().map(|&v| name[v]).collect();
        let joined = PolygonMesh::new(positions, self.mesh.starts().to_vec(), corners);
        (joined.expect("no face loses a corner"), name)
    }
}
