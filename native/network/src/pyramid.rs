//! What the network reads: some levels of the collapse hierarchy, in numbers.
//!
//! Vertices are numbered coarse to fine, so that the vertices of a level are the first ones of the
//! next finer level. Each level has the edges of its mesh, features of its vertices, and for the
//! vertices of the next finer level the one that each of them collapsed into.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use orbflow_geometry::hierarchy::{CollapseHierarchy, HierarchyError};
use orbflow_geometry::mesh::{Id, VertexId, VertexMap};

use crate::features::{N_FEATURES, features};
use crate::frame::principal_frame;
use crate::neighbours::Neighbours;

/// One level of a [`Pyramid`].
#[derive(Clone, PartialEq, Debug)]
pub struct Level {
    /// The edges.
    pub graph: Arc<Neighbours>,
    /// [`N_FEATURES`] numbers per vertex.
    pub features: Vec<f32>,
    /// For each vertex of the next finer level, the vertex of this one that it collapsed into.
    pub parents: Vec<u32>,
}

/// The levels of one mesh, or of several side by side, fine to coarse.
#[derive(Clone, PartialEq, Debug)]
pub struct Pyramid {
    /// The levels, the finest first.
    pub levels: Vec<Level>,
}

/// A mesh made ready for the network.
#[derive(Clone, PartialEq, Debug)]
pub struct Prepared {
    /// What the network reads.
    pub pyramid: Pyramid,
    /// The vertices of the hierarchy, coarse to fine.
    pub order: Vec<VertexId>,
    /// The faces of the finest level, in the numbering of the pyramid.
    pub faces: Vec<[VertexId; 3]>,
    /// The positions of the finest level in the frame that the network sees: area 4π.
    pub positions: Vec<DVec3>,
    /// The rotation from that frame to the mesh's own.
    pub frame: DMat3,
}

impl Prepared {
    /// Reads the levels of at most `sizes` vertices, fine to coarse, out of a hierarchy.
    ///
    /// # Errors
    /// [`HierarchyError`].
    pub fn new(hierarchy: &CollapseHierarchy, sizes: &[usize]) -> Result<Self, HierarchyError> {
        let order = hierarchy.coarse_to_fine();
        let sizes: Vec<usize> = sizes.iter().map(|&n| n.clamp(4, order.len())).collect();
        let mut rank = VertexMap::filled(order.len(), VertexId(0));
        for (i, &v) in order.iter().enumerate() {
            rank[v] = VertexId::from_index(i);
        }
        let mut meshes = Vec::with_capacity(sizes.len());
        for &n in &sizes {
            let faces = hierarchy.faces_at(n)?;
            meshes.push(faces.iter().map(|f| f.map(|v| rank[v])).collect::<Vec<_>>());
        }
        let mesh = hierarchy.mesh();
        let whole: Vec<DVec3> = order.iter().map(|&v| mesh.position(v)).collect();
        let n_finest = sizes.first().map_or(0, |&n| n);
        let fine = meshes.first().cloned().unwrap_or_default();
        let (frame, positions) = principal_frame(&whole[..n_finest], &fine);
        let into = collapse_targets(hierarchy, &rank);
        let levels = sizes
            .iter()
            .zip(&meshes)
            .enumerate()
            .map(|(i, (&n, faces))| Level {
                graph: Arc::new(Neighbours::of_faces(n, faces)),
                features: features(&positions[..n], faces),
                parents: match i.checked_sub(1) {
                    Some(finer) => parents(&into, n, sizes[finer]),
                    None => Vec::new(),
                },
            });
        let pyramid = Pyramid {
            levels: levels.collect(),
        };
        Ok(Self {
            pyramid,
            order,
            faces: fine,
            positions,
            frame,
        })
    }

    /// How many vertices the finest level has.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// The same, turned: the faces, positions and features of a turned mesh.
    #[must_use]
    pub fn turned(&self, turn: DMat3) -> Self {
        let mut turned = self.clone();
        for p in &mut turned.positions {
            *p = turn * *p;
        }
        for level in &mut turned.pyramid.levels {
            for row in level.features.chunks_exact_mut(N_FEATURES) {
                for vector in row[..6].chunks_exact_mut(3) {
                    let v = DVec3::new(vector[0].into(), vector[1].into(), vector[2].into());
                    vector.copy_from_slice(&(turn * v).as_vec3().to_array());
                }
            }
        }
        turned.frame = self.frame * turn.transpose();
        turned
    }
}

impl Pyramid {
    /// Meshes side by side: one graph that falls apart into theirs.
    pub fn joined(pyramids: &[&Self]) -> Self {
        let n_levels = pyramids.iter().map(|p| p.levels.len()).min().unwrap_or(0);
        let levels = (0..n_levels).map(|i| {
            let each = || pyramids.iter().map(|p| &p.levels[i]);
            let mut parents = Vec::new();
            let mut n_before = 0;
            for level in each() {
                parents.extend(level.parents.iter().map(|p| p + n_before));
                n_before += level.graph.n_vertices() as u32;
            }
            Level {
                graph: Arc::new(Neighbours::joined(each().map(|level| &*level.graph))),
                features: each()
                    .flat_map(|level| level.features.iter().copied())
                    .collect(),
                parents,
            }
        });
        Self {
            levels: levels.collect(),
        }
    }
}

/// The rank of what each vertex collapsed into; the tetrahedron's into themselves.
fn collapse_targets(hierarchy: &CollapseHierarchy, rank: &VertexMap<VertexId>) -> Vec<u32> {
    let mut into: Vec<u32> = (0..4).collect();
    into.extend(hierarchy.undone().map(|c| rank[c.into_vertex()].0));
    into
}

/// Where the vertices of a finer level end up when it collapses to `n` vertices.
fn parents(into: &[u32], n: usize, n_finer: usize) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..n as u32).collect();
    for &target in &into[n..n_finer] {
        parents.push(parents[target as usize]);
    }
    parents
}
