//! Untangling: inverted and nearly inverted faces are opened, vertex by vertex, in space.
//!
//! On limbs thinner than a face there may be no place on the surface for a vertex whose faces are
//! all good. Near it there is: a vertex of a bad face goes to the best of some places around it,
//! off the surface too, where it pays for the distance. Sphere points stay, so nothing folds there.

use glam::DVec3;

use super::follow::Stars;
use super::sheet::{Point, Sheet};
use crate::mesh::{FaceId, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// Quality below which a face is opened.
const BAD: f64 = 0.15;
/// And up to which it is opened.
const ENOUGH: f64 = 0.3;
/// How far away the places are that a vertex tries, in mean edges.
pub(super) const REACHES: [f64; 5] = [0.4, 0.2, 0.1, 0.05, 0.02];
/// Rounds over the vertices of bad faces; most are open after five.
const N_ROUNDS: usize = 40;
/// Rings of faces around a knot that are pulled smooth with it, at most.
const MOST_RINGS: usize = 4;
/// How often each of their vertices goes to the middle of its neighbours.
const N_SMOOTHINGS: usize = 8;
/// What a vertex a mean edge away from where it was costs, against 0.09 for a face without area.
const COST: f64 = 0.02;
/// The least share by which a move has to lower the sum of both.
const LEAST_GAIN: f64 = 1e-6;

/// Moves the vertices of bad faces in space until none is left or no move helps; returns how many
/// faces were inverted, and how many moves it took.
///
/// What is still inverted then is a knot. It is pulled smooth with more and more of what is around
/// it, and stays so where that leaves less inverted.
pub(super) fn untangle(sheet: &mut Sheet, progress: &Progress) -> Result<[usize; 2], Cancelled> {
    let n_knotted = worse_than(sheet, 0.0).len();
    let mut n_moves = open_all(sheet, progress)?;
    for n_rings in 1..=MOST_RINGS {
        let knots = worse_than(sheet, 0.0);
        if knots.is_empty() {
            break;
        }
        let before = sheet.positions();
        smooth(sheet, &grown(sheet, corners(sheet, &knots), n_rings));
        n_moves += open_all(sheet, progress)?;
        if worse_than(sheet, 0.0).len() >= knots.len() {
            sheet.lift_all(&before);
        }
    }
    Ok([n_knotted, n_moves])
}

/// Moves vertices that are not pinned to the middle of their neighbours, some times.
pub(super) fn smooth(sheet: &mut Sheet, vertices: &[VertexId]) {
    let stars = Stars::new(sheet);
    for _ in 0..N_SMOOTHINGS {
        for &v in vertices {
            if sheet.is_pinned(v) {
                continue;
            }
            let star = stars.of(v);
            let sum: DVec3 = star.iter().map(|&other| sheet.position(other)).sum();
            sheet.lift(v, sum / star.len() as f64);
        }
    }
}

/// Opens bad faces, vertex by vertex, round by round.
fn open_all(sheet: &mut Sheet, progress: &Progress) -> Result<usize, Cancelled> {
    let edge = sheet.mean_edge();
    let starts = sheet.positions();
    let mut n_moves = 0;
    for _ in 0..N_ROUNDS {
        progress.check()?;
        let before = n_moves;
        for v in corners(sheet, &worse_than(sheet, BAD)) {
            n_moves += usize::from(!sheet.is_pinned(v) && open(sheet, v, edge, starts[v]));
        }
        if n_moves == before {
            break;
        }
    }
    Ok(n_moves)
}

/// Whether a face is a quad with a corner that does not turn left seen along the quad's own normal.
pub fn is_inverted(mesh: &PolygonMesh, face: &[VertexId]) -> bool {
    let Ok(p) = <[VertexId; 4]>::try_from(face).map(|face| face.map(|v| mesh.position(v))) else {
        return false;
    };
    let normal = (p[2] - p[0]).cross(p[3] - p[1]);
    let turn = |i: usize| (p[(i + 1) % 4] - p[i]).cross(p[(i + 3) % 4] - p[i]);
    !(0..4).all(|i| turn(i).dot(normal) > 0.0)
}

/// How many of the quads are inverted.
pub fn n_inverted(mesh: &PolygonMesh) -> usize {
    mesh.faces().filter(|face| is_inverted(mesh, face)).count()
}

/// The faces of less than a quality.
pub(super) fn worse_than(sheet: &Sheet, quality: f64) -> Vec<FaceId> {
    let ids = sheet.faces().ids();
    ids.filter(|&face| sheet.quality(face) < quality).collect()
}

/// The corners of faces, each once.
pub(super) fn corners(sheet: &Sheet, faces: &[FaceId]) -> Vec<VertexId> {
    let corners = faces.iter().flat_map(|&face| sheet.faces()[face].corners());
    let mut vertices: Vec<_> = corners.copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// The vertices and so many rings of faces around them.
pub(super) fn grown(sheet: &Sheet, mut vertices: Vec<VertexId>, n_rings: usize) -> Vec<VertexId> {
    for _ in 0..n_rings {
        let around: Vec<_> = vertices
            .iter()
            .flat_map(|&v| sheet.ring(v))
            .copied()
            .collect();
        vertices = corners(sheet, &around);
    }
    vertices
}

/// The places around a vertex that it tries, along the surface and off it, farthest first.
pub(super) fn places_around(now: &Point, edge: f64) -> impl Iterator<Item = DVec3> {
    let now = *now;
    REACHES.into_iter().flat_map(move |reach| {
        let ways = now.ways().into_iter().chain([now.normal, -now.normal]);
        ways.map(move |way| now.position + way * (reach * edge))
    })
}

/// Moves a vertex to the best place around it; false if it stands there.
fn open(sheet: &mut Sheet, v: VertexId, edge: f64, start: DVec3) -> bool {
    let now = *sheet.point(v);
    let cost = |position: DVec3| {
        let there = Point { position, ..now };
        let way = position.distance_squared(start) / (edge * edge);
        sheet.badness(v, &there, ENOUGH) + COST * way
    };
    let before = cost(now.position);
    let mut best = (before, now.position);
    for there in places_around(&now, edge) {
        let cost = cost(there);
        if cost < best.0 {
            best = (cost, there);
        }
    }
    let moves = best.0 < before * (1.0 - LEAST_GAIN);
    if moves {
        sheet.lift(v, best.1);
    }
    moves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::vertex_normals;
    use crate::shapes;
    use crate::sphere::quad_sphere;
    use crate::sphere_map::SphereMap;

    #[test]
    fn quads_with_a_corner_that_turns_back_are_counted() {
        let quad = |corner: [f64; 2]| {
            let flat = [[0.0, 0.0], [1.0, 0.0], corner, [0.0, 1.0]];
            let positions = flat.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
            PolygonMesh::from_faces(positions, &[[0u32, 1, 2, 3]]).unwrap()
        };
        let counts =
            [[1.0, 1.0], [0.6, 0.6], [0.4, 0.4], [-0.2, 2.0]].map(|c| n_inverted(&quad(c)));
        assert_eq!(counts, [0, 0, 1, 1]);
    }

    #[test]
    fn inverted_faces_are_opened_and_the_rest_stays() {
        let mesh = shapes::sphere(12);
        let sphere = mesh.positions().iter().copied().collect();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let mut sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([6, 6, 6]));
        let edge = sheet.mean_edge();
        for i in (0..sheet.n_vertices() as u32).step_by(31) {
            let v = VertexId(i);
            let normal = sheet.point(v).normal;
            let away = normal.any_orthonormal_vector() * (1.3 * edge);
            sheet.lift(v, sheet.position(v) + away);
        }
        let moved = worse_than(&sheet, BAD);
        let before = sheet.positions();
        assert!(!moved.is_empty());
        let [n_knotted, n_moves] = untangle(&mut sheet, &Progress::none()).unwrap();
        assert!(n_knotted > 0 && n_moves > 0);
        assert!(sheet.faces().ids().all(|face| sheet.quality(face) > 0.0));
        let n_stayed = sheet
            .vertex_ids()
            .filter(|&v| sheet.position(v) == before[v]);
        assert!(2 * n_stayed.count() > sheet.n_vertices());
        assert_eq!(untangle(&mut sheet, &Progress::none()).unwrap(), [0, 0]);
    }

    #[test]
    fn a_knot_is_pulled_smooth() {
        let mesh = shapes::sphere(12);
        let sphere = mesh.positions().iter().copied().collect();
        let map = SphereMap::prove(mesh, sphere).unwrap();
        let mut sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([8, 8, 8]));
        // A cap turned inside out: no vertex alone can mend that.
        let cap = sheet.vertex_ids().filter(|&v| sheet.position(v).z > 0.85);
        for v in cap.collect::<Vec<_>>() {
            let p = sheet.position(v);
            sheet.lift(v, DVec3::new(-p.x, p.y, p.z));
        }
        let mut alone = sheet.clone();
        open_all(&mut alone, &Progress::none()).unwrap();
        assert!(!worse_than(&alone, 0.0).is_empty());
        untangle(&mut sheet, &Progress::none()).unwrap();
        assert_eq!(worse_than(&sheet, 0.0), []);
    }
}
