//! Edges along which data on corners is cut, as texture coordinates are along seams.

use std::collections::HashMap;

use glam::DVec3;

use crate::mesh::{PolygonMesh, VertexId};

/// The sides of all faces, those of one edge together, as they are once borders are welded: where a
/// seam is split, as files for games split it, the two borders that lie on each other are one edge.
#[derive(Clone, Debug)]
pub struct Seams {
    /// The two corners of every side, in the same order of places for all sides of an edge.
    sides: Vec<[u32; 2]>,
    /// Where the sides of every edge begin, and their end.
    starts: Vec<usize>,
    corners: Vec<VertexId>,
    /// The first vertex at the place of every vertex on a border.
    places: Vec<u32>,
    /// For some of these all that are near, themselves among them.
    twins: HashMap<u32, Vec<u32>>,
}

/// A side of a face while its edge is looked for.
struct Side {
    corners: [u32; 2],
    names: [u64; 2],
}

impl Seams {
    /// Finds out which sides of faces are on one edge.
    ///
    /// Sides share an edge that share its two vertices. Those that have nobody beside them look for
    /// others at the same places, and where there are none, for some within `weld`, a share of the
    /// diagonal. Costs O(n log n).
    pub fn new(mesh: &PolygonMesh, weld: Option<f64>) -> Self {
        let corners = mesh.corners();
        let mut sides = sides(mesh);
        let n = mesh.n_vertices() as u64;
        let mut places: Vec<u32> = (0..mesh.n_vertices() as u32).collect();
        let single = alone(&sides, (0..sides.len()).collect());
        let ends = |sides: &[Side], which: &[usize]| -> Vec<u32> {
            let ends = which.iter().flat_map(|&i| sides[i].corners);
            ends.map(|c| corners[c as usize].0).collect()
        };
        name_places(mesh, &ends(&sides, &single), &mut places);
        for &i in &single {
            let place = |c: u32| n + u64::from(places[corners[c as usize].0 as usize]);
            sides[i].names = sides[i].corners.map(place);
        }
        let border = alone(&sides, single);
        let mut on_border = ends(&sides, &border);
        for v in &mut on_border {
            *v = places[*v as usize];
        }
        let twins = weld.map_or_else(HashMap::new, |share| twins(mesh, on_border, share));
        for i in border {
            let near = |c: u32| {
                let place = places[corners[c as usize].0 as usize];
                let first = twins.get(&place).map_or(place, |near| near[0]);
                2 * n + u64::from(first)
            };
            sides[i].names = sides[i].corners.map(near);
        }
        Self::sorted(sides, (corners, places), twins)
    }

    fn sorted(
        mut sides: Vec<Side>,
        (corners, places): (&[VertexId], Vec<u32>),
        twins: HashMap<u32, Vec<u32>>,
    ) -> Self {
        for side in &mut sides {
            if side.names[0] > side.names[1] {
                side.names.reverse();
                side.corners.reverse();
            }
        }
        sides.sort_by_key(|side| (side.names, side.corners));
        let mut starts = vec![0];
        for run in sides.chunk_by(|a, b| a.names == b.names) {
            starts.push(starts[starts.len() - 1] + run.len());
        }
        Self {
            sides: sides.into_iter().map(|side| side.corners).collect(),
            starts,
            corners: corners.to_vec(),
            places,
            twins,
        }
    }

    /// The edges at which what lies on corners is `apart`, by all vertices that a weld may take for
    /// their ends. What is told apart are two corners at one place.
    pub fn cuts(&self, apart: impl Fn(usize, usize) -> bool) -> Vec<[VertexId; 2]> {
        let mut cuts = Vec::new();
        for run in self.starts.windows(2) {
            let sides = &self.sides[run[0]..run[1]];
            let first = sides[0];
            let differs = |side: &[u32; 2]| {
                let ends = side.iter().zip(first);
                ends.into_iter()
                    .any(|(&one, other)| apart(one as usize, other as usize))
            };
            if !sides[1..].iter().any(differs) {
                continue;
            }
            let ends = first.map(|c| self.corners[c as usize]);
            cuts.push(ends);
            let [near, far] = ends.map(|v| self.near(v));
            let more = near.iter().flat_map(|&a| far.iter().map(move |&b| [a, b]));
            cuts.extend(more.filter(|pair| *pair != ends));
        }
        cuts
    }

    /// The vertices that a weld may take for this one.
    fn near(&self, vertex: VertexId) -> Vec<VertexId> {
        let twins = self.twins.get(&self.places[vertex.0 as usize]);
        let twins = twins.map(|near| near.iter().map(|&v| VertexId(v)).collect());
        twins.unwrap_or_else(|| vec![vertex])
    }
}

fn sides(mesh: &PolygonMesh) -> Vec<Side> {
    let corners = mesh.corners();
    let faces = mesh.starts().windows(2);
    let sides = faces.flat_map(|face| {
        let (first, end) = (face[0], face[1]);
        (first..end).map(move |c| [c, if c + 1 == end { first } else { c + 1 }])
    });
    let named = sides.map(|ends| Side {
        corners: ends,
        names: ends.map(|c| u64::from(corners[c as usize].0)),
    });
    named.collect()
}

/// Those of some sides that no other of them has the names of.
fn alone(sides: &[Side], mut which: Vec<usize>) -> Vec<usize> {
    let key = |&i: &usize| {
        let [a, b] = sides[i].names;
        [a.min(b), a.max(b)]
    };
    which.sort_by_key(key);
    let runs = which.chunk_by(|a, b| key(a) == key(b));
    runs.filter(|run| run.len() == 1)
        .map(|run| run[0])
        .collect()
}

/// Names some vertices by the first of them at the same place.
fn name_places(mesh: &PolygonMesh, some: &[u32], places: &mut [u32]) {
    // Both zeros are one place.
    let at = |v: u32| {
        (mesh.position(VertexId(v)) + 0.0)
            .to_array()
            .map(f64::to_bits)
    };
    let mut sorted: Vec<_> = some.iter().map(|&v| (at(v), v)).collect();
    sorted.sort_unstable();
    for run in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, v) in run {
            places[v as usize] = run[0].1;
        }
    }
}

/// Of vertices at different places those that others are near, and all that are near them.
fn twins(mesh: &PolygonMesh, mut some: Vec<u32>, share: f64) -> HashMap<u32, Vec<u32>> {
    some.sort_unstable();
    some.dedup();
    let [low, high] = mesh.bounds();
    let reach = share * (high - low).length();
    if reach <= 0.0 {
        return HashMap::new();
    }
    let cell = |p: DVec3| ((p - low) / reach).floor().to_array().map(|x| x as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for &v in &some {
        cells
            .entry(cell(mesh.position(VertexId(v))))
            .or_default()
            .push(v);
    }
    let near = |&v: &u32| {
        let p = mesh.position(VertexId(v));
        let [x, y, z] = cell(p);
        let around =
            (0..27).filter_map(|i| cells.get(&[x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]));
        let is_near = |v: &u32| mesh.position(VertexId(*v)).distance(p) <= reach;
        let mut near: Vec<u32> = around.flatten().copied().filter(is_near).collect();
        near.sort_unstable();
        (near.len() > 1).then_some((v, near))
    };
    some.iter().filter_map(near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares side by side that share no vertex, `gap` apart.
    fn split(gap: f64) -> PolygonMesh {
        let squares = [0.0, 1.0 + gap].map(|x| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec3::new(x + u, v, 0.0))
        });
        PolygonMesh::from_faces(squares.concat(), &[[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap()
    }

    fn cuts(mesh: &PolygonMesh, weld: Option<f64>) -> Vec<[u32; 2]> {
        let face = |corner: usize| corner / 4;
        let cuts = Seams::new(mesh, weld).cuts(|a, b| face(a) != face(b));
        cuts.iter().map(|ends| ends.map(|v| v.0)).collect()
    }

    #[test]
    fn a_shared_edge_is_cut_where_its_faces_differ_and_not_elsewhere() {
        let positions = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (0.0, 1.0),
            (1.0, 1.0),
            (2.0, 1.0),
        ];
        let positions = positions.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let mesh = PolygonMesh::from_faces(positions, &[[0, 1, 4, 3], [1, 2, 5, 4]]).unwrap();
        assert_eq!(cuts(&mesh, None), [[1, 4]]);
        assert!(Seams::new(&mesh, None).cuts(|_, _| false).is_empty());
    }

    #[test]
    fn a_split_seam_is_one_edge_also_across_a_gap_that_is_welded() {
        assert_eq!(cuts(&split(0.0), None), [[1, 2]]);
        let across = cuts(&split(1e-6), Some(1e-5));
        for ends in [[1, 2], [4, 7], [1, 7], [4, 2]] {
            assert!(across.contains(&ends), "{ends:?} of {across:?}");
        }
        assert_eq!(cuts(&split(1e-6), None), [[0; 2]; 0]);
        assert_eq!(cuts(&split(1e-3), Some(1e-5)), [[0; 2]; 0]);
    }
}
