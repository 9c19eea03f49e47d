//! First positions of the quads: least squares through the vertices that lie in them.

use glam::{DVec2, DVec3};
use thiserror::Error;

use super::stars;
use crate::mesh::{VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sparse::{NotPositiveDefinite, SymmetricMatrix};
use crate::sphere_map::{SphereMap, SurfacePoint, walk_along};

/// Weight of a vertex's distance to the middle of its neighbours, against 1 for each vertex of the
/// surface. At 0.005 quads on thin limbs turn over; above 0.3 tips shrink.
const SMOOTHING: f64 = 0.05;
/// Weight of a vertex's distance to where it belongs: enough to be there within a hair.
const GOAL_WEIGHT: f64 = 1e3;
/// What keeps the system definite where a quad holds no vertex at all.
const SHIFT: f64 = 1e-9;

/// Where a vertex of the surface lies: in a quad, at coordinates from 0 to 1 along its first side
/// and from its first corner to its last.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cell {
    /// The quad.
    pub quad: u32,
    /// Where in it.
    pub at: DVec2,
}

/// Quads in space and on the sphere.
#[derive(Clone, PartialEq, Debug)]
pub struct Placed {
    /// The position of each vertex, near the surface.
    pub positions: Vec<DVec3>,
    /// A proposal of its point on the sphere: quads may be folded; zero where nothing is known.
    pub sphere: Vec<DVec3>,
}

/// Why quads have no positions.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum PlaceError {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A coordinate is not finite.
    #[error(transparent)]
    Unsolvable(#[from] NotPositiveDefinite),
}

/// Finds positions for `n_vertices` vertices of quads, given where the surface's vertices lie.
///
/// Minimises Σ |bilinear(quad; s, t) − x|² + 0.05 Σ |umbrella|²; `goals` are places where vertices
/// belong. The point on the sphere is that of the surface's face that covers the vertex in the
/// quads. Where there is none it is found by
/// a walk on the surface, from the vertex nearest in the quads to the position in space: it stays
/// on its own finger. One factorisation.
///
/// # Errors
/// [`PlaceError`].
pub fn place(
    map: &SphereMap,
    (n_vertices, quads): (usize, &[[u32; 4]]),
    cells: &VertexMap<Cell>,
    goals: &[(u32, DVec3)],
    progress: &Progress,
) -> Result<Placed, PlaceError> {
    let mut matrix = SymmetricMatrix::new(n_vertices);
    let mut positions = vec![DVec3::ZERO; n_vertices];
    for (v, cell) in cells.iter_ids() {
        let row = bilinear(quads, cell);
        matrix.add_square(&row, 1.0);
        for (corner, weight) in row {
            positions[corner] += map.mesh().position(v) * weight;
        }
    }
    for (v, star) in neighbours(n_vertices, quads).iter().enumerate() {
        let share = -1.0 / star.len().max(1) as f64;
        let mut row = vec![(v, 1.0)];
        row.extend(star.iter().map(|&other| (other as usize, share)));
        matrix.add_square(&row, SMOOTHING);
        matrix.add(v, v, SHIFT);
    }
    for &(v, position) in goals {
        matrix.add(v as usize, v as usize, GOAL_WEIGHT);
        positions[v as usize] += position * GOAL_WEIGHT;
    }
    progress.at(0.1)?;
    matrix.factorize()?.solve_vectors(&mut positions);
    progress.at(0.8)?;
    let starts = nearest_vertices((n_vertices, quads), cells);
    let found = stars::locate(map.mesh(), (n_vertices, quads), cells);
    let sphere = (0..n_vertices).map(|v| {
        let walk = |start| walk_along(map, at_vertex(map, start), positions[v]);
        let place = found[v].or_else(|| starts[v].map(walk));
        place.map_or(DVec3::ZERO, |place| map.sphere_position(place))
    });
    let sphere = sphere.collect();
    Ok(Placed { positions, sphere })
}

/// The corners of a cell's quad and their bilinear weights.
fn bilinear(quads: &[[u32; 4]], cell: &Cell) -> [(usize, f64); 4] {
    let [s, t] = cell.at.to_array();
    let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
    let corners = quads[cell.quad as usize];
    [0, 1, 2, 3].map(|i| (corners[i] as usize, weights[i]))
}

/// The neighbours of each vertex over edges, each once.
fn neighbours(n_vertices: usize, quads: &[[u32; 4]]) -> Vec<Vec<u32>> {
    let mut stars = vec![Vec::with_capacity(4); n_vertices];
    for quad in quads {
        for i in 0..4 {
            let [a, b] = [quad[i], quad[(i + 1) % 4]];
            for (from, to) in [(a, b), (b, a)] {
                let star: &mut Vec<u32> = &mut stars[from as usize];
                if from != to && !star.contains(&to) {
                    star.push(to);
                }
            }
        }
    }
    stars
}

/// For each vertex of the quads the vertex of the surface that lies nearest in its quads.
fn nearest_vertices(
    (n_vertices, quads): (usize, &[[u32; 4]]),
    cells: &VertexMap<Cell>,
) -> Vec<Option<VertexId>> {
    const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let mut nearest = vec![(f64::INFINITY, None); n_vertices];
    for (v, cell) in cells.iter_ids() {
        for (corner, at) in quads[cell.quad as usize].iter().zip(CORNERS) {
            let distance = cell.at.distance_squared(at);
            let best = &mut nearest[*corner as usize];
            if distance < best.0 {
                *best = (distance, Some(v));
            }
        }
    }
    nearest.into_iter().map(|(_, v)| v).collect()
}

/// A vertex as a place on the surface.
fn at_vertex(map: &SphereMap, vertex: VertexId) -> SurfacePoint {
    let outgoing = map.mesh().outgoing(vertex).next();
    let h = outgoing.expect("a vertex of a closed mesh has faces");
    let mut weights = [0.0; 3];
    weights[h.corner()] = 1.0;
    SurfacePoint {
        face: h.face(),
        weights,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PolygonMesh;
    use crate::shapes;
    use crate::sphere_map::check_cover;

    /// The six sides of a box as quads, and the cells of a fine box's vertices.
    fn sides(n: u32) -> (SphereMap, Vec<[u32; 4]>, VertexMap<Cell>) {
        let mesh = shapes::mapped_cube(n, |p| p);
        let corner = |p: DVec3| {
            let bit = |c: f64, b: u32| if c > 0.0 { b } else { 0 };
            bit(p.x, 1) + bit(p.y, 2) + bit(p.z, 4)
        };
        let side = |axis: usize, sign: f64| {
            let [u, v] = [
                DVec3::AXES[(axis + 1) % 3] * sign,
                DVec3::AXES[(axis + 2) % 3],
            ];
            (DVec3::AXES[axis] * sign, u, v)
        };
        let all: Vec<_> = (0..6).map(|i| side(i / 2, [1.0, -1.0][i % 2])).collect();
        let quads = all
            .iter()
            .map(|&(n, u, v)| [n - u - v, n + u - v, n + u + v, n - u + v].map(corner));
        let cells = mesh.positions().iter().map(|&p| {
            let quad = (0..6).find(|&i| p.dot(all[i].0) > 1.0 - 1e-9).unwrap();
            let (_, u, v) = all[quad];
            let at = (DVec2::new(p.dot(u), p.dot(v)) + 1.0) / 2.0;
            let quad = quad as u32;
            Cell { quad, at }
        });
        let (quads, cells) = (quads.collect(), cells.collect());
        let sphere = mesh
            .positions()
            .iter()
            .map(|p| p.normalize_or(DVec3::Z))
            .collect();
        (SphereMap::prove(mesh, sphere).unwrap(), quads, cells)
    }

    #[test]
    fn a_box_of_six_quads_gets_its_corners() {
        let (map, quads, cells) = sides(12);
        let placed = place(&map, (8, &quads), &cells, &[], &Progress::none()).unwrap();
        for (i, (p, s)) in placed.positions.iter().zip(&placed.sphere).enumerate() {
            let sign = |bit: usize| (i >> bit & 1) as f64 * 2.0 - 1.0;
            let corner = DVec3::new(sign(0), sign(1), sign(2));
            assert!(p.distance(corner) < 0.02, "{p} {corner}");
            assert!(s.distance(corner / 3f64.sqrt()) < 0.02, "{s}");
        }
        let mesh = PolygonMesh::from_faces(placed.positions, &quads).unwrap();
        assert_eq!(check_cover(&mesh, &placed.sphere), Ok(()));
    }

    #[test]
    fn a_quad_without_any_vertex_is_filled_in() {
        let (map, quads, mut cells) = sides(6);
        // Everything from one side to its edge: the opposite side's corners stay known.
        for cell in cells.as_mut_slice() {
            if cell.quad == 0 {
                *cell = Cell {
                    quad: 1,
                    at: DVec2::new(0.5, 0.5),
                };
            }
        }
        let placed = place(&map, (8, &quads), &cells, &[], &Progress::none()).unwrap();
        assert!(placed.positions.iter().all(|p| p.is_finite()));
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let (map, quads, mut cells) = sides(4);
        cells[VertexId(0)].at.x = f64::NAN;
        let result = place(&map, (8, &quads), &cells, &[], &Progress::none());
        assert!(matches!(result, Err(PlaceError::Unsolvable(_))));
    }
}
