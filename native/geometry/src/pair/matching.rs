//! Largest matchings of graphs in which every node has up to three neighbours.
//!
//! A greedy matching is completed by augmenting paths through blossoms (Edmonds 1965), so that none
//! is missed: with three neighbours each and without bridges, as the faces of closed triangles are
//! joined, a perfect one exists (Petersen 1891). Small changes make it better then ([`improve`]).

use std::collections::VecDeque;

use super::improve::improve;
use crate::progress::{Cancelled, Progress};

/// No neighbour, no partner, no parent.
pub(super) const NONE: u32 = u32::MAX;
/// For every node its neighbours, some [`NONE`], and what to be paired with each is worth.
pub(super) type Arcs = [[(u32, f64); 3]];

/// The partner of every node in a matching that leaves as few without one as can be.
pub(super) fn largest(arcs: &Arcs, progress: &Progress) -> Result<Vec<u32>, Cancelled> {
    let mut search = Search::new(arcs, greedy(arcs));
    for node in 0..arcs.len() as u32 {
        if node % 1024 == 0 {
            progress.at(0.5 * f64::from(node) / arcs.len() as f64)?;
        }
        if search.mate[node as usize] == NONE {
            // A node that finds no way now finds none later.
            search.augment(node);
        }
    }
    let mut mate = search.mate;
    improve(arcs, &mut mate, &progress.part("", 0.5, 1.0))?;
    Ok(mate)
}

/// Pairs the dearest edge of what is left, again and again.
fn greedy(arcs: &Arcs) -> Vec<u32> {
    let mut edges: Vec<(f64, u32, u32)> = Vec::with_capacity(3 * arcs.len() / 2);
    for (a, arcs) in (0..).zip(arcs) {
        let later = arcs.iter().filter(|&&(b, _)| b != NONE && a < b);
        edges.extend(later.map(|&(b, weight)| (weight, a, b)));
    }
    edges.sort_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut mate = vec![NONE; arcs.len()];
    for (_, a, b) in edges {
        if mate[a as usize] == NONE && mate[b as usize] == NONE {
            (mate[a as usize], mate[b as usize]) = (b, a);
        }
    }
    mate
}

/// The search for augmenting paths: a tree that grows from a free node.
struct Search<'a> {
    arcs: &'a Arcs,
    mate: Vec<u32>,
    /// The node before, for nodes at odd distance and inside blossoms.
    parent: Vec<u32>,
    /// The base of the blossom that a node is in; itself outside of any.
    base: Vec<u32>,
    is_even: Vec<bool>,
    is_inside: Vec<bool>,
    /// Nodes of the tree.
    touched: Vec<u32>,
    queue: VecDeque<u32>,
}

impl<'a> Search<'a> {
    fn new(arcs: &'a Arcs, mate: Vec<u32>) -> Self {
        let n = arcs.len();
        Self {
            arcs,
            mate,
            parent: vec![NONE; n],
            base: (0..n as u32).collect(),
            is_even: vec![false; n],
            is_inside: vec![false; n],
            touched: Vec::new(),
            queue: VecDeque::new(),
        }
    }

    /// Matches a free node by an augmenting path; false if there is none.
    fn augment(&mut self, root: u32) -> bool {
        let mut end = self.grow(root);
        let found = end.is_some();
        while let Some(v) = end {
            let before = self.parent[v as usize];
            let next = self.mate[before as usize];
            (self.mate[v as usize], self.mate[before as usize]) = (before, v);
            end = (next != NONE).then_some(next);
        }
        for v in self.touched.drain(..) {
            self.parent[v as usize] = NONE;
            self.base[v as usize] = v;
            self.is_even[v as usize] = false;
        }
        self.queue.clear();
        found
    }

    fn reach(&mut self, v: u32) {
        if !self.is_even[v as usize] {
            self.is_even[v as usize] = true;
            self.queue.push_back(v);
        }
    }

    /// Grows the tree until it meets a free node.
    fn grow(&mut self, root: u32) -> Option<u32> {
        self.touched.push(root);
        self.reach(root);
        while let Some(v) = self.queue.pop_front() {
            for (to, _) in self.arcs[v as usize] {
                if to == NONE
                    || self.base[v as usize] == self.base[to as usize]
                    || self.mate[v as usize] == to
                {
                    continue;
                }
                let mate = self.mate[to as usize];
                if to == root || (mate != NONE && self.parent[mate as usize] != NONE) {
                    self.contract(v, to);
                } else if self.parent[to as usize] == NONE {
                    self.parent[to as usize] = v;
                    self.touched.push(to);
                    if mate == NONE {
                        return Some(to);
                    }
                    self.touched.push(mate);
                    self.reach(mate);
                }
            }
        }
        None
    }

    /// Makes one node of an odd cycle that an edge closes.
    fn contract(&mut self, a: u32, b: u32) {
        let base = self.common_base(a, b);
        for &v in &self.touched {
            self.is_inside[v as usize] = false;
        }
        self.mark(a, base, b);
        self.mark(b, base, a);
        for i in 0..self.touched.len() {
            let v = self.touched[i];
            if self.is_inside[self.base[v as usize] as usize] {
                self.base[v as usize] = base;
                self.reach(v);
            }
        }
    }

    /// The bases from a node up to the root.
    fn bases(&self, from: u32) -> impl Iterator<Item = u32> {
        let mut next = Some(from);
        std::iter::from_fn(move || {
            let base = self.base[next? as usize];
            let mate = self.mate[base as usize];
            next = (mate != NONE).then(|| self.parent[mate as usize]);
            Some(base)
        })
    }

    fn common_base(&self, a: u32, b: u32) -> u32 {
        let mut above: Vec<u32> = self.bases(a).collect();
        above.sort_unstable();
        let mut of_b = self.bases(b);
        of_b.find(|base| above.binary_search(base).is_ok())
            .expect("both ways end in the root")
    }

    fn mark(&mut self, mut v: u32, base: u32, mut child: u32) {
        while self.base[v as usize] != base {
            let mate = self.mate[v as usize];
            for inside in [v, mate] {
                self.is_inside[self.base[inside as usize] as usize] = true;
            }
            self.parent[v as usize] = child;
            child = mate;
            v = self.parent[mate as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::improve::{gaining_cycle, worth};
    use super::*;
    use crate::mesh::{Id, TriangleMesh};
    use crate::random::Random;
    use crate::shapes;

    /// The faces of a mesh, and what their pairs are worth by chance.
    fn arcs(mesh: &TriangleMesh, seed: u64) -> Vec<[(u32, f64); 3]> {
        let mut random = Random::new(seed);
        let worth: Vec<f64> = mesh.halfedge_ids().map(|_| random.unit()).collect();
        let arcs = mesh.face_ids().map(|face| {
            let first = mesh.halfedge(face);
            [first, first.next(), first.prev()].map(|h| {
                let twin = mesh.twin(h).unwrap();
                (twin.face().0, worth[h.min(twin).index()])
            })
        });
        arcs.collect()
    }

    fn total(arcs: &Arcs, mate: &[u32]) -> f64 {
        let nodes = (0..).zip(mate);
        nodes.map(|(a, &b)| worth(arcs, a, b)).sum::<f64>() / 2.0
    }

    /// The weight of the best perfect matching, by trying all.
    fn best(arcs: &Arcs, mate: &mut [u32]) -> f64 {
        let Some(a) = mate.iter().position(|&m| m == NONE) else {
            return 0.0;
        };
        let mut most = f64::NEG_INFINITY;
        for (b, weight) in arcs[a] {
            if mate[b as usize] == NONE {
                (mate[a], mate[b as usize]) = (b, a as u32);
                most = most.max(weight + best(arcs, mate));
                (mate[a], mate[b as usize]) = (NONE, NONE);
            }
        }
        most
    }

    #[test]
    fn every_closed_surface_is_paired_whole() {
        for (i, (name, mesh)) in shapes::closed(5).into_iter().enumerate() {
            let arcs = arcs(&mesh, i as u64);
            let mate = largest(&arcs, &Progress::none()).unwrap();
            for (a, &b) in (0..).zip(&mate) {
                assert_eq!(mate[b as usize], a, "{name}");
                assert!(arcs[a as usize].iter().any(|arc| arc.0 == b), "{name}");
            }
        }
    }

    #[test]
    fn small_matchings_are_the_best_and_larger_ones_have_no_small_gain() {
        for seed in 0..40 {
            let arcs = arcs(&shapes::sphere(1), seed);
            let mate = largest(&arcs, &Progress::none()).unwrap();
            let most = best(&arcs, &mut vec![NONE; arcs.len()]);
            assert!((total(&arcs, &mate) - most).abs() < 1e-9, "{seed}");
        }
        let arcs = arcs(&shapes::sphere(6), 1);
        let mate = largest(&arcs, &Progress::none()).unwrap();
        assert!((0..arcs.len() as u32).all(|a| gaining_cycle(&arcs, &mate, a).is_none()));
        assert!(total(&arcs, &mate) > 1.03 * total(&arcs, &complete(&arcs)));
    }

    /// The greedy matching, completed.
    fn complete(arcs: &Arcs) -> Vec<u32> {
        let mut search = Search::new(arcs, greedy(arcs));
        for node in 0..arcs.len() as u32 {
            assert!(search.mate[node as usize] != NONE || search.augment(node));
        }
        search.mate
    }

    #[test]
    fn blossoms_do_not_hide_a_way_and_bridges_leave_as_few_as_can_be() {
        // Two triangles joined by an edge; every node has a third arc to a neighbour it has.
        let flat = |list: [[u32; 3]; 6]| list.map(|to| to.map(|b| (b, 1.0)));
        let joined = flat([
            [1, 2, 2],
            [0, 2, 2],
            [0, 1, 3],
            [4, 5, 2],
            [3, 5, 5],
            [3, 4, 4],
        ]);
        let mut search = Search::new(&joined, vec![NONE, 2, 1, 4, 3, NONE]);
        assert!(search.augment(0));
        assert!(search.mate.iter().all(|&m| m != NONE));
        // Three such triangles round a node.
        let star = [
            [1, 4, 7],
            [0, 2, 3],
            [1, 3, 3],
            [1, 2, 2],
            [0, 5, 6],
            [4, 6, 6],
            [4, 5, 5],
            [0, 8, 9],
            [7, 9, 9],
            [7, 8, 8],
        ];
        let star = star.map(|to| to.map(|b| (b, 1.0)));
        let mate = largest(&star, &Progress::none()).unwrap();
        assert_eq!(mate.iter().filter(|&&m| m == NONE).count(), 2);
    }
}
