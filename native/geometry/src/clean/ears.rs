//! Polygons of five and more corners, by the crate `earcut`.

use earcut::Earcut;
use glam::DVec2;

/// The triangles of a polygon as rising positions in it, which is also their direction; none when
/// the polygon crosses itself or has no area so that no proper triangulation came out.
pub(super) fn clip_ears(polygon: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let mut flat = Vec::new();
    let points = polygon.iter().map(DVec2::to_array);
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
        let points: Vec<DVec2> = points.iter().map(|&p| DVec2::from_array(p)).collect();
        clip_ears(&points)
    }

    #[test]
    fn a_concave_polygon_is_covered_once() {
        let star: Vec<DVec2> = (0..40)
            .map(|i| direction(f64::from(i) * 0.05 * std::f64::consts::PI) * f64::from(1 + i % 2))
            .collect();
        let triangles = clip_ears(&star).unwrap();
        let area = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) / 2.0;
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
}
