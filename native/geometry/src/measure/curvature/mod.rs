//! Principal curvatures and directions at a chosen scale.
//!
//! Per triangle, the second fundamental form is fitted to the differences of vertex normals along
//! its edges (Rusinkiewicz 2004). As a symmetric tensor of space it is averaged to vertices by area
//! and smoothed by heat: two implicit steps of together scale² / 2, about a Gaussian of deviation
//! `scale`. Heat flows on the surface, so the average never jumps across a thin wall, and a detail
//! much smaller than `scale` has no say. On large meshes heat flows between patches of vertices,
//! which a fraction of the scale holds.

mod heat;
mod patches;

use glam::DVec3;

use super::area_vector;
use crate::elementary::{atan2, cos, hypot, sin};
use crate::mesh::{Id, TriangleMesh, VertexId, VertexMap};
use crate::sparse::NotPositiveDefinite;
use heat::Heat;
use patches::Patches;

/// The curvatures of a surface at one place.
///
/// Curvatures are positive where the surface bends away from its normal, as a sphere does. The
/// directions mean nothing where k1 and k2 are about equal.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Curvature {
    /// The larger curvature.
    pub k1: f64,
    /// The smaller curvature.
    pub k2: f64,
    /// The direction of the larger curvature, a unit vector up to sign.
    pub d1: DVec3,
    /// The direction of the smaller curvature: normal × d1.
    pub d2: DVec3,
    /// The smoothed unit normal.
    pub normal: DVec3,
}

/// The smoothed curvature tensor and normal everywhere on a surface.
#[derive(Clone, Debug)]
pub struct CurvatureField {
    /// Of every vertex, or of every patch of vertices.
    values: Vec<Value>,
    patches: Option<Patches>,
}

/// The principal curvatures and directions of every vertex, smoothed over `scale`.
///
/// Keeps what is larger than `scale`, which should be no less than the mean edge length: half of
/// that already shows single triangles. One sparse factorisation, O(n^1.5).
///
/// # Errors
/// When areas overflow, so that the heat equation cannot be solved.
pub fn principal_curvatures(
    mesh: &TriangleMesh,
    scale: f64,
) -> Result<VertexMap<Curvature>, NotPositiveDefinite> {
    let field = CurvatureField::new(mesh.positions(), mesh.faces(), scale)?;
    Ok(VertexMap::from_vec(
        field.values.iter().map(Value::curvature).collect(),
    ))
}

/// A normal and a symmetric tensor, entries (xx, yy, zz) and (xy, yz, zx); sums of such.
#[derive(Clone, Copy, Default, Debug)]
struct Value {
    normal: DVec3,
    diagonal: DVec3,
    mixed: DVec3,
}

impl Value {
    fn add(&mut self, other: Self, weight: f64) {
        self.normal += other.normal * weight;
        self.diagonal += other.diagonal * weight;
        self.mixed += other.mixed * weight;
    }

    /// The tensor of the outer product k (a bᵀ + b aᵀ) / 2.
    fn add_product(&mut self, a: DVec3, b: DVec3, k: f64) {
        let turned = |p: DVec3| DVec3::new(p.y, p.z, p.x);
        self.diagonal += a * b * k;
        self.mixed += (a * turned(b) + turned(a) * b) * (k / 2.0);
    }

    /// The tensor applied to two vectors.
    fn between(&self, a: DVec3, b: DVec3) -> f64 {
        let turned = |p: DVec3| DVec3::new(p.y, p.z, p.x);
        self.diagonal.dot(a * b) + self.mixed.dot(a * turned(b) + turned(a) * b)
    }

    fn curvature(&self) -> Curvature {
        let normal = self.normal.normalize_or_zero();
        let (u, v) = tangent_frame(normal);
        let [a, b, c] = [self.between(u, u), self.between(u, v), self.between(v, v)];
        let angle = atan2(2.0 * b, a - c) / 2.0;
        let d1 = u * cos(angle) + v * sin(angle);
        let [mean, half] = [f64::midpoint(a, c), hypot((a - c) / 2.0, b)];
        Curvature {
            k1: mean + half,
            k2: mean - half,
            d1,
            d2: normal.cross(d1),
            normal,
        }
    }
}

impl CurvatureField {
    /// Measures any triangles over some positions; they need not be manifold.
    ///
    /// # Errors
    /// When areas overflow, so that the heat equation cannot be solved.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[VertexId; 3]],
        scale: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let surface = Surface {
            positions,
            triangles,
        };
        let mut values = surface.values();
        Heat::of_vertices(&surface, scale)?.smooth(&mut values);
        Ok(Self {
            values,
            patches: None,
        })
    }

    /// The same in a time that hardly grows with the number of triangles: curvatures are measured on
    /// all of them, and smoothed between patches of vertices of a fraction of the scale. Where
    /// patches would be no larger than triangles, nothing is saved and nothing lost.
    ///
    /// # Errors
    /// When areas overflow, so that the heat equation cannot be solved.
    pub fn in_patches(
        positions: &[DVec3],
        triangles: &[[VertexId; 3]],
        scale: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let surface = Surface {
            positions,
            triangles,
        };
        let patches = Patches::new(&surface, scale);
        let mut values = patches.means(&surface.values());
        patches.heat(scale)?.smooth(&mut values);
        Ok(Self {
            values,
            patches: Some(patches),
        })
    }

    /// The curvatures at a place of a triangle, interpolated from its corners or from the patches
    /// around.
    pub fn at(&self, triangle: [VertexId; 3], weights: [f64; 3], place: DVec3) -> Curvature {
        let mut sum = Value::default();
        match &self.patches {
            None => {
                for (v, weight) in triangle.into_iter().zip(weights) {
                    sum.add(self.values[v.index()], weight);
                }
            }
            Some(patches) => {
                for (patch, weight) in patches.around(triangle, place) {
                    sum.add(self.values[patch], weight);
                }
            }
        }
        sum.curvature()
    }
}

#[derive(Clone, Copy)]
struct Surface<'a> {
    positions: &'a [DVec3],
    triangles: &'a [[VertexId; 3]],
}

impl<'a> Surface<'a> {
    fn corners(self) -> impl Iterator<Item = [DVec3; 3]> + 'a {
        self.triangles.iter().map(move |&t| self.at(t))
    }

    fn at(&self, triangle: [VertexId; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.positions[v.index()])
    }

    /// The normal and the curvature tensor of every vertex, means of those of its triangles.
    fn values(self) -> Vec<Value> {
        let areas: Vec<f64> = self.corners().map(|t| area_vector(t).length()).collect();
        let mut values = self.vertex_normals(&areas);
        let mut sums = vec![(Value::default(), 0.0); self.positions.len()];
        for (&triangle, &area) in self.triangles.iter().zip(&areas) {
            let tensor = self.tensor(triangle, &values);
            for v in triangle {
                let (sum, total) = &mut sums[v.index()];
                sum.add(tensor, area);
                *total += area;
            }
        }
        for (value, (sum, total)) in values.iter_mut().zip(sums) {
            value.add(sum, 1.0 / f64::max(total, 1e-300));
        }
        values
    }

    /// Unit normals, of faces weighted by area; the tensors are still zero.
    fn vertex_normals(&self, areas: &[f64]) -> Vec<Value> {
        let mut values = vec![Value::default(); self.positions.len()];
        for (triangle, area) in self.triangles.iter().zip(areas) {
            let normal = area_vector(self.at(*triangle)).normalize_or_zero() * *area;
            for v in triangle {
                values[v.index()].normal += normal;
            }
        }
        for value in &mut values {
            value.normal = value.normal.normalize_or_zero();
        }
        values
    }

    /// The second fundamental form [e f; f g] that fits the turn of the normals along the three
    /// edges best, as a tensor of space.
    fn tensor(&self, triangle: [VertexId; 3], normals: &[Value]) -> Value {
        let p = self.at(triangle);
        let n = triangle.map(|v| normals[v.index()].normal);
        let (u, v) = tangent_frame(area_vector(p).normalize_or_zero());
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        let [mut right_e, mut right_f, mut right_g] = [0.0; 3];
        for i in 0..3 {
            let [edge, turn] = [p[(i + 1) % 3] - p[i], n[(i + 1) % 3] - n[i]];
            let [x, y] = [edge.dot(u), edge.dot(v)];
            xx += x * x;
            xy += x * y;
            yy += y * y;
            right_e += x * turn.dot(u);
            right_f += y * turn.dot(u) + x * turn.dot(v);
            right_g += y * turn.dot(v);
        }
        // Triangles without a height have no curvature across: a little of the trace decides.
        let ridge = 2e-9 * (xx + yy) + 1e-300;
        let diagonal = [xx + ridge, xx + yy + ridge, yy + ridge];
        let [e, f, g] = solve_tridiagonal(diagonal, xy, [right_e, right_f, right_g]);
        let mut tensor = Value::default();
        if [e, f, g].iter().all(|k| k.is_finite()) {
            tensor.add_product(u, u, e);
            tensor.add_product(u, v, 2.0 * f);
            tensor.add_product(v, v, g);
        }
        tensor
    }
}

/// Solves [a b 0; b c b; 0 b d] x = right.
fn solve_tridiagonal([a, c, d]: [f64; 3], b: f64, [p, q, r]: [f64; 3]) -> [f64; 3] {
    let first = b / a;
    let pivot = c - b * first;
    let second = b / pivot;
    let q = q - p * first;
    let z = (r - q * second) / (d - b * second);
    let y = (q - b * z) / pivot;
    [(p - b * y) / a, y, z]
}

/// Two directions that make a right-handed frame with a unit normal.
fn tangent_frame(normal: DVec3) -> (DVec3, DVec3) {
    let axis = DVec3::AXES[normal.abs().min_position()];
    let u = normal.cross(axis).normalize_or_zero();
    (u, normal.cross(u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::mean_edge_length;
    use crate::shapes;

    #[test]
    fn a_sphere_is_bent_by_one_over_its_radius_everywhere() {
        let sphere = shapes::sphere(24);
        let mesh = sphere.with_positions(sphere.positions().iter().map(|&p| p * 5.0).collect());
        for (found, position) in principal_curvatures(&mesh, 0.5)
            .unwrap()
            .iter()
            .zip(mesh.positions())
        {
            assert!(
                (found.k1 - 0.2).abs() < 0.006 && (found.k2 - 0.2).abs() < 0.006,
                "{found:?}"
            );
            assert!(found.normal.distance(*position / 5.0) < 0.05);
        }
    }

    #[test]
    fn a_rod_is_bent_around_and_straight_along() {
        let mesh = shapes::capsule(8.0, 30);
        let field = principal_curvatures(&mesh, mean_edge_length(&mesh)).unwrap();
        let on_rod = |p: &DVec3| p.z.abs() < 2.0;
        for (found, _) in field
            .iter()
            .zip(mesh.positions())
            .filter(|(_, p)| on_rod(p))
        {
            assert!(
                (found.k1 - 1.0).abs() < 0.06 && found.k2.abs() < 0.03,
                "{found:?}"
            );
            assert!(
                found.d2.z.abs() > 0.999 && found.d1.z.abs() < 0.05,
                "{found:?}"
            );
        }
    }

    #[test]
    fn curvature_of_an_inside_out_mesh_has_the_other_sign() {
        let mesh = shapes::sphere(8);
        let flipped = mesh
            .faces()
            .iter()
            .map(|&[a, b, c]| [a, c, b])
            .collect::<Vec<_>>();
        let field = CurvatureField::new(mesh.positions(), &flipped, 0.2).unwrap();
        assert!(field.values.iter().all(|v| v.curvature().k1 < -0.8));
    }

    #[test]
    fn scaling_the_mesh_scales_curvature_inversely() {
        let mesh = shapes::limbs(3, 6);
        for size in [1e-30, 1e30] {
            let scaled = mesh.with_positions(mesh.positions().iter().map(|&p| p * size).collect());
            let [one, other] = [(&mesh, 1.0), (&scaled, size)]
                .map(|(mesh, size)| principal_curvatures(mesh, 0.3 * size).unwrap());
            for (a, b) in one.iter().zip(other.iter()) {
                assert!(
                    (a.k1 - b.k1 * size).abs() < 1e-6 * (a.k1.abs() + a.k2.abs()),
                    "{a:?} {b:?}"
                );
            }
        }
    }

    #[test]
    fn faces_without_area_do_not_poison_the_field() {
        let mesh = shapes::sphere(4);
        let mut faces = mesh.faces().to_vec();
        faces.push([faces[0][0], faces[0][1], faces[0][1]]);
        faces.push([faces[3][0]; 3]);
        let mut positions = mesh.positions().to_vec();
        positions.push(DVec3::ONE);
        let field = CurvatureField::new(&positions, &faces, 0.5).unwrap();
        assert!(field.values.iter().all(|v| v.curvature().k1.is_finite()));
    }

    #[test]
    fn patches_of_a_fraction_of_the_scale_have_the_field_of_all_vertices() {
        let mesh = shapes::limbs(3, 40);
        let scale = 12.0 * mean_edge_length(&mesh);
        let (positions, faces) = (mesh.positions(), mesh.faces());
        let all = CurvatureField::new(positions, faces, scale).unwrap();
        let patches = CurvatureField::in_patches(positions, faces, scale).unwrap();
        assert!(3 * patches.values.len() < all.values.len());
        let [mut off, mut bent, mut total] = [0.0; 3];
        for &face in faces {
            let middle = face.iter().map(|v| mesh.position(*v)).sum::<DVec3>() / 3.0;
            let [a, b] = [&all, &patches].map(|field| field.at(face, [1.0 / 3.0; 3], middle));
            let weight = (a.k1 - a.k2).abs();
            off += weight * atan2(a.d1.cross(b.d1).length(), a.d1.dot(b.d1).abs());
            bent += (a.k1 - b.k1).abs() + (a.k2 - b.k2).abs();
            total += weight;
        }
        let [off, bent] = [(off / total).to_degrees(), bent / total];
        assert!(off < 3.0 && bent < 0.1, "{off}° {bent}");
    }

    #[test]
    fn a_surface_without_area_is_flat_and_one_too_large_is_refused() {
        let faces = [[0, 1, 2].map(VertexId)];
        let field = CurvatureField::new(&[DVec3::ZERO; 3], &faces, 0.0).unwrap();
        assert!(field.at(faces[0], [1.0, 0.0, 0.0], DVec3::ZERO).k1.abs() < 1e-300);
        let huge = [DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 1e200);
        assert!(CurvatureField::new(&huge, &faces, 1e200).is_err());
    }
}
