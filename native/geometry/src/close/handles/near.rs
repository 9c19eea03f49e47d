//! Looks for short loops near one vertex, without looking at the rest of the mesh.

use super::search::Search;
use crate::groups::Groups;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, VertexId};
use crate::progress::{Cancelled, Progress};

/// No number.
const NONE: u32 = u32::MAX;

/// What of the surface is near, as numbers.
pub struct Region {
    /// The number of each face.
    numbers: FaceMap<u32>,
    faces: Vec<FaceId>,
}

impl Region {
    /// Of a mesh with so many faces.
    pub fn new(n_faces: usize) -> Self {
        Self {
            numbers: FaceMap::filled(n_faces, NONE),
            faces: Vec::new(),
        }
    }

    fn enter(&mut self, face: FaceId) {
        if self.numbers[face] == NONE {
            self.numbers[face] = self.faces.len() as u32;
            self.faces.push(face);
        }
    }

    fn clear(&mut self) {
        for face in self.faces.drain(..) {
            self.numbers[face] = NONE;
        }
    }
}

impl Search<'_> {
    /// Vertices of which every other one is no farther than `spacing` from the nearest.
    pub fn net(&mut self, spacing: f64, progress: &Progress) -> Result<Vec<VertexId>, Cancelled> {
        let spacing = self.inside(spacing);
        let mut roots = Vec::new();
        for v in self.mesh.vertex_ids() {
            if self.is_free(v) && !self.has(v) {
                roots.push(v);
                self.grow(v, spacing, progress)?;
            }
        }
        self.forget();
        Ok(roots)
    }

    /// Loops near a vertex that do not part what is near; where there are none, those that part
    /// nothing if all that is farther hangs together. None longer than `limit`.
    pub fn near(
        &mut self,
        (root, limit): (VertexId, f64),
        region: &mut Region,
        progress: &Progress,
    ) -> Result<Vec<Vec<VertexId>>, Cancelled> {
        let limit = self.inside(limit);
        self.forget();
        self.grow(root, limit / 2.0, progress)?;
        if self.is_disc() {
            return Ok(Vec::new());
        }
        for &v in &self.settled {
            self.mesh.outgoing(v).for_each(|h| region.enter(h.face()));
        }
        let mut closing = self.left_out_near(limit, (region, false));
        if closing.is_empty() {
            closing = self.left_out_near(limit, (region, true));
        }
        region.clear();
        let loops = closing.into_iter().map(|h| self.closed(h).vertices);
        Ok(loops.filter(|vertices| vertices.len() > 2).collect())
    }

    /// The edges of a region that are in neither tree; what is beyond it is one face, or as many as the
    /// region has sides.
    fn left_out_near(&self, limit: f64, (region, is_one): (&Region, bool)) -> Vec<HalfedgeId> {
        let mesh = self.mesh;
        let n = region.faces.len();
        let mut borders: Vec<u32> = Vec::new();
        let mut links = Vec::new();
        let mut closing = Vec::new();
        for (own, &face) in region.faces.iter().enumerate() {
            let first = mesh.halfedge(face);
            for h in [first, first.next(), first.prev()] {
                let twin = mesh.twin(h);
                let beyond = match twin.map(|twin| region.numbers[twin.face()]) {
                    Some(NONE) if is_one => n,
                    Some(NONE) => continue,
                    // From one side alone.
                    Some(_) if twin.is_some_and(|twin| twin < h) => continue,
                    Some(number) => number as usize,
                    None => {
                        let border = self.border[mesh.origin(h)];
                        let at = borders.iter().position(|&b| b == border);
                        n + 1
                            + at.unwrap_or_else(|| {
                                borders.push(border);
                                borders.len() - 1
                            })
                    }
                };
                match self.role(h, limit) {
                    Role::Tree => {}
                    Role::Closing(length) => closing.push((length, h, own, beyond)),
                    Role::Other => links.push((own, beyond)),
                }
            }
        }
        let mut groups = Groups::new(n + 1 + borders.len());
        for (own, beyond) in links {
            groups.link(own, beyond);
        }
        closing.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        closing.retain(|&(_, _, own, beyond)| !groups.link(own, beyond));
        closing.into_iter().map(|(_, h, ..)| h).collect()
    }

    /// What an edge is to the tree.
    fn role(&self, h: HalfedgeId, limit: f64) -> Role {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
        let [from, to] = [self.steps[a], self.steps[b]];
        if from.rank.is_none() || to.rank.is_none() {
            return Role::Other;
        }
        if from.from == b || to.from == a {
            return Role::Tree;
        }
        let length = from.distance + to.distance + self.costs[h];
        if length < limit {
            Role::Closing(length)
        } else {
            Role::Other
        }
    }
}

/// What an edge is to a tree of ways.
enum Role {
    /// It belongs to it.
    Tree,
    /// It closes a loop of some length.
    Closing(f64),
    /// It reaches farther.
    Other,
}
