//! Faces of the input that go out as they came, after those that are made.

use std::collections::HashMap;

use glam::DVec3;

use super::frame::Frame;
use super::origins::{Origin, Origins};
use super::{CarriedEdge, Cross, Input, Remeshed, Report};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};

/// What goes out, element by element.
pub struct Elements {
    pub mesh: PolygonMesh,
    pub materials: Option<Vec<i32>>,
    pub sphere: Vec<DVec3>,
    pub carried: Vec<CarriedEdge>,
    pub origins: Option<Origins>,
    pub filled: Vec<FaceId>,
}

impl Elements {
    /// With what is told of them.
    pub fn told(self, crosses: Vec<Cross>, kept_faces: usize, report: Report) -> Remeshed {
        Remeshed {
            mesh: self.mesh,
            materials: self.materials,
            sphere: self.sphere,
            carried: self.carried,
            origins: self.origins,
            filled: self.filled,
            crosses,
            kept_faces,
            report,
        }
    }
}

/// The faces that stay, in order, and the vertices that they use.
pub struct Staying {
    faces: Vec<FaceId>,
    vertices: Vec<VertexId>,
}

impl Staying {
    pub fn new(mesh: &PolygonMesh, faces: Vec<FaceId>) -> Self {
        let mut vertices: Vec<VertexId> =
            faces.iter().flat_map(|&f| mesh.face(f)).copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        Self { faces, vertices }
    }

    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// The vertex, counted among those that stay, that an input's vertex is.
    fn name(&self, vertex: VertexId) -> usize {
        let found = self.vertices.binary_search(&vertex);
        found.expect("the vertices of all faces are listed")
    }

    /// Puts the faces after those that are made, with all that lies on them: positions bit for bit.
    pub fn append(&self, input: &Input<'_>, made: &mut Elements) {
        if self.faces.is_empty() {
            return;
        }
        let first = made.mesh.n_vertices();
        let named = |v: VertexId| VertexId::from_index(first + self.name(v));
        made.mesh = self.joined(input.mesh, &made.mesh, named);
        made.sphere.resize(made.mesh.n_vertices(), DVec3::ZERO);
        if let (Some(all), Some(of_faces)) = (&mut made.materials, input.materials) {
            all.extend(self.faces.iter().map(|face| of_faces[face.index()]));
        }
        if let Some(origins) = &mut made.origins {
            let [of_vertices, of_corners] = self.corners(input.mesh);
            origins
                .vertices
                .extend(of_vertices.into_iter().map(Origin::of));
            for set in &mut origins.corners {
                set.extend(of_corners.iter().copied().map(Origin::of));
            }
            origins.faces.extend_from_slice(&self.faces);
        }
        let carried = self.carried(input).into_iter().map(|edge| CarriedEdge {
            ends: edge.ends.map(named),
            ..edge
        });
        made.carried.extend(carried);
    }

    /// A corner of the input at each vertex, and that of each corner.
    fn corners(&self, mesh: &PolygonMesh) -> [Vec<u32>; 2] {
        let starts = mesh.starts();
        let of_faces = self.faces.iter();
        let corners = of_faces.flat_map(|f| starts[f.index()]..starts[f.index() + 1]);
        let of_corners: Vec<u32> = corners.collect();
        let mut of_vertices = vec![0; self.vertices.len()];
        for &corner in of_corners.iter().rev() {
            of_vertices[self.name(mesh.corners()[corner as usize])] = corner;
        }
        [of_vertices, of_corners]
    }

    fn joined(
        &self,
        input: &PolygonMesh,
        made: &PolygonMesh,
        named: impl Fn(VertexId) -> VertexId,
    ) -> PolygonMesh {
        let mut positions = made.positions().to_vec();
        positions.extend(self.vertices.iter().map(|&v| input.position(v)));
        let (mut starts, mut corners) = (made.starts().to_vec(), made.corners().to_vec());
        for &face in &self.faces {
            corners.extend(input.face(face).iter().map(|&v| named(v)));
            starts.push(corners.len() as u32);
        }
        PolygonMesh::new(positions, starts, corners).expect("faces of a mesh make one")
    }

    /// The edges to be carried that stay, each once, by their ends in the input.
    fn carried(&self, input: &Input<'_>) -> Vec<CarriedEdge> {
        let sorted = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
        let mut wanted = HashMap::new();
        for (from, &ends) in input.carried.iter().enumerate() {
            wanted.entry(sorted(ends)).or_insert(from);
        }
        let mut carried = Vec::new();
        for &face in &self.faces {
            let corners = input.mesh.face(face);
            let next = corners.iter().cycle().skip(1);
            for (&a, &b) in corners.iter().zip(next) {
                let ends = [a, b];
                let from = wanted.remove(&sorted(ends));
                carried.extend(from.map(|from| CarriedEdge { ends, from }));
            }
        }
        carried
    }

    /// How many edges to be carried stay, and how long they are in the frame of work.
    pub fn carried_length(&self, input: &Input<'_>, frame: &Frame) -> (usize, f64) {
        let length = |edge: CarriedEdge| {
            let ends = frame.enter(&edge.ends.map(|v| input.mesh.position(v)));
            ends[0].distance(ends[1])
        };
        let carried = self.carried(input);
        (carried.len(), carried.into_iter().map(length).sum())
    }
}

/// A mesh of some of the faces of another, with the vertices that they use.
pub fn some_faces(mesh: &PolygonMesh, is_wanted: impl Fn(FaceId) -> bool) -> PolygonMesh {
    let faces = mesh.face_ids().filter(|&face| is_wanted(face)).collect();
    let nothing = PolygonMesh::new(Vec::new(), vec![0], Vec::new()).expect("nothing is a mesh");
    let staying = Staying::new(mesh, faces);
    let named = |v| VertexId::from_index(staying.name(v));
    staying.joined(mesh, &nothing, named)
}
