//! The surface cut open into a disk on which all frames are turned alike.

use std::collections::VecDeque;

use crate::flow::field::{OrientationField, halfedges};
use crate::mesh::{FaceId, FaceMap, HalfedgeMap, TriangleMesh, VertexMap};

/// A closed surface cut along a tree through its singularities.
pub struct Disk {
    /// How many quarters a vector in a face's frame is turned to be that in the disk's.
    pub combed: FaceMap<u8>,
    /// Which edges are cut, on both sides.
    pub is_cut: HalfedgeMap<bool>,
    /// The point of the disk that a halfedge leaves.
    pub classes: HalfedgeMap<usize>,
    /// How many points the disk has.
    pub n_classes: usize,
}

impl Disk {
    /// Cuts the edges that a spanning tree of the faces does not cross, pruned at regular leaves.
    pub fn new(mesh: &TriangleMesh, field: &OrientationField) -> Self {
        let (combed, mut is_cut) = comb(mesh, field);
        prune(mesh, field, &mut is_cut);
        let (classes, n_classes) = classify(mesh, &is_cut);
        Self {
            combed,
            is_cut,
            classes,
            n_classes,
        }
    }
}

/// Turns the frames alike along a spanning tree of the faces, breadth first; its edges are not cut.
fn comb(mesh: &TriangleMesh, field: &OrientationField) -> (FaceMap<u8>, HalfedgeMap<bool>) {
    let mut combed = FaceMap::filled(mesh.n_faces(), u8::MAX);
    let mut is_cut = HalfedgeMap::filled(3 * mesh.n_faces(), true);
    let mut queue = VecDeque::from([FaceId(0)]);
    combed[FaceId(0)] = 0;
    while let Some(face) = queue.pop_front() {
        for h in halfedges(face) {
            let Some(twin) = mesh.twin(h).filter(|twin| combed[twin.face()] == u8::MAX) else {
                continue;
            };
            // Across a tree edge the vectors of the disk agree: r + combed' − combed = 0.
            combed[twin.face()] = (4 + combed[face] - field.turns[h]) % 4;
            is_cut[h] = false;
            is_cut[twin] = false;
            queue.push_back(twin.face());
        }
    }
    (combed, is_cut)
}

/// Mends the cut wherever it ends at a regular vertex.
fn prune(mesh: &TriangleMesh, field: &OrientationField, is_cut: &mut HalfedgeMap<bool>) {
    let mut n_cut = VertexMap::filled(mesh.n_vertices(), 0);
    for (h, _) in is_cut.iter_ids().filter(|(_, cut)| **cut) {
        n_cut[mesh.origin(h)] += 1;
    }
    let is_loose = |n_cut: &VertexMap<i32>, v| n_cut[v] == 1 && field.indices[v] == 0;
    let mut loose: Vec<_> = mesh.vertex_ids().filter(|&v| is_loose(&n_cut, v)).collect();
    while let Some(v) = loose.pop() {
        let Some(h) = mesh.outgoing(v).find(|h| is_cut[*h]) else {
            continue;
        };
        is_cut[h] = false;
        is_cut[mesh.twin(h).expect("the mesh of a field is closed")] = false;
        let other = mesh.target(h);
        n_cut[v] -= 1;
        n_cut[other] -= 1;
        if is_loose(&n_cut, other) {
            loose.push(other);
        }
    }
}

/// Numbers the corners so that those at one vertex with no cut between share a number.
fn classify(mesh: &TriangleMesh, is_cut: &HalfedgeMap<bool>) -> (HalfedgeMap<usize>, usize) {
    let mut classes = HalfedgeMap::filled(3 * mesh.n_faces(), usize::MAX);
    let mut n_classes = 0;
    for v in mesh.vertex_ids() {
        let fan: Vec<_> = mesh.outgoing(v).collect();
        // From a cut edge on, so that no class goes over the fan's end.
        let start = fan.iter().position(|&h| is_cut[h]).unwrap_or(0);
        for i in 0..fan.len() {
            let h = fan[(start + i) % fan.len()];
            n_classes += usize::from(i == 0 || is_cut[h]);
            classes[h] = n_classes - 1;
        }
    }
    (classes, n_classes)
}
