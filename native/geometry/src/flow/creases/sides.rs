//! How many quads of a grid lie on what counts.

use std::collections::{HashMap, HashSet};

/// A way through vertices of a grid.
type Walk = Vec<u32>;

/// Quads that borders part into those that count and those that do not.
pub struct Sides<'a> {
    quads: &'a [[u32; 4]],
    /// The quad on the left of each edge.
    left: HashMap<[u32; 2], usize>,
    /// Whether each of the first vertices of the grid lies on what counts; none on a border.
    is_real: &'a [Option<bool>],
}

/// Quads of two colours.
#[derive(Clone, Copy)]
struct Parted {
    n_first: usize,
    /// For how many corners of quads more the first colour is that of what counts.
    votes: i64,
}

impl<'a> Sides<'a> {
    /// Those of a grid.
    pub fn new(quads: &'a [[u32; 4]], is_real: &'a [Option<bool>]) -> Self {
        let mut left = HashMap::with_capacity(4 * quads.len());
        for (i, quad) in quads.iter().enumerate() {
            left.extend(sides(quad).map(|edge| (edge, i)));
        }
        Self {
            quads,
            left,
            is_real,
        }
    }

    /// How many quads count, where each border runs along one of some walks.
    ///
    /// More than one walk may lead from end to end: of these the one is right that parts the vertices
    /// of which it is known where they lie.
    pub fn n_real(&self, borders: &[Vec<Walk>]) -> usize {
        let choices: Vec<Vec<&Walk>> = borders.iter().map(|walks| distinct(walks)).collect();
        let mut chosen = vec![0; choices.len()];
        let parted = |chosen: &[usize]| {
            let walks = choices.iter().zip(chosen);
            self.parted(walks.filter_map(|(walks, &i)| walks.get(i).copied()))
        };
        let mut best = parted(&chosen);
        for (border, walks) in choices.iter().enumerate() {
            for i in 1..walks.len() {
                let before = std::mem::replace(&mut chosen[border], i);
                let other = parted(&chosen);
                if other.votes.abs() > best.votes.abs() {
                    best = other;
                } else {
                    chosen[border] = before;
                }
            }
        }
        if best.votes > 0 {
            best.n_first
        } else {
            self.quads.len() - best.n_first
        }
    }

    /// Beyond every edge of the walks is the other colour.
    fn parted<'w>(&self, walks: impl Iterator<Item = &'w Walk>) -> Parted {
        let pairs = walks.flat_map(|walk| walk.windows(2));
        let edges: HashSet<[u32; 2]> = pairs
            .flat_map(|pair| [[pair[0], pair[1]], [pair[1], pair[0]]])
            .collect();
        let mut colours: Vec<Option<bool>> = vec![None; self.quads.len()];
        colours[0] = Some(true);
        let mut open = vec![0];
        let mut found = Parted {
            n_first: 0,
            votes: 0,
        };
        while let Some(i) = open.pop() {
            let own = colours[i] == Some(true);
            found.n_first += usize::from(own);
            for [a, b] in sides(&self.quads[i]) {
                if let Some(Some(is_real)) = self.is_real.get(a as usize) {
                    found.votes += if *is_real == own { 1 } else { -1 };
                }
                if let Some(&beyond) = self.left.get(&[b, a])
                    && colours[beyond].is_none()
                {
                    colours[beyond] = Some(own != edges.contains(&[a, b]));
                    open.push(beyond);
                }
            }
        }
        found
    }
}

fn sides(quad: &[u32; 4]) -> [[u32; 2]; 4] {
    [0, 1, 2, 3].map(|i| [quad[i], quad[(i + 1) % 4]])
}

/// The walks that run along other edges than those before them.
fn distinct(walks: &[Walk]) -> Vec<&Walk> {
    let mut found: Vec<&Walk> = Vec::new();
    for walk in walks {
        let is_same = |other: &&Walk| *other == walk || other.iter().rev().eq(walk.iter());
        if !found.iter().any(is_same) {
            found.push(walk);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of so many quads round, and so many rows of them, closed by one cap of a quad at either
    /// end; it has four quads round.
    fn prism(n_rows: u32) -> Vec<[u32; 4]> {
        let id = |row: u32, i: u32| 4 * row + i % 4;
        let mut quads: Vec<[u32; 4]> = (0..n_rows)
            .flat_map(|row| {
                (0..4).map(move |i| {
                    [
                        id(row, i),
                        id(row, i + 1),
                        id(row + 1, i + 1),
                        id(row + 1, i),
                    ]
                })
            })
            .collect();
        quads.push([3, 2, 1, 0]);
        quads.push([0, 1, 2, 3].map(|i| id(n_rows, i)));
        quads
    }

    #[test]
    fn quads_on_the_side_of_known_vertices_count() {
        let quads = prism(5);
        let round = |row: u32| (0..=4).map(|i| 4 * row + i % 4).collect::<Walk>();
        for (real, n) in [(true, 1 + 2 * 4), (false, 1 + 3 * 4)] {
            let is_real = [Some(real); 4];
            let sides = Sides::new(&quads, &is_real);
            assert_eq!(sides.n_real(&[vec![round(2)]]), n);
        }
    }

    #[test]
    fn of_two_walks_the_one_counts_that_parts_what_is_known() {
        let quads = prism(5);
        let round = |row: u32| (0..=4).map(|i| 4 * row + i % 4).collect::<Walk>();
        // The vertices of the first rows lie on one side, those of the third on the other.
        let is_real: Vec<Option<bool>> = (0..16).map(|v| Some(v < 8)).collect();
        let sides = Sides::new(&quads, &is_real);
        let walks = vec![round(4), round(1), round(1).into_iter().rev().collect()];
        assert_eq!(sides.n_real(&[walks]), 1 + 4);
    }
}
