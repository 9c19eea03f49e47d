//! Sheets and thin walls, made thick enough for the grid to show.

use glam::DVec3;

use super::cross::Hits;
use super::field::Field;
use super::flood::Outside;
use super::grid::Grid;
use crate::mesh::{FaceId, Id};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// How far a sheet reaches to either side, in cells. Every place within √3 / 2 cells of a vertex of
/// the grid has one inside then: below, sheets get holes.
pub const REACH: f64 = 0.9;

/// Walls at least as thick as a cell the grid finds by itself.
const THIN: f64 = 1.0;
/// Cosine between the normals of the two sides of a thin wall: within 14° of parallel. Above, bent
/// walls get holes; below, the edges of blades become beads.
const OPPOSITE: f64 = -0.97;

/// All places near sheets.
pub struct Thick(Bvh);

impl Thick {
    /// Near some triangles.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(triangles: &[[DVec3; 3]], progress: &Progress) -> Result<Self, Cancelled> {
        Ok(Self(Bvh::build(triangles, progress)?))
    }
}

impl Field for Thick {
    fn at(&self, p: DVec3) -> f64 {
        let place = self.0.closest_where(p, 4.0 * REACH * REACH, |_| true);
        place.map_or(-REACH, |place| REACH - place.distance_squared.sqrt())
    }

    fn fills(&self) -> bool {
        true
    }
}

/// All places near walls that are thinner than a cell, as near as makes them as thick as a sheet.
pub struct Plates<'a> {
    /// Of triangles that face outward.
    pub tree: &'a Bvh,
    /// Theirs.
    pub normals: &'a [DVec3],
}

impl Plates<'_> {
    /// How thick the wall is at a place of its outside, if it is thin.
    fn thickness(&self, place: DVec3, normal: DVec3) -> Option<f64> {
        let is_opposite = |face: FaceId| self.normals[face.index()].dot(normal) < OPPOSITE;
        let middle = place - normal * (THIN / 2.0);
        let reach = (THIN / 2.0).powi(2);
        let other = self.tree.closest_where(middle, reach, is_opposite)?;
        Some((place - other.position).dot(normal).clamp(0.0, THIN))
    }
}

impl Field for Plates<'_> {
    fn at(&self, p: DVec3) -> f64 {
        let place = self.tree.closest_where(p, 4.0 * REACH * REACH, |_| true);
        let thick = place.and_then(|place| {
            let normal = self.normals[place.face.index()];
            let thickness = self.thickness(place.position, normal)?;
            Some(REACH - thickness / 2.0 - place.distance_squared.sqrt())
        });
        thick.unwrap_or(-REACH)
    }

    fn fills(&self) -> bool {
        true
    }
}

/// Edges of the grid with both ends outside that pass a thin wall.
pub fn thin(
    grid: &Grid,
    (hits, normals): (&Hits, &[DVec3]),
    outside: &Outside,
) -> Vec<(usize, u64)> {
    let mut thin = Vec::new();
    for (axis, hits) in hits.iter().enumerate() {
        let step = grid.step(axis);
        for own in hits.chunk_by(|a, b| a.edge == b.edge) {
            let [first, last] = [own[0], own[own.len() - 1]].map(|hit| normals[hit.of as usize]);
            let edge = own[0].edge;
            let is_wall = first[axis] < 0.0 && last[axis] > 0.0 && first.dot(last) < OPPOSITE;
            if is_wall && [edge, edge + step].iter().all(|&end| outside.contains(end)) {
                thin.push((axis, edge));
            }
        }
    }
    thin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_reaches_to_both_sides() {
        let square = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(DVec3::from_array);
        let thick = Thick::new(&[square], &Progress::none()).unwrap();
        for z in [-0.5, 0.5] {
            assert!((thick.at(DVec3::new(1.0, 1.0, z)) - (REACH - 0.5)).abs() < 1e-12);
            assert!(thick.at(DVec3::new(1.0, 1.0, 9.0 * z)) < 0.0);
        }
    }
}
