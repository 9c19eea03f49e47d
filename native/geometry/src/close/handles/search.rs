//! The shortest loop through a vertex that does not part the surface.
//!
//! A tree of shortest ways reaches all vertices nearer than half the length of a loop; a tree of
//! faces that crosses none of its edges takes the edges that close the longest loops first. What is
//! left over are two edges for each handle; each closes a loop that does not part the surface,
//! and the shortest one through the root is among them (erickson2005greedy).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::groups::Groups;
use crate::measure::sharp_edges;
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Edges that turn by more than this count as sharp, in radians.
const SHARP: f64 = 0.7;
/// And are so much shorter to a loop: it may go a third farther to run along them.
const CHEAP: f64 = 0.75;
/// Edges beside a border are so much longer to a loop: quads need room between the two.
const DEAR: f64 = 1.5;

/// A closed way along edges.
#[derive(Clone, PartialEq, Debug)]
pub struct Loop {
    /// Its vertices, in order.
    pub vertices: Vec<VertexId>,
    /// Its length in terms of [`costs`].
    pub length: f64,
}

/// How far a vertex is and from where it was reached.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub distance: f64,
    pub from: VertexId,
    /// How many vertices were settled before it, once it is.
    pub rank: Option<u32>,
}

const FAR: Step = Step {
    distance: f64::INFINITY,
    from: VertexId(u32::MAX),
    rank: None,
};

/// Finds loops through one vertex after another.
pub struct Search<'a> {
    pub(super) mesh: &'a TriangleMesh,
    /// What counts as a length of 1.
    size: f64,
    is_sharp: HalfedgeMap<bool>,
    /// How long each edge is to a loop.
    pub(super) costs: HalfedgeMap<f64>,
    /// Vertices that no loop may pass.
    is_barred: VertexMap<bool>,
    /// The border that each vertex is on.
    pub(super) border: VertexMap<u32>,
    n_borders: usize,
    pub(super) steps: VertexMap<Step>,
    pub(super) settled: Vec<VertexId>,
    touched: Vec<VertexId>,
}

impl<'a> Search<'a> {
    /// Loops pass the border's vertices or avoid them.
    pub fn new(mesh: &'a TriangleMesh, avoids_borders: bool) -> Self {
        let is_sharp = sharp_edges(mesh, SHARP);
        let loops = mesh.border_loops();
        let mut border = VertexMap::filled(mesh.n_vertices(), u32::MAX);
        for (i, h) in (0..)
            .zip(&loops)
            .flat_map(|(i, l)| l.iter().map(move |h| (i, h)))
        {
            border[mesh.origin(*h)] = i;
        }
        let is_barred = border.iter().map(|&b| avoids_borders && b != u32::MAX);
        let is_barred: VertexMap<bool> = is_barred.collect();
        let size = size_of(mesh);
        Self {
            costs: costs((mesh, size), &is_sharp, &is_barred),
            size,
            is_barred,
            is_sharp,
            border,
            n_borders: loops.len(),
            steps: VertexMap::filled(mesh.n_vertices(), FAR),
            settled: Vec::new(),
            touched: Vec::new(),
            mesh,
        }
    }

    /// A length as it counts here.
    pub(super) fn inside(&self, length: f64) -> f64 {
        length / self.size
    }

    /// Whether an edge counts as sharp.
    pub fn is_sharp(&self, h: HalfedgeId) -> bool {
        self.is_sharp[h]
    }

    /// Whether loops may pass a vertex.
    pub fn is_free(&self, v: VertexId) -> bool {
        !self.is_barred[v]
    }

    /// Up to `n` vertices far from each other: the first free one, and each time the farthest.
    pub fn spread(&mut self, n: usize, progress: &Progress) -> Result<Vec<VertexId>, Cancelled> {
        let mut roots: Vec<VertexId> = Vec::new();
        let mut next = self.mesh.vertex_ids().find(|&v| self.is_free(v));
        while let Some(root) = next.filter(|_| roots.len() < n) {
            roots.push(root);
            // Ways that are no shorter than those of the roots before go no farther.
            self.grow(root, f64::INFINITY, progress)?;
            let far = |&v: &VertexId| self.steps[v].distance;
            let reached = self.mesh.vertex_ids().filter(|v| far(v).is_finite());
            next = reached.max_by(|v, w| far(v).total_cmp(&far(w)).then(w.cmp(v)));
            next = next.filter(|v| far(v) > 0.0);
        }
        self.forget();
        Ok(roots)
    }

    /// The shortest loop through `root` that does not part the surface, if one is shorter than
    /// `limit`.
    pub fn through(
        &mut self,
        root: VertexId,
        limit: f64,
        progress: &Progress,
    ) -> Result<Option<Loop>, Cancelled> {
        self.forget();
        self.grow(root, limit / 2.0, progress)?;
        if self.is_disc() {
            return Ok(None);
        }
        let closing = self.left_out(limit, progress)?;
        let loops = closing.into_iter().map(|h| self.closed(h));
        let shortest = loops.min_by(|a, b| a.length.total_cmp(&b.length));
        Ok(shortest.filter(|found| found.length < limit))
    }

    pub(super) fn forget(&mut self) {
        for v in self.touched.drain(..) {
            self.steps[v] = FAR;
        }
        self.settled.clear();
    }

    /// Reaches what is nearer to a vertex than `radius` and than to vertices grown from before.
    pub(super) fn grow(
        &mut self,
        root: VertexId,
        radius: f64,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut heap = BinaryHeap::new();
        self.reach(root, (0.0, root), &mut heap);
        while let Some(Reverse((bits, v))) = heap.pop() {
            let distance = f64::from_bits(bits);
            if distance > radius {
                break;
            }
            let step = self.steps[VertexId(v)];
            if distance > step.distance || step.rank.is_some() {
                continue;
            }
            progress.check()?;
            let v = VertexId(v);
            self.steps[v].rank = Some(self.settled.len() as u32);
            self.settled.push(v);
            self.relax(v, distance, &mut heap);
        }
        Ok(())
    }

    fn relax(&mut self, v: VertexId, distance: f64, heap: &mut Heap) {
        let mut last = None;
        for h in self.mesh.outgoing(v) {
            self.reach(self.mesh.target(h), (distance + self.costs[h], v), heap);
            last = Some(h.prev());
        }
        if let Some(h) = last.filter(|&h| self.mesh.twin(h).is_none()) {
            self.reach(self.mesh.origin(h), (distance + self.costs[h], v), heap);
        }
    }

    fn reach(&mut self, v: VertexId, (distance, from): (f64, VertexId), heap: &mut Heap) {
        if distance < self.steps[v].distance && !self.is_barred[v] {
            if self.steps[v].distance.is_infinite() {
                self.touched.push(v);
            }
            self.steps[v] = Step {
                distance,
                from,
                rank: None,
            };
            heap.push(Reverse((distance.to_bits(), v.0)));
        }
    }

    pub(super) fn has(&self, v: VertexId) -> bool {
        self.steps[v].rank.is_some()
    }

    /// Whether what was reached, one piece, has the Euler number of a disc: it holds no loop then.
    pub(super) fn is_disc(&self) -> bool {
        let mesh = self.mesh;
        let mut euler = self.settled.len() as i64;
        for h in self.settled.iter().flat_map(|&v| mesh.outgoing(v)) {
            if !self.has(mesh.target(h)) {
                continue;
            }
            euler -= i64::from(mesh.twin(h).is_none_or(|twin| h < twin));
            euler += i64::from(h.corner() == 0 && self.has(mesh.origin(h.prev())));
        }
        euler == 1
    }

    /// The edges that are in neither tree; a border counts as a face.
    fn left_out(&self, limit: f64, progress: &Progress) -> Result<Vec<HalfedgeId>, Cancelled> {
        let mesh = self.mesh;
        let n_faces = mesh.n_faces();
        let mut groups = Groups::new(n_faces + self.n_borders);
        let beyond = |h: HalfedgeId| match mesh.twin(h) {
            Some(twin) => twin.face().index(),
            None => n_faces + self.border[mesh.origin(h)] as usize,
        };
        let mut closing = Vec::new();
        progress.check()?;
        for h in mesh.halfedge_ids() {
            if mesh.twin(h).is_some_and(|twin| twin < h) {
                continue;
            }
            let [a, b] = [mesh.origin(h), mesh.target(h)];
            let [from, to] = [self.steps[a], self.steps[b]];
            let are_reached = from.rank.is_some() && to.rank.is_some();
            if are_reached && (from.from == b || to.from == a) {
                continue;
            }
            let length = from.distance + to.distance + self.costs[h];
            if are_reached && length < limit {
                closing.push((length, h));
            } else {
                groups.link(h.face().index(), beyond(h));
            }
        }
        progress.check()?;
        closing.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        closing.retain(|(_, h)| !groups.link(h.face().index(), beyond(*h)));
        Ok(closing.into_iter().map(|(_, h)| h).collect())
    }

    /// The loop that an edge closes: the ways of the tree to its ends from where they part.
    pub(super) fn closed(&self, h: HalfedgeId) -> Loop {
        let mut sides = [self.mesh.origin(h), self.mesh.target(h)].map(|v| vec![v]);
        let mut length = self.costs[h];
        let [mut a, mut b] = [sides[0][0], sides[1][0]];
        // The end that was settled later goes back: it is nobody's way to the other.
        while a != b {
            let is_a = self.steps[a].rank > self.steps[b].rank;
            let end = if is_a { &mut a } else { &mut b };
            length += self.steps[*end].distance;
            *end = self.steps[*end].from;
            length -= self.steps[*end].distance;
            sides[usize::from(!is_a)].push(*end);
        }
        let [mut vertices, back] = sides;
        // Both end where they met, and the second one begins beside where the first begins.
        vertices.extend(back.iter().rev().skip(1));
        Loop { vertices, length }
    }
}

type Heap = BinaryHeap<Reverse<(u64, u32)>>;

/// The largest coordinate of a mesh.
fn size_of(mesh: &TriangleMesh) -> f64 {
    let largest = |size: f64, p: &glam::DVec3| size.max(p.abs().max_element());
    mesh.positions().iter().fold(f64::MIN_POSITIVE, largest)
}

/// The length of every edge as a share of the mesh's size, less where it is sharp, more beside
/// vertices that are barred.
fn costs(
    (mesh, size): (&TriangleMesh, f64),
    is_sharp: &HalfedgeMap<bool>,
    is_barred: &VertexMap<bool>,
) -> HalfedgeMap<f64> {
    let mut is_beside = VertexMap::filled(mesh.n_vertices(), false);
    for v in mesh.vertex_ids().filter(|&v| is_barred[v]) {
        mesh.neighbours(v).for_each(|next| is_beside[next] = true);
    }
    let cost = |h: HalfedgeId| {
        let ends = [mesh.origin(h), mesh.target(h)];
        let [a, b] = ends.map(|v| mesh.position(v) / size);
        let room = if ends.iter().any(|&v| is_beside[v]) {
            DEAR
        } else {
            1.0
        };
        a.distance(b) * room * if is_sharp[h] { CHEAP } else { 1.0 }
    };
    mesh.halfedge_ids().map(cost).collect()
}
