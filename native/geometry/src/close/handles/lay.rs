//! Makes a line over faces one of edges.

use std::collections::HashSet;

use super::slit::between;
use super::split::{Pieces, Place};
use super::tighten::{Stop, ends};
use crate::mesh::{HalfedgeId, Id, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// The mesh with edges along a closed line, and the line's vertices; none where it touches itself.
///
/// Crossings nearer to an inner vertex than the share `snap` of their edge are moved onto it.
pub fn lay(
    pieces: &Pieces,
    (stops, snap): (&[Stop], f64),
    progress: &Progress,
) -> Result<Option<(Pieces, Vec<VertexId>)>, Cancelled> {
    let mesh = &pieces.mesh;
    let snapped = stops
        .iter()
        .map(|stop| snapped(mesh, *stop, snap))
        .collect();
    let stops = absorbed(mesh, snapped);
    if stops.len() < 3 || !is_simple(mesh, &stops) {
        return Ok(None);
    }
    let mut places = Vec::new();
    let line: Vec<VertexId> = stops
        .into_iter()
        .map(|stop| match stop {
            Stop::Vertex(v) => v,
            Stop::Edge(place) => {
                places.push(place);
                VertexId::from_index(mesh.n_vertices() + places.len() - 1)
            }
        })
        .collect();
    let split = pieces.split(&places, progress)?;
    let next = line.iter().cycle().skip(1);
    let are_joined = (line.iter().zip(next)).all(|(&a, &b)| between(&split.mesh, [a, b]).is_some());
    Ok(are_joined.then_some((split, line)))
}

fn snapped(mesh: &TriangleMesh, stop: Stop, snap: f64) -> Stop {
    let Stop::Edge(Place { edge, share }) = stop else {
        return stop;
    };
    let [a, b] = ends(mesh, edge);
    match share {
        share if share < snap && !mesh.is_border(a) => Stop::Vertex(a),
        share if share > 1.0 - snap && !mesh.is_border(b) => Stop::Vertex(b),
        _ => stop,
    }
}

/// Leaves out what a vertex beside makes needless: itself again, crossings of its edges, and
/// ways that come back.
fn absorbed(mesh: &TriangleMesh, mut stops: Vec<Stop>) -> Vec<Stop> {
    loop {
        let n = stops.len();
        // Twice, so that the ends come to the middle.
        for _ in 0..2 {
            let mut kept: Vec<Stop> = Vec::with_capacity(stops.len());
            for stop in stops {
                while kept.last().is_some_and(|&last| covers(mesh, stop, last)) {
                    kept.pop();
                }
                let is_back = kept.len() > 1 && kept[kept.len() - 2] == stop;
                if is_back && matches!(stop, Stop::Vertex(_)) {
                    kept.pop();
                } else if !kept.last().is_some_and(|&last| covers(mesh, last, stop)) {
                    kept.push(stop);
                }
            }
            let half = kept.len() / 2;
            kept.rotate_left(half);
            stops = kept;
        }
        if stops.len() == n {
            return stops;
        }
    }
}

/// Whether a stop beside another says nothing new.
fn covers(mesh: &TriangleMesh, by: Stop, stop: Stop) -> bool {
    match (by, stop) {
        (Stop::Vertex(v), Stop::Edge(place)) => ends(mesh, place.edge).contains(&v),
        (Stop::Vertex(v), Stop::Vertex(w)) => v == w,
        _ => false,
    }
}

/// Whether no vertex and no edge is passed twice.
fn is_simple(mesh: &TriangleMesh, stops: &[Stop]) -> bool {
    let mut vertices = HashSet::new();
    let mut edges: HashSet<HalfedgeId> = HashSet::new();
    stops.iter().all(|stop| match *stop {
        Stop::Vertex(v) => vertices.insert(v),
        Stop::Edge(place) => {
            let twin = mesh.twin(place.edge).expect("a line crosses no border");
            edges.insert(place.edge.min(twin))
        }
    })
}
