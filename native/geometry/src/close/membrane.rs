//! Makes triangles over a loop fine and smooth (Liepa 2003).

use glam::DVec3;

use super::patch::Patch;
use crate::mesh::{HalfedgeId, Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// How much longer edges may be for each unit of distance to the loop. With 0.2 a cap of a large
/// loop has twice the faces; with 0.5 half of them, and slivers where it grows coarser.
const GRADE: f64 = 0.35;

/// A face is split where its middle is farther from its corners than the length wanted over this.
/// With less the outermost rows are slivers; with more faces are half as long as wanted.
const ROOM: f64 = std::f64::consts::SQRT_2;

/// The shortest length that is wanted, as a share of the loop's mean edge: vertices that lie on
/// each other would ask for ever smaller faces.
const FINEST: f64 = 1.0 / 16.0;

/// Every round cuts what is too large in three at least: for 10,000 edges a quarter of these do.
const ROUNDS: usize = 40;

/// How often all vertices are moved. They settle fast where there are few rows of them.
const MOVES: usize = 12;

/// Splits and turns the triangles of a patch until they are as fine as its loop, and relaxes them.
pub fn refine(patch: &mut Patch, progress: &Progress) -> Result<(), Cancelled> {
    let mut wanted = lengths(patch);
    let most = 40 * wanted.len() + 400;
    patch.settle(patch.halfedge_ids().collect());
    for _ in 0..ROUNDS {
        let n_before = patch.n_faces();
        for face in by_area(patch) {
            progress.check()?;
            if patch.n_faces() >= most {
                break;
            }
            if let Some((middle, length)) = is_large(patch, &wanted, face) {
                let new = patch.split_face(face, middle);
                wanted.push(length);
                patch.settle(patch.outgoing(new).map(HalfedgeId::next).collect());
            }
        }
        if patch.n_faces() == n_before {
            break;
        }
    }
    for _ in 0..MOVES {
        progress.check()?;
        relax(patch);
        patch.settle(patch.halfedge_ids().collect());
    }
    Ok(())
}

/// The faces, the largest first.
fn by_area(patch: &Patch) -> Vec<usize> {
    let area = |corners: [VertexId; 3]| {
        let [a, b, c] = corners.map(|v| patch.positions[v]);
        (b - a).cross(c - a).length()
    };
    let areas: Vec<f64> = patch.faces().map(area).collect();
    let mut faces: Vec<usize> = (0..areas.len()).collect();
    faces.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
    faces
}

/// How long edges are to be at each vertex of the loop, and at those that are inside already.
fn lengths(patch: &Patch) -> VertexMap<f64> {
    let inner = patch
        .inner()
        .next()
        .map_or(patch.positions.len(), Id::index);
    let at = |i: usize| patch.positions[VertexId::from_index(i % inner)];
    let edges: Vec<f64> = (0..inner).map(|i| at(i).distance(at(i + 1))).collect();
    let mean = edges.iter().sum::<f64>() / inner as f64;
    let beside = (0..inner).map(|i| edges[i].midpoint(edges[(i + inner - 1) % inner]));
    let of_loop = beside.map(|length| length.max(FINEST * mean));
    let of_others = (inner..patch.positions.len()).map(|_| mean);
    of_loop.chain(of_others).collect()
}

/// Where a face is to be split, if it is too large, and the length wanted there.
fn is_large(patch: &Patch, wanted: &VertexMap<f64>, face: usize) -> Option<(DVec3, f64)> {
    let corners = patch.face(face);
    let middle = corners.map(|v| patch.positions[v]).iter().sum::<DVec3>() / 3.0;
    let far = corners.map(|v| middle.distance(patch.positions[v]));
    let lengths = corners.map(|v| wanted[v]);
    let graded = (0..3).map(|i| lengths[i] + GRADE * far[i]);
    let length = graded.fold(f64::INFINITY, f64::min);
    let is_far = |i: usize| ROOM * far[i] > length.max(lengths[i]);
    (0..3).all(is_far).then_some((middle, length))
}

/// Moves every inner vertex to the middle of its neighbours, as far as the area does not grow: so
/// nothing folds on a plane, and elsewhere the membrane tightens.
fn relax(patch: &mut Patch) {
    for v in patch.inner() {
        let around: Vec<[DVec3; 2]> = patch
            .outgoing(v)
            .map(|h| [h.next(), h.prev()].map(|x| patch.positions[patch.origin(x)]))
            .collect();
        let here = patch.positions[v];
        let area = |p: DVec3| -> f64 {
            let twice = around.iter().map(|[a, b]| (a - p).cross(b - p).length());
            twice.sum()
        };
        let middle = around.iter().map(|[a, _]| *a).sum::<DVec3>() / around.len() as f64;
        let most = area(here) * (1.0 + 1e-12);
        let steps = [1.0, 0.5, 0.25].map(|share| here.lerp(middle, share));
        if let Some(there) = steps.into_iter().find(|&p| area(p) <= most) {
            patch.positions[v] = there;
        }
    }
}
