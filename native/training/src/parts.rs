//! The parts of a mesh that can be trained on, and how they are brought to size.

use orbflow_geometry::mesh::{Id, TriangleMesh, VertexId};
use orbflow_geometry::progress::Progress;

/// The components of a mesh, those that can be trained on and how many cannot.
#[derive(Clone, Debug)]
pub struct Parts {
    /// Those that are closed and of genus 0.
    pub usable: Vec<TriangleMesh>,
    /// How many have a border.
    pub n_open: usize,
    /// How many are closed but have handles.
    pub n_with_handles: usize,
}

/// Splits a mesh into its components.
pub fn split(mesh: &TriangleMesh) -> Parts {
    let parts = mesh.components(&Progress::none());
    let parts = parts.expect("nobody cancels");
    let (closed, open): (Vec<_>, Vec<_>) = parts.into_iter().partition(TriangleMesh::is_closed);
    let is_usable = |part: &TriangleMesh| part.euler_number() == 2;
    let (usable, with_handles): (Vec<_>, Vec<_>) = closed.into_iter().partition(is_usable);
    Parts {
        usable,
        n_open: open.len(),
        n_with_handles: with_handles.len(),
    }
}

/// Each triangle in four, until there are at least `n_faces`; the surface stays what it is.
pub fn refined(mut mesh: TriangleMesh, n_faces: usize) -> TriangleMesh {
    while mesh.n_faces() < n_faces {
        mesh = quartered(&mesh);
    }
    mesh
}

fn quartered(mesh: &TriangleMesh) -> TriangleMesh {
    let mut positions = mesh.positions().to_vec();
    let mut middles = vec![VertexId(u32::MAX); 3 * mesh.n_faces()];
    for h in mesh.halfedge_ids() {
        let twin = mesh.twin(h);
        if twin.is_none_or(|twin| h.index() < twin.index()) {
            let id = VertexId::from_index(positions.len());
            positions.push(
                mesh.position(mesh.origin(h))
                    .midpoint(mesh.position(mesh.target(h))),
            );
            middles[h.index()] = id;
            if let Some(twin) = twin {
                middles[twin.index()] = id;
            }
        }
    }
    let quarters = mesh.faces().iter().enumerate().flat_map(|(f, &[a, b, c])| {
        let [ab, bc, ca] = [0, 1, 2].map(|i| middles[3 * f + i]);
        [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    });
    let faces = quarters.collect();
    TriangleMesh::new(positions, faces).expect("a subdivided manifold is one")
}
