//! Squares: quads that are to be even wish to be squares of one size while they are fitted.
//!
//! Each quad has a goal, its nearest square, grown or shrunk towards the mean size and turned
//! towards the field, that goes along with its corners: Σᵢ k (xᵢ + stepᵢ − c − sᵢ)², with sᵢ the
//! spokes of the square and c the middle of where the corners step to (Bouaziz et al. 2012). A goal
//! that stayed behind would hold its quad where it is: so whole regions slide instead, and what is
//! too dense makes room over long ways. It asks along the surface alone.

use std::array;
use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::follow::nearest_arm;
use super::sheet::{Face, Sheet};
use super::springs::asked;
use crate::mesh::{FaceMap, VertexId, VertexMap};

/// Share of the way to the arms of the field that squares turn at once: at 0 equal edges leave the
/// field by half a degree, at 1 they are a thirtieth less equal.
const TURN: f64 = 0.35;

/// The quads of a sheet as squares that go along.
pub(super) struct Squares {
    spokes: FaceMap<[DVec3; 4]>,
    /// Of each corner, relative to a sample's pull.
    weight: f64,
}

impl Squares {
    /// All faces of a sheet of quads, along crosses on its map.
    pub fn new(sheet: &Sheet, crosses: &FaceMap<DVec3>, weight: f64) -> Self {
        let mean = sheet.mean_edge() * FRAC_1_SQRT_2;
        let spokes = |face: &Face| {
            let points = array::from_fn(|i| sheet.position(face.corner(0, i)));
            let (spoke, normal) = spoke(&points);
            let length = spoke.length();
            let wanted = length + asked(mean, length);
            let sine = sine_to_arms(sheet, (face, crosses), normal.cross(spoke) - spoke, normal);
            let turned = spoke + normal.cross(spoke) * (TURN * sine);
            let spoke = turned.normalize_or_zero() * wanted;
            let next = normal.cross(spoke);
            [spoke, next, -spoke, -next]
        };
        Self {
            spokes: sheet.faces().iter().map(spokes).collect(),
            weight,
        }
    }

    /// Of each quad at a vertex the step that it wants the vertex to take if its other corners take
    /// theirs, and how much that weighs.
    pub fn at(
        &self,
        sheet: &Sheet,
        v: VertexId,
        steps: &VertexMap<DVec3>,
    ) -> impl Iterator<Item = (DVec3, f64)> {
        sheet.ring(v).iter().map(move |&id| {
            let face = &sheet.faces()[id];
            let corner = face.find(v).expect("a ring's faces have the vertex");
            let others = (1..4).map(|i| face.corner(corner, i));
            let others: DVec3 = others.map(|u| sheet.position(u) + steps[u]).sum();
            // The vertex's own quarter of the middle goes along with it.
            let wanted = (self.spokes[id][corner] + others * 0.25) / 0.75;
            (wanted - sheet.position(v), 0.75 * self.weight)
        })
    }
}

/// The way from the middle of a quad to the first corner of the nearest square, and its normal.
pub(super) fn spoke(&[here, next, far, before]: &[DVec3; 4]) -> (DVec3, DVec3) {
    let normal = (far - here).cross(before - next).normalize_or_zero();
    let spoke = (here - far + normal.cross(before - next)) / 4.0;
    (spoke, normal)
}

/// The sine of the angle from a side of a face's square to the arms of its corners' crosses.
fn sine_to_arms(
    sheet: &Sheet,
    (face, crosses): (&Face, &FaceMap<DVec3>),
    side: DVec3,
    normal: DVec3,
) -> f64 {
    let points = face.corners().iter().map(|&v| sheet.point(v));
    let arms: DVec3 = points
        .map(|at| nearest_arm(crosses[at.place.face], at.normal, side))
        .sum();
    normal.dot(side.normalize_or_zero().cross(arms.normalize_or_zero()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{area_vector, vertex_normals};
    use crate::shapes;
    use crate::sphere::quad_sphere;
    use crate::sphere_map::SphereMap;

    /// A ball with crosses along X.
    fn ball() -> (SphereMap, FaceMap<DVec3>) {
        let ball = shapes::sphere(12);
        let along = |&f: &[VertexId; 3]| {
            let normal = area_vector(f.map(|v| ball.position(v))).normalize_or_zero();
            (DVec3::X - normal * normal.x).normalize_or_zero()
        };
        let crosses = ball.faces().iter().map(along).collect();
        let sphere = ball.positions().iter().copied().collect();
        (SphereMap::prove(ball, sphere).unwrap(), crosses)
    }

    #[test]
    fn squares_go_along_with_their_corners() {
        let (map, crosses) = ball();
        let sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([5, 6, 7]));
        let squares = Squares::new(&sheet, &crosses, 1.0);
        let step = DVec3::new(0.3, -0.1, 0.2);
        let [still, moving] =
            [DVec3::ZERO, step].map(|step| VertexMap::filled(sheet.n_vertices(), step));
        for v in sheet.vertex_ids() {
            let both = squares
                .at(&sheet, v, &still)
                .zip(squares.at(&sheet, v, &moving));
            for ((here, _), (there, _)) in both {
                assert!((there - here).distance(step) < 1e-12, "{there} {here}");
            }
        }
    }

    #[test]
    fn squares_grow_towards_the_mean_size_and_turn_towards_the_arms() {
        let (map, crosses) = ball();
        let sheet = Sheet::new(&map, vertex_normals(map.mesh()), &quad_sphere([5, 6, 7]));
        let squares = Squares::new(&sheet, &crosses, 1.0);
        let mean = sheet.mean_edge() * FRAC_1_SQRT_2;
        let mut off = [0.0; 2];
        for (id, face) in sheet.faces().iter_ids() {
            let points = array::from_fn(|i| sheet.position(face.corner(0, i)));
            let (before, normal) = spoke(&points);
            let after = squares.spokes[id][0];
            let [was, is] = [before, after].map(|spoke| (spoke.length() - mean).abs());
            assert!(is < 1e-12 || is < was, "{id}: {was} {is}");
            for (off, spoke) in off.iter_mut().zip([before, after]) {
                let side = normal.cross(spoke) - spoke;
                *off += sine_to_arms(&sheet, (face, &crosses), side, normal).abs();
            }
        }
        assert!(off[1] < 0.8 * off[0], "{off:?}");
    }
}
