//! Grids of quads, as hair cards and strips of cloth are: found, and made anew with other counts.
//!
//! ```text
//! v  +--+--+--+      corners have one quad, borders two at a vertex, all else four
//! ^  |  |  |  |
//! |  +--+--+--+      lines run at the same shares of the mean length of all rows, columns likewise;
//! +> u               places between are taken from the cells: those of borders lie on borders
//! ```

use std::collections::HashMap;

use glam::DVec3;

use super::faces_on;
use crate::elementary::ln;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};

/// What a share of the count that is missed costs, against a factor by which quads are longer than
/// wide.
const MISSED: f64 = 20.0;

/// A disc that is a grid of quads.
#[derive(Clone, PartialEq, Debug)]
pub struct Grid {
    /// Row by row, each from the first column to the last.
    points: Vec<DVec3>,
    /// How many cells a row and a column have.
    counts: [usize; 2],
    /// The lines across u and across v that stay lines.
    kept: [Vec<usize>; 2],
}

/// The corners of a cell, counterclockwise from where u and v begin.
type Cell = [VertexId; 4];

impl Grid {
    /// A mesh as a grid, if it is one; lines of it with one of some edges, smaller end first, stay.
    pub fn of(mesh: &PolygonMesh, kept: &[[VertexId; 2]]) -> Option<Self> {
        let rows = rows(mesh)?;
        Self::of_rows(mesh, &rows, kept)
    }

    fn of_rows(mesh: &PolygonMesh, rows: &[Vec<Cell>], kept: &[[VertexId; 2]]) -> Option<Self> {
        let counts = [rows[0].len(), rows.len()];
        let is_full = rows.iter().all(|row| row.len() == counts[0]);
        if !is_full || counts[0] * counts[1] != mesh.n_faces() {
            return None;
        }
        let mut names: Vec<VertexId> = Vec::new();
        for row in rows {
            names.extend(row.iter().map(|cell| cell[0]));
            names.push(row[counts[0] - 1][1]);
        }
        let last = &rows[counts[1] - 1];
        names.extend(last.iter().map(|cell| cell[3]));
        names.push(last[counts[0] - 1][2]);
        let mut each = names.clone();
        each.sort_unstable();
        each.dedup();
        // Of a ring the last column is the first again.
        if each.len() != names.len() || each.len() != mesh.n_vertices() {
            return None;
        }
        let at = |i: usize, j: usize| names[j * (counts[0] + 1) + i];
        let has = |a: VertexId, b: VertexId| kept.binary_search(&[a.min(b), a.max(b)]).is_ok();
        let [u, v] = counts;
        let columns = (1..u).filter(|&i| (0..v).any(|j| has(at(i, j), at(i, j + 1))));
        let lines = (1..v).filter(|&j| (0..u).any(|i| has(at(i, j), at(i + 1, j))));
        Some(Self {
            kept: [columns.collect(), lines.collect()],
            points: names.iter().map(|&v| mesh.position(v)).collect(),
            counts,
        })
    }

    fn point(&self, i: usize, j: usize) -> DVec3 {
        self.points[j * (self.counts[0] + 1) + i]
    }

    /// The mean length along u or v up to each line across.
    fn lengths(&self, axis: usize) -> Vec<f64> {
        let [along, across] = [self.counts[axis], self.counts[1 - axis]];
        let at = |k: usize, l: usize| match axis {
            0 => self.point(k, l),
            _ => self.point(l, k),
        };
        let mut lengths = vec![0.0];
        for k in 0..along {
            let sum: f64 = (0..=across).map(|l| at(k, l).distance(at(k + 1, l))).sum();
            lengths.push(lengths[k] + sum / (across + 1) as f64);
        }
        lengths
    }

    /// The counts for about so many quads, as square as can be.
    fn counts_for(&self, n: usize) -> [usize; 2] {
        let whole = |axis: usize| self.lengths(axis)[self.counts[axis]].max(f64::MIN_POSITIVE);
        let wanted = ln(whole(0) / whole(1));
        let cost = |[u, v]: [usize; 2]| {
            let missed = (u * v).abs_diff(n) as f64 / n as f64;
            (ln(u as f64 / v as f64) - wanted).abs() + MISSED * missed
        };
        let both = (1..=n).flat_map(|u| [[u, n / u], [u, n.div_ceil(u)]]);
        let best = both.min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
        best.unwrap_or([1, 1])
    }

    /// The same surface as a grid of about so many quads.
    pub fn remade(&self, n_quads: usize) -> PolygonMesh {
        let counts = self.counts_for(n_quads.max(1));
        let [along, across] =
            [0, 1].map(|axis| shares((&self.lengths(axis), &self.kept[axis]), counts[axis]));
        let mut positions = Vec::with_capacity(along.len() * across.len());
        for &(j, t) in &across {
            for &(i, s) in &along {
                let row = |j: usize| self.point(i, j).lerp(self.point(i + 1, j), s);
                positions.push(row(j).lerp(row(j + 1), t));
            }
        }
        let name = |i: usize, j: usize| (j * (counts[0] + 1) + i) as u32;
        let cells = (0..counts[1]).flat_map(|j| (0..counts[0]).map(move |i| (i, j)));
        let faces = cells.map(|(i, j)| {
            [
                name(i, j),
                name(i + 1, j),
                name(i + 1, j + 1),
                name(i, j + 1),
            ]
        });
        faces_on(positions, &faces.collect::<Vec<_>>())
    }
}

/// The cells of a mesh row by row, from a corner of it; none where they do not end.
fn rows(mesh: &PolygonMesh) -> Option<Vec<Vec<Cell>>> {
    let around = Around::new(mesh)?;
    let first = around.corner(mesh)?;
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut start = Some(first);
    while let Some(cell) = start {
        let mut row = vec![cell];
        while let Some(next) = around.right(row[row.len() - 1]) {
            row.push(next);
            if row.len() > mesh.n_faces() {
                return None;
            }
        }
        start = around.above(cell);
        rows.push(row);
        if rows.len() > mesh.n_faces() {
            return None;
        }
    }
    Some(rows)
}

/// The cells in which even places lie, and where in them; the nearest to each line that is kept lies on
/// it.
fn shares((lengths, kept): (&[f64], &[usize]), n: usize) -> Vec<(usize, f64)> {
    let last = lengths.len() - 1;
    let mut onto: Vec<Option<usize>> = vec![None; n + 1];
    for &line in kept {
        let share = lengths[line] / lengths[last].max(f64::MIN_POSITIVE);
        let nearest = (share * n as f64).round() as usize;
        if (1..n).contains(&nearest) && onto[nearest].is_none() {
            onto[nearest] = Some(line);
        }
    }
    let at = |k: usize| {
        if k == n {
            return (last - 1, 1.0);
        }
        if let Some(line) = onto[k] {
            return (line, 0.0);
        }
        let place = lengths[last] * k as f64 / n as f64;
        let cell = lengths.partition_point(|&l| l <= place).clamp(1, last) - 1;
        let step = lengths[cell + 1] - lengths[cell];
        let share = if step > 0.0 {
            ((place - lengths[cell]) / step).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (cell, share)
    };
    (0..=n).map(at).collect()
}

/// Which cell lies beyond each side.
struct Around {
    /// The face that runs from one vertex to another, and its corner there.
    sides: HashMap<[VertexId; 2], (FaceId, usize)>,
    cells: Vec<Cell>,
}

impl Around {
    /// None where a face is no quad or a side is there twice.
    fn new(mesh: &PolygonMesh) -> Option<Self> {
        let mut sides = HashMap::new();
        let mut cells = Vec::with_capacity(mesh.n_faces());
        for face in mesh.face_ids() {
            let cell = Cell::try_from(mesh.face(face)).ok()?;
            for i in 0..4 {
                let side = [cell[i], cell[(i + 1) % 4]];
                if sides.insert(side, (face, i)).is_some() {
                    return None;
                }
            }
            cells.push(cell);
        }
        Some(Self { sides, cells })
    }

    /// The cell at the first corner of the mesh, from there.
    fn corner(&self, mesh: &PolygonMesh) -> Option<Cell> {
        let mut n_cells = vec![0; mesh.n_vertices()];
        for v in self.cells.iter().flatten() {
            n_cells[v.index()] += 1;
        }
        let cell = self.cells.iter().find_map(|cell| {
            let at = cell.iter().position(|v| n_cells[v.index()] == 1)?;
            Some((*cell, at))
        });
        cell.map(|(cell, at)| turned(cell, at))
    }

    fn right(&self, [_, b, c, _]: Cell) -> Option<Cell> {
        let &(face, at) = self.sides.get(&[c, b])?;
        Some(turned(self.cells[face.index()], at + 1))
    }

    fn above(&self, [_, _, c, d]: Cell) -> Option<Cell> {
        let &(face, at) = self.sides.get(&[d, c])?;
        Some(turned(self.cells[face.index()], at))
    }
}

fn turned(cell: Cell, by: usize) -> Cell {
    [0, 1, 2, 3].map(|i| cell[(i + by) % 4])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curved grid, its vertices and faces in a strange order.
    fn grid(n: u32, m: u32) -> PolygonMesh {
        let name = |i: u32, j: u32| (7 * (j * (n + 1) + i) + 3) % ((n + 1) * (m + 1));
        let mut points = vec![DVec3::ZERO; ((n + 1) * (m + 1)) as usize];
        for (i, j) in (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))) {
            let [x, y] = [f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)];
            points[name(i, j) as usize] = DVec3::new(8.0 * x, y * (2.0 - x), x * x);
        }
        let cells = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
        let faces = cells.map(|(i, j)| {
            let cell = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let turn = ((i + 2 * j) % 4) as usize;
            [0, 1, 2, 3]
                .map(|k| cell[(k + turn) % 4])
                .map(|[i, j]| name(i, j))
        });
        PolygonMesh::from_faces(points, &faces.collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_strip_of_ten_quads_becomes_one_of_eight_between_the_same_corners() {
        let strip = grid(10, 1);
        let made = Grid::of(&strip, &[]).unwrap().remade(8);
        assert_eq!((made.n_faces(), made.n_vertices()), (8, 18));
        for corner in [0.0, 1.0]
            .into_iter()
            .flat_map(|x| [0.0, 1.0].map(|y| [x, y]))
        {
            let [x, y] = corner;
            let corner = DVec3::new(8.0 * x, y * (2.0 - x), x * x);
            let near = |p: &DVec3| p.distance(corner) < 1e-12;
            assert!(made.positions().iter().any(near), "{corner}");
        }
    }

    #[test]
    fn counts_follow_the_shape_and_what_is_no_grid_is_none() {
        for (n, m, wanted) in [(5, 2, 40), (12, 4, 12), (3, 3, 60)] {
            let made = Grid::of(&grid(n, m), &[]).unwrap().remade(wanted);
            assert_eq!(made.n_faces(), wanted, "{n} x {m}");
            assert!(Grid::of(&made, &[]).is_some());
        }
        let mesh = grid(4, 4);
        let faces = |is_left: &dyn Fn(usize) -> bool| {
            let left = mesh.faces().enumerate().filter(|(i, _)| is_left(*i));
            let left = left.map(|(_, face)| face.iter().map(|v| v.0).collect());
            let left: Vec<Vec<u32>> = left.collect();
            PolygonMesh::from_faces(mesh.positions().to_vec(), &left).unwrap()
        };
        for gone in [0, 5, 15] {
            assert!(Grid::of(&faces(&|i| i != gone), &[]).is_none(), "{gone}");
        }
    }
}
