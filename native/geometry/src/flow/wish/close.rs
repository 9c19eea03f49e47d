//! Makes nearly closed vectors closed.

use std::collections::VecDeque;

use glam::DVec2;

use crate::flow::complex::Turn;
use crate::flow::field::halfedges;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, HalfedgeMap, TriangleMesh, VertexId};

/// Changes vectors as little as it takes for those of each face to sum up to zero and those of
/// twins to be w and −i^r w, up to rounding.
///
/// The vectors along a spanning tree of the vertices decide all others: a face of which two are
/// known tells the third. One face is left over; what misses there is spread over the tree.
pub fn close(mesh: &TriangleMesh, turns: &HalfedgeMap<u8>, vectors: &mut HalfedgeMap<DVec2>) {
    let edges = Edges { mesh, turns };
    let is_tree = spanning_tree(mesh);
    let (order, last) = peel(mesh, &is_tree);
    for h in mesh.halfedge_ids() {
        let twin = edges.twin(h);
        if is_tree[h] && h < twin {
            let back = edges.across(twin, vectors[twin]);
            edges.set(vectors, h, (vectors[h] + back) / 2.0);
        }
    }
    let shares = shares(&edges, &order, last);
    let total: f64 = mesh
        .halfedge_ids()
        .map(|h| shares[h].length_squared())
        .sum();
    // The second time removes what rounding left of the first.
    for _ in 0..2 {
        follow(&edges, &order, vectors);
        let missing: DVec2 = halfedges(last).map(|h| vectors[h]).into_iter().sum();
        for h in mesh.halfedge_ids().filter(|&h| shares[h] != DVec2::ZERO) {
            let share = DVec2::new(shares[h].x, -shares[h].y);
            edges.set(vectors, h, vectors[h] - share.rotate(missing) / total);
        }
    }
    follow(&edges, &order, vectors);
}

struct Edges<'a> {
    mesh: &'a TriangleMesh,
    turns: &'a HalfedgeMap<u8>,
}

impl Edges<'_> {
    fn twin(&self, h: HalfedgeId) -> HalfedgeId {
        self.mesh.twin(h).expect("the mesh of a field is closed")
    }

    /// The vector of a halfedge's twin.
    fn across(&self, h: HalfedgeId, w: DVec2) -> DVec2 {
        -w.turned(self.turns[h])
    }

    fn set(&self, vectors: &mut HalfedgeMap<DVec2>, h: HalfedgeId, w: DVec2) {
        vectors[h] = w;
        vectors[self.twin(h)] = self.across(h, w);
    }
}

/// The edges of a spanning tree of the vertices, breadth first; both halfedges of each.
fn spanning_tree(mesh: &TriangleMesh) -> HalfedgeMap<bool> {
    let mut is_tree = HalfedgeMap::filled(3 * mesh.n_faces(), false);
    let mut seen = vec![false; mesh.n_vertices()];
    let mut queue = VecDeque::from([VertexId(0)]);
    seen[0] = true;
    while let Some(v) = queue.pop_front() {
        for h in mesh.outgoing(v) {
            let to = mesh.target(h);
            if !std::mem::replace(&mut seen[to.0 as usize], true) {
                is_tree[h] = true;
                if let Some(twin) = mesh.twin(h) {
                    is_tree[twin] = true;
                }
                queue.push_back(to);
            }
        }
    }
    is_tree
}

/// The halfedges off the tree in an order in which each is the last unknown one of its face, and
/// the face that none of them is needed for.
fn peel(mesh: &TriangleMesh, is_tree: &HalfedgeMap<bool>) -> (Vec<HalfedgeId>, FaceId) {
    let mut is_known = is_tree.clone();
    let n_unknown = |face| halfedges(face).iter().filter(|h| !is_tree[**h]).count();
    let mut n_unknown: FaceMap<usize> = mesh.face_ids().map(n_unknown).collect();
    let mut ready: Vec<FaceId> = mesh.face_ids().filter(|&f| n_unknown[f] == 1).collect();
    let mut order = Vec::new();
    let mut last = FaceId(0);
    while let Some(face) = ready.pop() {
        let Some(h) = halfedges(face).into_iter().find(|h| !is_known[*h]) else {
            last = face;
            continue;
        };
        order.push(h);
        let twin = mesh.twin(h).expect("the mesh of a field is closed");
        is_known[h] = true;
        is_known[twin] = true;
        n_unknown[face] -= 1;
        n_unknown[twin.face()] -= 1;
        // A face that was ready already comes up again with nothing unknown: the last one.
        if n_unknown[twin.face()] <= 1 {
            ready.push(twin.face());
        }
    }
    (order, last)
}

/// Computes the vectors off the tree from those on it.
fn follow(edges: &Edges, order: &[HalfedgeId], vectors: &mut HalfedgeMap<DVec2>) {
    for &h in order {
        let third = -(vectors[h.next()] + vectors[h.prev()]);
        edges.set(vectors, h, third);
    }
}

/// a of each tree edge's smaller halfedge such that the vectors of the last face sum up to Σ a w.
fn shares(edges: &Edges, order: &[HalfedgeId], last: FaceId) -> HalfedgeMap<DVec2> {
    let mut shares = HalfedgeMap::filled(edges.turns.len(), DVec2::ZERO);
    let give = |shares: &mut HalfedgeMap<DVec2>, h: HalfedgeId, share: DVec2| {
        let twin = edges.twin(h);
        if h < twin {
            shares[h] += share;
        } else {
            // w_h = −i^r w_twin, r the turn of the twin.
            shares[twin] -= share.turned(edges.turns[twin]);
        }
    };
    for h in halfedges(last) {
        give(&mut shares, h, DVec2::X);
    }
    for &h in order.iter().rev() {
        let twin = edges.twin(h);
        let first = h.min(twin);
        let share = std::mem::replace(&mut shares[first], DVec2::ZERO);
        // w_first = −i^r w_h where h is the second.
        let share = if h == first {
            share
        } else {
            -share.turned(edges.turns[h])
        };
        give(&mut shares, h.next(), -share);
        give(&mut shares, h.prev(), -share);
    }
    shares
}
