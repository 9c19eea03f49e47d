//! The generalised winding number: how often shells, open ones too, go round a place.
//!
//! It is the sum of the solid angles of all triangles over 4 π [jacobson2013robust]. Triangles that
//! are far away count together, as one dipole at their middle [barill2018fast].

use std::f64::consts::PI;

use glam::DVec3;

use super::field::Field;
use crate::elementary::atan2;
use crate::measure::area_vector;

/// Triangles count together from so many of their radii on: at 2 the number is off by some
/// hundredths beside a box; above, only time grows.
const FAR: f64 = 3.0;
/// Heights over a triangle's plane below this share of the distances are none: rounding alone would
/// tell the side of a place on it.
const FLAT: f64 = 1e-12;
/// Triangles of a leaf.
const LEAF: usize = 8;

/// A tree over triangles.
pub struct Winding {
    nodes: Vec<Node>,
    triangles: Vec<[DVec3; 3]>,
}

#[derive(Clone, Copy)]
struct Node {
    middle: DVec3,
    radius: f64,
    /// The areas of the triangles along their normals.
    dipole: DVec3,
    /// Its triangles.
    from: u32,
    to: u32,
    /// Where its second half is; the first follows it. None for a leaf.
    second: Option<u32>,
}

impl Winding {
    /// Builds the tree.
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let middles: Vec<DVec3> = triangles.iter().map(middle).collect();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut nodes = Vec::new();
        build(&mut nodes, (triangles, &middles), &mut order, 0);
        Self {
            nodes,
            triangles: order.iter().map(|&i| triangles[i as usize]).collect(),
        }
    }

    /// The number at a place: 1 inside a closed shell that faces outward, 0 outside; on a triangle the
    /// middle between its two sides.
    pub fn number(&self, p: DVec3) -> f64 {
        let mut sum = 0.0;
        let mut stack = vec![0u32];
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            let to = node.middle - p;
            let distance = to.length();
            if distance > FAR * node.radius {
                sum += to.dot(node.dipole) / (distance * distance * distance);
            } else if let Some(second) = node.second {
                stack.push(second);
                stack.push(at + 1);
            } else {
                let own = &self.triangles[node.from as usize..node.to as usize];
                sum += own.iter().map(|t| solid_angle(t, p)).sum::<f64>();
            }
        }
        sum / (4.0 * PI)
    }
}

fn build(
    nodes: &mut Vec<Node>,
    (triangles, middles): (&[[DVec3; 3]], &[DVec3]),
    order: &mut [u32],
    from: u32,
) {
    let at = nodes.len();
    let own = order.iter().map(|&i| &triangles[i as usize]);
    let areas = own.clone().map(|&t| (area_vector(t), middle(&t)));
    let (sum, dipole, whole) = areas.fold(
        (DVec3::ZERO, DVec3::ZERO, 0.0),
        |(sum, dipole, whole), (area, middle)| {
            let size = area.length();
            (sum + middle * size, dipole + area, whole + size)
        },
    );
    let centre = if whole > 0.0 {
        sum / whole
    } else {
        DVec3::ZERO
    };
    let radius = own
        .flatten()
        .map(|p| p.distance_squared(centre))
        .fold(0.0, f64::max)
        .sqrt();
    nodes.push(Node {
        middle: centre,
        radius,
        dipole,
        from,
        to: from + order.len() as u32,
        second: None,
    });
    if order.len() <= LEAF {
        return;
    }
    let bounds = order
        .iter()
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &i| {
            [low.min(middles[i as usize]), high.max(middles[i as usize])]
        });
    let axis = (bounds[1] - bounds[0]).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        let [x, y] = [a, b].map(|i| middles[i as usize][axis]);
        x.total_cmp(&y).then(a.cmp(&b))
    });
    // Which half each is in is certain, its place there is not.
    let (first, second) = order.split_at_mut(half);
    first.sort_unstable();
    second.sort_unstable();
    build(nodes, (triangles, middles), first, from);
    nodes[at].second = Some(nodes.len() as u32);
    build(nodes, (triangles, middles), second, from + half as u32);
}

fn middle([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*a + *b + *c) / 3.0
}

/// The solid angle of a triangle as seen from a place [oosterom1983solid].
fn solid_angle(triangle: &[DVec3; 3], p: DVec3) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner - p);
    let [x, y, z] = [a, b, c].map(DVec3::length);
    let volume = a.dot(b.cross(c));
    let rest = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    if volume.abs() <= FLAT * x * y * z {
        // In its plane; on it, the middle between half of all and half of all the other way.
        return 0.0;
    }
    2.0 * atan2(volume, rest)
}

impl Field for Winding {
    fn at(&self, p: DVec3) -> f64 {
        self.number(p) - 0.5
    }

    fn fills(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::shapes;

    #[test]
    fn dipoles_agree_with_the_sum_of_all_angles() {
        let mesh = shapes::limbs(3, 12);
        let half = mesh.face_ids().map(|f| mesh.triangle(f));
        let half: Vec<_> = half.filter(|t| middle(t).x > 0.0).collect();
        let tree = Winding::new(&half);
        let mut random = Random::new(2);
        for _ in 0..200 {
            let p = DVec3::new(random.unit(), random.unit(), random.unit()) * 8.0 - 4.0;
            let exact = half.iter().map(|t| solid_angle(t, p)).sum::<f64>() / (4.0 * PI);
            assert!((tree.number(p) - exact).abs() < 0.02, "{p}");
        }
    }

    #[test]
    fn a_closed_shell_is_one_inside_and_nought_outside() {
        let mesh = shapes::cuboid(3);
        let all: Vec<_> = mesh.face_ids().map(|f| mesh.triangle(f)).collect();
        let tree = Winding::new(&all);
        assert!((tree.number(DVec3::new(0.2, 0.1, -0.1)) - 1.0).abs() < 0.01);
        assert!(tree.number(DVec3::new(0.7, 0.1, -0.1)).abs() < 0.01);
        for face in mesh.face_ids() {
            let on_it = middle(&mesh.triangle(face));
            assert!((tree.number(on_it) - 0.5).abs() < 0.01);
        }
    }
}
