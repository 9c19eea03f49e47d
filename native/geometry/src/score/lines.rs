//! How far edges and quads run straight on.

use serde::Serialize;

use super::statistics::{median, share};
use super::surface::Surface;
use crate::groups::Groups;
use crate::mesh::Id;
use crate::progress::{Cancelled, Progress};

/// Chains of edges that go straight through inner vertices of four quads; none without quads.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Chains {
    /// ↑ Mean number of edges in a chain.
    pub chain_mean: Option<f64>,
    /// ↑ Its median over chains.
    pub chain_median: Option<f64>,
    /// ↑ Its median over edges: the chain on which half of the edges lie.
    pub chain_edge_median: Option<f64>,
    /// ↑ Share of edges on chains that close without crossing themselves.
    pub loop_edges_pct: Option<f64>,
}

/// Strips of quads joined across opposite edges; none without quads.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Strips {
    /// How many there are; very few, very long ones are spirals.
    pub strips: Option<usize>,
    /// The median of their lengths.
    pub strip_median: Option<f64>,
    /// ↓ Share of quads both of whose strips are one.
    pub spiral_pct: Option<f64>,
}

pub fn chains(surface: &Surface, progress: &Progress) -> Result<Chains, Cancelled> {
    if surface.mesh.n_quads() == 0 {
        return Ok(Chains::default());
    }
    let edges = &surface.edges;
    let onward = straight_on(surface);
    progress.check()?;
    let mut groups = Groups::new(edges.len());
    let mut is_end = vec![false; edges.len()];
    for (corner, onward) in onward.into_iter().enumerate() {
        progress.check()?;
        let edge = edges.of_corner[corner] as usize;
        match onward {
            Some(next) => {
                groups.link(edge, edges.of_corner[next] as usize);
            }
            None => is_end[edge] = true,
        }
    }
    let (chain, n) = groups.numbered();
    let lengths = counts(&chain, n);
    let mut is_loop = vec![true; n];
    for (&chain, _) in chain.iter().zip(is_end).filter(|(_, end)| *end) {
        is_loop[chain as usize] = false;
    }
    progress.check()?;
    drop_crossed(surface, &chain, &lengths, &mut is_loop);
    progress.check()?;
    let of_edges: Vec<u32> = chain.iter().map(|&c| lengths[c as usize]).collect();
    Ok(Chains {
        chain_mean: Some(edges.len() as f64 / n as f64),
        chain_median: Some(median(&lengths)),
        chain_edge_median: Some(median(&of_edges)),
        loop_edges_pct: Some(100.0 * share(&chain, |&c| is_loop[c as usize])),
    })
}

/// For each corner's halfedge the one that continues it straight through its end.
fn straight_on(surface: &Surface) -> Vec<Option<usize>> {
    let (mesh, edges) = (surface.mesh, &surface.edges);
    let n = mesh.n_vertices();
    let mut is_regular: Vec<bool> = edges
        .border_vertices(n)
        .iter()
        .zip(edges.valences(n))
        .map(|(b, v)| !b && v == 4)
        .collect();
    for v in mesh.faces().filter(|face| face.len() != 4).flatten() {
        is_regular[v.index()] = false;
    }
    let onward = |corner| {
        let next = edges.next(corner);
        let passes = is_regular[mesh.corners()[next].index()];
        edges
            .twin(next)
            .filter(|_| passes)
            .map(|across| edges.next(across))
    };
    (0..edges.n_corners()).map(onward).collect()
}

/// Leaves out loops that have fewer vertices than edges: they cross themselves.
fn drop_crossed(surface: &Surface, chain: &[u32], lengths: &[u32], is_loop: &mut [bool]) {
    let of_loops = chain.iter().zip(&surface.edges.ends);
    let of_loops = of_loops.filter(|&(&c, _)| is_loop[c as usize]);
    let mut touches: Vec<_> = of_loops
        .flat_map(|(&c, ends)| ends.map(|v| (c, v)))
        .collect();
    touches.sort_unstable();
    touches.dedup();
    let n_vertices = counts(
        &touches.into_iter().map(|(c, _)| c).collect::<Vec<_>>(),
        lengths.len(),
    );
    for (is_loop, (vertices, edges)) in is_loop.iter_mut().zip(n_vertices.iter().zip(lengths)) {
        *is_loop &= vertices == edges;
    }
}

fn counts(group: &[u32], n: usize) -> Vec<u32> {
    let mut counts = vec![0; n];
    for &g in group {
        counts[g as usize] += 1;
    }
    counts
}

pub fn strips(surface: &Surface) -> Strips {
    let edges = &surface.edges;
    let starts = surface
        .mesh
        .starts()
        .windows(2)
        .filter(|w| w[1] - w[0] == 4);
    let quads: Vec<[usize; 4]> = starts
        .map(|w| [0, 1, 2, 3].map(|i| edges.of_corner[w[0] as usize + i] as usize))
        .collect();
    if quads.is_empty() {
        return Strips::default();
    }
    let mut groups = Groups::new(edges.len());
    for &[a, b, c, d] in &quads {
        groups.link(a, c);
        groups.link(b, d);
    }
    let (strip, n) = groups.numbered();
    let crossings: Vec<[u32; 2]> = quads.iter().map(|q| [strip[q[0]], strip[q[1]]]).collect();
    let mut lengths = counts(crossings.as_flattened(), n);
    lengths.retain(|&length| length > 0);
    Strips {
        strips: Some(lengths.len()),
        strip_median: Some(median(&lengths)),
        spiral_pct: Some(100.0 * share(&crossings, |[a, b]| a == b)),
    }
}
