//! The point where planes meet best, within a cell [ju2002dual].

use glam::{DMat3, DVec3};

/// Of the directions in which planes hold a point, those weaker than this share of the strongest do
/// not count: below, noise of normals makes spikes; above, edges that turn by 25° become round.
const WEAK: f64 = 0.05;
/// How much a point wishes for the middle when it cannot have what it wants: far less than a plane.
const REST: f64 = 0.01;
/// Rounds until a point held in the cell is at its best, which it is after a few.
const N_ROUNDS: usize = 60;
/// Sweeps of Jacobi's method: a 3 × 3 matrix is diagonal to rounding after five or six.
const N_SWEEPS: usize = 10;

/// Planes through points.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    n: f64,
    sum: DVec3,
    product: DMat3,
    /// Of each normal times its plane's height over the origin.
    heights: DVec3,
}

impl Planes {
    pub const NONE: Self = Self {
        n: 0.0,
        sum: DVec3::ZERO,
        product: DMat3::ZERO,
        heights: DVec3::ZERO,
    };

    /// Adds the plane through a point; a zero normal adds the point alone.
    pub fn push(&mut self, p: DVec3, normal: DVec3) {
        self.n += 1.0;
        self.sum += p;
        self.product += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        self.heights += normal * normal.dot(p);
    }

    /// The mean of the points.
    pub fn middle(&self) -> DVec3 {
        self.sum / self.n.max(1.0)
    }

    /// The point that is nearest to all planes, as near to the middle as it can; the best one inside
    /// the box where that lies outside.
    pub fn meet(&self, [low, high]: [DVec3; 2]) -> DVec3 {
        let middle = self.middle();
        let want = self.heights - self.product * middle;
        let (values, axes) = eigen(self.product);
        let least = WEAK * values.max_element();
        let mut at = middle;
        for i in 0..3 {
            if values[i] > least {
                at += axes.col(i) * (axes.col(i).dot(want) / values[i]);
            }
        }
        if at.clamp(low, high) == at {
            return at;
        }
        let matrix = self.product + DMat3::from_diagonal(DVec3::splat(REST * self.n));
        let want = self.heights + middle * (REST * self.n);
        let mut at = at.clamp(low, high);
        for _ in 0..N_ROUNDS {
            for i in 0..3 {
                let row = matrix.row(i);
                let rest = want[i] - row.dot(at) + row[i] * at[i];
                at[i] = (rest / row[i]).clamp(low[i], high[i]);
            }
        }
        at
    }
}

/// The eigenvalues of a symmetric matrix and their directions, by Jacobi's rotations.
fn eigen(matrix: DMat3) -> (DVec3, DMat3) {
    let mut a = matrix.to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..N_SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= f64::EPSILON * f64::EPSILON {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
            }
            let [from_p, from_q] = [a[p], a[q]];
            for i in 0..3 {
                [a[p][i], a[q][i]] = [c * from_p[i] - s * from_q[i], s * from_p[i] + c * from_q[i]];
            }
            let [from_p, from_q] = [axes[p], axes[q]];
            for i in 0..3 {
                [axes[p][i], axes[q][i]] =
                    [c * from_p[i] - s * from_q[i], s * from_p[i] + c * from_q[i]];
            }
        }
    }
    let values = DVec3::new(a[0][0], a[1][1], a[2][2]);
    (values, DMat3::from_cols_array_2d(&axes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_and_axes_give_the_matrix_back() {
        let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1);
        let wanted = DVec3::new(3.0, 0.5, 0.01);
        let matrix = turn * DMat3::from_diagonal(wanted) * turn.transpose();
        let (values, axes) = eigen(matrix);
        let back = axes * DMat3::from_diagonal(values) * axes.transpose();
        for (a, b) in back.to_cols_array().iter().zip(matrix.to_cols_array()) {
            assert!((a - b).abs() < 1e-14);
        }
        let mut sorted = values.to_array();
        sorted.sort_by(f64::total_cmp);
        for (a, b) in sorted.iter().zip([0.01, 0.5, 3.0]) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn planes_meet_in_a_corner_along_an_edge_or_not_at_all() {
        let unit = [DVec3::ZERO, DVec3::ONE];
        let corner = DVec3::new(0.3, 0.6, 0.7);
        let mut planes = Planes::NONE;
        for (i, axis) in DVec3::AXES.into_iter().enumerate() {
            let beside = DVec3::AXES[(i + 1) % 3] * 0.2;
            planes.push(corner + beside, axis);
        }
        assert!(planes.meet(unit).distance(corner) < 1e-12);

        // Two planes leave an edge: the point of it that is nearest to the middle.
        let mut planes = Planes::NONE;
        planes.push(DVec3::new(0.5, 0.1, 0.2), DVec3::X);
        planes.push(DVec3::new(0.1, 0.5, 0.4), DVec3::Y);
        assert!(planes.meet(unit).distance(DVec3::new(0.5, 0.5, 0.3)) < 1e-12);

        // One plane leaves the middle where it is.
        let mut planes = Planes::NONE;
        planes.push(DVec3::new(0.2, 0.1, 0.5), DVec3::Z);
        planes.push(DVec3::new(0.4, 0.1, 0.5), DVec3::Z);
        assert!(planes.meet(unit).distance(DVec3::new(0.3, 0.1, 0.5)) < 1e-12);
    }

    #[test]
    fn what_lies_outside_the_cell_comes_to_the_best_place_in_it() {
        // The edge x = 1.5, y = 0.5 is outside: y can be had, x as far as it goes.
        let mut planes = Planes::NONE;
        planes.push(DVec3::new(1.5, 0.0, 0.5), DVec3::X);
        planes.push(DVec3::new(0.5, 0.5, 0.5), DVec3::Y);
        let at = planes.meet([DVec3::ZERO, DVec3::ONE]);
        assert!(at.distance(DVec3::new(1.0, 0.5, 0.5)) < 0.02, "{at}");
    }
}
