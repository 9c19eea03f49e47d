//! Triangles of lists, strips and fans, and of polygons.

use glam::DVec3;

/// Cosine below which a triangle looks away from its polygon.
const AWAY: f64 = 0.0;

/// The triangles of a mode: 4 has three indices for each, 5 a strip, 6 a fan. Triangles without area
/// because an index repeats, as strips have, are left out.
pub fn triangles(mode: u32, indices: &[u32]) -> Vec<[u32; 3]> {
    let triangles: Vec<[u32; 3]> = match mode {
        5 => {
            let turned = |(i, t): (usize, &[u32])| match i % 2 {
                0 => [t[0], t[1], t[2]],
                _ => [t[1], t[0], t[2]],
            };
            indices.windows(3).enumerate().map(turned).collect()
        }
        6 => {
            let first = indices.first().copied().unwrap_or(0);
            let rest = indices.get(1..).unwrap_or_default().windows(2);
            rest.map(|t| [first, t[0], t[1]]).collect()
        }
        _ => indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
    };
    let is_whole = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    triangles.into_iter().filter(is_whole).collect()
}

/// The triangles of a polygon, as places of its corners: a quad is cut along the diagonal that leaves
/// both halves facing like it, the shorter of two; others are cut from the corner that does so best.
pub fn cut(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let n = corners.len();
    let fan = |first: usize| -> Vec<[usize; 3]> {
        let at = |i: usize| (first + i) % n;
        (1..n - 1).map(|i| [first, at(i), at(i + 1)]).collect()
    };
    if n == 3 {
        return vec![[0, 1, 2]];
    }
    let whole: DVec3 = fan(0).iter().map(|t| doubled(corners, t)).sum();
    // A fan of a quad from its third corner is the one from its first.
    let firsts = if n == 4 { 2 } else { n };
    let rank = |first: usize| {
        let fan = fan(first);
        let looks_away = |t: &&[usize; 3]| doubled(corners, t).dot(whole) <= AWAY;
        let length: f64 = fan[..n - 3]
            .iter()
            .map(|t| corners[t[0]].distance(corners[t[2]]))
            .sum();
        (fan.iter().filter(looks_away).count(), length)
    };
    let mut best = (0, rank(0));
    for first in 1..firsts {
        let next = rank(first);
        if next.0 < best.1.0 || (next.0 == best.1.0 && next.1 < best.1.1) {
            best = (first, next);
        }
    }
    fan(best.0)
}

/// Twice the area of a triangle, along its normal.
fn doubled(corners: &[DVec3], &[a, b, c]: &[usize; 3]) -> DVec3 {
    (corners[b] - corners[a]).cross(corners[c] - corners[a])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_face_one_way() {
        assert_eq!(triangles(4, &[0, 1, 2, 2, 1, 3, 9]), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(5, &[0, 1, 2, 3]), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(
            triangles(5, &[0, 1, 2, 2, 3, 3, 4, 5]),
            [[0, 1, 2], [4, 3, 5]]
        );
        assert_eq!(triangles(6, &[0, 1, 2, 3]), [[0, 1, 2], [0, 2, 3]]);
        for mode in [4, 5, 6] {
            assert_eq!(triangles(mode, &[0, 1]), [[0; 3]; 0]);
        }
    }

    fn flat(corners: &[(f64, f64)]) -> Vec<[usize; 3]> {
        let corners: Vec<_> = corners
            .iter()
            .map(|&(x, y)| DVec3::new(x, y, 0.0))
            .collect();
        cut(&corners)
    }

    #[test]
    fn a_quad_is_cut_along_its_short_diagonal_inside() {
        let kite = [(0.0, 0.0), (2.0, -1.0), (6.0, 0.0), (2.0, 1.0)];
        assert_eq!(flat(&kite), [[1, 2, 3], [1, 3, 0]]);
        // The corner at the right is pulled in: the short diagonal lies outside.
        let dart = [(0.0, 0.0), (4.0, -1.0), (1.0, 0.0), (4.0, 1.0)];
        assert_eq!(flat(&dart), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(flat(&kite[..3]), [[0, 1, 2]]);
    }

    #[test]
    fn a_polygon_has_two_triangles_less_than_corners_that_face_like_it() {
        let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)];
        let cut = flat(&arrow);
        assert_eq!(cut.len(), 3);
        let corners: Vec<_> = arrow.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
        assert!(cut.iter().all(|t| doubled(&corners, t).z > 0.0));
    }
}
