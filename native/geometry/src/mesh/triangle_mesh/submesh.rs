//! Meshes of some of the faces of another.

use glam::DVec3;

use super::super::{Id, VertexId};
use super::{TriangleMesh, TriangleMeshError};
use crate::progress::{Cancelled, Progress};

/// No name yet.
const NONE: VertexId = VertexId(u32::MAX);

impl TriangleMesh {
    /// The mesh of some faces over positions that others use too, and for each of its vertices the
    /// one that it was. Vertices come in the order in which the faces name them first.
    ///
    /// # Errors
    /// The promises of the type, the first one broken.
    ///
    /// # Panics
    /// When a face names a position that does not exist.
    pub fn of_faces(
        positions: &[DVec3],
        faces: impl IntoIterator<Item = [VertexId; 3]>,
    ) -> Result<(Self, Vec<VertexId>), TriangleMeshError> {
        compact(positions, faces, &mut vec![NONE; positions.len()])
    }

    /// The components, in the order of their first faces, each with vertices as
    /// [`TriangleMesh::of_faces`] numbers them.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn components(&self, progress: &Progress) -> Result<Vec<Self>, Cancelled> {
        let components = self.named_components(progress)?.into_iter();
        Ok(components.map(|(mesh, _)| mesh).collect())
    }

    /// The same, and for each of their vertices the one that it was.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn named_components(
        &self,
        progress: &Progress,
    ) -> Result<Vec<(Self, Vec<VertexId>)>, Cancelled> {
        let (component, n) = self.face_components();
        progress.check()?;
        let mut faces: Vec<Vec<[VertexId; 3]>> = vec![Vec::new(); n];
        for (face, &of) in self.faces().iter().zip(&component) {
            faces[of as usize].push(*face);
        }
        // One for all: no vertex is in two components.
        let mut names = vec![NONE; self.n_vertices()];
        let mut components = Vec::with_capacity(n);
        for faces in faces {
            progress.check()?;
            let made = compact(self.positions(), faces, &mut names);
            components.push(made.expect("a component of a mesh is a mesh"));
        }
        Ok(components)
    }
}

/// `names` holds what each vertex is called in the new mesh, [`NONE`] before.
fn compact(
    positions: &[DVec3],
    faces: impl IntoIterator<Item = [VertexId; 3]>,
    names: &mut [VertexId],
) -> Result<(TriangleMesh, Vec<VertexId>), TriangleMeshError> {
    let mut sources = Vec::new();
    let mut name = |v: VertexId| {
        let name = &mut names[v.index()];
        if *name == NONE {
            *name = VertexId::from_index(sources.len());
            sources.push(v);
        }
        *name
    };
    let faces = faces.into_iter().map(|face| face.map(&mut name)).collect();
    let used = sources.iter().map(|v| positions[v.index()]).collect();
    Ok((TriangleMesh::new(used, faces)?, sources))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn components_keep_triangles_in_order_and_use_every_vertex() {
        let [a, b] = [shapes::sphere(3), shapes::cuboid(2)];
        let shift = a.n_vertices() as u32;
        let moved = b.faces().iter().map(|f| f.map(|v| VertexId(v.0 + shift)));
        let positions = [a.positions(), b.positions()].concat();
        // The second comes first and between, so that components are named by their first faces.
        let (first, rest): (Vec<_>, Vec<_>) = moved.enumerate().partition(|(i, _)| i % 2 == 0);
        let faces = first.iter().map(|f| f.1).chain(a.faces().iter().copied());
        let faces: Vec<_> = faces.chain(rest.iter().map(|f| f.1)).collect();
        let whole = TriangleMesh::new(positions, faces).unwrap();
        let parts = whole.components(&Progress::none()).unwrap();
        for (part, sources) in whole.named_components(&Progress::none()).unwrap() {
            for v in part.vertex_ids() {
                assert_eq!(part.position(v), whole.position(sources[v.index()]));
            }
        }
        let counts: Vec<_> = parts.iter().map(TriangleMesh::n_vertices).collect();
        assert_eq!(counts, [b.n_vertices(), a.n_vertices()]);
        let triangles = |mesh: &TriangleMesh| -> Vec<[DVec3; 3]> {
            mesh.face_ids().map(|f| mesh.triangle(f)).collect()
        };
        assert_eq!(triangles(&parts[1]), triangles(&a));
    }

    #[test]
    fn some_faces_know_the_vertices_that_they_were() {
        let ball = shapes::sphere(3);
        let some = ball.faces().iter().rev().take(7).copied();
        let (patch, sources) = TriangleMesh::of_faces(ball.positions(), some).unwrap();
        assert_eq!((patch.n_faces(), patch.n_vertices()), (7, sources.len()));
        for v in patch.vertex_ids() {
            assert_eq!(patch.position(v), ball.position(sources[v.index()]));
        }
    }

    #[test]
    fn faces_that_make_no_mesh_are_refused() {
        let ball = shapes::sphere(3);
        let twice = [ball.faces()[0]; 2];
        let refused = TriangleMesh::of_faces(ball.positions(), twice);
        assert!(matches!(
            refused,
            Err(TriangleMeshError::Orientation { .. })
        ));
    }
}
