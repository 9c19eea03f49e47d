//! Lines of shared edges, and the pages that meet along each.
//!
//! Two shared edges belong to one line where no other ends at the vertex between them and every
//! face at the one leads round the vertex, over edges of two faces, to a face at the other. What
//! leads on so along the whole line is a *page*.

use std::collections::HashMap;

use super::super::edges::Twins;
use super::super::triangulate::Triangulated;
use crate::mesh::{HalfedgeId, Id, VertexId};

/// A line of edges that are shared by the same pages.
pub(in super::super) struct Line {
    pub(in super::super) edges: Vec<LineEdge>,
    pub(in super::super) is_closed: bool,
    /// The page that each page goes on into.
    pub(super) partner: Vec<Option<usize>>,
}

impl Line {
    pub(super) fn n_pages(&self) -> usize {
        self.partner.len()
    }

    pub(super) fn is_free(&self, page: usize) -> bool {
        self.partner[page].is_none()
    }

    /// Whether each page goes on into the same other one all along.
    fn goes_on_alike(&self, twins: &Twins) -> bool {
        let mut edges = self.edges.iter();
        let is_alike = edges.all(|edge| edge.partners(twins) == self.partner);
        is_alike && self.partner.iter().all(Option::is_some)
    }
}

/// An edge of a line.
pub(in super::super) struct LineEdge {
    /// Its ends, along the line.
    pub(in super::super) ends: [VertexId; 2],
    /// Its side in each page, in the order of the pages.
    pub(in super::super) pages: Vec<HalfedgeId>,
}

impl LineEdge {
    /// The page that each page goes on into.
    fn partners(&self, twins: &Twins) -> Vec<Option<usize>> {
        let page = |h: HalfedgeId| self.pages.iter().position(|&side| side == h);
        self.pages.iter().map(|&h| page(twins.of(h)?)).collect()
    }
}

/// Where a line goes on at an end of an edge.
struct Joint {
    /// The edge there.
    to: usize,
    /// The place of each page among the sides of that edge.
    places: Vec<usize>,
}

/// What lines are put together from.
struct Chain<'a> {
    triangulated: &'a Triangulated,
    twins: &'a Twins,
    /// The sides of each shared edge.
    shared: &'a [Vec<HalfedgeId>],
    /// The ends of each, the smaller first.
    ends: Vec<[VertexId; 2]>,
    /// Where lines go on at these.
    joints: Vec<[Option<Joint>; 2]>,
    is_seen: Vec<bool>,
}

/// The lines of some shared edges, in an order that does not depend on that of the faces.
pub(super) fn chained(
    triangulated: &Triangulated,
    twins: &Twins,
    shared: &[Vec<HalfedgeId>],
) -> Vec<Line> {
    let mut chain = Chain {
        triangulated,
        twins,
        shared,
        ends: Vec::new(),
        joints: shared.iter().map(|_| [None, None]).collect(),
        is_seen: vec![false; shared.len()],
    };
    chain.ends = shared.iter().map(|run| chain.sorted_ends(run[0])).collect();
    chain.join();
    // Open lines first, each from the smaller of its ends.
    let mut starts: Vec<(VertexId, VertexId, usize)> = Vec::new();
    for (edge, joints) in chain.joints.iter().enumerate() {
        let [a, b] = chain.ends[edge];
        let free = joints.iter().zip([(a, b, edge), (b, a, edge)]);
        starts.extend(free.filter(|(j, _)| j.is_none()).map(|(_, start)| start));
    }
    starts.sort_unstable();
    let mut closed: Vec<_> = chain.ends.iter().copied().enumerate().collect();
    closed.sort_unstable_by_key(|&(_, ends)| ends);
    starts.extend(closed.into_iter().map(|(edge, [a, b])| (a, b, edge)));
    let mut lines = Vec::new();
    for (from, to, edge) in starts {
        if !chain.is_seen[edge] {
            lines.push(chain.walk(edge, [from, to]));
        }
    }
    lines
}

/// The lines of edges at which solids touch, whose pages are paired already.
pub(super) fn touching(
    triangulated: &Triangulated,
    twins: &Twins,
    pairs: &[Vec<[HalfedgeId; 2]>],
) -> Vec<Line> {
    let mut apart = twins.clone();
    pairs.iter().flatten().for_each(|&pair| apart.part(pair));
    let run = |pairs: &Vec<[HalfedgeId; 2]>| {
        let mut run = pairs.concat();
        run.sort_unstable();
        run
    };
    let shared: Vec<Vec<HalfedgeId>> = pairs.iter().map(run).collect();
    let mut lines = chained(triangulated, &apart, &shared);
    for line in &mut lines {
        line.partner = line.edges[0].partners(twins);
    }
    lines.retain(|line| line.goes_on_alike(twins));
    lines
}

impl Chain<'_> {
    fn sorted_ends(&self, h: HalfedgeId) -> [VertexId; 2] {
        let [a, b] = self.triangulated.ends(h);
        [a.min(b), a.max(b)]
    }

    /// Finds where lines go on.
    fn join(&mut self) {
        let sides = self.shared.iter().enumerate().flat_map(|(edge, run)| {
            let places = run.iter().enumerate();
            places.map(move |(place, &h)| (h, (edge, place)))
        });
        let sides: HashMap<HalfedgeId, (usize, usize)> = sides.collect();
        let ends = self.ends.iter().enumerate();
        let mut at: Vec<(VertexId, usize)> = ends
            .flat_map(|(edge, ends)| ends.map(|v| (v, edge)))
            .collect();
        at.sort_unstable();
        for here in at.chunk_by(|x, y| x.0 == y.0) {
            let [(v, a), (_, b)] = *here else {
                continue;
            };
            for [from, to] in [[a, b], [b, a]] {
                let joint = self.joint(v, [from, to], &sides);
                let end = usize::from(self.ends[from][1] == v);
                self.joints[from][end] = joint;
            }
        }
    }

    /// Where each face at one of two edges leads to at the other, if all do and to different ones.
    fn joint(
        &self,
        v: VertexId,
        [from, to]: [usize; 2],
        sides: &HashMap<HalfedgeId, (usize, usize)>,
    ) -> Option<Joint> {
        let n = self.shared[from].len();
        if self.shared[to].len() != n {
            return None;
        }
        let mut is_taken = vec![false; n];
        let mut places = Vec::with_capacity(n);
        for &h in &self.shared[from] {
            let (edge, place) = *sides.get(&self.round(h, v))?;
            if edge != to || std::mem::replace(&mut is_taken[place], true) {
                return None;
            }
            places.push(place);
        }
        Some(Joint { to, places })
    }

    /// The last side of the faces round a vertex that begin with one.
    fn round(&self, start: HalfedgeId, v: VertexId) -> HalfedgeId {
        let mut at = start;
        loop {
            let leaves = self.triangulated.ends(at)[0] == v;
            let other = if leaves { at.prev() } else { at.next() };
            match self.twins.of(other) {
                Some(twin) => at = twin,
                None => return other,
            }
        }
    }

    /// The line from an edge on.
    fn walk(&mut self, first: usize, ends: [VertexId; 2]) -> Line {
        let first_places = self.sorted_places(first, ends[0]);
        let mut line = Line {
            edges: Vec::new(),
            is_closed: false,
            partner: vec![None; first_places.len()],
        };
        let (mut edge, mut ends, mut places) = (first, ends, first_places.clone());
        loop {
            self.is_seen[edge] = true;
            let pages = places.iter().map(|&place| self.shared[edge][place]);
            line.edges.push(LineEdge {
                ends,
                pages: pages.collect(),
            });
            let end = usize::from(self.ends[edge][1] == ends[1]);
            let Some(joint) = &self.joints[edge][end] else {
                break;
            };
            places = places.iter().map(|&place| joint.places[place]).collect();
            edge = joint.to;
            if self.is_seen[edge] {
                line.is_closed = places == first_places;
                break;
            }
            let [a, b] = self.ends[edge];
            ends = [ends[1], if a == ends[1] { b } else { a }];
        }
        line
    }

    /// The sides of an edge by what their faces have beside it, then by direction.
    fn sorted_places(&self, edge: usize, from: VertexId) -> Vec<usize> {
        let run = &self.shared[edge];
        let mut places: Vec<usize> = (0..run.len()).collect();
        places.sort_by_key(|&place| {
            let h = run[place];
            let apex = self.triangulated.ends(h.prev())[0];
            let name = self.triangulated.origins[apex.index()];
            (name, apex, self.triangulated.ends(h)[0] == from, h)
        });
        places
    }
}
