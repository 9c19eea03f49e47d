//! Sharp edges as lines, which the result's edges should run along.
//!
//! A line of sharp edges ends where it branches, stops, turns sharply or meets a singularity; a
//! closed line without such a place begins and ends at its first vertex. Between its ends a line is
//! one straight segment of the flat metric if the result is to have edges on it: its span, the sum
//! of the wish along it, says along which axis and how long.

use glam::DVec2;

use crate::flow::complex::Turn;
use crate::flow::field::OrientationField;
use crate::measure::angle_between;
use crate::mesh::{HalfedgeId, HalfedgeMap, TriangleMesh, VertexId, VertexMap};

/// A line that turns by more than this at a vertex has a corner there (53°).
const CORNER_ANGLE: f64 = 0.927;

/// A line of sharp edges between two ends.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Crease {
    /// Its halfedges from one end to the other, each beginning where the one before stops.
    pub line: Vec<HalfedgeId>,
}

/// All lines of the edges that `is_sharp` names, each in one of its two directions.
///
/// It is asked for both halfedges of an edge and must answer the same. O(n).
pub fn creases(
    mesh: &TriangleMesh,
    field: &OrientationField,
    is_sharp: impl Fn(HalfedgeId) -> bool,
) -> Vec<Crease> {
    let sharp: HalfedgeMap<bool> = mesh.halfedge_ids().map(is_sharp).collect();
    let mut is_end: VertexMap<bool> = mesh
        .vertex_ids()
        .map(|v| is_end(mesh, field, &sharp, v))
        .collect();
    let mut used = HalfedgeMap::filled(sharp.len(), false);
    let mut creases = Vec::new();
    // First the lines between ends; what is left are closed ones.
    for closed in [false, true] {
        for h in mesh.halfedge_ids().filter(|&h| sharp[h]) {
            if used[h] || (!closed && !is_end[mesh.origin(h)]) {
                continue;
            }
            is_end[mesh.origin(h)] = true;
            let line = follow(mesh, (&sharp, &is_end), h);
            for &h in &line {
                used[h] = true;
                if let Some(twin) = mesh.twin(h) {
                    used[twin] = true;
                }
            }
            creases.push(Crease { line });
        }
    }
    creases
}

/// The wished vector from the first end of a crease to the last, in the frame of the face left of
/// its first halfedge; frames are carried along its left side.
pub fn span(
    mesh: &TriangleMesh,
    field: &OrientationField,
    wish: &HalfedgeMap<DVec2>,
    crease: &Crease,
) -> DVec2 {
    let mut sum = DVec2::ZERO;
    let mut turned = 0;
    let mut lines = crease.line.iter().peekable();
    while let Some(&h) = lines.next() {
        // A vector of a frame `turned` quarters further, seen from the first frame.
        sum += wish[h].turned((4 - turned % 4) % 4);
        let Some(&&ahead) = lines.peek() else {
            break;
        };
        let mut e = h.next();
        while e != ahead {
            turned = (turned + field.turns[e]) % 4;
            e = mesh.twin(e).expect("the mesh of a field is closed").next();
        }
    }
    sum
}

/// The sharp halfedges that leave a vertex.
fn sharp_from(
    mesh: &TriangleMesh,
    sharp: &HalfedgeMap<bool>,
    vertex: VertexId,
) -> impl Iterator<Item = HalfedgeId> {
    mesh.outgoing(vertex).filter(|&h| sharp[h])
}

fn is_end(
    mesh: &TriangleMesh,
    field: &OrientationField,
    sharp: &HalfedgeMap<bool>,
    vertex: VertexId,
) -> bool {
    let mut leaving = sharp_from(mesh, sharp, vertex);
    let [Some(a), Some(b), None] = [leaving.next(), leaving.next(), leaving.next()] else {
        // No end either where there is no line at all.
        return sharp_from(mesh, sharp, vertex).next().is_some();
    };
    let [a, b] = [a, b].map(|h| mesh.position(mesh.target(h)) - mesh.position(vertex));
    field.indices[vertex] != 0 || angle_between(-a, b) > CORNER_ANGLE
}

/// The line from a halfedge on to the next end.
fn follow(
    mesh: &TriangleMesh,
    (sharp, is_end): (&HalfedgeMap<bool>, &VertexMap<bool>),
    first: HalfedgeId,
) -> Vec<HalfedgeId> {
    let mut line = vec![first];
    let mut at = mesh.target(first);
    let mut from = mesh.origin(first);
    while !is_end[at] {
        let Some(h) = sharp_from(mesh, sharp, at).find(|&h| mesh.target(h) != from) else {
            break;
        };
        line.push(h);
        [from, at] = [at, mesh.target(h)];
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::field::{Settings, orient};
    use crate::flow::wish::wish;
    use crate::measure::{dihedral_angle, total_area};
    use crate::mesh::FaceMap;
    use crate::progress::Progress;
    use crate::shapes;

    fn sharp(mesh: &TriangleMesh) -> impl Fn(HalfedgeId) -> bool {
        |h| dihedral_angle(mesh, h) > 0.7
    }

    #[test]
    fn a_box_has_twelve_creases_along_the_axes_of_the_flat_metric() {
        let mesh = shapes::cuboid(10);
        let field = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        let h = (total_area(&mesh) / 400.0).sqrt();
        let sizes = FaceMap::filled(mesh.n_faces(), h);
        let vectors = wish(&mesh, &field, &sizes, &Progress::none()).unwrap();
        let creases = creases(&mesh, &field, sharp(&mesh));
        assert_eq!(creases.len(), 12);
        for crease in creases {
            assert_eq!(crease.line.len(), 10);
            let first = mesh.position(mesh.origin(crease.line[0]));
            let last = mesh.position(mesh.target(crease.line[9]));
            let span = span(&mesh, &field, &vectors, &crease);
            let across = span.abs().min_element();
            assert!(across < 0.02 * span.length(), "{span}");
            let length = first.distance(last) / h;
            assert!(
                (span.length() / length - 1.0).abs() < 0.05,
                "{span} {length}"
            );
        }
    }

    #[test]
    fn closed_lines_come_once_and_round_shapes_have_none() {
        let mesh = shapes::sphere(8);
        let field = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        assert!(creases(&mesh, &field, |_| false).is_empty());
        let on_equator = |v| mesh.position(v).z.abs() < 1e-9;
        let equator = |h| on_equator(mesh.origin(h)) && on_equator(mesh.target(h));
        let lines = creases(&mesh, &field, equator);
        let singular = |v: &VertexId| on_equator(*v) && field.indices[*v] != 0;
        let n_singular = mesh.vertex_ids().filter(singular).count();
        assert_eq!(lines.len(), n_singular.max(1));
        let n_edges: usize = lines.iter().map(|crease| crease.line.len()).sum();
        assert_eq!(n_edges, 32);
        for crease in &lines {
            for pair in crease.line.windows(2) {
                assert_eq!(mesh.target(pair[0]), mesh.origin(pair[1]));
            }
        }
    }

    #[test]
    fn the_span_of_a_way_and_back_is_nothing() {
        let mesh = shapes::blob(2, 8);
        let field = orient(&mesh, &Settings::default(), &Progress::none()).unwrap();
        let sizes = FaceMap::filled(mesh.n_faces(), 0.2);
        let vectors = wish(&mesh, &field, &sizes, &Progress::none()).unwrap();
        let regular = |h: &HalfedgeId| field.indices[mesh.target(*h)] == 0;
        for h in mesh.halfedge_ids().filter(regular).take(50) {
            let line = vec![h, mesh.twin(h).unwrap()];
            let back = span(&mesh, &field, &vectors, &Crease { line });
            assert!(back.length() < 1e-12, "{back}");
        }
    }
}
