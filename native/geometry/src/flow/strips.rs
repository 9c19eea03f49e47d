//! How the quads of a grid run: strips that close, spirals, lines that close, doubled edges.
//!
//! A strip goes from a quad through opposite edges until it comes back. Where it crosses itself it
//! is a spiral: the artist's loop cut lands twice on one quad. A line goes straight through
//! vertices of four edges; one that closes without touching itself is an edge loop.

use serde::{Deserialize, Serialize};

use crate::chords::{Leaving, end, next};

/// What the connectivity of quads says about their flow.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Strips {
    /// The share of quads that one strip crosses twice.
    pub spiral: f64,
    /// The share of edges on closed lines that do not touch themselves.
    pub loops: f64,
    /// How many strips there are.
    pub n_strips: usize,
}

/// How many halfedges join two vertices a second time, or a vertex to itself across a quad.
///
/// 0 means that the quads are a simple mesh, as far as edges say.
pub fn doubled_edges(quads: &[[u32; 4]], n_vertices: usize) -> usize {
    let leaving = Leaving::new(quads, n_vertices);
    let twice = |v: usize| {
        let mut ends: Vec<u32> = leaving.of(v).iter().map(|&h| end(quads, h)).collect();
        ends.sort_unstable();
        ends.windows(2).filter(|pair| pair[0] == pair[1]).count()
    };
    let pinched = quads
        .iter()
        .map(|q| usize::from(q[0] == q[2]) + usize::from(q[1] == q[3]));
    (0..n_vertices).map(twice).sum::<usize>() + pinched.sum::<usize>()
}

/// Follows every strip and every line of a closed quad mesh; none when edges do not match.
pub fn strips(quads: &[[u32; 4]], n_vertices: usize) -> Option<Strips> {
    let leaving = Leaving::new(quads, n_vertices);
    let twins = leaving.twins(quads)?;
    let (strip_of, n_strips) = follow_strips(&twins);
    let is_spiral = |q: &usize| strip_of[4 * q] == strip_of[4 * q + 1];
    let n_spiral = (0..quads.len()).filter(is_spiral).count();
    let n_looped = edges_on_loops(quads, &leaving, &twins);
    let n = quads.len().max(1) as f64;
    Some(Strips {
        spiral: n_spiral as f64 / n,
        loops: n_looped as f64 / (2.0 * n),
        n_strips,
    })
}

/// The strip that crosses each halfedge, and how many there are.
pub(super) fn follow_strips(twins: &[usize]) -> (Vec<usize>, usize) {
    let mut strip_of = vec![usize::MAX; twins.len()];
    let mut n = 0;
    for first in 0..twins.len() {
        let mut h = first;
        while strip_of[h] == usize::MAX {
            let opposite = next(next(h));
            [strip_of[h], strip_of[opposite]] = [n; 2];
            h = twins[opposite];
        }
        n += usize::from(strip_of[first] == n);
    }
    (strip_of, n)
}

fn edges_on_loops(quads: &[[u32; 4]], leaving: &Leaving, twins: &[usize]) -> usize {
    let mut is_seen = vec![false; twins.len()];
    let mut last_line = vec![usize::MAX; leaving.n_vertices()];
    let mut n_edges = 0;
    for first in 0..twins.len() {
        if is_seen[first] {
            continue;
        }
        let mut line = Vec::new();
        let mut is_loop = true;
        let mut h = first;
        loop {
            is_seen[h] = true;
            line.push(h);
            let end = end(quads, h) as usize;
            is_loop &= last_line[end] != first;
            last_line[end] = first;
            if leaving.of(end).len() != 4 {
                is_loop = false;
                break;
            }
            h = next(twins[next(h)]);
            if is_seen[h] {
                is_loop &= h == first;
                break;
            }
        }
        if is_loop {
            n_edges += line.len();
            for h in line {
                is_seen[twins[h]] = true;
            }
        }
    }
    n_edges
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp)] // No spiral is exactly none.

    use super::*;
    use crate::flow::thin;
    use crate::sphere::{quad_sphere, quad_sphere_counts};

    fn quads_of(n: usize) -> (Vec<[u32; 4]>, usize) {
        let sphere = quad_sphere(quad_sphere_counts(n));
        (thin::quads_of(&sphere), sphere.n_vertices())
    }

    #[test]
    fn a_quad_sphere_has_loops_but_where_lines_meet_its_corners() {
        // A cube of n squares a side: 3 n strips; of its 12 n² edges the 12 n on the cube's own
        // edges end at corners.
        let n = 5;
        let (quads, n_vertices) = quads_of(6 * n * n);
        let strips = strips(&quads, n_vertices).unwrap();
        assert_eq!(strips.n_strips, 3 * n);
        assert_eq!(strips.spiral, 0.0);
        let share = 1.0 - 1.0 / n as f64;
        assert!((strips.loops - share).abs() < 1e-12, "{}", strips.loops);
        assert_eq!(doubled_edges(&quads, n_vertices), 0);
    }

    #[test]
    fn a_quad_folded_on_itself_is_counted() {
        // Two quads glued like a pillow along four edges are simple; a quad with two equal corners
        // and its edges are not.
        let pillow = [[0, 1, 2, 3], [3, 2, 1, 0]];
        assert_eq!(doubled_edges(&pillow, 4), 0);
        let folded = [[0, 1, 0, 2], [0, 1, 0, 2]];
        assert!(doubled_edges(&folded, 3) >= 2);
    }

    #[test]
    fn edges_that_do_not_match_have_no_strips() {
        assert_eq!(strips(&[[0, 1, 2, 3]], 4), None);
        assert_eq!(strips(&[], 0), Some(Strips::default()));
    }
}
