//! The surface of an implicit solid by marching tetrahedra (Doi & Koide 1991).
//!
//! Every cube of the grid falls into six tetrahedra around its diagonal, the same way in all cubes,
//! so that neighbours agree on their common face. A vertex lies on a grid edge whose ends differ in
//! sign; the result is a closed manifold where the solid stays off the grid's border.

use std::collections::BTreeMap;

use glam::DVec3;
use orbflow_geometry::mesh::{Id, VertexId};

/// The ends of the paths from corner 0 to corner 7 of a cube, by the order in which axes are gone.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

/// Points and triangles, facing outward.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// The points.
    pub positions: Vec<DVec3>,
    /// The triangles.
    pub faces: Vec<[VertexId; 3]>,
}

struct Marching {
    surface: Surface,
    on_edge: BTreeMap<(usize, usize), VertexId>,
    n: usize,
    half: f64,
    values: Vec<f64>,
}

/// Finds where `solid` is zero in the cube of half side `half`, on a grid of `n` points a side.
pub fn march(solid: impl Fn(DVec3) -> f64, half: f64, n: usize) -> Surface {
    let mut marching = Marching {
        surface: Surface::default(),
        on_edge: BTreeMap::new(),
        n,
        half,
        values: Vec::new(),
    };
    // An exact zero would put vertices of several edges into one place.
    let signed = |value: f64| if value.abs() < 1e-9 { 1e-9 } else { value };
    marching.values = (0..n * n * n)
        .map(|i| signed(solid(marching.point(i))))
        .collect();
    let is_cube = |i: &usize| marching.grid(*i).iter().all(|&x| x + 1 < n);
    let cubes: Vec<usize> = (0..n * n * n).filter(is_cube).collect();
    for i in cubes {
        let corner = |c: usize| i + (c & 1) + (c >> 1 & 1) * n + (c >> 2) * n * n;
        for tetrahedron in TETRAHEDRA {
            marching.cut(tetrahedron.map(corner));
        }
    }
    marching.surface
}

impl Marching {
    fn grid(&self, i: usize) -> [usize; 3] {
        [i % self.n, i / self.n % self.n, i / self.n / self.n]
    }

    fn point(&self, i: usize) -> DVec3 {
        let step = 2.0 * self.half / (self.n - 1) as f64;
        DVec3::from_array(self.grid(i).map(|x| x as f64 * step - self.half))
    }

    /// Adds the triangles of a tetrahedron, one or two.
    fn cut(&mut self, corners: [usize; 4]) {
        let (inside, outside): (Vec<usize>, Vec<usize>) =
            corners.into_iter().partition(|&c| self.values[c] < 0.0);
        match (inside[..].len(), &inside[..], &outside[..]) {
            (1, &[a], &[b, c, d]) => self.triangle([[a, b], [a, c], [a, d]]),
            (3, &[b, c, d], &[a]) => self.triangle([[b, a], [c, a], [d, a]]),
            (2, &[a, b], &[c, d]) => {
                self.triangle([[a, c], [a, d], [b, d]]);
                self.triangle([[a, c], [b, d], [b, c]]);
            }
            _ => {}
        }
    }

    /// Adds a triangle between three grid edges, each from inside to outside, facing outward.
    fn triangle(&mut self, edges: [[usize; 2]; 3]) {
        let mut face = edges.map(|edge| self.vertex(edge));
        let outward: DVec3 = edges
            .iter()
            .map(|&[a, b]| self.point(b) - self.point(a))
            .sum();
        let [p, q, r] = face.map(|v| self.surface.positions[v.index()]);
        if (q - p).cross(r - p).dot(outward) < 0.0 {
            face.swap(1, 2);
        }
        self.surface.faces.push(face);
    }

    fn vertex(&mut self, [a, b]: [usize; 2]) -> VertexId {
        let key = (a.min(b), a.max(b));
        let [at_a, at_b] = [a, b].map(|i| self.values[i]);
        // Away from the ends, so that no two vertices meet in a grid point.
        let share = (at_a / (at_a - at_b)).clamp(0.02, 0.98);
        let point = self.point(a).lerp(self.point(b), share);
        let surface = &mut self.surface;
        *self.on_edge.entry(key).or_insert_with(|| {
            surface.positions.push(point);
            VertexId::from_index(surface.positions.len() - 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use orbflow_geometry::measure::volume;
    use orbflow_geometry::mesh::TriangleMesh;

    use super::*;

    #[test]
    fn a_ball_is_closed_and_of_its_volume() {
        let Surface { positions, faces } = march(|p| p.length() - 0.8, 1.0, 30);
        let mesh = TriangleMesh::new(positions, faces).unwrap();
        assert!(mesh.is_closed() && mesh.euler_number() == 2);
        let wanted = 4.0 / 3.0 * std::f64::consts::PI * 0.8_f64.powi(3);
        assert!(
            (volume(&mesh) / wanted - 1.0).abs() < 0.02,
            "{}",
            volume(&mesh)
        );
    }
}
