//! Quadrics: the weighted sum of squared distances to planes, as a function of the point.

use std::ops::{Add, AddAssign};

use glam::DVec3;

/// Garland & Heckbert's quadric `p·A p + 2 b·p + c`.
#[derive(Clone, Copy, Default)]
pub(super) struct Quadric {
    /// xx, xy, xz, yy, yz, zz of the symmetric matrix A.
    a: [f64; 6],
    b: DVec3,
    c: f64,
}

impl Quadric {
    /// The squared distance to the plane of a triangle, times its area; zero without area.
    pub fn of_triangle([p, q, r]: [DVec3; 3]) -> Self {
        let cross = (q - p).cross(r - p);
        match cross.try_normalize() {
            Some(n) => Self::of_plane(n, p, 0.5 * cross.length()),
            None => Self::default(),
        }
    }

    /// The squared distance to the plane through `point` with the unit normal `n`, times `weight`.
    pub fn of_plane(n: DVec3, point: DVec3, weight: f64) -> Self {
        let d = -n.dot(point);
        let wn = weight * n;
        Self {
            a: [
                wn.x * n.x,
                wn.x * n.y,
                wn.x * n.z,
                wn.y * n.y,
                wn.y * n.z,
                wn.z * n.z,
            ],
            b: wn * d,
            c: weight * d * d,
        }
    }

    /// The value at a point, not below zero.
    pub fn at(&self, p: DVec3) -> f64 {
        let linear = self.b * 2.0 + self.times(p);
        (linear.dot(p) + self.c).max(0.0)
    }

    fn times(&self, p: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        DVec3::new(
            xx * p.x + xy * p.y + xz * p.z,
            xy * p.x + yy * p.y + yz * p.z,
            xz * p.x + yz * p.y + zz * p.z,
        )
    }
}

impl Add for Quadric {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Self) {
        for (x, y) in self.a.iter_mut().zip(other.a) {
            *x += y;
        }
        self.b += other.b;
        self.c += other.c;
    }
}
