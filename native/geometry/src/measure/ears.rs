//! Polygons to triangles: ears by the crate `earcut`, and the way in which surfaces are measured.

use earcut::Earcut;
use glam::{DVec2, DVec3};

use crate::mesh::{PolygonMesh, VertexId};

/// Adds the triangles of a polygon of a mesh: a quad along the shorter of its diagonals that lie
/// inside, a larger polygon as a fan from its first corner or, where that folds, by its ears.
///
/// Inside is told along Newell's normal. A polygon that crosses itself stays a fan.
pub fn cut_polygon(mesh: &PolygonMesh, polygon: &[VertexId], triangles: &mut Vec<[VertexId; 3]>) {
    match *polygon {
        [a, b, c] => triangles.push([a, b, c]),
        [a, b, c, d] if is_cut_at_first([a, b, c, d].map(|v| mesh.position(v))) => {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        [a, b, c, d] => triangles.extend([[b, c, d], [b, d, a]]),
        _ => {
            let points: Vec<DVec3> = polygon.iter().map(|&v| mesh.position(v)).collect();
            let fan = || (1..polygon.len() - 1).map(|i| [0, i, i + 1]);
            let normal = newell(&points);
            let is_folded = fan().any(|t| area_along(normal, t.map(|i| points[i])) < 0.0);
            let ears = if is_folded { clip_ears(&points) } else { None };
            let named = |t: [usize; 3]| t.map(|i| polygon[i]);
            match ears {
                Some(ears) => triangles.extend(ears.iter().map(|t| named(t.map(|i| i as usize)))),
                None => triangles.extend(fan().map(named)),
            }
        }
    }
}

/// Whether a quad is cut from its first corner.
fn is_cut_at_first([a, b, c, d]: [DVec3; 4]) -> bool {
    let normal = (c - a).cross(d - b);
    let worst = |one, other| f64::min(area_along(normal, one), area_along(normal, other));
    let [first, second] = [worst([a, b, c], [a, c, d]), worst([b, c, d], [b, d, a])];
    if (first <= 0.0) == (second <= 0.0) {
        a.distance(c) <= b.distance(d)
    } else {
        second <= 0.0
    }
}

/// The area of a triangle as seen against a normal, up to a factor.
fn area_along(normal: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).dot(normal)
}

/// Newell's normal of a polygon, as long as twice its area.
fn newell(points: &[DVec3]) -> DVec3 {
    let first = points.first().copied().unwrap_or_default();
    let next = points.iter().cycle().skip(1);
    let pairs = points.iter().zip(next);
    pairs.map(|(&p, &q)| (p - first).cross(q - first)).sum()
}

/// A polygon on the plane that fits it best (Newell's normal), counter-clockwise.
fn flattened(points: &[DVec3]) -> Vec<DVec2> {
    let first = points.first().copied().unwrap_or_default();
    let normal = newell(points).try_normalize().unwrap_or(DVec3::Z);
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |&p: &DVec3| DVec2::new((p - first).dot(x), (p - first).dot(y));
    points.iter().map(flat).collect()
}

/// The triangles of a polygon as rising positions in it, which is also their direction, seen on the
/// plane that fits it best; none when the polygon crosses itself or has no area so that no proper
/// triangulation came out.
pub fn clip_ears(polygon: &[DVec3]) -> Option<Vec<[u32; 3]>> {
    let mut flat = Vec::new();
    let points = flattened(polygon);
    let points = points.iter().map(DVec2::to_array);
    Earcut::new().earcut(points, &[] as &[u32], &mut flat);
    let mut triangles: Vec<[u32; 3]> = flat
        .chunks_exact(3)
        .map(|t| rising([t[0], t[1], t[2]]))
        .collect();
    let n = polygon.len() as u32;
    insert_missing(n, &mut triangles)?;
    is_triangulation(n, &triangles).then_some(triangles)
}

fn rising(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

/// Puts corners back that the crate leaves out because they lie on a straight line: left out, the
/// neighbour across that line would see a crack.
fn insert_missing(n: u32, triangles: &mut Vec<[u32; 3]>) -> Option<()> {
    let mut is_used = vec![false; n as usize];
    for &i in triangles.iter().flatten() {
        is_used[i as usize] = true;
    }
    let used: Vec<u32> = (0..n).filter(|&i| is_used[i as usize]).collect();
    let next = used.iter().cycle().skip(1);
    for (&a, &b) in used.iter().zip(next) {
        let n_missing = (b + n - a - 1) % n;
        if n_missing == 0 {
            continue;
        }
        let at = triangles
            .iter()
            .position(|t| t.contains(&a) && t.contains(&b))?;
        let apex = *triangles[at].iter().find(|&&i| i != a && i != b)?;
        triangles.swap_remove(at);
        let fan = (0..=n_missing).map(|k| rising([(a + k) % n, (a + k + 1) % n, apex]));
        triangles.extend(fan);
    }
    Some(())
}

/// Whether every side has one triangle and every diagonal two, one on each side.
fn is_triangulation(n: u32, triangles: &[[u32; 3]]) -> bool {
    let sides = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let mut sides: Vec<(u32, u32)> = sides.collect();
    sides.sort_unstable();
    let has_side = |i: u32| sides.binary_search(&(i, (i + 1) % n)).is_ok();
    let is_paired = |&(a, b): &(u32, u32)| (a + 1) % n == b || sides.binary_search(&(b, a)).is_ok();
    triangles.len() + 2 == n as usize
        && sides.windows(2).all(|w| w[0] != w[1])
        && (0..n).all(has_side)
        && sides.iter().all(is_paired)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::direction;

    fn cut(points: &[[f64; 2]]) -> Option<Vec<[u32; 3]>> {
        let points: Vec<DVec3> = points
            .iter()
            .map(|p| DVec2::from_array(*p).extend(0.0))
            .collect();
        clip_ears(&points)
    }

    fn triangles(points: &[[f64; 2]]) -> Vec<[u32; 3]> {
        let positions = points
            .iter()
            .map(|p| DVec2::from_array(*p).extend(0.5))
            .collect();
        let polygon: Vec<u32> = (0..points.len() as u32).collect();
        let mesh = PolygonMesh::from_faces(positions, &[polygon]).unwrap();
        let mut found = Vec::new();
        mesh.faces()
            .for_each(|face| cut_polygon(&mesh, face, &mut found));
        found.into_iter().map(|t| t.map(|v| v.0)).collect()
    }

    fn area(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> (f64, f64) {
        let at = |i: u32| DVec2::from_array(points[i as usize]);
        let signed = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).perp_dot(at(c) - at(a)) / 2.0;
        let areas: Vec<f64> = triangles.iter().map(signed).collect();
        (areas.iter().sum(), areas.iter().map(|a| a.abs()).sum())
    }

    #[test]
    fn a_concave_polygon_is_covered_once() {
        let star: Vec<DVec3> = (0..40)
            .map(|i| direction(f64::from(i) * 0.05 * std::f64::consts::PI) * f64::from(1 + i % 2))
            .map(|p| p.extend(0.0))
            .collect();
        let triangles = clip_ears(&star).unwrap();
        let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).z / 2.0;
        let parts = triangles.iter().map(|t| {
            area(
                star[t[0] as usize],
                star[t[1] as usize],
                star[t[2] as usize],
            )
        });
        let whole: f64 = (1..39).map(|i| area(star[0], star[i], star[i + 1])).sum();
        assert!(parts.clone().all(|a| a > 0.0));
        assert!((parts.sum::<f64>() - whole).abs() < 1e-12);
    }

    #[test]
    fn corners_on_a_straight_line_are_kept() {
        let square = [
            [0., 0.],
            [1., 0.],
            [2., 0.],
            [3., 0.],
            [3., 3.],
            [0., 3.],
            [0., 1.],
        ];
        let triangles = cut(&square).unwrap();
        assert_eq!(triangles.len(), 5);
    }

    #[test]
    fn a_line_and_a_bow_tie_are_refused() {
        let line: Vec<_> = (0..6).map(|i| [f64::from(i), 0.0]).collect();
        assert_eq!(cut(&line), None);
        let crossing = [[0., 0.], [4., 4.], [4., 0.], [0., 4.], [-1., 2.]];
        assert!(cut(&crossing).is_none_or(|t| t.len() == 3));
    }

    #[test]
    fn a_quad_is_cut_along_the_shorter_diagonal_that_lies_inside() {
        let kite = [[0.0, 0.0], [1.0, -0.2], [3.0, 0.0], [1.0, 0.2]];
        assert_eq!(triangles(&kite), [[1, 2, 3], [1, 3, 0]]);
        // The shorter one lies outside.
        let arrow = [[0.0, 0.0], [-1.0, -1.0], [4.0, 0.0], [-1.0, 1.0]];
        assert_eq!(triangles(&arrow), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn polygons_are_a_fan_unless_that_folds() {
        let hexagon = [[0., 0.], [1., -1.], [2., -1.], [3., 0.], [2., 1.], [1., 1.]];
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        assert_eq!(triangles(&hexagon), fan);
        let u = [
            [0., 0.],
            [3., 0.],
            [3., 3.],
            [2., 3.],
            [2., 1.],
            [1., 1.],
            [1., 3.],
            [0., 3.],
        ];
        for turned in 0..8 {
            let mut u = u;
            u.rotate_left(turned);
            let found = triangles(&u);
            assert_eq!((found.len(), area(&u, &found)), (6, (7.0, 7.0)), "{turned}");
        }
        // One that crosses itself has a triangle for every corner but two all the same.
        let crossing = [[0., 0.], [4., 4.], [4., 0.], [0., 4.], [-1., 2.]];
        assert_eq!(triangles(&crossing).len(), 3);
    }
}
