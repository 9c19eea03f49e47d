//! Room for a new vertex: the kernel of a ring on the sphere, from where every edge of the ring is
//! seen counter-clockwise.

use glam::{DVec2, DVec3};

/// How far from the old vertex the kernel is looked at, in the plane that touches the sphere there:
/// the tangent of about 84°.
const FARTHEST: f64 = 10.0;

/// A point of the kernel of a ring: the mean of the kernel's corners.
///
/// The ring is closed (its first point comes again at its end) and every triangle of `ring[0]`
/// with an edge of the ring is positive, so that the kernel has `ring[0]` on its border and is not
/// empty. It is cut out of a square in the plane that touches the sphere at `ring[0]`, where great
/// circles are straight lines. None when rounding leaves nothing of it.
pub fn point(ring: &[DVec3]) -> Option<DVec3> {
    let old = ring[0];
    let (x, y) = old.any_orthonormal_pair();
    let size = half_width(ring);
    let mut kernel = vec![
        DVec2::new(-size, -size),
        DVec2::new(size, -size),
        DVec2::new(size, size),
        DVec2::new(-size, size),
    ];
    let mut cut = Vec::with_capacity(8);
    for pair in ring.windows(2) {
        let [u, w] = [pair[0] - old, pair[1] - old];
        // det(old + t, b, c) = det(old, b, c) + t · (b × c), from differences to keep the digits.
        let normal = u.cross(w) + old.cross(w - u);
        let line = DVec3::new(normal.dot(x), normal.dot(y), old.dot(u.cross(w)));
        clip(&kernel, line, &mut cut);
        std::mem::swap(&mut kernel, &mut cut);
    }
    if kernel.len() < 3 {
        return None;
    }
    let mean = kernel.iter().sum::<DVec2>() / kernel.len() as f64;
    (old + x * mean.x + y * mean.y).try_normalize()
}

/// The farthest point of the ring as seen from the first, in the plane that touches there.
fn half_width(ring: &[DVec3]) -> f64 {
    let old = ring[0];
    let far = |&p: &DVec3| {
        let [along, up] = [old.cross(p - old).length(), old.dot(p)];
        if up * FARTHEST > along {
            along / up
        } else {
            FARTHEST
        }
    };
    ring[1..].iter().map(far).fold(0.0, f64::max)
}

/// Keeps of a convex polygon what lies on the positive side of line.x x + line.y y + line.z.
fn clip(polygon: &[DVec2], line: DVec3, kept: &mut Vec<DVec2>) {
    kept.clear();
    let height = |p: DVec2| line.truncate().dot(p) + line.z;
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let [here, there] = [height(p), height(q)];
        if here >= 0.0 {
            kept.push(p);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(p + (q - p) * (here / (here - there)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere_map::is_positive;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec3> {
        let lift = |&(x, y): &(f64, f64)| DVec3::new(x, y, 1.0).normalize_or(DVec3::Z);
        points.iter().chain(points.first()).map(lift).collect()
    }

    #[test]
    fn the_point_sees_every_edge_counter_clockwise() {
        // The second ring is not convex: only a wedge at the first point sees all of it.
        let rings = [
            ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]),
            ring(&[
                (0.0, 0.0),
                (2.0, -0.5),
                (0.5, 0.1),
                (2.0, 2.0),
                (0.2, 0.3),
                (-0.5, 1.0),
            ]),
            ring(&[(0.0, 0.0), (1e-6, 0.0), (1e-6, 1e-6)]),
            ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1e-9)]),
        ];
        for ring in rings {
            let p = point(&ring).unwrap();
            assert!(
                ring.windows(2).all(|e| is_positive(p, e[0], e[1])),
                "{ring:?}"
            );
        }
    }

    #[test]
    fn a_ring_as_wide_as_a_face_of_the_tetrahedron_has_room() {
        let corners = [
            (1.0, 1.0, 1.0),
            (1.0, -1.0, -1.0),
            (-1.0, 1.0, -1.0),
            (1.0, 1.0, 1.0),
        ];
        let ring = corners.map(|c| DVec3::from(c) / 3.0_f64.sqrt());
        let p = point(&ring).unwrap();
        assert!(ring.windows(2).all(|e| is_positive(p, e[0], e[1])), "{p}");
    }

    #[test]
    fn a_ring_without_a_kernel_has_no_room() {
        // Clockwise, it has no inside.
        let clockwise = ring(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]);
        assert_eq!(point(&clockwise), None);
    }
}
