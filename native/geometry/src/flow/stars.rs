//! Where the vertices of quads lie on the surface whose vertices lie in the quads.
//!
//! The quads around a vertex, unfolded, are a disk of flat sectors. A face of the surface with all
//! corners in them that covers the middle holds the vertex; this is the inverse of the map that
//! put the surface's vertices into the quads, exact but for the bends inside one face.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec2;

use super::place::Cell;
use crate::elementary::{argument, direction};
use crate::mesh::{TriangleMesh, VertexMap};
use crate::sphere_map::SurfacePoint;

/// How far outside a face a vertex may lie, in weights: rounding, and bends inside the face.
const OUTSIDE: f64 = 1e-6;

/// The place of each vertex of the quads; none where no face covers it.
pub(super) fn locate(
    mesh: &TriangleMesh,
    (n_vertices, quads): (usize, &[[u32; 4]]),
    cells: &VertexMap<Cell>,
) -> Vec<Option<SurfacePoint>> {
    let sectors = sectors(n_vertices, quads);
    let mut best = vec![(-OUTSIDE, None); n_vertices];
    for face in mesh.face_ids() {
        let corners = mesh.face(face).map(|v| &cells[v]);
        for &vertex in &quads[corners[0].quad as usize] {
            let unfolded = corners.map(|cell| unfold(&sectors[vertex as usize], cell));
            let [Some(a), Some(b), Some(c)] = unfolded else {
                continue;
            };
            let area = (b - a).perp_dot(c - a);
            let weights = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)].map(|w| w / area);
            let least = weights[0].min(weights[1]).min(weights[2]);
            let best = &mut best[vertex as usize];
            if area > 0.0 && least > best.0 {
                *best = (least, Some(SurfacePoint { face, weights }));
            }
        }
    }
    best.into_iter().map(|(_, place)| place).collect()
}

/// A quad at a vertex: which of its corners the vertex is, and the sector's place in the turn.
#[derive(Clone, Copy)]
struct Sector {
    quad: u32,
    corner: usize,
    from: f64,
    angle: f64,
}

/// The sectors at each vertex, counter-clockwise.
fn sectors(n_vertices: usize, quads: &[[u32; 4]]) -> Vec<Vec<Sector>> {
    let mut around = vec![Vec::with_capacity(5); n_vertices];
    for (quad, corners) in (0..).zip(quads) {
        for (corner, &v) in corners.iter().enumerate() {
            around[v as usize].push((quad, corner));
        }
    }
    let sort = |mut around: Vec<(u32, usize)>| {
        let n = around.len();
        for i in 1..n {
            let (quad, corner) = around[i - 1];
            let last = quads[quad as usize][(corner + 3) % 4];
            let is_next =
                |&(quad, corner): &(u32, usize)| quads[quad as usize][(corner + 1) % 4] == last;
            if let Some(j) = (i..n).find(|&j| is_next(&around[j])) {
                around.swap(i, j);
            }
        }
        let angle = TAU / n as f64;
        let sector = |(i, (quad, corner))| Sector {
            quad,
            corner,
            from: angle * i as f64,
            angle,
        };
        (0..n).zip(around).map(sector).collect()
    };
    around.into_iter().map(sort).collect()
}

/// Where a cell lies in the disk around a vertex.
fn unfold(sectors: &[Sector], cell: &Cell) -> Option<DVec2> {
    let sector = sectors.iter().find(|sector| sector.quad == cell.quad)?;
    let [s, t] = cell.at.to_array();
    let at = match sector.corner {
        0 => DVec2::new(s, t),
        1 => DVec2::new(t, 1.0 - s),
        2 => DVec2::new(1.0 - s, 1.0 - t),
        _ => DVec2::new(1.0 - t, s),
    };
    let share = argument(at) / FRAC_PI_2;
    Some(direction(sector.from + share * sector.angle) * at.length())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::shapes;

    /// The sides of a box cut into n² quads each, as in [`shapes::mapped_cube`], and the cells in
    /// which the vertices of a finer one lie.
    #[test]
    fn the_vertices_of_a_coarse_box_are_found_on_a_fine_one() {
        let fine = shapes::mapped_cube(12, |p| p);
        let coarse = shapes::mapped_cube(4, |p| p);
        let mut quads: Vec<[u32; 4]> = Vec::new();
        for pair in coarse.faces().chunks_exact(2) {
            let [a, b] = [pair[0], pair[1]];
            let apart = b.iter().find(|v| !a.contains(v)).unwrap();
            let i = (0..3).find(|&i| !b.contains(&a[i])).unwrap();
            quads.push([a[i], a[(i + 1) % 3], *apart, a[(i + 2) % 3]].map(|v| v.0));
        }
        let corner = |quad: &[u32; 4], i: usize| coarse.positions()[quad[i] as usize];
        let inside = |p: DVec3| {
            let place = |(quad, corners): (u32, &[u32; 4])| {
                let o = corner(corners, 0);
                let [u, v] = [corner(corners, 1) - o, corner(corners, 3) - o];
                let d = p - o;
                let at = DVec2::new(d.dot(u), d.dot(v)) / u.length_squared();
                let off = (d - u * at.x - v * at.y).length();
                let is_in =
                    at.cmpge(DVec2::splat(-1e-9)).all() && at.cmple(DVec2::splat(1.0 + 1e-9)).all();
                (is_in && off < 1e-9).then_some(Cell { quad, at })
            };
            (0..).zip(&quads).find_map(place).unwrap()
        };
        let cells = fine.positions().iter().map(|&p| inside(p)).collect();
        let found = locate(&fine, (coarse.n_vertices(), &quads), &cells);
        for (place, p) in found.iter().zip(coarse.positions()) {
            let SurfacePoint { face, weights } = place.unwrap();
            let corners = fine.triangle(face);
            let there: DVec3 = (0..3).map(|i| corners[i] * weights[i]).sum();
            assert!(there.distance(*p) < 1e-6, "{there} {p}");
        }
    }
}
