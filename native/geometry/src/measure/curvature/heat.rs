//! The heat equation by which curvature is smoothed.

use glam::DVec3;

use super::{Surface, Value};
use crate::measure::area_vector;
use crate::mesh::Id;
use crate::sparse::{Cholesky, NotPositiveDefinite, SymmetricMatrix};

/// One implicit step of the heat equation, factorised.
pub(super) struct Heat {
    mass: Vec<f64>,
    system: Cholesky,
}

/// How heat flows on the triangles of a surface.
pub(super) struct Conduction {
    /// The area of each vertex.
    pub mass: Vec<f64>,
    /// The two ends of the sides of triangles and how well they conduct, each in each triangle.
    pub sides: Vec<([usize; 2], f64)>,
}

impl Conduction {
    /// Cotangents are kept in 0..=10, so that obtuse triangles make no maximum anew and needles do
    /// not weld their ends together.
    pub fn new(surface: &Surface) -> Self {
        let mut mass = vec![0.0; surface.positions.len()];
        let mut sides = Vec::with_capacity(3 * surface.triangles.len());
        for (&triangle, p) in surface.triangles.iter().zip(surface.corners()) {
            let double_area = 2.0 * area_vector(p).length();
            let ids = triangle.map(Id::index);
            for i in 0..3 {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                mass[ids[i]] += double_area / 6.0;
                let along = (p[i] - p[k]).dot(p[j] - p[k]);
                let cotangent = (along / double_area.max(1e-300)).clamp(0.0, 10.0);
                if ids[i] != ids[j] {
                    sides.push(([ids[i], ids[j]], cotangent / 2.0));
                }
            }
        }
        Self { mass, sides }
    }
}

impl Heat {
    /// Prepares steps of time scale² / 4 between vertices.
    pub fn of_vertices(surface: &Surface, scale: f64) -> Result<Self, NotPositiveDefinite> {
        let Conduction { mass, sides } = Conduction::new(surface);
        Self::new(mass, &sides, scale)
    }

    /// Prepares steps of time scale² / 4 between places of some area.
    pub fn new(
        mut mass: Vec<f64>,
        sides: &[([usize; 2], f64)],
        scale: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let mut system = SymmetricMatrix::new(mass.len());
        for &([a, b], conductance) in sides {
            system.add_square(&[(a, 1.0), (b, -1.0)], conductance * scale * scale / 4.0);
        }
        // Places without area take on what is around them.
        let least = 1e-9 * mass.iter().copied().fold(1e-300, f64::max);
        for (i, mass) in mass.iter_mut().enumerate() {
            *mass = mass.max(least);
            system.add(i, i, *mass);
        }
        Ok(Self {
            mass,
            system: system.factorize()?,
        })
    }

    pub fn smooth(&self, values: &mut [Value]) {
        let parts: [fn(&mut Value) -> &mut DVec3; 3] =
            [|v| &mut v.normal, |v| &mut v.diagonal, |v| &mut v.mixed];
        for part in parts {
            let mut column: Vec<DVec3> = values.iter_mut().map(|v| *part(v)).collect();
            for _ in 0..2 {
                column
                    .iter_mut()
                    .zip(&self.mass)
                    .for_each(|(v, mass)| *v *= *mass);
                self.system.solve_vectors(&mut column);
            }
            for (value, solved) in values.iter_mut().zip(column) {
                *part(value) = solved;
            }
        }
    }
}
