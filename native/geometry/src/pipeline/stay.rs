//! Faces of the input that go out as they came, after those that are made.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use glam::DVec3;

use super::frame::{Frame, bits};
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
    /// What is made of those of its vertices that are made.
    made: BTreeMap<VertexId, VertexId>,
    /// What is made between the ends of edges.
    between: BTreeMap<[VertexId; 2], Vec<VertexId>>,
    /// Whether what was made has their vertices, and so their data there.
    is_exact: bool,
}

/// Vertices that were made where faces stay, by the places of these.
#[derive(Default)]
pub struct Met {
    /// What is made of the vertex at a place.
    pub vertices: HashMap<[u64; 3], VertexId>,
    /// What is made between two places, from one to the other.
    pub between: HashMap<[[u64; 3]; 2], Vec<VertexId>>,
}

impl Staying {
    /// Faces of a mesh. What was made where they lie takes the places of their vertices.
    pub fn new(mesh: &PolygonMesh, faces: Vec<FaceId>, met: &Met) -> Self {
        let corners = faces.iter().flat_map(|&f| mesh.face(f)).copied();
        let mut vertices: Vec<VertexId> = corners.collect();
        vertices.sort_unstable();
        vertices.dedup();
        let (mut made, mut between) = (BTreeMap::new(), BTreeMap::new());
        if !met.vertices.is_empty() {
            let place = |v: VertexId| bits(mesh.position(v));
            let found = |&v: &VertexId| Some((v, *met.vertices.get(&place(v))?));
            made = vertices.iter().filter_map(found).collect();
            vertices.retain(|v| !made.contains_key(v));
            for ends in faces.iter().flat_map(|&face| sides(mesh.face(face))) {
                if let Some(new) = met.between.get(&ends.map(place)) {
                    between.insert(ends, new.clone());
                }
            }
        }
        Self {
            faces,
            vertices,
            made,
            between,
            is_exact: false,
        }
    }

    /// The same where what is made was given the vertices of faces that somebody keeps.
    #[must_use]
    pub fn exactly(self, is_exact: bool) -> Self {
        Self { is_exact, ..self }
    }

    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// What a vertex of the input is called where so many were made.
    fn name(&self, vertex: VertexId, n_made: usize) -> VertexId {
        let staying = || {
            let found = self.vertices.binary_search(&vertex);
            VertexId::from_index(n_made + found.expect("the vertices of all faces are listed"))
        };
        self.made.get(&vertex).copied().unwrap_or_else(staying)
    }

    /// What is made between the ends of a side.
    fn between(&self, ends: [VertexId; 2]) -> &[VertexId] {
        self.between.get(&ends).map_or(&[], Vec::as_slice)
    }

    /// Puts the faces after those that are made, with all that lies on them: positions bit for bit.
    pub fn append(&self, input: &Input<'_>, made: &mut Elements) {
        if self.faces.is_empty() {
            return;
        }
        let n_made = made.mesh.n_vertices();
        made.mesh = self.joined(input.mesh, &made.mesh);
        made.sphere.resize(made.mesh.n_vertices(), DVec3::ZERO);
        if let (Some(all), Some(of_faces)) = (&mut made.materials, input.materials) {
            all.extend(self.faces.iter().map(|face| of_faces[face.index()]));
        }
        if let Some(origins) = &mut made.origins {
            let (of_vertices, of_corners) = self.corners(input.mesh, &made.mesh);
            if self.is_exact {
                self.own_vertices(input.mesh, &mut origins.vertices);
            }
            origins
                .vertices
                .extend(of_vertices.into_iter().map(Origin::of));
            for set in &mut origins.corners {
                set.extend(of_corners.iter().copied());
            }
            origins.faces.extend_from_slice(&self.faces);
        }
        let sorted = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
        let there = made.carried.iter().filter(|_| self.is_exact);
        let there: BTreeSet<_> = there.map(|edge| sorted(edge.ends)).collect();
        let carried = self.carried(input).into_iter().flat_map(|edge| {
            let [a, b] = edge.ends;
            let along = [
                &[self.name(a, n_made)],
                self.between([a, b]),
                &[self.name(b, n_made)],
            ];
            let along = along.concat();
            let pieces = along.windows(2).map(|w| CarriedEdge {
                ends: [w[0], w[1]],
                ..edge
            });
            pieces.collect::<Vec<_>>()
        });
        let carried = carried.filter(|edge| !there.contains(&sorted(edge.ends)));
        made.carried.extend(carried);
    }

    /// Has vertices that were made where faces stay come from corners of these.
    fn own_vertices(&self, mesh: &PolygonMesh, origins: &mut [Origin]) {
        for &face in &self.faces {
            let first = mesh.starts()[face.index()];
            for (corner, v) in (first..).zip(mesh.face(face)) {
                if let Some(name) = self.made.get(v) {
                    origins[name.index()] = Origin::of(corner);
                }
            }
        }
    }

    /// A corner of the input at each vertex that is not made, and where each corner comes from.
    fn corners(&self, mesh: &PolygonMesh, out: &PolygonMesh) -> (Vec<u32>, Vec<Origin>) {
        let mut of_vertices = vec![0; self.vertices.len()];
        let mut of_corners = Vec::new();
        for &face in &self.faces {
            let corners = mesh.face(face);
            let first = mesh.starts()[face.index()];
            for (i, ends) in sides(corners).enumerate() {
                let [own, next] = [i, (i + 1) % corners.len()].map(|i| first + i as u32);
                if let Ok(at) = self.vertices.binary_search(&ends[0]) {
                    of_vertices[at] = own;
                }
                of_corners.push(Origin::of(own));
                let [a, b] = ends.map(|v| mesh.position(v));
                let between = self.between(ends).iter().map(|&v| {
                    let share = out.position(v).distance(a) / a.distance(b);
                    let share = if share.is_finite() {
                        share.min(1.0)
                    } else {
                        0.0
                    };
                    Origin {
                        corners: [own, next, next],
                        weights: [1.0 - share, share, 0.0],
                    }
                });
                of_corners.extend(between);
            }
        }
        (of_vertices, of_corners)
    }

    /// The faces after those of a mesh that was made.
    fn joined(&self, input: &PolygonMesh, made: &PolygonMesh) -> PolygonMesh {
        let n_made = made.n_vertices();
        let mut positions = made.positions().to_vec();
        for (&v, name) in &self.made {
            positions[name.index()] = input.position(v);
        }
        positions.extend(self.vertices.iter().map(|&v| input.position(v)));
        let (mut starts, mut corners) = (made.starts().to_vec(), made.corners().to_vec());
        for &face in &self.faces {
            for ends in sides(input.face(face)) {
                corners.push(self.name(ends[0], n_made));
                corners.extend(self.between(ends));
            }
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
    Staying::new(mesh, faces, &Met::default()).joined(mesh, &nothing)
}

/// The sides of a face by their ends.
fn sides(face: &[VertexId]) -> impl Iterator<Item = [VertexId; 2]> {
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).map(|(&a, &b)| [a, b])
}
