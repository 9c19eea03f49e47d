//! Reduces a complex to its cones.
//!
//! Edges at a flat vertex are flipped away until three are left, and the three faces become one.
//! The metric stays the same; the vertex is kept as a point inside a face, which every later
//! flip finds again. What is left of a mesh of thousands of vertices is a few hundred edges.

use super::complex::Complex;
use crate::mesh::{HalfedgeId, Id, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// The least sine of an angle made by a flip on the way; below, the metric's digits are lost.
const FLAT: f64 = 1e-9;
/// How many rounds wait for neighbours to go first. Each round admits two more edges a vertex.
const N_ROUNDS: usize = 60;
/// More flips at one vertex than this lead nowhere.
const MOST_FLIPS: usize = 200;

/// Removes every vertex that is flat and not wanted, and makes the result compact and Delaunay.
///
/// Cones always stay. A flat vertex that no flip frees stays too: the result is as valid, it
/// just has one more integral point.
///
/// # Errors
/// When cancelled.
pub fn keep_cones(
    mut complex: Complex,
    is_wanted: &VertexMap<bool>,
    progress: &Progress,
) -> Result<Complex, Cancelled> {
    let is_spare = |v: &VertexId| complex.indices[*v] == 0 && !is_wanted[*v];
    let mut spare: Vec<VertexId> = complex.outgoing.ids().filter(is_spare).collect();
    let n = spare.len().max(1);
    for round in 0..N_ROUNDS {
        let mut later = Vec::new();
        for (i, &vertex) in spare.iter().enumerate() {
            if i.is_multiple_of(1000) {
                progress.at(1.0 - (spare.len() - i + later.len()) as f64 / n as f64)?;
            }
            if !remove(&mut complex, vertex, 6 + 2 * round) {
                later.push(vertex);
            }
        }
        let is_stuck = later.len() == spare.len() && round > N_ROUNDS / 3;
        spare = later;
        if spare.is_empty() || is_stuck {
            break;
        }
    }
    complex.compact();
    complex.delaunay();
    Ok(complex)
}

fn remove(complex: &mut Complex, vertex: VertexId, most_edges: usize) -> bool {
    let mut fan: Vec<HalfedgeId> = complex.fan(vertex).take(most_edges + 1).collect();
    if fan.len() > most_edges {
        return false;
    }
    for _ in 0..MOST_FLIPS {
        if fan.len() <= 3 {
            break;
        }
        // A vertex in the middle of a straight line leaves a flat face, which goes with it.
        let least = if fan.len() == 4 { -FLAT } else { FLAT };
        let Some(h) = best_flip(complex, vertex, (&fan, least)) else {
            break;
        };
        complex.flip(h);
        fan.clear();
        fan.extend(complex.fan(vertex));
        if fan.len() == 3 && !is_removable(complex, vertex, &fan) {
            complex.flip(h);
            return false;
        }
    }
    if !is_removable(complex, vertex, &fan) {
        return false;
    }
    let h = complex.remove_vertex(fan[0]);
    complex.delaunay_from(&mut vec![h, h.next(), h.prev()]);
    true
}

/// The edge whose flip leaves the widest angles, none with a sine of the `least` or below; an edge
/// from the vertex to itself goes first.
fn best_flip(
    complex: &Complex,
    vertex: VertexId,
    (fan, least): (&[HalfedgeId], f64),
) -> Option<HalfedgeId> {
    let mut best = None;
    for &h in fan {
        let Some(sine) = complex.flipped_sine(h).filter(|&sine| sine > least) else {
            continue;
        };
        let is_loop = complex.target(h) == vertex;
        let merit = sine + if is_loop { 10.0 } else { 0.0 };
        if best.is_none_or(|(most, _)| merit > most) {
            best = Some((merit, h));
        }
    }
    best.map(|(_, h)| h)
}

fn is_removable(complex: &Complex, vertex: VertexId, fan: &[HalfedgeId]) -> bool {
    let &[a, b, c] = fan else {
        return false;
    };
    let faces = [a, b, c].map(|h| h.face().index());
    faces[0] != faces[1]
        && faces[1] != faces[2]
        && faces[2] != faces[0]
        && fan.iter().all(|&h| complex.target(h) != vertex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::complex::tests::box_complex;

    fn nobody(complex: &Complex) -> VertexMap<bool> {
        VertexMap::filled(complex.n_vertices(), false)
    }

    #[test]
    fn a_box_is_reduced_to_its_corners() {
        let complex = box_complex(6);
        let n = complex.n_vertices();
        let wanted = nobody(&complex);
        let area = complex.area();
        let cones = keep_cones(complex, &wanted, &Progress::none()).unwrap();
        cones.check().unwrap();
        assert_eq!([cones.n_vertices(), cones.n_faces()], [8, 12]);
        assert_eq!(cones.located.points().len(), n - 8);
        assert!((cones.area() - area).abs() < 1e-9);
        for h in cones.halfedge_ids() {
            assert!(cones.start[h].distance(cones.wish[h]) < 1e-9);
            assert!(cones.start[h].distance(cones.start[h].round()) < 1e-9);
        }
    }

    #[test]
    fn a_wanted_vertex_stays() {
        let complex = box_complex(4);
        let mut wanted = nobody(&complex);
        let flat = complex
            .indices
            .ids()
            .find(|&v| complex.indices[v] == 0)
            .unwrap();
        wanted[flat] = true;
        let cones = keep_cones(complex, &wanted, &Progress::none()).unwrap();
        cones.check().unwrap();
        assert_eq!([cones.n_vertices(), cones.n_faces()], [9, 14]);
        assert!(cones.original.contains(&flat));
    }

    #[test]
    fn every_vertex_is_a_cone_or_located_once() {
        let complex = box_complex(5);
        let n = complex.n_vertices();
        let wanted = nobody(&complex);
        let cones = keep_cones(complex, &wanted, &Progress::none()).unwrap();
        let points = cones.located.points().iter().map(|p| p.vertex);
        let mut all: Vec<VertexId> = cones.original.iter().copied().chain(points).collect();
        all.sort_unstable();
        assert!(all.into_iter().eq((0..n).map(VertexId::from_index)));
    }
}
