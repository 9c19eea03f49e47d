//! Equal points.

use crate::mesh::{Id, PolygonMesh, VertexId};

/// Which vertices may be welded.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// Every vertex.
    All,
    /// Those with a side that only one polygon has.
    Border,
}

/// For each vertex the first one at exactly the same point, itself if there is none before.
pub(super) fn first_equal(input: &PolygonMesh, reach: Reach) -> Vec<VertexId> {
    let mut first: Vec<VertexId> = (0..input.n_vertices()).map(VertexId::from_index).collect();
    let may_weld = match reach {
        Reach::All => None,
        Reach::Border => Some(on_border(input)),
    };
    let key = |v: u32| input.positions()[v as usize].to_array().map(bits);
    let mut order: Vec<(u64, u32)> = (0..first.len() as u32)
        .filter(|&v| may_weld.as_ref().is_none_or(|may| may[v as usize]))
        .map(|v| (mixed(key(v)), v))
        .collect();
    order.sort_unstable();
    for run in order.chunk_by_mut(|x, y| x.0 == y.0) {
        if run.len() == 1 {
            continue;
        }
        // Different points may share a mixed key.
        run.sort_unstable_by_key(|&(_, v)| (key(v), v));
        for equal in run.chunk_by(|x, y| key(x.1) == key(y.1)) {
            for &(_, v) in equal {
                first[v as usize] = VertexId(equal[0].1);
            }
        }
    }
    first
}

/// The bits of a coordinate; both zeros have the same.
pub(super) fn bits(coordinate: f64) -> u64 {
    (coordinate + 0.0).to_bits()
}

/// One number of three, so that most comparisons of the sort look at one number.
fn mixed(key: [u64; 3]) -> u64 {
    key.into_iter().fold(0, |hash, bits| {
        let product = u128::from(hash ^ bits ^ 0x9e37_79b9_7f4a_7c15) * 0xd6e8_feb8_6659_fd93;
        (product >> 64) as u64 ^ product as u64
    })
}

fn on_border(input: &PolygonMesh) -> Vec<bool> {
    let mut sides: Vec<u64> = Vec::with_capacity(input.corners().len());
    for face in input.faces() {
        let next = face.iter().cycle().skip(1);
        let ends = face.iter().zip(next).filter(|(a, b)| a != b);
        sides.extend(ends.map(|(a, b)| u64::from(a.min(b).0) << 32 | u64::from(a.max(b).0)));
    }
    sides.sort_unstable();
    let mut on_border = vec![false; input.n_vertices()];
    for run in sides.chunk_by(|a, b| a == b).filter(|run| run.len() == 1) {
        on_border[(run[0] >> 32) as usize] = true;
        on_border[run[0] as u32 as usize] = true;
    }
    on_border
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_first_of_equal_points_stands_for_all() {
        let minus = DVec3::new(-0.0, 0.0, -0.0);
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, minus, DVec3::Y, DVec3::Z];
        let mesh = PolygonMesh::from_faces(positions, &[[0, 1, 2], [3, 4, 5]]).unwrap();
        for reach in [Reach::All, Reach::Border] {
            assert_eq!(first_equal(&mesh, reach), [0, 1, 2, 0, 2, 5].map(VertexId));
        }
    }

    #[test]
    fn vertices_inside_a_closed_part_are_not_on_the_border() {
        let positions = vec![
            DVec3::ZERO,
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            DVec3::X,
            DVec3::X,
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3], [3, 4, 5]];
        let mesh = PolygonMesh::from_faces(positions, &faces).unwrap();
        let first = first_equal(&mesh, Reach::Border);
        assert_eq!(first, [0, 1, 2, 3, 4, 4].map(VertexId));
    }
}
