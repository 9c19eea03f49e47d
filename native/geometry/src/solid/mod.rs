//! Makes one closed surface of many: of shells that intersect, walls that are double, cavities, open
//! scraps.
//!
//! ```text
//! triangles ─ cross ─▶ hits of a grid's edges ─ flood ─▶ outside ─ cells ─▶ crossed edges ─ contour ─▶ closed surface
//!                      shells with borders: + winding, + thickened sheets
//! ```
//!
//! What cannot be reached from outside without crossing a triangle is inside, so cavities are filled
//! and shells may face either way. A shell with borders lets the flood in: where the generalised
//! winding number [jacobson2013robust, barill2018fast] says that it bounds a body all the same, a wall
//! is put where that number is ½. A *sheet* bounds nothing, and is made some cells thick. The outside
//! is contoured on the grid with exact places and normals of what is hit, so sharp edges stay, by
//! pieces that cannot cross (`contour`) and are manifold (`table`).
//!
//! Not kept: what is thinner than the cells, walls and gaps both.

mod cells;
mod contour;
mod cross;
mod field;
mod flood;
mod grid;
mod lines;
mod pieces;
mod qef;
mod sheets;
mod shells;
mod table;
mod wedge;
mod winding;

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

use crate::mesh::{TriangleMesh, TriangleMeshError, VertexMap, bounds};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use cells::Cells;
use cross::Hits;
use field::Walls;
use flood::Outside;
use grid::Grid;
use lines::Lines;
use sheets::{Plates, Thick};
use shells::Sorted;
pub use winding::Winding;

/// The most edges of the grid that may be hit: some 4 GiB of memory.
const MOST_HITS: f64 = 2e7;

/// What comes in.
#[derive(Clone, Copy, Debug)]
pub struct Shells<'a> {
    /// Oriented surfaces, closed or not, each a component.
    pub surfaces: &'a TriangleMesh,
    /// Triangles that belong to no oriented surface.
    pub loose: &'a [[DVec3; 3]],
    /// Segments on them that edges of the surface are to lie on, where it passes there.
    pub lines: &'a [[DVec3; 2]],
}

/// How fine the surface is to be.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Settings {
    /// The side of a cell, in the mesh's units.
    pub cell: f64,
}

/// What is told of it.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Report {
    /// How many shells came in.
    pub n_shells: usize,
    /// How many of them were closed.
    pub n_closed: usize,
    /// How many have borders but bound a body, which was closed there.
    pub n_walls: usize,
    /// How many of these faced inward and were turned.
    pub n_turned: usize,
    /// How many bound nothing and were made thick.
    pub n_sheets: usize,
    /// How many bound nothing and were too small for that: they are gone.
    pub n_scraps: usize,
    /// How many pieces of surface there are.
    pub n_pieces: usize,
    /// How many were dropped: specks.
    pub n_dropped: usize,
    /// How many triangles were made.
    pub n_faces: usize,
}

/// The closed surface.
#[derive(Clone, PartialEq, Debug)]
pub struct Solid {
    /// Closed, manifold and free of crossings; one component for each piece.
    pub mesh: TriangleMesh,
    /// Which of its vertices lie on lines.
    pub is_on_line: VertexMap<bool>,
    /// Which triangles of the shells, the loose ones last, the surface was taken from.
    pub is_hit: Vec<bool>,
    /// What is told of it.
    pub report: Report,
}

/// Why there is none.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// Cells are so small that there would be too many.
    #[error(
        "so fine a grid would meet the surface in about {n_hits:.1e} places; {MOST_HITS:.0e} are \
         the most: cells at least {fit:.2} times as large would do"
    )]
    TooFine {
        /// How many edges of the grid would be hit.
        n_hits: f64,
        /// How many times as large cells would have to be.
        fit: f64,
    },
    /// Nothing is left that has a volume.
    #[error("the {n_shells} shells enclose nothing that cells of this size could show")]
    Nothing {
        /// How many came in.
        n_shells: usize,
    },
    /// There are too many triangles.
    #[error(transparent)]
    Mesh(#[from] TriangleMeshError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Makes one closed surface of all shells; see the module for how.
///
/// Costs O(n log n) in the triangles and in the cells at the surface.
///
/// # Errors
/// When cells are too small or nothing is enclosed; when cancelled.
pub fn solidify(
    shells: &Shells<'_>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Solid, Error> {
    let job = Job::new(shells, settings.cell)?;
    let n_shells = job.sorted.n_shells();
    let mut hits = cross::hits(&job.grid, &job.triangles, |i| job.has_area(i), progress)?;
    let mut normals = job.normals.clone();
    progress.at(0.2)?;
    job.close((&mut hits, &mut normals), &progress.part("", 0.2, 0.4))?;
    let tree = Bvh::build(&job.triangles, progress)?;
    let stage = progress.part("", 0.4, 0.5);
    let outside = job.outside((&mut hits, &mut normals), &tree, &stage)?;
    let cells = Cells::new(&job.grid, &hits, &outside, progress)?;
    progress.at(0.6)?;
    let entered = shells
        .lines
        .iter()
        .map(|ends| ends.map(|p| job.grid.enter(p)));
    let lines = Lines::new(&job.grid, entered);
    let surface = contour::contour(
        (&job.grid, &cells),
        (&normals, &tree, &lines),
        &progress.part("", 0.6, 0.9),
    )?;
    if surface.faces.is_empty() {
        return Err(Error::Nothing { n_shells });
    }
    let places = surface.positions.iter().map(|&p| job.grid.leave(p));
    let mesh = TriangleMesh::build(places.collect(), surface.faces, progress)??;
    debug_assert!(mesh.is_closed());
    let all = (mesh, surface.is_on_line);
    let ((mesh, is_on_line), report) = pieces::largest(all, bounds(shells.surfaces.positions()))?;
    Ok(Solid {
        is_hit: job.is_hit(&cells),
        is_on_line: VertexMap::from_vec(is_on_line),
        report: Report {
            n_faces: mesh.n_faces(),
            ..job.sorted.report(report)
        },
        mesh,
    })
}

/// Shells in the places of a grid.
struct Job {
    grid: Grid,
    triangles: Vec<[DVec3; 3]>,
    normals: Vec<DVec3>,
    sorted: Sorted,
}

impl Job {
    fn new(shells: &Shells<'_>, cell: f64) -> Result<Self, Error> {
        let mut triangles = shells.triangles();
        let grid = fitting(&triangles, cell)?;
        let [low, high] = bounds(shells.surfaces.positions());
        let scrap = pieces::SPECK * low.distance(high) / cell;
        for triangle in &mut triangles {
            *triangle = triangle.map(|p| grid.enter(p));
        }
        let sorted = shells::sort(shells.surfaces, &triangles, scrap);
        for (triangle, _) in triangles.iter_mut().zip(&sorted.is_turned).filter(|t| *t.1) {
            triangle.swap(1, 2);
        }
        Ok(Self {
            normals: triangles.par_iter().map(normal).collect(),
            sorted,
            grid,
            triangles,
        })
    }

    fn has_area(&self, triangle: usize) -> bool {
        self.normals[triangle] != DVec3::ZERO
    }

    /// Puts walls where shells are open, and around sheets.
    fn close(
        &self,
        (hits, normals): (&mut Hits, &mut Vec<DVec3>),
        progress: &Progress,
    ) -> Result<(), Error> {
        let sorted = &self.sorted;
        let (around_walls, around_sheets) = (
            self.around(hits, |i| sorted.is_wall[i]),
            self.around(hits, |i| sorted.is_sheet[i]),
        );
        if !around_walls.is_empty() {
            let winding = Winding::new(&self.those(&sorted.is_wall));
            let walls = Walls::new(&self.grid, &winding);
            walls.add(around_walls, (hits, normals), &progress.part("", 0.0, 0.5))?;
        }
        if !around_sheets.is_empty() {
            let all = self.triangles.iter().zip(&sorted.is_sheet);
            let sheets: Vec<_> = all
                .filter(|(_, is_sheet)| **is_sheet)
                .map(|(&t, _)| t)
                .collect();
            let thick = Thick::new(&sheets, progress)?;
            let walls = Walls::new(&self.grid, &thick);
            walls.add(around_sheets, (hits, normals), &progress.part("", 0.5, 1.0))?;
        }
        Ok(())
    }

    fn those(&self, are_wanted: &[bool]) -> Vec<[DVec3; 3]> {
        let all = self.triangles.iter().zip(are_wanted);
        all.filter(|(_, is_wanted)| **is_wanted)
            .map(|(&t, _)| t)
            .collect()
    }

    /// The cells around hits of some triangles.
    fn around(&self, hits: &Hits, is_wanted: impl Fn(usize) -> bool) -> Vec<u64> {
        let all = hits.iter().enumerate();
        let edges = all.flat_map(|(axis, hits)| hits.iter().map(move |hit| (axis, hit)));
        let own = edges.filter(|(_, hit)| is_wanted(hit.of as usize));
        own.flat_map(|(axis, hit)| self.grid.around_edge(axis, hit.edge))
            .collect()
    }

    /// What is outside, once walls too thin for the grid are made thick.
    fn outside(
        &self,
        (hits, normals): (&mut Hits, &mut Vec<DVec3>),
        tree: &Bvh,
        progress: &Progress,
    ) -> Result<Outside, Error> {
        let outside = Outside::new(&self.grid, hits, progress)?;
        let thin = sheets::thin(&self.grid, (hits, normals), &outside);
        if thin.is_empty() {
            return Ok(outside);
        }
        let plates = Plates {
            tree,
            normals: &self.normals,
        };
        let edges = thin.iter();
        let around = edges.flat_map(|&(axis, edge)| self.grid.around_edge(axis, edge));
        let walls = Walls::new(&self.grid, &plates);
        walls.add(around.collect(), (hits, normals), progress)?;
        Ok(Outside::new(&self.grid, hits, progress)?)
    }

    /// Which triangles the surface was taken from.
    fn is_hit(&self, cells: &Cells) -> Vec<bool> {
        let mut is_hit = vec![false; self.triangles.len()];
        for crossing in cells.crossings.iter().flatten() {
            if let Some(is_hit) = is_hit.get_mut(crossing.hit.of as usize) {
                *is_hit = true;
            }
        }
        is_hit
    }
}

impl Shells<'_> {
    fn triangles(&self) -> Vec<[DVec3; 3]> {
        let surfaces = self.surfaces;
        let own = surfaces.face_ids().map(|face| surfaces.triangle(face));
        own.chain(self.loose.iter().copied()).collect()
    }
}

/// The grid around triangles, if it is not too fine.
fn fitting(triangles: &[[DVec3; 3]], cell: f64) -> Result<Grid, Error> {
    let corners: Vec<DVec3> = triangles.iter().flatten().copied().collect();
    // A triangle is hit in each direction as often as its shadow there has vertices.
    let shadow = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).abs().element_sum() / 2.0;
    let n_hits = triangles.iter().map(shadow).sum::<f64>() / (cell * cell);
    let grid = Grid::around(bounds(&corners), cell);
    match grid {
        Some(grid) if n_hits.max(grid.n_rows() as f64) <= MOST_HITS => Ok(grid),
        _ => {
            let n_rows = grid.map_or(f64::INFINITY, |grid| grid.n_rows() as f64);
            let n_hits = n_hits.max(n_rows.min(1e12));
            let fit = (n_hits / MOST_HITS).sqrt();
            Err(Error::TooFine { n_hits, fit })
        }
    }
}

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

#[cfg(test)]
mod tests;
