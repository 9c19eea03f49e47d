//! How the surface passes a cell, for each of the 256 patterns of its corners.
//!
//! Corner i of a cell lies up along an axis for every bit of i; a pattern has a bit for every corner
//! that is inside. Edge `4 axis + b + 2 c` runs along an axis, up or not along the two that follow.
//! On a face the surface runs from edge to edge; where it passes twice, each outside corner is cut
//! off by itself. These ways join to closed loops round the cell, each of which bounds one piece of
//! surface with a vertex of its own [nielson2004dual, schaefer2007manifold].

use super::grid::others;
use crate::groups::Groups;

/// The ways of the surface over one face: up to two, each between two edges.
pub type Ways = [Option<[u8; 2]>; 2];

/// What a pattern means.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pattern {
    /// How many loops there are.
    pub n_loops: u8,
    /// The loop of each edge that the surface crosses.
    pub loop_of: [Option<u8>; 12],
    /// The ways over the faces: for each axis the low one and the high one.
    pub ways: [[Ways; 2]; 3],
}

/// All patterns.
pub struct Table(Vec<Pattern>);

/// The two ends of an edge of a cell, the low one first.
pub fn corners(edge: usize) -> [usize; 2] {
    let axis = edge / 4;
    let [b, c] = others(axis);
    let low = ((edge & 1) << b) | (((edge >> 1) & 1) << c);
    [low, low | 1 << axis]
}

/// The edge of a cell along an axis, up or not along the two that follow.
pub fn edge(axis: usize, [b, c]: [usize; 2]) -> usize {
    4 * axis + b + 2 * c
}

impl Table {
    pub fn new() -> Self {
        Self((0..=u8::MAX).map(Pattern::new).collect())
    }

    pub fn of(&self, signs: u8) -> &Pattern {
        &self.0[signs as usize]
    }
}

impl Pattern {
    fn new(signs: u8) -> Self {
        let mut pattern = Self::default();
        let mut groups = Groups::new(12);
        for axis in 0..3 {
            for side in 0..2 {
                let ways = ways(signs, (axis, side));
                pattern.ways[axis][side] = ways;
                for [e, f] in ways.into_iter().flatten() {
                    groups.link(e as usize, f as usize);
                }
            }
        }
        let mut names = [None; 12];
        for e in 0..12 {
            let [low, high] = corners(e).map(|corner| signs >> corner & 1);
            if low == high {
                continue;
            }
            let root = groups.root(e);
            let name = *names[root].get_or_insert_with(|| {
                pattern.n_loops += 1;
                pattern.n_loops - 1
            });
            pattern.loop_of[e] = Some(name);
        }
        pattern
    }

    /// Whether the surface passes a face twice.
    pub fn is_double(&self, axis: usize, side: usize) -> bool {
        self.ways[axis][side][1].is_some()
    }
}

fn ways(signs: u8, (axis, side): (usize, usize)) -> Ways {
    let [b, c] = others(axis);
    // Round the face: corners, and the edges that lead to the next one.
    let ring = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let is_inside = ring.map(|[u, v]| signs >> (side << axis | u << b | v << c) & 1 == 1);
    let edges = ring.map(|at| match at {
        [0, 0] => edge(b, [0, side]),
        [1, 0] => edge(c, [side, 1]),
        [1, 1] => edge(b, [1, side]),
        _ => edge(c, [side, 0]),
    });
    let crossed: Vec<usize> = (0..4)
        .filter(|&i| is_inside[i] != is_inside[(i + 1) % 4])
        .collect();
    let way = |i: usize, j: usize| Some([edges[i] as u8, edges[j] as u8]);
    match crossed[..] {
        [] => [None; 2],
        [i, j] => [way(i, j), None],
        _ if is_inside[0] => [way(0, 1), way(2, 3)],
        _ => [way(3, 0), way(1, 2)],
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn middle(edge: usize) -> DVec3 {
        let [low, high] = corners(edge).map(|corner| {
            DVec3::from_array([0, 1, 2].map(|axis| f64::from((corner >> axis & 1) as u8)))
        });
        low.midpoint(high)
    }

    #[test]
    fn ways_lie_on_their_faces_and_every_crossed_edge_has_two() {
        let table = Table::new();
        for signs in 0..=u8::MAX {
            let pattern = table.of(signs);
            let mut n = [0; 12];
            for axis in 0..3 {
                for side in 0..2 {
                    for e in pattern.ways[axis][side].into_iter().flatten().flatten() {
                        n[e as usize] += 1;
                        assert!((middle(e as usize)[axis] - side as f64).abs() < 1e-12);
                    }
                }
            }
            for (e, n) in n.into_iter().enumerate() {
                let is_crossed = pattern.loop_of[e].is_some();
                assert_eq!(n, if is_crossed { 2 } else { 0 }, "{signs:08b} {e}");
            }
        }
        assert_eq!(table.of(0b1000_0001).n_loops, 2);
        assert_eq!(table.of(0b1001_0110).n_loops, 4);
    }

    #[test]
    fn what_two_cells_share_they_see_alike() {
        // The high face of one is the low face of the next.
        for face in 0..16u8 {
            for axis in 0..3 {
                let [b, c] = others(axis);
                let signs = |side: usize| {
                    let bit = |i: usize| {
                        let corner = side << axis | (i & 1) << b | (i >> 1) << c;
                        (face >> i & 1) << corner
                    };
                    (0..4).map(bit).sum::<u8>()
                };
                let [low, high] = [1, 0].map(|side| {
                    ways(signs(side), (axis, side)).map(|way| {
                        way.map(|edges| {
                            edges.map(|e| middle(e as usize).with_axis(axis, 0.0).to_array())
                        })
                    })
                });
                assert_eq!(low, high);
            }
        }
    }

    trait WithAxis {
        fn with_axis(self, axis: usize, value: f64) -> Self;
    }

    impl WithAxis for DVec3 {
        fn with_axis(mut self, axis: usize, value: f64) -> Self {
            self[axis] = value;
            self
        }
    }

    /// What lies between the crossed edges of a loop does not meet what lies between those of
    /// another: this is why pieces of one cell do not cross.
    #[test]
    fn loops_of_a_cell_lie_on_two_sides_of_a_plane() {
        let table = Table::new();
        let mut n = 0;
        for signs in 0..=u8::MAX {
            let pattern = table.of(signs);
            for one in 0..pattern.n_loops {
                for other in 0..one {
                    let ends = |name: u8| -> Vec<DVec3> {
                        let own = (0..12).filter(|&e| pattern.loop_of[e] == Some(name));
                        let ends = own.flat_map(corners);
                        ends.map(|corner| {
                            DVec3::from_array([0, 1, 2].map(|a| (corner >> a & 1) as f64))
                        })
                        .collect()
                    };
                    let [one, other] = [ends(one), ends(other)];
                    let is_parted = (0..27).any(|i| {
                        let normal = DVec3::from_array(
                            [i % 3, i / 3 % 3, i / 9].map(|x| f64::from(x) - 1.0),
                        );
                        let least = one
                            .iter()
                            .map(|p| p.dot(normal))
                            .fold(f64::INFINITY, f64::min);
                        let most = other
                            .iter()
                            .map(|p| p.dot(normal))
                            .fold(f64::NEG_INFINITY, f64::max);
                        normal != DVec3::ZERO && least >= most
                    });
                    assert!(is_parted, "{signs:08b}");
                    n += 1;
                }
            }
        }
        assert!(n > 60, "{n}");
    }
}
