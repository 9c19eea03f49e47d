//! Places the vertices of the mesh in the quads.

use glam::{DVec2, I64Vec2};

use super::chart::Chart;
use super::{CORNERS, NotReadable, Reader};
use crate::flow::place::Cell;
use crate::mesh::{HalfedgeId, Id, VertexId, VertexMap};

/// More faces than this are not crossed on the way to a middle next by.
const MOST_CROSSED: usize = 500;
/// How far beyond a side a middle may be to be in its face still: rounding.
const OVER: f64 = 1e-9;

/// Where each vertex of the mesh lies, those located in faces and those that are cones.
pub(super) fn locate(reader: &Reader) -> Result<VertexMap<Cell>, NotReadable> {
    let complex = reader.chart.complex;
    let points = complex.located.points();
    let known = complex
        .original
        .iter()
        .chain(points.iter().map(|p| &p.vertex));
    let n = known.map(|v| v.index() + 1).max().unwrap_or(0);
    let mut cells: VertexMap<Option<Cell>> = VertexMap::filled(n, None);
    let corner_of = corners(reader);
    for (own, &vertex) in complex.original.iter().enumerate() {
        cells[vertex] = corner_of[own];
    }
    for point in points {
        let face = point.face.index();
        let corners = reader.chart.corners[face].map(I64Vec2::as_dvec2);
        let place: DVec2 = (0..3).map(|i| corners[i] * point.weights[i]).sum();
        cells[point.vertex] = cell(reader, face, place)
            .or_else(|| nearest_corner(reader, &corner_of, point.face.0, point.weights));
    }
    let found = |(vertex, cell): (VertexId, &Option<Cell>)| cell.ok_or(NotReadable::Lost(vertex));
    cells.iter_ids().map(found).collect()
}

/// A quad at each vertex of the complex, with the vertex's corner in it.
fn corners(reader: &Reader) -> Vec<Option<Cell>> {
    let mut corners = vec![None; reader.chart.complex.n_vertices()];
    for (quad, vertices) in reader.quads.iter().enumerate() {
        for (&vertex, step) in vertices.iter().zip(CORNERS) {
            if let Some(corner) = corners.get_mut(vertex as usize) {
                *corner = corner.or(Some(Cell {
                    quad: quad as u32,
                    at: (step.as_dvec2() + 1.0) / 2.0,
                }));
            }
        }
    }
    corners
}

/// What is said of a point that rounding led astray: the cone of its face that has most weight.
fn nearest_corner(
    reader: &Reader,
    corner_of: &[Option<Cell>],
    face: u32,
    weights: [f64; 3],
) -> Option<Cell> {
    let nearest = (0..3u32).max_by(|&a, &b| weights[a as usize].total_cmp(&weights[b as usize]))?;
    let VertexId(cone) = reader.chart.complex.origins[HalfedgeId(3 * face + nearest)];
    corner_of[cone as usize]
}

/// The quad whose middle is the odd place nearest to a point, and the point's place in it.
fn cell(reader: &Reader, face: usize, point: DVec2) -> Option<Cell> {
    let middle = (point / 2.0).floor() * 2.0 + 1.0;
    let (mut face, mut point, mut middle) = walk(&reader.chart, face, point, middle.as_i64vec2())?;
    if let Some(side) = reader.chart.owner(face, middle) {
        face = reader.chart.complex.twins[side].face().index();
        point = reader.chart.carry_real(side, point);
        middle = reader.chart.carry(side, middle);
    }
    let quad = reader.quad_at.get(face, middle)?;
    let place = (point - middle.as_dvec2() + 1.0) / 2.0;
    Some(Cell {
        quad,
        at: place.clamp(DVec2::ZERO, DVec2::ONE),
    })
}

/// Walks from a point of a face to the middle next by: through the side that the way crosses
/// most clearly, because rounding may have put the point a little outside.
fn walk(
    chart: &Chart,
    face: usize,
    point: DVec2,
    middle: I64Vec2,
) -> Option<(usize, DVec2, I64Vec2)> {
    let (mut face, mut point, mut middle) = (face, point, middle);
    for _ in 0..MOST_CROSSED {
        let corners = chart.corners[face].map(I64Vec2::as_dvec2);
        let to = middle.as_dvec2();
        let is_beyond = |i: &usize| {
            let a = corners[*i];
            (corners[(i + 1) % 3] - a).perp_dot(to - a) < -OVER
        };
        let miss = |i: usize| {
            let side_of = |p: DVec2| (to - point).perp_dot(p - point);
            side_of(corners[i]).max(-side_of(corners[(i + 1) % 3]))
        };
        let sides = (0..3).filter(is_beyond);
        let Some(i) = sides.min_by(|&a, &b| miss(a).total_cmp(&miss(b))) else {
            return Some((face, point, middle));
        };
        let exit = HalfedgeId((3 * face + i) as u32);
        point = chart.carry_real(exit, point);
        middle = chart.carry(exit, middle);
        face = chart.complex.twins[exit].face().index();
    }
    None
}
