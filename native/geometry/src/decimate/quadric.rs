//! Quadrics: the weighted sum of squared distances to planes, as a function of the point.

use std::ops::{Add, AddAssign};

use glam::DVec3;
use rayon::prelude::*;

use super::rounds::{BATCH, TASK};
use crate::mesh::{TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

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

    /// The lowest point, kept near the middle of an edge where the quadric leaves it open: along a
    /// crease, across a plane, and everywhere when there is no area.
    pub fn lowest_near(&self, ends: [DVec3; 2]) -> DVec3 {
        let middle = ends[0].midpoint(ends[1]);
        let [xx, xy, xz, yy, yz, zz] = self.a;
        // Below 1e-6 the inverse loses its digits, from 1e-3 on curved parts shrink visibly.
        let pull = 1e-5 * (xx + yy + zz);
        let x = DVec3::new(xx + pull, xy, xz);
        let y = DVec3::new(xy, yy + pull, yz);
        let z = DVec3::new(xz, yz, zz + pull);
        let [yz, zx, xy] = [y.cross(z), z.cross(x), x.cross(y)];
        let down = -(self.times(middle) + self.b);
        let step = DVec3::new(down.dot(yz), down.dot(zx), down.dot(xy)) / x.dot(yz);
        let reach = ends[0].distance_squared(ends[1]);
        if step.length_squared() <= reach {
            middle + step
        } else {
            middle
        }
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

/// The quadrics of the faces around every vertex, with the corners at `points`.
pub(super) fn vertex_quadrics(
    mesh: &TriangleMesh,
    points: &VertexMap<DVec3>,
    progress: &Progress,
) -> Result<VertexMap<Quadric>, Cancelled> {
    let mut quadrics: VertexMap<Quadric> = VertexMap::filled(points.len(), Quadric::default());
    let mut of_faces = Vec::new();
    for batch in mesh.faces().chunks(BATCH) {
        progress.check()?;
        let faces = batch.par_iter().with_min_len(TASK);
        let quadric = |face: &[VertexId; 3]| Quadric::of_triangle(face.map(|v| points[v]));
        faces.map(quadric).collect_into_vec(&mut of_faces);
        for (face, &quadric) in batch.iter().zip(&of_faces) {
            for &v in face {
                quadrics[v] += quadric;
            }
        }
    }
    Ok(quadrics)
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
