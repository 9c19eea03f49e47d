//! Sites: points of the surface that faces are to come near to.

use glam::DVec3;

use super::target::Target;
use crate::measure::area_vector;
use crate::mesh::{Id, VertexId};

/// A point of the surface and the normal there.
#[derive(Clone, Copy)]
pub(super) struct Site {
    pub position: DVec3,
    pub normal: DVec3,
}

/// About so many vertices of the surface, evenly chosen: its outermost points are among them.
pub(super) fn vertices(target: &Target, n: usize) -> Vec<Site> {
    let n_vertices = target.mesh().n_vertices();
    let ids = (0..n_vertices).step_by(n_vertices.div_ceil(n).max(1));
    let site = |i| {
        let v = VertexId::from_index(i);
        Site {
            position: target.mesh().position(v),
            normal: target.vertex_normal(v),
        }
    };
    ids.map(site).collect()
}

/// So many points, spread evenly by area. No two lie in one of so many pieces of equal area into
/// which the faces in their order are cut.
pub(super) fn spread(target: &Target, n: usize) -> Vec<Site> {
    let mesh = target.mesh();
    let area = |face| area_vector(mesh.triangle(face)).length();
    let piece = mesh.face_ids().map(area).sum::<f64>() / n as f64;
    let mut sites = Vec::with_capacity(n);
    let mut passed = 0.0;
    for face in mesh.face_ids() {
        passed += area(face);
        while sites.len() < n && (sites.len() as f64 + 0.5) * piece <= passed {
            let [a, b, c] = mesh.triangle(face);
            let [u, v] = inside(sites.len());
            sites.push(Site {
                position: a + (b - a) * u + (c - a) * v,
                normal: target.normal(face),
            });
        }
    }
    sites
}

/// Barycentric weights of the i-th of points that fill a triangle evenly: the additive sequence of
/// two irrational steps, folded.
fn inside(i: usize) -> [f64; 2] {
    // 1/g and 1/g² with g³ = g + 1, whose multiples lie farthest apart.
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let [u, v] = STEPS.map(|step| (0.5 + step * i as f64).fract());
    if u + v > 1.0 {
        [1.0 - u, 1.0 - v]
    } else {
        [u, v]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Progress;
    use crate::shapes;

    #[test]
    fn sites_are_spread_evenly_over_the_surface() {
        let target = Target::new(shapes::sphere(20), &Progress::none()).unwrap();
        let sites = spread(&target, 2_000);
        assert_eq!(sites.len(), 2_000);
        let is_on = |s: &Site| {
            (0.98..=1.0).contains(&s.position.length()) && s.normal.dot(s.position) > 0.98
        };
        assert!(sites.iter().all(is_on));
        // Cap by cap about the share of its area.
        for axis in DVec3::AXES
            .into_iter()
            .chain([DVec3::NEG_ONE.normalize_or_zero()])
        {
            for height in [-0.5, 0.0, 0.5, 0.8] {
                let share = sites
                    .iter()
                    .filter(|s| s.position.dot(axis) > height)
                    .count() as f64
                    / 2_000.0;
                assert!(
                    (share - (1.0 - height) / 2.0).abs() < 0.02,
                    "{share} {height}"
                );
            }
        }
    }
}
