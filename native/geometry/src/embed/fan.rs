//! The relaxation of one vertex: a Newton step on the energy of its fan.
//!
//! For a triangle with rest area A and corners p, b, c on the sphere,
//! d = det(p, b, c) / 2A is its area ratio, g = Σ cot · |opposite edge|² / 2A its Dirichlet energy
//! density, and A · g · (1 + 1/d²) its symmetric Dirichlet energy (Smith & Schaefer 2015): lowest
//! for an isometry, infinite where d reaches 0. An even map adds A · W · (d + 1/d), which is lowest
//! where areas are kept. Everything is computed from differences to p in
//! its tangent plane, so that triangles of 10⁻⁷ keep their digits.

use crate::elementary::hypot;
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

/// What is around a vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Fan<'a> {
    /// The points of its ring on the sphere, the first again at the end.
    pub ring: &'a [DVec3],
    /// The rest shape of each triangle.
    pub rests: &'a [Rest],
    /// The weight W of an even area.
    pub evenness: f64,
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
#[derive(Clone, Copy, PartialEq, Debug, Default)]
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

impl Fan<'_> {
    /// The energy with the vertex at `p`; infinite unless every triangle is positive.
    pub fn energy(&self, p: DVec3) -> f64 {
        let mut total = 0.0;
        let mut u = self.ring[0] - p;
        let mut uu = u.length_squared();
        for (rest, &c) in self.rests.iter().zip(&self.ring[1..]) {
            let w = c - p;
            let ww = w.length_squared();
            let det = p.dot(u.cross(w));
            if !(det > 0.0 && det * det > LEAST_SINE_SQUARED * uu * ww) {
                return f64::INFINITY;
            }
            let dirichlet = rest.cot_c * uu + rest.cot_b * ww + rest.cot_p * u.distance_squared(w);
            let inverse = 1.0 / det;
            let press = rest.square * inverse;
            total += dirichlet * (1.0 + press * inverse) + self.evenness * (det + press);
            u = w;
            uu = ww;
        }
        0.5 * total
    }

    /// The energy with the vertex at `p`, and its derivatives in the tangent frame (x, y, p).
    pub fn derivatives(&self, p: DVec3, (x, y): (DVec3, DVec3)) -> Derivatives {
        let local = |b: DVec3| {
            let u = b - p;
            DVec3::new(u.dot(x), u.dot(y), u.dot(p))
        };
        let mut sum = Derivatives::default();
        let mut u = local(self.ring[0]);
        for (rest, &c) in self.rests.iter().zip(&self.ring[1..]) {
            let w = local(c);
            sum.add(rest, u, w, self.evenness);
            u = w;
        }
        Derivatives {
            energy: 0.5 * sum.energy,
            gradient: 0.5 * sum.gradient,
            hessian: sum.hessian.map(|entry| 0.5 * entry),
            radius_squared: sum.radius_squared / self.rests.len() as f64,
        }
    }

    /// Moves a vertex from `p` to lower the energy: one safeguarded Newton step. The fan must be
    /// positive and stays so.
    pub fn relax(&self, p: DVec3) -> Relaxed {
        let (x, y) = p.any_orthonormal_pair();
        let at = self.derivatives(p, (x, y));
        let stay = Relaxed {
            position: p,
            moved: 0.0,
            before: at.energy,
            after: at.energy,
        };
        let mut step = at.step();
        for _ in 0..MAX_HALVINGS {
            let position = (p + x * step.x + y * step.y).normalize_or(p);
            let after = self.energy(position);
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
}

impl Derivatives {
    /// Adds twice the energy of a triangle (p, p + u, p + w), given in the frame of p.
    #[inline]
    fn add(&mut self, rest: &Rest, u: DVec3, w: DVec3, even: f64) {
        let [uu, ww] = [u.length_squared(), w.length_squared()];
        let normal = u.cross(w);
        let inverse = 1.0 / normal.z;
        // The gradient of det(p, b, c) is b × c = normal + p × (c − b).
        let turn = DVec2::new(normal.x - (w.y - u.y), normal.y + (w.x - u.x));
        let pull = -2.0 * (rest.cot_c * u + rest.cot_b * w);
        let dirichlet = rest.cot_c * uu + rest.cot_b * ww + rest.cot_p * u.distance_squared(w);
        let barrier = rest.square * inverse * inverse;
        let slope = 2.0 * barrier * inverse;
        self.energy += (dirichlet + even * normal.z) * (1.0 + barrier);
        let press = dirichlet * slope - even * (1.0 - barrier);
        self.gradient += pull.truncate() * (1.0 + barrier) - turn * press;
        let bend = (3.0 * dirichlet * inverse + even) * slope;
        // Along a great circle the second derivative loses the radial part of the gradient.
        let radial = pull.z * (1.0 + barrier) - press * normal.z;
        let stiff = 2.0 * (rest.cot_b + rest.cot_c) * (1.0 + barrier) - radial;
        let mixed = pull.x * turn.y + pull.y * turn.x;
        self.hessian[0] += stiff + turn.x * (bend * turn.x - 2.0 * slope * pull.x);
        self.hessian[1] += bend * turn.x * turn.y - slope * mixed;
        self.hessian[2] += stiff + turn.y * (bend * turn.y - 2.0 * slope * pull.y);
        self.radius_squared += uu;
    }

    /// The Newton step, with the Hessian shifted to positive definite, no longer than the radius.
    fn step(&self) -> DVec2 {
        let [xx, xy, yy] = self.hessian;
        let mean = f64::midpoint(xx, yy);
        let spread = hypot(0.5 * (xx - yy), xy);
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

#[cfg(test)]
mod tests {
    use super::super::rest::Metric;
    use super::*;
    use crate::elementary::{cos, sin};
    use crate::random::Random;

    /// A random star of `n` triangles around a random point.
    fn star(seed: u64, n: usize, evenness: f64) -> (DVec3, Vec<DVec3>, Vec<Rest>) {
        let mut random = Random::new(seed);
        let p = DVec3::new(random.unit(), random.unit(), 1.0 + random.unit());
        let p = p.normalize_or(DVec3::Z);
        let (x, y) = p.any_orthonormal_pair();
        let point = |i: usize, random: &mut Random| {
            let angle = (i as f64 + 0.6 * random.unit()) / n as f64 * std::f64::consts::TAU;
            let radius = 0.1 + 0.3 * random.unit();
            (p + radius * (x * cos(angle) + y * sin(angle))).normalize_or(p)
        };
        let mut ring: Vec<DVec3> = (0..n).map(|i| point(i, &mut random)).collect();
        ring.push(ring[0]);
        let metric = Metric {
            delta: 0.05,
            floor: 0.0,
            scale: 0.8,
            evenness,
        };
        let shapes = ring
            .windows(2)
            .map(|e| metric.rest(p, 1.3 * e[0], e[1] + 0.02 * x));
        let rests = shapes.collect();
        (p, ring, rests)
    }

    #[test]
    fn derivatives_are_those_of_the_energy_by_central_differences() {
        for (seed, evenness) in (0..60).map(|i| (i, [0.0, 1.0, 30.0][i as usize % 3])) {
            let (p, ring, rests) = star(seed, 3 + seed as usize % 7, evenness);
            let fan = Fan {
                ring: &ring,
                rests: &rests,
                evenness,
            };
            let (x, y) = p.any_orthonormal_pair();
            let d = fan.derivatives(p, (x, y));
            assert!(
                (fan.energy(p) - d.energy).abs() < 1e-12 * d.energy,
                "{seed}"
            );
            // Along great circles, where second derivatives are those of the sphere.
            let at = |s: f64, t: f64| {
                let step = x * s + y * t;
                let angle = step.length().max(f64::MIN_POSITIVE);
                fan.energy(p * cos(angle) + step / angle * sin(angle))
            };
            let size = d.gradient.length() + d.energy;
            let error = (d.gradient - differences(&at, 1e-5)).length() / size;
            assert!(error < 1e-6, "{seed}: {error}");
            let size = d.hessian.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
            for (found, wanted) in second_differences(&at, 1e-4).iter().zip(d.hessian) {
                assert!((found - wanted).abs() < 1e-3 * size, "{seed}: {wanted}");
            }
        }
    }

    fn differences(at: &impl Fn(f64, f64) -> f64, h: f64) -> DVec2 {
        DVec2::new(at(h, 0.0) - at(-h, 0.0), at(0.0, h) - at(0.0, -h)) / (2.0 * h)
    }

    fn second_differences(at: &impl Fn(f64, f64) -> f64, h: f64) -> [f64; 3] {
        let middle = 2.0 * at(0.0, 0.0);
        let entries = [
            at(h, 0.0) + at(-h, 0.0) - middle,
            (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / 4.0,
            at(0.0, h) + at(0.0, -h) - middle,
        ];
        entries.map(|entry| entry / (h * h))
    }

    #[test]
    fn relaxing_lowers_the_energy_until_it_stays() {
        for seed in 0..20 {
            let (mut p, ring, rests) = star(seed, 6, 0.0);
            let fan = Fan {
                ring: &ring,
                rests: &rests,
                evenness: 0.0,
            };
            let mut last = fan.energy(p);
            for _ in 0..50 {
                let relaxed = fan.relax(p);
                assert!(relaxed.after <= last * (1.0 + 1e-12));
                assert!((relaxed.position.length() - 1.0).abs() < 1e-12);
                (p, last) = (relaxed.position, relaxed.after);
            }
            assert!(fan.relax(p).moved < 1e-6, "{seed}");
        }
    }

    #[test]
    fn a_folded_fan_has_infinite_energy() {
        let (p, ring, rests) = star(3, 5, 0.0);
        let fan = Fan {
            ring: &ring,
            rests: &rests,
            evenness: 0.0,
        };
        assert!(fan.energy(p).is_finite());
        assert!(fan.energy(-p).is_infinite());
        let beyond = ring[0] + 2.0 * (ring[0] - p);
        assert!(fan.energy(beyond.normalize_or(p)).is_infinite());
    }
}
