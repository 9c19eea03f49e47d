//! The grid: cells of side 1 around everything, known by the number of their low corner.
//!
//! Its middle is the middle of a cell and of the box of what comes in, so that what is symmetric
//! stays so.

use glam::{DVec3, UVec3};

/// Vertices between the box and the rim of the grid: what is made thick and what bulges lies inside.
const RIM: f64 = 4.0;

/// Vertices at whole numbers, from 0 to one less than the size.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    origin: DVec3,
    cell: f64,
    /// How many vertices there are along each axis.
    size: UVec3,
}

/// The two axes that follow an axis.
pub fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

impl Grid {
    /// The grid around a box; none where it would have more rows than there are numbers for.
    pub fn around([low, high]: [DVec3; 2], cell: f64) -> Option<Self> {
        let half = ((high - low) / (2.0 * cell)).ceil() + RIM;
        if half.max_element() > f64::from(u16::MAX) {
            return None;
        }
        let size = 2 * half.as_uvec3();
        Some(Self {
            origin: low.midpoint(high) - (half - 0.5) * cell,
            cell,
            size,
        })
    }

    /// A place of space in the grid.
    pub fn enter(&self, p: DVec3) -> DVec3 {
        (p - self.origin) / self.cell
    }

    /// A place of the grid in space.
    pub fn leave(&self, p: DVec3) -> DVec3 {
        p * self.cell + self.origin
    }

    /// How many rows along x there are.
    pub fn n_rows(&self) -> usize {
        self.size.y as usize * self.size.z as usize
    }

    /// How many vertices a row along an axis has.
    pub fn length(&self, axis: usize) -> u64 {
        u64::from(self.size[axis])
    }

    /// The number of a vertex.
    pub fn key(&self, at: [u64; 3]) -> u64 {
        (at[2] * self.length(1) + at[1]) * self.length(0) + at[0]
    }

    /// The vertex of a number.
    pub fn vertex(&self, key: u64) -> [u64; 3] {
        let (row, x) = (key / self.length(0), key % self.length(0));
        [x, row % self.length(1), row / self.length(1)]
    }

    /// Where that vertex is.
    pub fn place(&self, key: u64) -> DVec3 {
        DVec3::from_array(self.vertex(key).map(|x| x as f64))
    }

    /// By how much the next vertex along an axis has a larger number.
    pub fn step(&self, axis: usize) -> u64 {
        match axis {
            0 => 1,
            1 => self.length(0),
            _ => self.length(0) * self.length(1),
        }
    }

    /// The four cells around an edge along an axis, counter-clockwise as seen from its end.
    pub fn around_edge(&self, axis: usize, edge: u64) -> [u64; 4] {
        let [b, c] = others(axis).map(|other| self.step(other));
        [edge, edge - b, edge - b - c, edge - c]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_have_numbers_and_the_middle_is_that_of_a_cell() {
        let corners = [DVec3::new(-1.0, 0.0, 2.0), DVec3::new(3.0, 1.0, 2.5)];
        let grid = Grid::around(corners, 0.25).unwrap();
        let key = grid.key([5, 3, 7]);
        assert_eq!(grid.vertex(key), [5, 3, 7]);
        for axis in 0..3 {
            let next = grid.place(key + grid.step(axis)) - grid.place(key);
            assert_eq!(next, DVec3::AXES[axis]);
        }
        let middle = grid.enter(corners[0].midpoint(corners[1]));
        assert_eq!(middle.fract(), DVec3::splat(0.5));
        for corner in corners {
            assert!((grid.leave(grid.enter(corner)) - corner).length() < 1e-12);
            assert!(grid.enter(corner).min_element() >= 3.0);
        }
        assert!(Grid::around(corners, 1e-6).is_none());
    }
}
