//! The parts of a mesh that can be trained on, and how they are brought to size.

use glam::DVec3;
use orbflow_geometry::mesh::{Id, TriangleMesh, VertexId};

/// The components that are closed and of genus 0.
pub fn closed_parts(mesh: &TriangleMesh) -> Vec<TriangleMesh> {
    let (component, n) = mesh.face_components();
    let mut faces: Vec<Vec<[VertexId; 3]>> = vec![Vec::new(); n];
    for (face, &of) in mesh.faces().iter().zip(&component) {
        faces[of as usize].push(*face);
    }
    let parts = faces
        .into_iter()
        .filter_map(|faces| compact(mesh.positions(), &faces));
    parts
        .filter(|part| part.is_closed() && part.euler_number() == 2)
        .collect()
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

/// The mesh of some faces of another, with only the vertices that they use.
fn compact(positions: &[DVec3], faces: &[[VertexId; 3]]) -> Option<TriangleMesh> {
    let mut ids = vec![VertexId(u32::MAX); positions.len()];
    let mut used = Vec::new();
    let mut id = |v: VertexId| {
        if ids[v.index()].0 == u32::MAX {
            ids[v.index()] = VertexId::from_index(used.len());
            used.push(positions[v.index()]);
        }
        ids[v.index()]
    };
    let faces = faces.iter().map(|f| f.map(&mut id)).collect();
    TriangleMesh::new(used, faces).ok()
}
