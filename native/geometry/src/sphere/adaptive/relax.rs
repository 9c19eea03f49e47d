//! Making the triangles of a net even on the surface.

use glam::DVec3;

use super::{Net, Report};
use crate::mesh::{HalfedgeId, Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// How many flips or moves pass between two looks at the progress.
const STRIDE: usize = 4096;

/// Flips edges until each faces angles on the surface that sum to less than π, as far as the
/// sphere allows; returns how many.
pub fn flip_to_delaunay(net: &mut Net, progress: &Progress) -> Result<usize, Cancelled> {
    let mut open = edges(net);
    let mut n_flips = 0;
    // On a bent surface the angles can ask for a flip and for its undoing; a few flips an edge are
    // what a random triangulation needs.
    for step in 0..20 * open.len() {
        if step.is_multiple_of(STRIDE) {
            progress.at(0.0)?;
        }
        let Some(h) = open.pop() else { break };
        if faces_obtuse_angles(net, h) && net.flip(h) {
            n_flips += 1;
            let twin = net.triangulation.twin(h);
            open.extend([h.next(), h.prev(), twin.next(), twin.prev()]);
        }
    }
    Ok(n_flips)
}

/// One halfedge of every edge.
fn edges(net: &Net) -> Vec<HalfedgeId> {
    let halfedges = net.triangulation.halfedge_ids();
    halfedges
        .filter(|&h| h < net.triangulation.twin(h))
        .collect()
}

/// The ends of an edge and the corners that face it.
fn quad(net: &Net, h: HalfedgeId) -> [VertexId; 4] {
    let t = &net.triangulation;
    [t.origin(h), t.target(h), t.apex(h), t.apex(t.twin(h))]
}

/// Whether the angles that face an edge sum to more than π.
fn faces_obtuse_angles(net: &Net, h: HalfedgeId) -> bool {
    let [a, b, c, d] = quad(net, h).map(|v| net.position(v));
    let angle = |p: DVec3| ((a - p).dot(b - p), (a - p).cross(b - p).length());
    let [(cos_c, sin_c), (cos_d, sin_d)] = [angle(c), angle(d)];
    // sin (γ + δ) < 0; the margin keeps the flips of a square from going on for ever.
    cos_c * sin_d + cos_d * sin_c < -1e-9 * a.distance_squared(b).powi(2)
}

/// Flips edges where that brings valences nearer to 6 and the new edge is not much longer.
pub fn even_valences(net: &mut Net, progress: &Progress) -> Result<usize, Cancelled> {
    let mut n_flips = 0;
    for (step, h) in edges(net).into_iter().enumerate() {
        if step.is_multiple_of(STRIDE) {
            progress.at(0.3)?;
        }
        let corners = quad(net, h);
        let excess = corners.map(|v| net.triangulation.valence(v) as i64 - 6);
        // The sum of squares falls by 2 (a + b − c − d) − 4.
        let gain = excess[0] + excess[1] - excess[2] - excess[3];
        let [a, b, c, d] = corners.map(|v| net.position(v));
        // Longer than this, the next Delaunay flips undo it.
        if gain > 2 && c.distance(d) < 1.4 * a.distance(b) && net.flip(h) {
            n_flips += 1;
        }
    }
    Ok(n_flips)
}

/// Moves every vertex that is not fixed along the surface to the middle of the triangles around it.
pub fn smooth(
    net: &mut Net,
    (density, is_fixed): (&VertexMap<f64>, &VertexMap<bool>),
    report: &mut Report,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let n_vertices = net.n_vertices();
    for v in net.triangulation.vertex_ids() {
        if v.index().is_multiple_of(STRIDE) {
            progress.at(0.5 + 0.5 * v.index() as f64 / n_vertices as f64)?;
        }
        if is_fixed[v] {
            continue;
        }
        if net.step(v, middle(net, density, v)) {
            report.n_moves += 1;
        } else {
            report.n_refused_moves += 1;
        }
    }
    Ok(())
}

/// The centroid of the triangles around a vertex, weighted by the number of faces wanted in them
/// (Chen & Holst 2011), in the tangent plane.
fn middle(net: &Net, density: &VertexMap<f64>, vertex: VertexId) -> DVec3 {
    let p = net.position(vertex);
    let wanted = |v| {
        let place = net.place(v);
        let corners = net
            .map
            .mesh()
            .face(place.face)
            .map(|corner| density[corner]);
        DVec3::from(corners).dot(DVec3::from(place.weights))
    };
    let (mut sum, mut normal, mut total) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for h in net.triangulation.outgoing(vertex) {
        let ends = [net.triangulation.target(h), net.triangulation.apex(h)];
        let [b, c] = ends.map(|v| net.position(v) - p);
        let cross = b.cross(c);
        let weight = cross.length() * (wanted(vertex) + wanted(ends[0]) + wanted(ends[1]));
        normal += cross;
        sum += (b + c) / 3.0 * weight;
        total += weight;
    }
    if total <= 0.0 {
        return p;
    }
    let shift = sum / total;
    let normal = normal.normalize_or_zero();
    p + shift - normal * normal.dot(shift)
}
