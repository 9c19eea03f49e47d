//! The last step: every vertex and its image become each other's image exactly.

use glam::DVec3;

use crate::deform::{Deformed, Target};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::mirror::mirrored;
use crate::pipeline::probe::Halves;

/// Makes quads whose connections are their own image so in space too.
///
/// Of three ways the one with the fewest inverted quads is taken, of these the nearest to the
/// target: the middle between every vertex and where its image has it, or one side and its image.
/// Which side is first and which second is decided by connections alone.
pub fn even_out(
    deformed: &Deformed,
    images: &[VertexId],
    axis: usize,
    target: &Target,
) -> Deformed {
    let side = sides(&deformed.mesh, images);
    let now = deformed.mesh.positions();
    let shared = |share: [f64; 2]| -> Vec<DVec3> {
        let place = |(v, image): (usize, &VertexId)| {
            let there = mirrored(now[image.index()], axis);
            let mut at = match side[v] {
                None => now[v].midpoint(there),
                Some(side) => now[v] * share[side] + there * share[1 - side],
            };
            if image.index() == v {
                at[axis] = 0.0;
            }
            at
        };
        images.iter().enumerate().map(place).collect()
    };
    let ways = [[0.5, 0.5], [1.0, 0.0], [0.0, 1.0]];
    let made = ways.map(|share| deformed.clone().moved(shared(share)));
    let [mut best, others @ ..] = made.map(|way| (distance(&way.mesh, target), way));
    for other in others {
        let cost = |(distance, way): &(f64, Deformed)| (way.report.n_inverted, *distance);
        if cost(&other) < cost(&best) {
            best = other;
        }
    }
    best.1
}

/// The side of each vertex, 0 for that of the first one beside the plane; none in the plane.
fn sides(mesh: &PolygonMesh, images: &[VertexId]) -> Vec<Option<usize>> {
    let mut around = vec![Vec::new(); images.len()];
    for face in mesh.faces() {
        for i in 0..face.len() {
            let [a, b] = [face[i], face[(i + 1) % face.len()]];
            around[a.index()].push(b);
            around[b.index()].push(a);
        }
    }
    let is_beside = |v: VertexId| images[v.index()] != v;
    let mut side = vec![None; images.len()];
    let first = (0..images.len())
        .map(VertexId::from_index)
        .find(|&v| is_beside(v));
    let mut open: Vec<VertexId> = first.into_iter().collect();
    while let Some(v) = open.pop() {
        if side[v.index()].is_some() || !is_beside(v) {
            continue;
        }
        side[v.index()] = Some(0);
        side[images[v.index()].index()] = Some(1);
        open.extend(&around[v.index()]);
    }
    side
}

/// The mean squared distance of quads and the target, both ways.
fn distance(mesh: &PolygonMesh, target: &Target) -> f64 {
    let halves = Halves::of(mesh);
    let gaps = halves.gaps(target);
    let there = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let (mut back, mut area) = (0.0, 0.0);
    for (middle, weight) in halves.pieces() {
        back += weight * target.bvh().closest(middle).distance_squared;
        area += weight;
    }
    there + back / area
}
