//! Reads the unit grid of a metric with whole periods, in exact arithmetic.
//!
//! In doubled coordinates the cones lie at even numbers and the middles of quads at odd ones. A
//! triangle owns the middles inside it; from each, four straight walks across triangles lead to
//! the quad's corners. A vertex cannot lie on the way, so that no case is degenerate, and a corner
//! is named by where it is: a cone, a step along an edge, a place inside a triangle.

mod chart;
mod locate;
mod table;

use glam::I64Vec2;
use thiserror::Error;

use super::complex::Complex;
use super::place::Cell;
use crate::mesh::{FaceId, HalfedgeId, VertexId, VertexMap};
use chart::Chart;
use table::Table;

/// The corners of a quad as seen from its middle, counter-clockwise.
const CORNERS: [I64Vec2; 4] = [
    I64Vec2::new(-1, -1),
    I64Vec2::new(1, -1),
    I64Vec2::new(1, 1),
    I64Vec2::new(-1, 1),
];

/// A closed mesh of quads and where the vertices of the mesh behind it lie in them.
#[derive(Clone, PartialEq, Debug)]
pub struct Grid {
    /// The corners of each quad, counter-clockwise. Vertex i of the complex is vertex i here.
    pub quads: Vec<[u32; 4]>,
    /// How many vertices there are.
    pub n_vertices: usize,
    /// Where each vertex of the mesh lies.
    pub cells: VertexMap<Cell>,
}

/// Why a metric has no grid.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum NotReadable {
    /// A vector is not whole, or the vectors are not those of a flat metric.
    #[error("the grid leads nowhere from face {0} of the flat metric")]
    Nowhere(FaceId),
    /// The complex neither has nor locates a vertex of the mesh.
    #[error("vertex {0} is not on the flat metric")]
    Lost(VertexId),
}

/// Reads the quads of a compact complex whose `start` vectors are whole, and places every vertex
/// of the mesh in them: those located in faces and those that are cones.
///
/// The quads close to a sphere, but two edges of them may join the same two vertices. Costs some
/// µs a quad and a vertex.
///
/// # Errors
/// See [`NotReadable`].
pub fn read(complex: &Complex) -> Result<Grid, NotReadable> {
    let reader = Reader::read(complex)?;
    let cells = locate::locate(&reader)?;
    Ok(Grid {
        quads: reader.quads,
        n_vertices: reader.n_vertices,
        cells,
    })
}

/// Reads the quads alone and their number of vertices, for searches that read many.
///
/// # Errors
/// [`NotReadable::Nowhere`].
pub fn read_quads(complex: &Complex) -> Result<(Vec<[u32; 4]>, usize), NotReadable> {
    let reader = Reader::read(complex)?;
    Ok((reader.quads, reader.n_vertices))
}

struct Reader<'a> {
    chart: Chart<'a>,
    quads: Vec<[u32; 4]>,
    n_vertices: usize,
    /// The quads by their middles.
    quad_at: Table,
    /// Vertices inside faces.
    vertex_at: Table,
    /// Vertices along edges, from the origin of the smaller halfedge.
    along: Vec<Vec<Option<u32>>>,
}

impl<'a> Reader<'a> {
    fn read(complex: &'a Complex) -> Result<Self, NotReadable> {
        let chart = Chart::new(complex);
        let mut reader = Self {
            quads: Vec::new(),
            n_vertices: complex.n_vertices(),
            quad_at: Table::new(&chart),
            vertex_at: Table::new(&chart),
            along: vec![Vec::new(); complex.twins.len()],
            chart,
        };
        for face in 0..complex.n_faces() {
            for middle in reader.chart.middles(face) {
                let quad = reader
                    .read_quad(face, middle)
                    .ok_or(NotReadable::Nowhere(FaceId(face as u32)))?;
                reader.quad_at.set(face, middle, reader.quads.len() as u32);
                reader.quads.push(quad);
            }
        }
        Ok(reader)
    }

    fn read_quad(&mut self, face: usize, middle: I64Vec2) -> Option<[u32; 4]> {
        let mut quad = [0; 4];
        for (corner, step) in quad.iter_mut().zip(CORNERS) {
            let (face, place) = self.chart.walk(face, middle, middle + step)?;
            *corner = self.name(face, place);
        }
        Some(quad)
    }

    /// The vertex at an even place of a face.
    fn name(&mut self, face: usize, place: I64Vec2) -> u32 {
        if let Some(i) = (0..3).find(|&i| self.chart.corners[face][i] == place) {
            let VertexId(cone) = self.chart.complex.origins[HalfedgeId((3 * face + i) as u32)];
            return cone;
        }
        let new = self.n_vertices as u32;
        let found = match self.chart.step_along(face, place) {
            Some((edge, step, n_steps)) => {
                let along = &mut self.along[edge];
                if along.is_empty() {
                    along.resize(n_steps, None);
                }
                *along[step].get_or_insert(new)
            }
            None => self.vertex_at.get_or_set(face, place, new),
        };
        self.n_vertices += usize::from(found == new);
        found
    }
}

#[cfg(test)]
mod tests;
