//! Vertices with two quads alone: both become one.

use crate::mesh::{Id, VertexId};

/// Fewer quads than this are left as they are: six cover a sphere like a cube.
const FEWEST: usize = 6;
/// No quad.
const GONE: [u32; 4] = [u32::MAX; 4];

/// Joins the two quads of every vertex that has no others and is not held, as long as what comes
/// out is a quad whose diagonal from the first corner to the third is inside. Returns the vertices
/// that are left, in their order.
pub(super) fn without(
    quads: &mut Vec<[u32; 4]>,
    is_held: &[bool],
    is_inside: &dyn Fn([u32; 4]) -> bool,
) -> Vec<VertexId> {
    let n = is_held.len();
    let mut rings: Vec<Vec<u32>> = vec![Vec::new(); n];
    for (i, quad) in (0..).zip(&*quads) {
        for &v in quad {
            rings[v as usize].push(i);
        }
    }
    let mut n_left = quads.len();
    let mut queue: Vec<u32> = (0..n as u32).rev().collect();
    while let Some(v) = queue.pop() {
        if is_held[v as usize] {
            continue;
        }
        let &[first, second] = &rings[v as usize][..] else {
            continue;
        };
        let both = [quads[first as usize], quads[second as usize]];
        let Some(joined) = joined(both, v, is_inside) else {
            continue;
        };
        if n_left <= FEWEST {
            break;
        }
        n_left -= 1;
        rings[v as usize].clear();
        for u in quads[second as usize] {
            rings[u as usize].retain(|&quad| quad != second);
        }
        for u in joined {
            if !rings[u as usize].contains(&first) {
                rings[u as usize].push(first);
            }
            queue.push(u);
        }
        quads[first as usize] = joined;
        quads[second as usize] = GONE;
    }
    quads.retain(|quad| *quad != GONE);
    let vertices = (0..n).filter(|&v| is_held[v] || !rings[v].is_empty());
    vertices.map(VertexId::from_index).collect()
}

/// The quad around a vertex with two quads, from one end of an inner diagonal.
fn joined(
    [one, other]: [[u32; 4]; 2],
    v: u32,
    is_inside: &dyn Fn([u32; 4]) -> bool,
) -> Option<[u32; 4]> {
    let around = |quad: [u32; 4]| {
        let at = quad.iter().position(|&u| u == v)?;
        Some([1, 2, 3].map(|step| quad[(at + step) % 4]))
    };
    let [a, b, c] = around(one)?;
    let [d, e, f] = around(other)?;
    if [a, c] != [f, d] || b == e {
        return None;
    }
    let ways = [[a, b, c, e], [b, c, e, a]];
    ways.into_iter().find(|&quad| is_inside(quad))
}
