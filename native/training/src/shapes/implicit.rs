//! Random solids as functions that are negative inside.

use glam::{DMat3, DVec3};
use orbflow_geometry::elementary::{exp, exp2, ln, powf, sin_cos};
use orbflow_geometry::random::Random;

/// The share of solids without limbs.
const LUMPS: f64 = 0.3;

/// A solid made of rounded pieces that blend into each other, bent and twisted as a whole.
#[derive(Clone, Debug)]
pub struct Solid {
    pieces: Vec<Piece>,
    /// How far pieces blend.
    blend: f64,
    bend: f64,
    twist: f64,
}

#[derive(Clone, Debug)]
enum Piece {
    /// A rod between two points whose radius goes from one to the other.
    Rod { ends: [DVec3; 2], radii: [f64; 2] },
    /// (|x/a|ⁿ + |y/b|ⁿ + |z/c|ⁿ)^(1/n) ≤ 1 in a frame of its own: from octahedron to box.
    Superquadric {
        centre: DVec3,
        frame: DMat3,
        axes: DVec3,
        power: f64,
    },
}

impl Solid {
    /// A solid about as large as the unit ball: mostly creatures, some lumps.
    pub fn random(random: &mut Random) -> Self {
        let is_lump = random.unit() < LUMPS;
        let pieces = if is_lump {
            lump(random)
        } else {
            creature(random)
        };
        let most_blend = if is_lump { 0.2 } else { 0.06 };
        Self {
            pieces,
            blend: between(random, 0.01, most_blend),
            bend: between(random, -0.8, 0.8),
            twist: between(random, -1.0, 1.0),
        }
    }

    /// Negative inside; about the distance to the surface near it.
    pub fn at(&self, p: DVec3) -> f64 {
        let angle = self.twist * p.z;
        let p = DMat3::from_rotation_z(angle) * p;
        let p = DMat3::from_rotation_y(self.bend * p.x) * p;
        // A smooth minimum: −b log Σ e^(−f/b).
        let sum: f64 = self
            .pieces
            .iter()
            .map(|piece| exp(-piece.at(p) / self.blend))
            .sum();
        -self.blend * ln(sum.max(f64::MIN_POSITIVE))
    }
}

impl Piece {
    fn at(&self, p: DVec3) -> f64 {
        match self {
            Self::Rod {
                ends: [a, b],
                radii,
            } => {
                let along = *b - *a;
                let t = ((p - *a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                p.distance(*a + along * t) - (radii[0] + (radii[1] - radii[0]) * t)
            }
            Self::Superquadric {
                centre,
                frame,
                axes,
                power,
            } => {
                let q = (frame.transpose() * (p - *centre)).abs() / *axes;
                let sum = powf(q.x, *power) + powf(q.y, *power) + powf(q.z, *power);
                (powf(sum, 1.0 / power) - 1.0) * axes.min_element()
            }
        }
    }
}

/// A branching skeleton of thick rods with some bodies at its joints.
fn lump(random: &mut Random) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut joints = vec![DVec3::ZERO];
    let n_rods = random.below(9);
    let thickness = between(random, 0.08, 0.25);
    for _ in 0..n_rods {
        let start = joints[random.below(joints.len())];
        let end = start + direction(random) * between(random, 0.25, 0.8);
        pieces.push(rod([start, end], thickness, random));
        joints.push(end);
    }
    for _ in 0..=random.below(3) {
        let centre = joints[random.below(joints.len())] * random.unit();
        pieces.push(body(centre, 0.6, random));
    }
    pieces
}

/// A body with limbs, each a chain of thin rods that turns less than it goes on.
fn creature(random: &mut Random) -> Vec<Piece> {
    let mut pieces = vec![body(DVec3::ZERO, 0.3, random)];
    let thickness = between(random, 0.07, 0.12);
    for _ in 0..2 + random.below(6) {
        let mut ahead = direction(random);
        let mut joint = ahead * between(random, 0.0, 0.15);
        for _ in 0..=random.below(3) {
            let end = joint + ahead * between(random, 0.3, 0.6);
            pieces.push(rod([joint, end], thickness, random));
            ahead = (ahead + 0.9 * direction(random)).normalize_or(ahead);
            joint = end;
        }
        if random.unit() < 0.3 {
            pieces.push(body(joint, 0.25, random));
        }
    }
    pieces
}

fn rod(ends: [DVec3; 2], thickness: f64, random: &mut Random) -> Piece {
    let radii = [0, 1].map(|_| thickness * between(random, 0.6, 1.3));
    Piece::Rod { ends, radii }
}

fn body(centre: DVec3, most: f64, random: &mut Random) -> Piece {
    let axes = DVec3::from_array([0, 1, 2].map(|_| between(random, 0.12, most)));
    Piece::Superquadric {
        centre,
        frame: turn(random),
        axes,
        power: exp2(between(random, 1.0, 3.0)),
    }
}

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

/// A uniform direction: heights on a sphere are uniform.
fn direction(random: &mut Random) -> DVec3 {
    let z = between(random, -1.0, 1.0);
    let (s, c) = sin_cos(random.unit() * std::f64::consts::TAU);
    let radius = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(radius * c, radius * s, z)
}

/// A rotation about a random axis.
fn turn(random: &mut Random) -> DMat3 {
    let axis = direction(random);
    DMat3::from_axis_angle(axis, random.unit() * std::f64::consts::TAU)
}
