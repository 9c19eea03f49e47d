//! Where the surface wants the crosses: along its principal directions and its sharp edges.

use glam::{DMat3, DVec2, DVec3};

use super::charts::{Charts, halfedges};
use crate::elementary::cos;
use crate::measure::{area_vector, vertex_normals};
use crate::mesh::{FaceId, FaceMap, HalfedgeId, HalfedgeMap, TriangleMesh, VertexMap};

/// What a face asks of the cross on it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pull {
    /// e^{4iθ} of the wanted direction θ in the face's chart; unit, or zero for no wish at all.
    pub toward: DVec2,
    /// How much it matters beside smoothness across one edge.
    pub weight: f64,
}

/// Two directions and the normal of a face: the chart's axes in space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Axes {
    /// Along halfedge 0.
    pub u: DVec3,
    /// normal × u.
    pub v: DVec3,
    /// The unit normal.
    pub normal: DVec3,
}

/// The weight of a sharp edge, of the pull of principal directions at most 1.
const SHARP_WEIGHT: f64 = 4.0;

/// The axes of every face's chart in space; of some frame where a face has no area.
pub fn axes(mesh: &TriangleMesh) -> FaceMap<Axes> {
    let axes = |face| {
        let corners = mesh.triangle(face);
        let along = (corners[1] - corners[0]).normalize_or(DVec3::X);
        let normal = area_vector(corners)
            .try_normalize()
            .unwrap_or_else(|| along.any_orthonormal_vector());
        Axes {
            u: along,
            v: normal.cross(along),
            normal,
        }
    };
    mesh.face_ids().map(axes).collect()
}

/// A tangent direction in a face's chart, as a unit vector.
pub fn in_chart(direction: DVec3, axes: &Axes) -> DVec2 {
    DVec2::new(direction.dot(axes.u), direction.dot(axes.v)).normalize_or(DVec2::X)
}

/// What every face asks: principal directions with weight min(1, alignment · d · |κ₁ − κ₂|)²,
/// d the root of the mean face area, and edges sharper than `sharp_angle` and those `along` which
/// crosses have to lie, with a weight of 4.
pub fn pulls(
    mesh: &TriangleMesh,
    (charts, axes): (&Charts, &FaceMap<Axes>),
    settings: &super::Settings,
    along: &HalfedgeMap<bool>,
) -> FaceMap<Pull> {
    let sharp_cosine = cos(settings.sharp_angle);
    let areas: FaceMap<f64> = mesh
        .face_ids()
        .map(|face| area_vector(mesh.triangle(face)).length())
        .collect();
    let size = (areas.iter().sum::<f64>() / areas.len().max(1) as f64).sqrt();
    let shapes = smooth_shapes(mesh, axes, &areas, sharp_cosine);
    mesh.face_ids()
        .map(|face| {
            let is_line = |h: HalfedgeId| along[h] || is_sharp(mesh, axes, (h, sharp_cosine));
            line_pull(charts, face, is_line).unwrap_or_else(|| {
                let Axes { u, v, .. } = axes[face];
                let [ku, kv] = [shapes[face] * u, shapes[face] * v];
                // κ₁ − κ₂ and twice the angle of the direction of κ₁.
                let double = DVec2::new(u.dot(ku) - v.dot(kv), 2.0 * u.dot(kv));
                let share = (settings.alignment * size * double.length()).min(1.0);
                Pull {
                    toward: double.rotate(double).normalize_or_zero(),
                    weight: share * share,
                }
            })
        })
        .collect()
}

fn is_sharp(
    mesh: &TriangleMesh,
    axes: &FaceMap<Axes>,
    (h, sharp_cosine): (HalfedgeId, f64),
) -> bool {
    let across = mesh.twin(h).map(|twin| axes[twin.face()].normal);
    across.is_some_and(|normal| normal.dot(axes[h.face()].normal) < sharp_cosine)
}

/// Along the lines that bound a face, if it has any.
fn line_pull(charts: &Charts, face: FaceId, is_line: impl Fn(HalfedgeId) -> bool) -> Option<Pull> {
    let mut n = 0;
    let mut sum = DVec2::ZERO;
    for h in halfedges(face).into_iter().filter(|&h| is_line(h)) {
        sum += fourth_power(charts.edge(h).normalize_or(DVec2::X));
        n += 1;
    }
    (n > 0).then(|| Pull {
        toward: sum.normalize_or_zero(),
        weight: SHARP_WEIGHT * sum.length() / f64::from(n),
    })
}

/// z⁴ of a complex number.
pub fn fourth_power(z: DVec2) -> DVec2 {
    let square = z.rotate(z);
    square.rotate(square)
}

/// Shape operators as tensors of space, averaged three times over neighbours by area; never over
/// sharp edges.
fn smooth_shapes(
    mesh: &TriangleMesh,
    axes: &FaceMap<Axes>,
    areas: &FaceMap<f64>,
    sharp_cosine: f64,
) -> FaceMap<DMat3> {
    let normals = vertex_normals(mesh);
    let mut shapes: FaceMap<DMat3> = mesh
        .face_ids()
        .map(|face| shape(mesh, face, axes[face], &normals))
        .collect();
    for _ in 0..3 {
        shapes = mesh
            .face_ids()
            .map(|face| {
                let mut sum = shapes[face] * areas[face];
                let mut total = areas[face];
                for twin in halfedges(face).into_iter().filter_map(|h| mesh.twin(h)) {
                    let other = twin.face();
                    if axes[face].normal.dot(axes[other].normal) >= sharp_cosine {
                        sum += shapes[other] * areas[other];
                        total += areas[other];
                    }
                }
                sum * total.max(1e-300).recip()
            })
            .collect();
    }
    shapes
}

/// The second fundamental form of one face that fits the turn of the vertex normals along its
/// edges best (Rusinkiewicz 2004).
fn shape(mesh: &TriangleMesh, face: FaceId, axes: Axes, normals: &VertexMap<DVec3>) -> DMat3 {
    let Axes { u, v, .. } = axes;
    let corners = mesh.triangle(face);
    let normals = mesh.face(face).map(|vertex| normals[vertex]);
    let size = (corners[1] - corners[0]).length() + (corners[2] - corners[0]).length() + 1e-300;
    let mut system = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for i in 0..3 {
        let j = (i + 1) % 3;
        let edge = (corners[j] - corners[i]) / size;
        let turn = normals[j] - normals[i];
        let [x, y] = [edge.dot(u), edge.dot(v)];
        for (row, value) in [
            (DVec3::new(x, y, 0.0), turn.dot(u)),
            (DVec3::new(0.0, x, y), turn.dot(v)),
        ] {
            system += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            right += row * value;
        }
    }
    // Triangles without a height have no curvature across: a little of the trace decides.
    let trace = system.x_axis.x + system.y_axis.y + system.z_axis.z;
    let ridge = DMat3::from_diagonal(DVec3::splat(1e-9 * trace + 1e-300));
    let form = (system + ridge).inverse() * right / size;
    if !form.is_finite() {
        return DMat3::ZERO;
    }
    let [along, across] = [u * form.x + v * form.y, u * form.y + v * form.z];
    outer(u, along) + outer(v, across)
}

/// The matrix a bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
