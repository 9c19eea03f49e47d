//! A part as bytes.

use glam::DVec3;
use orbflow_geometry::hierarchy::{Collapse, CollapseHierarchy, HierarchyBuilder, HierarchyError};
use orbflow_geometry::mesh::{TriangleMesh, TriangleMeshError, VertexId};
use thiserror::Error;

use crate::thesis::chamfer;
use crate::thesis::target::{N_POINTS, Target};

/// How many bytes the offsets of a target take.
const TARGET_BYTES: usize = 12 * N_POINTS;
/// How many counts stand before a part.
const N_COUNTS: usize = 6;

/// A closed mesh of genus 0, and what is trained on.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The part itself; brought down where it had very many faces.
    pub whole: TriangleMesh,
    /// The part brought to the faces of the set, and its collapses.
    pub level: CollapseHierarchy,
    /// What the thesis is to learn of it, in sets that were asked for targets.
    pub target: Option<Target>,
}

/// Why bytes are no part.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum PartError {
    /// They end too early.
    #[error("{wanted} more bytes are needed, but {left} are left")]
    Short {
        /// How many are needed.
        wanted: usize,
        /// How many there are.
        left: usize,
    },
    /// They go on.
    #[error("{n_bytes} bytes are left over")]
    Left {
        /// How many.
        n_bytes: usize,
    },
    /// The counts contradict each other.
    #[error(
        "{n_vertices} vertices cannot have {n_rings} neighbours of collapses in {n_rounds} rounds"
    )]
    Counts {
        /// Vertices of the level.
        n_vertices: usize,
        /// The lengths of all rings together.
        n_rings: usize,
        /// Rounds.
        n_rounds: usize,
    },
    /// The faces make no mesh.
    #[error(transparent)]
    Mesh(#[from] TriangleMeshError),
    /// The mesh is not closed and of genus 0.
    #[error(
        "the mesh is not a closed piece of genus 0 and four vertices or more: its euler number is {euler}"
    )]
    Topology {
        /// Vertices − edges + faces.
        euler: i64,
    },
    /// There is a target, but nothing says how it was made.
    #[error("it has a target, but the head has no settings of targets")]
    TargetUnasked,
    /// An offset of the target is no number.
    #[error("offset {index} of the target is {found}")]
    TargetNotFinite {
        /// Which of them, counted from 0.
        index: usize,
        /// What it is.
        found: f32,
    },
    /// The collapses are not those of the mesh.
    #[error(transparent)]
    Hierarchy(#[from] HierarchyError),
}

impl Shape {
    /// The bytes of a part; of a target the offsets alone, last.
    pub fn to_bytes(&self) -> Vec<u8> {
        let Self {
            whole,
            level,
            target,
        } = self;
        let collapses = || (0..level.n_collapses()).map(|i| level.collapse(i));
        let n_rings = collapses().map(|collapse| collapse.ring.len()).sum();
        let counts: [usize; N_COUNTS] = [
            whole.n_vertices(),
            whole.n_faces(),
            level.mesh().n_vertices(),
            level.mesh().n_faces(),
            n_rings,
            level.n_rounds(),
        ];
        let mut bytes = Vec::new();
        push_all(&mut bytes, counts.map(|n| n as u32));
        for mesh in [whole, level.mesh()] {
            let coordinates = mesh.positions().iter().flat_map(DVec3::to_array);
            bytes.extend(coordinates.flat_map(f64::to_le_bytes));
            push_all(&mut bytes, mesh.faces().iter().flatten().map(|v| v.0));
        }
        push_all(&mut bytes, level.base().iter().flatten().map(|v| v.0));
        push_all(&mut bytes, collapses().map(|c| c.vertex.0));
        push_all(&mut bytes, collapses().map(|c| c.ring.len() as u32));
        for Collapse { ring, .. } in collapses() {
            push_all(&mut bytes, ring.iter().map(|v| v.0));
        }
        let rounds = (0..level.n_rounds()).map(|i| level.round(i).len() as u32);
        push_all(&mut bytes, rounds);
        let offsets = target.iter().flat_map(|target| &target.offsets);
        push_all(&mut bytes, offsets.map(|x| x.to_bits()));
        bytes
    }

    /// Reads a part and checks all that it promises; `targets` is how those of the set were made.
    ///
    /// # Errors
    /// [`PartError`].
    pub fn from_bytes(
        bytes: &[u8],
        targets: Option<&chamfer::Settings>,
    ) -> Result<Self, PartError> {
        let mut rest = Rest(bytes);
        let counts: Vec<usize> = rest.numbers(N_COUNTS)?.map(|n| n as usize).collect();
        let whole = rest.mesh(counts[0], counts[1])?;
        let mesh = rest.mesh(counts[2], counts[3])?;
        let level = rest.hierarchy(mesh, counts[4], counts[5])?;
        let target = match rest.0.len() {
            0 => None,
            TARGET_BYTES => {
                let settings = targets.ok_or(PartError::TargetUnasked)?.clone();
                let offsets = rest.offsets()?;
                Some(Target { settings, offsets })
            }
            n_bytes => return Err(PartError::Left { n_bytes }),
        };
        Ok(Self {
            whole,
            level,
            target,
        })
    }
}

fn push_all(bytes: &mut Vec<u8>, numbers: impl IntoIterator<Item = u32>) {
    bytes.extend(numbers.into_iter().flat_map(u32::to_le_bytes));
}

/// What is not read yet.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, n: usize, size: usize) -> Result<&'a [u8], PartError> {
        let (wanted, left) = (n.saturating_mul(size), self.0.len());
        let split = self.0.split_at_checked(wanted);
        let (taken, rest) = split.ok_or(PartError::Short { wanted, left })?;
        self.0 = rest;
        Ok(taken)
    }

    fn numbers(&mut self, n: usize) -> Result<impl Iterator<Item = u32> + use<'a>, PartError> {
        let bytes = self.take(n, 4)?.chunks_exact(4);
        Ok(bytes.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
    }

    fn ids(&mut self, n: usize) -> Result<Vec<VertexId>, PartError> {
        Ok(self.numbers(n)?.map(VertexId).collect())
    }

    /// The offsets of a target.
    fn offsets(&mut self) -> Result<Vec<f32>, PartError> {
        let offsets: Vec<f32> = self.numbers(3 * N_POINTS)?.map(f32::from_bits).collect();
        match offsets.iter().position(|x| !x.is_finite()) {
            None => Ok(offsets),
            Some(index) => Err(PartError::TargetNotFinite {
                index,
                found: offsets[index],
            }),
        }
    }

    fn faces(&mut self, n: usize) -> Result<Vec<[VertexId; 3]>, PartError> {
        let corners = self.ids(n.saturating_mul(3))?;
        Ok(corners
            .chunks_exact(3)
            .map(|f| [f[0], f[1], f[2]])
            .collect())
    }

    /// A closed mesh of genus 0.
    fn mesh(&mut self, n_vertices: usize, n_faces: usize) -> Result<TriangleMesh, PartError> {
        let points = self.take(n_vertices, 24)?.chunks_exact(24);
        let coordinate = |b: &[u8]| f64::from_bits(super::number(b));
        let point = |b: &[u8]| {
            DVec3::new(
                coordinate(&b[..8]),
                coordinate(&b[8..16]),
                coordinate(&b[16..]),
            )
        };
        let positions = points.map(point).collect();
        let mesh = TriangleMesh::new(positions, self.faces(n_faces)?)?;
        let euler = mesh.euler_number();
        // In one piece too: a sphere beside a torus has the number of one sphere. Two triangles back to
        // back have it as well, but collapse to no tetrahedron.
        if n_vertices >= 4 && mesh.is_closed() && euler == 2 && mesh.face_components().1 == 1 {
            return Ok(mesh);
        }
        Err(PartError::Topology { euler })
    }

    fn hierarchy(
        &mut self,
        mesh: TriangleMesh,
        n_rings: usize,
        n_rounds: usize,
    ) -> Result<CollapseHierarchy, PartError> {
        let n_vertices = mesh.n_vertices();
        let n_collapses = n_vertices - 4;
        let base = self.faces(4)?;
        let vertices = self.ids(n_collapses)?;
        let lengths: Vec<usize> = self.numbers(n_collapses)?.map(|n| n as usize).collect();
        let rings = self.ids(n_rings)?;
        let rounds: Vec<usize> = self.numbers(n_rounds)?.map(|n| n as usize).collect();
        let sum = |counts: &[usize]| counts.iter().fold(0usize, |sum, &n| sum.saturating_add(n));
        if sum(&lengths) != n_rings || sum(&rounds) != n_collapses {
            return Err(PartError::Counts {
                n_vertices,
                n_rings,
                n_rounds,
            });
        }
        let mut builder = HierarchyBuilder::new();
        let (mut left, mut collapses) = (&rings[..], vertices.into_iter().zip(lengths));
        for n in rounds {
            for (vertex, length) in collapses.by_ref().take(n) {
                let (ring, rest) = left.split_at(length);
                builder.push(vertex, ring);
                left = rest;
            }
            builder.end_round();
        }
        let base = [base[0], base[1], base[2], base[3]];
        Ok(builder.build_checked(mesh, base)?)
    }
}
