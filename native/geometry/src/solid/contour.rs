//! The surface of a filled grid [ju2006intersection].
//!
//! Each loop of a cell has a vertex, where the planes of the surface there meet best; each crossed
//! edge has a polygon through the vertices of the four cells around it. Faces of a polygon stay in
//! the wedges between the edge and those vertices, each in a cell of its own, and no two wedges
//! overlap, so that nothing crosses: where the way from cell to cell misses their common face, it is
//! led through a point of that face, and where no diagonal of the polygon stays in the wedges, its
//! triangles meet in a point of the edge.

use glam::DVec3;
use rayon::prelude::*;

use super::cells::Cells;
use super::grid::{Grid, others};
use super::lines::Lines;
use super::qef::Planes;
use super::table;
use super::wedge::{self, Ring};
use crate::mesh::{Id, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};

/// Cells between two looks at the progress.
const CHUNK: usize = 8192;
/// How near vertices come to the rim of their cell, face or edge: far more than rounding, and less
/// than shows.
const MARGIN: f64 = 0.005;

/// Where planes meet farther than that from all triangles, in cells, is no place of the surface:
/// below, bends lose their corners; above, folds that are narrower than a cell get spikes.
const OFF: f64 = 0.1;

/// Triangles over places of the grid.
pub struct Surface {
    pub positions: Vec<DVec3>,
    pub faces: Vec<[VertexId; 3]>,
    /// Which vertices lie on lines; those on faces and edges do on none.
    pub is_on_line: Vec<bool>,
}

/// A point on the high face of a cell along each axis, for each of the ways over it.
type FacePoints = [[Option<VertexId>; 2]; 3];

/// Makes the surface; `normals` has one of everything that is hit, of which the first are those of
/// the triangles in the tree.
///
/// # Errors
/// When cancelled.
pub fn contour(
    (grid, cells): (&Grid, &Cells),
    (normals, tree, lines): (&[DVec3], &Bvh, &Lines),
    progress: &Progress,
) -> Result<Surface, Cancelled> {
    let contour = Contour {
        grid,
        cells,
        normals,
        tree,
        lines,
        first: firsts(cells),
    };
    let vertices = contour.vertices(&progress.part("", 0.0, 0.5))?;
    let (positions, is_on_line) = vertices.into_iter().unzip();
    let mut surface = Surface {
        positions,
        is_on_line,
        faces: Vec::new(),
    };
    let points = contour.face_points(&mut surface, &progress.part("", 0.5, 0.7))?;
    contour.polygons(&mut surface, &points, &progress.part("", 0.7, 1.0))?;
    surface.is_on_line.resize(surface.positions.len(), false);
    Ok(surface)
}

struct Contour<'a> {
    grid: &'a Grid,
    cells: &'a Cells,
    normals: &'a [DVec3],
    tree: &'a Bvh,
    lines: &'a Lines,
    /// The first vertex of each cell, and the end.
    first: Vec<u32>,
}

fn firsts(cells: &Cells) -> Vec<u32> {
    let mut first = Vec::with_capacity(cells.keys.len() + 1);
    let mut n = 0;
    for cell in 0..cells.keys.len() {
        first.push(n);
        n += u32::from(cells.pattern(cell).n_loops);
    }
    first.push(n);
    first
}

/// A box less its margin.
fn inner(low: DVec3) -> [DVec3; 2] {
    [low + MARGIN, low + (1.0 - MARGIN)]
}

impl Contour<'_> {
    fn vertices(&self, progress: &Progress) -> Result<Vec<(DVec3, bool)>, Cancelled> {
        let all: Vec<usize> = (0..self.cells.keys.len()).collect();
        let found = all.par_chunks(CHUNK).map(|chunk| {
            progress.check()?;
            Ok(chunk.iter().flat_map(|&cell| self.of_cell(cell)).collect())
        });
        let found: Vec<Vec<(DVec3, bool)>> = found.collect::<Result<_, Cancelled>>()?;
        progress.at(1.0)?;
        Ok(found.concat())
    }

    /// The vertices of a cell. Several stay between the crossings of their loops.
    fn of_cell(&self, cell: usize) -> impl Iterator<Item = (DVec3, bool)> {
        let pattern = self.cells.pattern(cell);
        let mut planes = [Planes::NONE; 4];
        let mut is_given = true;
        for edge in 0..12 {
            let Some(name) = pattern.loop_of[edge] else {
                continue;
            };
            let (_, crossing) = self.cells.crossing(self.grid, cell, edge);
            let hit = crossing.hit;
            is_given &= (hit.of as usize) < self.tree.n_faces();
            let mut p = self.grid.place(hit.edge);
            p[edge / 4] += hit.at.clamp(MARGIN, 1.0 - MARGIN);
            planes[name as usize].push(p, self.normals[hit.of as usize]);
        }
        let bounds = inner(self.grid.place(self.cells.keys[cell]));
        let n = usize::from(pattern.n_loops);
        let vertex = move |planes: Planes| match n {
            1 if is_given => self.vertex(cell, planes.meet(bounds), bounds),
            1 => (planes.meet(bounds), false),
            _ => (planes.middle(), false),
        };
        planes.into_iter().take(n).map(vertex)
    }

    /// A place where planes meet; on a line where one passes the cell there; or the nearest on a
    /// triangle where it is far off: planes of small triangles go on where these do not.
    fn vertex(&self, cell: usize, p: DVec3, [low, high]: [DVec3; 2]) -> (DVec3, bool) {
        if let Some(on_line) = self.lines.near(self.cells.keys[cell], p) {
            return (on_line.clamp(low, high), true);
        }
        let reach = self.tree.closest_where(p, OFF * OFF, |_| true);
        if reach.is_some() {
            return (p, false);
        }
        (self.tree.closest(p).position.clamp(low, high), false)
    }

    /// Points on faces, where vertices on both sides do not see each other through them.
    fn face_points(
        &self,
        surface: &mut Surface,
        progress: &Progress,
    ) -> Result<Vec<FacePoints>, Cancelled> {
        let all: Vec<usize> = (0..self.cells.keys.len()).collect();
        let positions = &surface.positions;
        let found = all.par_chunks(CHUNK).map(|chunk| {
            progress.check()?;
            let points = chunk.iter().map(|&cell| self.points_of(cell, positions));
            Ok(points.collect())
        });
        let found: Vec<Vec<[[Option<DVec3>; 2]; 3]>> = found.collect::<Result<_, Cancelled>>()?;
        let mut named = Vec::with_capacity(all.len());
        for of_cell in found.iter().flatten() {
            named.push(of_cell.map(|ways| {
                ways.map(|point| {
                    point.map(|p| {
                        surface.positions.push(p);
                        VertexId::from_index(surface.positions.len() - 1)
                    })
                })
            }));
        }
        Ok(named)
    }

    fn points_of(&self, cell: usize, positions: &[DVec3]) -> [[Option<DVec3>; 2]; 3] {
        let pattern = self.cells.pattern(cell);
        [0, 1, 2].map(|axis| {
            let ways = pattern.ways[axis][1];
            let Some(first) = ways[0] else {
                return [None; 2];
            };
            let next = self
                .cells
                .index(self.cells.keys[cell] + self.grid.step(axis));
            let beyond = self.cells.pattern(next);
            if pattern.is_double(axis, 1) || pattern.n_loops > 1 || beyond.n_loops > 1 {
                return ways.map(|way| way.map(|way| self.between(cell, way)));
            }
            let [a, b] = [cell, next].map(|cell| positions[self.first[cell] as usize]);
            let low = self
                .grid
                .place(self.cells.keys[cell] + self.grid.step(axis));
            let share = (low[axis] - a[axis]) / (b[axis] - a[axis]);
            let through = a + (b - a) * share;
            let [low, high] = inner(low);
            let is_in = |other: usize| (low[other]..=high[other]).contains(&through[other]);
            if others(axis).into_iter().all(is_in) {
                return [None; 2];
            }
            [Some(self.on_face(cell, axis, first)), None]
        })
    }

    /// The place and the normal of a crossing of a cell's edge.
    fn plane(&self, cell: usize, edge: u8) -> (DVec3, DVec3) {
        let (_, crossing) = self.cells.crossing(self.grid, cell, edge as usize);
        let p = self.place(edge as usize / 4, crossing.hit);
        (p, self.normals[crossing.hit.of as usize])
    }

    fn place(&self, axis: usize, hit: super::cross::Hit) -> DVec3 {
        let mut p = self.grid.place(hit.edge);
        p[axis] += hit.at.clamp(MARGIN, 1.0 - MARGIN);
        p
    }

    fn between(&self, cell: usize, way: [u8; 2]) -> DVec3 {
        let [p, q] = way.map(|edge| self.plane(cell, edge).0);
        p.midpoint(q)
    }

    /// Where the lines in which planes cut the high face meet best.
    fn on_face(&self, cell: usize, axis: usize, way: [u8; 2]) -> DVec3 {
        let low = self
            .grid
            .place(self.cells.keys[cell] + self.grid.step(axis));
        let mut planes = Planes::NONE;
        for edge in way {
            let (p, mut normal) = self.plane(cell, edge);
            normal[axis] = 0.0;
            planes.push(p, normal.normalize_or_zero());
        }
        let [mut least, mut most] = inner(low);
        [least[axis], most[axis]] = [low[axis]; 2];
        let mut at = planes.meet([least, most]);
        at[axis] = low[axis];
        at
    }

    fn polygons(
        &self,
        surface: &mut Surface,
        points: &[FacePoints],
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        for axis in 0..3 {
            let crossings = &self.cells.crossings[axis];
            for chunk in crossings.chunks(CHUNK) {
                progress.check()?;
                let positions = &surface.positions;
                let rings = chunk.par_iter().map(|crossing| {
                    let ring = self.ring(axis, crossing.hit.edge, points);
                    let low = self.grid.place(crossing.hit.edge);
                    let ends = [low, low + DVec3::AXES[axis]];
                    let normal = self.normals[crossing.hit.of as usize];
                    let upward = normal * normal[axis].signum();
                    let cut = wedge::cut(&ring, (ends, upward), positions);
                    (ring, cut, crossing)
                });
                let rings: Vec<_> = rings.collect();
                for (ring, cut, crossing) in rings {
                    let faces = if let Some(faces) = cut {
                        faces.to_vec()
                    } else {
                        surface.positions.push(self.place(axis, crossing.hit));
                        ring.fan(VertexId::from_index(surface.positions.len() - 1))
                    };
                    let turned = |[a, b, c]: [VertexId; 3]| {
                        if crossing.rises { [a, b, c] } else { [a, c, b] }
                    };
                    surface.faces.extend(faces.into_iter().map(turned));
                }
            }
        }
        Ok(())
    }

    /// The polygon around an edge, counter-clockwise as seen from its high end.
    fn ring(&self, axis: usize, edge: u64, points: &[FacePoints]) -> Ring {
        let [b, c] = others(axis);
        let cells = self
            .grid
            .around_edge(axis, edge)
            .map(|key| self.cells.index(key));
        // Which edge of each cell it is.
        let sides = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|side| table::edge(axis, side));
        // Between one cell and the next: whose high face it is, and along which axis.
        let faces = [(1, b), (2, c), (2, b), (3, c)];
        let vertex = |i: usize| {
            let pattern = self.cells.pattern(cells[i]);
            let name = pattern.loop_of[sides[i]].expect("the surface passes this edge");
            VertexId(self.first[cells[i]] + u32::from(name))
        };
        let point = |i: usize| {
            let (owner, along) = faces[i];
            let ways = self.cells.pattern(cells[owner]).ways[along][1];
            let is_own =
                |way: &Option<[u8; 2]>| way.is_some_and(|w| w.contains(&(sides[owner] as u8)));
            let way = ways
                .iter()
                .position(is_own)
                .expect("a way leads over the face");
            points[cells[owner]][along][way]
        };
        Ring {
            vertices: [0, 1, 2, 3].map(vertex),
            points: [0, 1, 2, 3].map(point),
        }
    }
}
