//! The relaxation of one vertex: a Newton step on the energy of its fan.
//!
//! For a triangle with rest area A and corners p, b, c on the sphere,
//! d = det(p, b, c) / 2A is its area ratio, g = Σ cot · |opposite edge|² / 2A its Dirichlet energy
//! density, and A · g · (1 + 1/d²) its symmetric Dirichlet energy (Smith & Schaefer 2015): lowest
//! for an isometry, infinite where d reaches 0. Everything is computed from differences to p in
//! its tangent plane, so that triangles of 10⁻⁷ keep their digits.

use glam::{DVec2, DVec3};

/// The rest shape of a triangle (p, b, c) of a fan around p.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rest {
    /// The cotangent at c, the weight of |p − b|².
    pub cot_c: f64,
    /// The cotangent at b, the weight of |p − c|².
    pub cot_b: f64,
    /// The cotangent at p, the weight of |b − c|².
    pub cot_p: f64,
    /// The square of twice the area.
    pub square: f64,
}

/// How a relaxation ended.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Relaxed {
    /// Where the vertex is now.
    pub position: DVec3,
    /// How far it moved, in ring radii.
    pub moved: f64,
    /// The energy of its fan before.
    pub before: f64,
    /// The energy of its fan after.
    pub after: f64,
}

/// The energy of a fan with its first and second derivatives along the sphere.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Derivatives {
    energy: f64,
    gradient: DVec2,
    /// The Hessian's entries xx, xy, yy.
    hessian: [f64; 3],
    /// The mean squared distance of the ring.
    radius_squared: f64,
}

/// Below this sine between its edges at p, a triangle counts as folded: rounding could decide.
const LEAST_SINE_SQUARED: f64 = 1e-28;
/// Halvings of a step before a vertex is left where it is.
const MAX_HALVINGS: usize = 12;
/// The least share of the largest curvature that the Hessian is shifted to: smaller ones send the
/// step to the cap, larger ones slow the descent.
const LEAST_CURVATURE: f64 = 1e-2;

/// The energy of the fan of `p`; infinite unless every triangle is positive. The ring is closed:
/// its first point comes again at its end.
pub fn energy(p: DVec3, ring: &[DVec3], rest: &[Rest]) -> f64 {
    let mut total = 0.0;
    let mut u = ring[0] - p;
    let mut uu = u.length_squared();
    for (rest, &c) in rest.iter().zip(&ring[1..]) {
        let w = c - p;
        let ww = w.length_squared();
        let det = p.dot(u.cross(w));
        if !(det > 0.0 && det * det > LEAST_SINE_SQUARED * uu * ww) {
            return f64::INFINITY;
        }
        let dirichlet = rest.cot_c * uu + rest.cot_b * ww + rest.cot_p * u.distance_squared(w);
        total += dirichlet * (1.0 + rest.square / (det * det));
        u = w;
        uu = ww;
    }
    0.5 * total
}

/// The energy of the fan of `p` and its derivatives in the tangent frame (x, y, p).
pub fn derivatives(p: DVec3, (x, y): (DVec3, DVec3), ring: &[DVec3], rest: &[Rest]) -> Derivatives {
    let local = |b: DVec3| {
        let u = b - p;
        DVec3::new(u.dot(x), u.dot(y), u.dot(p))
    };
    let mut total = 0.0;
    let mut gradient = DVec2::ZERO;
    let mut radial = 0.0;
    let mut hessian = [0.0; 3];
    let mut radius = 0.0;
    let mut u = local(ring[0]);
    let mut uu = u.length_squared();
    for (rest, &c) in rest.iter().zip(&ring[1..]) {
        let w = local(c);
        let ww = w.length_squared();
        let normal = u.cross(w);
        let inverse = 1.0 / normal.z;
        // The gradient of det(p, b, c) is b × c = normal + p × (c − b).
        let turn = DVec2::new(normal.x - (w.y - u.y), normal.y + (w.x - u.x));
        let pull = -2.0 * (rest.cot_c * u + rest.cot_b * w);
        let dirichlet = rest.cot_c * uu + rest.cot_b * ww + rest.cot_p * u.distance_squared(w);
        let barrier = rest.square * inverse * inverse;
        let slope = 2.0 * barrier * inverse;
        total += dirichlet * (1.0 + barrier);
        gradient += pull.truncate() * (1.0 + barrier) - turn * (dirichlet * slope);
        radial += pull.z * (1.0 + barrier) - dirichlet * slope * normal.z;
        let bend = 3.0 * dirichlet * slope * inverse;
        let stiff = 2.0 * (rest.cot_b + rest.cot_c) * (1.0 + barrier);
        hessian[0] += stiff + turn.x * (bend * turn.x - 2.0 * slope * pull.x);
        hessian[1] += bend * turn.x * turn.y - slope * (pull.x * turn.y + pull.y * turn.x);
        hessian[2] += stiff + turn.y * (bend * turn.y - 2.0 * slope * pull.y);
        radius += uu;
        u = w;
        uu = ww;
    }
    Derivatives {
        energy: 0.5 * total,
        gradient: 0.5 * gradient,
        // Along a great circle the second derivative loses the radial part of the gradient.
        hessian: [
            0.5 * (hessian[0] - radial),
            0.5 * hessian[1],
            0.5 * (hessian[2] - radial),
        ],
        radius_squared: radius / rest.len() as f64,
    }
}

impl Derivatives {
    /// The Newton step, with the Hessian shifted to positive definite, no longer than the radius.
    fn step(&self) -> DVec2 {
        let [xx, xy, yy] = self.hessian;
        let mean = f64::midpoint(xx, yy);
        let spread = (0.5 * (xx - yy)).hypot(xy);
        let least = LEAST_CURVATURE * (mean.abs() + spread);
        let shift = (least - (mean - spread)).max(0.0);
        let [xx, yy] = [xx + shift, yy + shift];
        let g = self.gradient;
        let step = DVec2::new(xy * g.y - yy * g.x, xy * g.x - xx * g.y) / (xx * yy - xy * xy);
        if step.is_finite() {
            step.clamp_length_max(self.radius_squared.sqrt())
        } else {
            DVec2::ZERO
        }
    }
}

/// Moves `p` to lower the energy of its fan: one safeguarded Newton step. The fan must be positive
/// and stays so.
pub fn relax(p: DVec3, ring: &[DVec3], rest: &[Rest]) -> Relaxed {
    let (x, y) = p.any_orthonormal_pair();
    let at = derivatives(p, (x, y), ring, rest);
    let stay = Relaxed {
        position: p,
        moved: 0.0,
        before: at.energy,
        after: at.energy,
    };
    let mut step = at.step();
    for _ in 0..MAX_HALVINGS {
        let position = (p + x * step.x + y * step.y).normalize_or(p);
        let after = energy(position, ring, rest);
        if after < at.energy {
            return Relaxed {
                position,
                moved: position.distance(p) / at.radius_squared.sqrt(),
                after,
                ..stay
            };
        }
        step *= 0.5;
    }
    stay
}
