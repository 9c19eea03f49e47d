//! A loop round or through a handle, to show where it is.
//!
//! A spanning tree of the vertices and one of the faces that does not cross it leave out two edges
//! for each handle; every such edge closes a loop of the first tree that no disc fills.

use std::collections::VecDeque;

use crate::groups::Groups;
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};

/// The most loops of a component that are measured to find a short one.
const MOST_LOOPS: usize = 64;

/// How a tree of edges reaches a vertex.
#[derive(Clone, Copy)]
struct Step {
    from: VertexId,
    depth: u32,
}

/// The edges of the shortest loop found in each component that has handles.
pub fn loops(mesh: &TriangleMesh, component: &[u32], n: usize) -> Vec<Vec<[VertexId; 2]>> {
    let tree = tree(mesh);
    let mut found = vec![Vec::new(); n];
    let mut n_seen = vec![0; n];
    for h in left_out(mesh, &tree) {
        let of = component[h.face().index()] as usize;
        n_seen[of] += 1;
        if n_seen[of] > MOST_LOOPS {
            continue;
        }
        let closed = closed(&tree, [mesh.origin(h), mesh.target(h)]);
        if found[of].is_empty() || closed.len() < found[of].len() {
            found[of] = closed;
        }
    }
    found
}

/// A tree of shortest ways from the first vertex of every component.
fn tree(mesh: &TriangleMesh) -> VertexMap<Step> {
    const UNSEEN: u32 = u32::MAX;
    let unseen = Step {
        from: VertexId(0),
        depth: UNSEEN,
    };
    let mut tree = VertexMap::filled(mesh.n_vertices(), unseen);
    let mut queue = VecDeque::new();
    for root in mesh.vertex_ids() {
        if tree[root].depth != UNSEEN {
            continue;
        }
        tree[root] = Step {
            from: root,
            depth: 0,
        };
        queue.push_back(root);
        while let Some(v) = queue.pop_front() {
            let depth = tree[v].depth + 1;
            for next in mesh.neighbours(v) {
                if tree[next].depth == UNSEEN {
                    tree[next] = Step { from: v, depth };
                    queue.push_back(next);
                }
            }
        }
    }
    tree
}

/// The edges that are in neither tree; a border counts as a face.
fn left_out(mesh: &TriangleMesh, tree: &VertexMap<Step>) -> Vec<HalfedgeId> {
    let borders = mesh.border_loops();
    let mut beyond = vec![0; 3 * mesh.n_faces()];
    for (i, border) in borders.iter().enumerate() {
        for h in border {
            beyond[h.index()] = mesh.n_faces() + i;
        }
    }
    let mut groups = Groups::new(mesh.n_faces() + borders.len());
    let mut left_out = Vec::new();
    for h in mesh.halfedge_ids() {
        let twin = mesh.twin(h);
        let [a, b] = [mesh.origin(h), mesh.target(h)];
        let is_of_tree = tree[a].from == b || tree[b].from == a;
        if is_of_tree || twin.is_some_and(|twin| twin < h) {
            continue;
        }
        let other = twin.map_or(beyond[h.index()], |twin| twin.face().index());
        if !groups.link(h.face().index(), other) {
            left_out.push(h);
        }
    }
    left_out
}

/// The loop that an edge closes: itself, and the ways of the tree from its ends to where they meet.
fn closed(tree: &VertexMap<Step>, ends: [VertexId; 2]) -> Vec<[VertexId; 2]> {
    let mut edges = vec![ends];
    let [mut a, mut b] = ends;
    while a != b {
        let deeper = if tree[a].depth >= tree[b].depth {
            &mut a
        } else {
            &mut b
        };
        let from = tree[*deeper].from;
        edges.push([*deeper, from]);
        *deeper = from;
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn a_loop_of_a_torus_closes_and_a_ball_has_none() {
        let torus = shapes::torus(8, 6);
        let (component, n) = torus.face_components();
        let found = &loops(&torus, &component, n)[0];
        assert!((3..=8).contains(&found.len()), "{found:?}");
        for v in found.iter().flatten() {
            assert_eq!(found.iter().flatten().filter(|w| *w == v).count(), 2);
        }
        let ball = shapes::sphere(4);
        let (component, n) = ball.face_components();
        assert!(loops(&ball, &component, n)[0].is_empty());
    }

    #[test]
    fn a_border_is_no_handle() {
        let ball = shapes::sphere(4);
        let some = ball.faces().iter().skip(9).copied();
        let (open, _) = TriangleMesh::of_faces(ball.positions(), some).unwrap();
        let (component, n) = open.face_components();
        assert!(!open.is_closed() && loops(&open, &component, n)[0].is_empty());
    }
}
