//! How far a part's surface lies from its quads.

use glam::DVec3;

use crate::deform::Target;
use crate::measure::area_vector;
use crate::mesh::{PolygonMesh, VertexId};
use crate::nearest::Bvh;

/// About how many points of the surface are asked.
const N_PROBES: usize = 4_000;

/// Points of the surface farther from the quads than this many edges are missed: a limb is cut off.
const MOST_MISSED: f64 = 2.0;
/// Quads farther from the surface than this many edges are a sheet between limbs (round one, 0.25).
const MOST_ASTRAY: f64 = 1.0;

/// How many quads a part of the surface would take that lies far from all of them, and how many
/// lie far from the surface.
pub fn n_missed(mesh: &PolygonMesh, target: &Target) -> usize {
    let halves = Halves::of(mesh);
    let quad_area = halves.area() / mesh.n_faces() as f64;
    let gaps = halves.gaps(target);
    let is_missed = |gap: &&f64| **gap > MOST_MISSED.powi(2) * quad_area;
    let n_far = gaps.iter().filter(is_missed).count();
    let is_astray = |&(middle, _): &(DVec3, f64)| {
        let gap = target.bvh().closest(middle).distance_squared;
        gap > MOST_ASTRAY.powi(2) * quad_area
    };
    let n_astray = halves.pieces().filter(is_astray).count().div_ceil(2);
    (n_far * mesh.n_faces()).div_ceil(gaps.len()) + n_astray
}

/// How far the surface is from faces at most, in their edges.
pub fn farthest(mesh: &PolygonMesh, target: &Target) -> f64 {
    let halves = Halves::of(mesh);
    let farthest = halves.gaps(target).into_iter().fold(0.0, f64::max);
    let face_area = halves.area() / mesh.n_faces() as f64;
    (farthest / face_area.max(f64::MIN_POSITIVE)).sqrt()
}

/// Faces cut in triangles from their first corner, quads in halves.
pub struct Halves(Vec<[DVec3; 3]>);

impl Halves {
    pub fn of(mesh: &PolygonMesh) -> Self {
        let cut = |f: &[VertexId]| {
            let halves = (2..f.len()).map(|i| [f[0], f[i - 1], f[i]]);
            halves.collect::<Vec<_>>()
        };
        let halves = mesh.faces().flat_map(cut);
        Self(halves.map(|t| t.map(|v| mesh.position(v))).collect())
    }

    /// The middle and the area of every half.
    pub fn pieces(&self) -> impl Iterator<Item = (DVec3, f64)> {
        let piece = |half: &[DVec3; 3]| {
            let middle = half.iter().sum::<DVec3>() / 3.0;
            (middle, area_vector(*half).length())
        };
        self.0.iter().map(piece)
    }

    /// The area of all.
    pub fn area(&self) -> f64 {
        self.pieces().map(|(_, area)| area).sum()
    }

    /// The squared distances of some vertices of the target, evenly chosen.
    pub fn gaps(&self, target: &Target) -> Vec<f64> {
        let bvh = Bvh::new(&self.0);
        let points = target.mesh().positions();
        let some = points.iter().step_by(points.len().div_ceil(N_PROBES));
        some.map(|&p| bvh.closest(p).distance_squared).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::progress::Progress;
    use crate::shapes;
    use crate::sphere::quad_sphere;

    #[test]
    fn halves_have_all_of_the_area_and_the_gaps_of_the_surface_around_them() {
        let quads = quad_sphere([6, 6, 6]);
        let halves = Halves::of(&quads);
        let area: f64 = halves.pieces().map(|(_, area)| area).sum();
        assert!(
            (area / (4.0 * std::f64::consts::PI) - 0.97).abs() < 0.02,
            "{area}"
        );
        let far = shapes::sphere(20);
        let positions = far.positions().iter().map(|&p| p * 2.0).collect();
        let far = TriangleMesh::new(positions, far.faces().to_vec()).unwrap();
        let target = Target::new(far, &Progress::none()).unwrap();
        let gaps = halves.gaps(&target);
        assert!((2_000..=4_000).contains(&gaps.len()), "{}", gaps.len());
        assert!(
            gaps.iter().all(|gap| (0.999..1.1).contains(gap)),
            "{gaps:?}"
        );
    }
}
