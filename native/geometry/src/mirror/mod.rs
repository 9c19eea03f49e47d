//! Mirror symmetry of triangle meshes: one side of a plane, closed by its image.
//!
//! The plane is where one coordinate is 0. [`double`] cuts a mesh there, keeps the positive side
//! and glues its image to it: a mesh that is exactly symmetric, vertex by vertex and face by face.
//!
//! Not done here: finding out whether a mesh is symmetric, which asks for distances.

mod cut;
mod glue;
mod half;

use std::collections::HashSet;

use glam::DVec3;
use thiserror::Error;

use crate::mesh::{
    FaceId, HalfedgeId, HalfedgeMap, Id, TriangleMesh, TriangleMeshError, VertexId, VertexMap,
};

pub use glue::{double, double_along, double_sheet};
pub use half::{Half, half};

/// A mesh that is its own image in a plane, and which element is whose image.
///
/// The first half of the faces lies on the positive side, the other half are their images.
#[derive(Clone, PartialEq, Debug)]
pub struct Doubled {
    mesh: TriangleMesh,
    images: VertexMap<VertexId>,
    /// The edges in the plane, one after the other, the positive side on their left.
    border: Vec<HalfedgeId>,
    /// Of the vertices of the positive side, the ends of the edge of the old mesh where they lie.
    sources: Vec<[VertexId; 2]>,
    reflection: Reflection,
}

/// Where the image of a point is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reflection {
    /// As far on the other side of the plane where a coordinate is 0: 0, 1 or 2.
    Across(usize),
    /// At the same place: the image of a sheet is its other side.
    Onto,
}

impl Reflection {
    /// The image of a point or vector.
    #[must_use]
    pub fn of(self, point: DVec3) -> DVec3 {
        match self {
            Self::Across(axis) => mirrored(point, axis),
            Self::Onto => point,
        }
    }
}

/// Why one side of a plane cannot be closed by its image.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum DoubleError {
    /// The plane does not meet the mesh, or meets it only in a point.
    #[error("the plane does not cut it")]
    NotCut,
    /// The largest piece on the positive side is no disc.
    #[error("its positive side has {n_loops} borders and the Euler number {euler}, not one and 1")]
    NotADisc {
        /// How many border loops there are.
        n_loops: usize,
        /// Vertices − edges + faces.
        euler: i64,
    },
    /// Too much of the positive side is not in its largest piece.
    #[error("{pct:.0} % of its positive side hangs together only across the plane")]
    Pieces {
        /// How much of the area.
        pct: f64,
    },
    /// The piece or its double touches itself.
    #[error("its positive side touches itself in the plane: {0}")]
    Touches(#[from] TriangleMeshError),
}

impl Doubled {
    /// The whole mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The same without who is whose image.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// Where images are.
    pub fn reflection(&self) -> Reflection {
        self.reflection
    }

    /// The edges in the plane, a closed line with the positive side on its left.
    pub fn border(&self) -> &[HalfedgeId] {
        &self.border
    }

    /// The image of a vertex; in the plane it is the vertex itself.
    pub fn image(&self, vertex: VertexId) -> VertexId {
        self.images[vertex]
    }

    /// Whether a vertex lies in the plane.
    pub fn is_in_plane(&self, vertex: VertexId) -> bool {
        self.images[vertex] == vertex
    }

    /// Edges of the mesh that was doubled, on both sides of each, found again: those of the positive
    /// side or what is left of them, and their images.
    pub fn carried(&self, old: &TriangleMesh, edges: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
        let chosen = old.halfedge_ids().filter(|&h| edges[h]);
        let chosen: HashSet<[VertexId; 2]> =
            chosen.map(|h| [old.origin(h), old.target(h)]).collect();
        let mut carried = HalfedgeMap::filled(edges_of(&self.mesh), false);
        for h in self.mesh.halfedge_ids().take(edges_of(&self.mesh) / 2) {
            let ends = [self.mesh.origin(h), self.mesh.target(h)];
            let is_on = lies_on_one(ends.map(|v| self.sources[v.index()]), &chosen);
            carried[h] = is_on;
            carried[self.image_of_halfedge(h)] = is_on;
        }
        carried
    }

    /// Values at the vertices of the mesh that was doubled, found again at those of the positive side
    /// and at their images.
    pub fn carried_values(&self, old: &TriangleMesh, values: &VertexMap<f64>) -> VertexMap<f64> {
        let mut carried = VertexMap::filled(self.mesh.n_vertices(), 0.0);
        for (v, &source) in self.mesh.vertex_ids().zip(&self.sources) {
            carried[v] = value_between(source, (old, values), self.mesh.position(v));
            carried[self.images[v]] = carried[v];
        }
        carried
    }

    /// Whether a face is one of the positive side.
    pub fn is_positive(&self, face: FaceId) -> bool {
        face.index() < self.mesh.n_faces() / 2
    }

    /// The image of a face.
    pub fn image_of_face(&self, face: FaceId) -> FaceId {
        let half = self.mesh.n_faces() / 2;
        FaceId::from_index((face.index() + half) % (2 * half))
    }

    /// The image of a halfedge: it bounds the image of the face, so it runs the other way.
    pub fn image_of_halfedge(&self, h: HalfedgeId) -> HalfedgeId {
        let face = self.image_of_face(h.face());
        HalfedgeId(3 * face.0 + 2 - h.corner() as u32)
    }

    /// The image of a halfedge that runs the same way, as the image of a path does.
    pub fn image_along(&self, h: HalfedgeId) -> HalfedgeId {
        let image = self.image_of_halfedge(h);
        let twin = self.mesh.twin(image);
        twin.expect("the double of a disc is closed")
    }
}

/// The value at a place between two vertices.
fn value_between(
    [a, b]: [VertexId; 2],
    (mesh, values): (&TriangleMesh, &VertexMap<f64>),
    place: DVec3,
) -> f64 {
    let away = |end| mesh.position(end).distance(place);
    let share = away(a) / (away(a) + away(b)).max(f64::MIN_POSITIVE);
    values[a] + (values[b] - values[a]) * share
}

/// Whether two places, each between the ends of an edge or at one, lie on one of some edges.
fn lies_on_one([a, b]: [[VertexId; 2]; 2], edges: &HashSet<[VertexId; 2]>) -> bool {
    let on_edge = |[p, q]: [VertexId; 2]| {
        let lies = [a, b].iter().flatten().all(|&v| v == p || v == q);
        lies && (edges.contains(&[p, q]) || edges.contains(&[q, p]))
    };
    on_edge([a[0], b[0]]) || on_edge([a[0], b[1]]) || on_edge([a[1], b[0]])
}

fn edges_of(mesh: &TriangleMesh) -> usize {
    3 * mesh.n_faces()
}

/// The image of a point in the plane where a coordinate is 0.
#[must_use]
pub fn mirrored(mut point: DVec3, axis: usize) -> DVec3 {
    point[axis] = -point[axis];
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    fn check(doubled: &Doubled) {
        let mesh = doubled.mesh();
        assert!(mesh.is_closed());
        assert_eq!(mesh.euler_number(), 2);
        for v in mesh.vertex_ids() {
            let image = doubled.image(v);
            assert_eq!(doubled.image(image), v);
            let there = doubled.reflection().of(mesh.position(v));
            assert_eq!(there, mesh.position(image));
        }
        for h in mesh.halfedge_ids() {
            let image = doubled.image_of_halfedge(h);
            assert_eq!(doubled.image_of_halfedge(image), h);
            assert_eq!(mesh.origin(image), doubled.image(mesh.target(h)));
            assert_eq!(mesh.target(image), doubled.image(mesh.origin(h)));
        }
        for pair in doubled.border().windows(2) {
            assert_eq!(mesh.target(pair[0]), mesh.origin(pair[1]));
            assert!(doubled.is_positive(pair[0].face()));
            assert_eq!(mesh.twin(pair[0]), Some(doubled.image_of_halfedge(pair[0])));
        }
    }

    #[test]
    fn closed_shapes_become_symmetric_in_every_axis() {
        for (name, mesh) in shapes::closed(10) {
            for axis in 0..3 {
                for shift in [0.0, 0.013] {
                    let moved = mesh
                        .positions()
                        .iter()
                        .map(|&p| p + DVec3::AXES[axis] * shift);
                    let mesh = mesh.with_positions(moved.collect());
                    let doubled = double(&mesh, axis, 0.3);
                    let doubled = doubled.unwrap_or_else(|e| panic!("{name} {axis}: {e}"));
                    check(&doubled);
                }
            }
        }
    }

    #[test]
    fn marked_edges_are_found_on_both_sides_where_the_positive_one_has_them() {
        let mesh = shapes::cuboid(4);
        let moved = mesh.positions().iter().map(|&p| p + DVec3::X * 0.1);
        let mesh = mesh.with_positions(moved.collect());
        let top = mesh.positions().iter().map(|p| p.y).fold(0.0, f64::max);
        let front = mesh.positions().iter().map(|p| p.z).fold(0.0, f64::max);
        let lies = |p: DVec3| (p.y - top).abs() < 1e-9 && (p.z - front).abs() < 1e-9;
        let ridge = |mesh: &TriangleMesh| -> HalfedgeMap<bool> {
            let ends = mesh
                .halfedge_ids()
                .map(|h| [mesh.origin(h), mesh.target(h)]);
            ends.map(|ends| ends.iter().all(|&v| lies(mesh.position(v))))
                .collect()
        };
        let doubled = double(&mesh, 0, 0.1).unwrap();
        let carried = doubled.carried(&mesh, &ridge(&mesh));
        assert_eq!(carried, ridge(doubled.mesh()));
        assert!(carried.iter().any(|&is_on| is_on));
    }

    #[test]
    fn values_are_found_on_both_sides_where_the_positive_one_has_them() {
        let mesh = shapes::cuboid(5);
        let moved = mesh.positions().iter().map(|&p| p + DVec3::X * 0.1);
        let mesh = mesh.with_positions(moved.collect());
        // Between the ends of an edge it is linear, as what is carried.
        let height = |p: &DVec3| 0.5 + p.y - 0.3 * p.z;
        let values = mesh.positions().iter().map(height).collect();
        let doubled = double(&mesh, 0, 0.0).unwrap();
        let carried = doubled.carried_values(&mesh, &values);
        for (v, value) in carried.iter_ids() {
            let wanted = height(&doubled.mesh().position(v));
            assert!((value - wanted).abs() < 1e-9, "{v}: {value} {wanted}");
        }
    }

    #[test]
    fn a_plane_beside_the_mesh_cuts_nothing() {
        let mesh = shapes::sphere(4);
        let moved = mesh.positions().iter().map(|&p| p + DVec3::X * 3.0);
        let mesh = mesh.with_positions(moved.collect());
        assert_eq!(double(&mesh, 0, 0.3), Err(DoubleError::NotCut));
    }
}
