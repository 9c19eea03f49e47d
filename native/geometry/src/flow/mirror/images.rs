//! Which vertex of a grid is whose image.

use std::collections::HashMap;

use crate::measure::Seam;
use crate::mesh::{Id, VertexId};

/// The image of every vertex, where the quads are their own image in a plane and all of its seams
/// are there and stay what they are; none where not.
pub fn images(quads: (usize, &[[u32; 4]]), in_plane: &[Option<Seam>]) -> Option<Vec<VertexId>> {
    let first = in_plane.first()?.as_ref()?;
    let images = across(quads, [first.vertices[0], first.vertices[1]])?;
    let stays = |v: &VertexId| images[v.index()] == *v;
    let lies = |seam: &Option<Seam>| seam.as_ref().is_some_and(|s| s.vertices.iter().all(stays));
    in_plane.iter().all(lies).then_some(images)
}

/// The image of every vertex in the line of an edge: quads are compared side by side, from the edge
/// on. None where they are not alike. Linear in time.
fn across(
    (n_vertices, quads): (usize, &[[u32; 4]]),
    [a, b]: [VertexId; 2],
) -> Option<Vec<VertexId>> {
    let mut left = HashMap::with_capacity(4 * quads.len());
    for (q, quad) in quads.iter().enumerate() {
        for i in 0..4 {
            left.insert([quad[i], quad[(i + 1) % 4]], (q, i));
        }
    }
    let mut images = vec![None; n_vertices];
    let mut is_seen = vec![false; quads.len()];
    // Halfedges with their images, whose quads lie on the other side.
    let mut open = vec![([a.0, b.0], [a.0, b.0])];
    while let Some((side, image)) = open.pop() {
        let &(q, i) = left.get(&side)?;
        let &(p, j) = left.get(&[image[1], image[0]])?;
        let corners = [0, 1, 2, 3].map(|k| quads[q][(i + k) % 4]);
        let there = [1, 0, 3, 2].map(|k| quads[p][(j + k) % 4]);
        for (&own, other) in corners.iter().zip(there) {
            if *images[own as usize].get_or_insert(other) != other {
                return None;
            }
        }
        if std::mem::replace(&mut is_seen[q], true) {
            continue;
        }
        for k in 0..4 {
            let [from, to] = [k, (k + 1) % 4];
            open.push(([corners[to], corners[from]], [there[to], there[from]]));
        }
    }
    let images: Option<Vec<u32>> = images.into_iter().collect();
    let images: Vec<VertexId> = images?.into_iter().map(VertexId).collect();
    let is_involution = |(v, image): (usize, &VertexId)| images[image.index()].index() == v;
    images
        .iter()
        .enumerate()
        .all(is_involution)
        .then_some(images)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::CUBE_QUADS;

    #[test]
    fn a_cube_is_its_own_image_in_the_diagonal_plane_of_an_edge() {
        let images = across((8, &CUBE_QUADS), [VertexId(0), VertexId(1)]).unwrap();
        // The edge from 0 to 1 stays, its two sides change places.
        assert_eq!(images, [0, 1, 4, 5, 2, 3, 6, 7].map(VertexId));
    }

    #[test]
    fn quads_that_differ_are_told_apart() {
        // A box of 2 × 1 × 1 in the line of an edge whose sides have different lengths.
        let boxed: [[u32; 4]; 10] = [
            [0, 3, 4, 1],
            [1, 4, 5, 2],
            [6, 7, 10, 9],
            [7, 8, 11, 10],
            [0, 1, 7, 6],
            [1, 2, 8, 7],
            [3, 9, 10, 4],
            [4, 10, 11, 5],
            [0, 6, 9, 3],
            [2, 5, 11, 8],
        ];
        assert_eq!(across((12, &boxed), [VertexId(0), VertexId(6)]), None);
        let middle = across((12, &boxed), [VertexId(1), VertexId(4)]).unwrap();
        assert_eq!(middle[0], VertexId(2));
        assert_eq!(middle[7], VertexId(7));
    }
}
