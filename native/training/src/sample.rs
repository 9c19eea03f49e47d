//! A shape made ready to train on.

use glam::DVec3;
use orbflow_geometry::decimate::{self, CollapseError, collapse_to_tetrahedron, simplify};
use orbflow_geometry::embed::{self, OffsetPredictor, distortion};
use orbflow_geometry::hierarchy::{CollapseHierarchy, HierarchyError};
use orbflow_geometry::measure::area_vector;
use orbflow_geometry::mesh::{Id, TriangleMesh, TriangleMeshError, VertexMap};
use orbflow_geometry::progress::Progress;
use orbflow_geometry::sphere_map::folded_faces;
use orbflow_network::pyramid::Prepared;
use thiserror::Error;

use crate::parts::refined;

/// Faces before the collapse, at least: enough that the finest level of 500 vertices is chosen by it.
const LEAST_FACES: usize = 3_000;
/// The same for finer levels, as many for each of their vertices: twice as many as they have.
const FACES_PER_VERTEX: usize = 4;
/// A triangle of less than this share of the mean area has no shape to keep.
const LEAST_AREA: f64 = 1e-5;
/// How much of the mean squared edge is added to the rest metric, as the solver does below 5,000
/// vertices: without it slivers drown the rest of the gradient.
const REGULAR: f64 = 0.01;

/// A shape, what the network reads of it, and what the loss wants to know.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Where it comes from.
    pub name: String,
    /// What the network reads.
    pub prepared: Prepared,
    /// What the loss knows of each face.
    pub rests: Vec<Rest>,
    /// The finest level as a mesh.
    pub mesh: TriangleMesh,
}

/// The rest shape of a triangle, the whole surface scaled to the area 4π.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rest {
    /// What the squared edges opposite to each corner count in the Dirichlet density.
    pub dirichlet: [f32; 3],
    /// 1 / 2A.
    pub per_area: f32,
    /// The triangle's share of the surface; zero without area.
    pub share: f32,
}

/// How good a proposal is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Quality {
    /// Its distortion, as reports count it.
    pub energy: f64,
    /// How many triangles of a hundred are folded.
    pub folds_pct: f64,
}

/// Why a shape cannot be trained on.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum SampleError {
    /// It cannot be simplified.
    #[error(transparent)]
    Simplify(#[from] decimate::Error),
    /// It does not collapse.
    #[error(transparent)]
    Collapse(#[from] CollapseError),
    /// Its levels contradict each other.
    #[error(transparent)]
    Hierarchy(#[from] HierarchyError),
    /// Its finest level is no mesh.
    #[error(transparent)]
    Mesh(#[from] TriangleMeshError),
    /// The solver fails on it.
    #[error(transparent)]
    Solver(#[from] embed::Error),
}

/// How many faces the meshes have that levels of these sizes, fine to coarse, are taken from.
pub fn n_faces_for(levels: &[usize]) -> usize {
    let finest = levels.first().copied().unwrap_or(0);
    LEAST_FACES.max(finest.saturating_mul(FACES_PER_VERTEX))
}

/// Brings a closed mesh of genus 0 to a number of faces, and collapses it.
///
/// # Errors
/// [`SampleError`].
pub fn training_level(
    mesh: TriangleMesh,
    n_faces: usize,
) -> Result<CollapseHierarchy, SampleError> {
    let quiet = Progress::none();
    let settings = decimate::Settings { n_faces };
    let small = simplify(&refined(mesh, n_faces), &settings, &quiet)?.mesh;
    Ok(collapse_to_tetrahedron(small, &quiet)?)
}

impl Sample {
    /// Prepares a closed mesh of genus 0 for a network with levels of these sizes.
    ///
    /// # Errors
    /// [`SampleError`].
    pub fn new(name: String, mesh: TriangleMesh, levels: &[usize]) -> Result<Self, SampleError> {
        Self::of(name, &training_level(mesh, n_faces_for(levels))?, levels)
    }

    /// The same from what [`training_level`] made.
    ///
    /// # Errors
    /// [`SampleError`].
    pub fn of(
        name: String,
        hierarchy: &CollapseHierarchy,
        levels: &[usize],
    ) -> Result<Self, SampleError> {
        let prepared = Prepared::new(hierarchy, levels)?;
        let mesh = TriangleMesh::new(prepared.positions.clone(), prepared.faces.clone())?;
        Ok(Self {
            name,
            rests: rests(&mesh),
            prepared,
            mesh,
        })
    }

    /// Where the solver puts the vertices of the finest level.
    ///
    /// # Errors
    /// [`SampleError`].
    pub fn solver_sphere(&self) -> Result<Vec<DVec3>, SampleError> {
        let quiet = Progress::none();
        let hierarchy = collapse_to_tetrahedron(self.mesh.clone(), &quiet)?;
        let (solver, settings) = (embed::Solver::default(), embed::Settings::default());
        let embedded = embed::embed(&hierarchy, &solver, &settings, &quiet)?;
        Ok(embedded.map.sphere().as_slice().to_vec())
    }

    /// Where the solver puts them before any sweep: each into the kernel of its ring when it comes,
    /// where it stays.
    ///
    /// # Errors
    /// [`SampleError`].
    pub fn unswept_sphere(&self) -> Result<Vec<DVec3>, SampleError> {
        let quiet = Progress::none();
        let hierarchy = collapse_to_tetrahedron(self.mesh.clone(), &quiet)?;
        let solver = embed::Solver {
            finest_swept: 0,
            ..embed::Solver::default()
        };
        let proposed = solver.propose(&hierarchy, &quiet);
        Ok(proposed.map_err(embed::Error::from)?.sphere.into_vec())
    }

    /// The distortion of [`Sample::solver_sphere`].
    ///
    /// # Errors
    /// [`SampleError`].
    pub fn solver_energy(&self) -> Result<f64, SampleError> {
        Ok(self.quality(&self.solver_sphere()?).energy)
    }

    /// Assesses what was proposed for the finest level.
    pub fn quality(&self, directions: &[DVec3]) -> Quality {
        let sphere: VertexMap<DVec3> = directions.iter().map(|d| d.normalize_or_zero()).collect();
        let n_folds = folded_faces(self.mesh.faces(), &sphere).len();
        Quality {
            energy: distortion(&self.mesh, &sphere),
            folds_pct: 100.0 * n_folds as f64 / self.mesh.n_faces() as f64,
        }
    }
}

fn rests(mesh: &TriangleMesh) -> Vec<Rest> {
    let corners = || {
        mesh.faces()
            .iter()
            .map(|f| f.map(|v| mesh.positions()[v.index()]))
    };
    let areas: Vec<f64> = corners().map(|t| area_vector(t).length()).collect();
    let total: f64 = areas.iter().sum();
    let least = LEAST_AREA * total / areas.len() as f64;
    let rest = |([a, b, c], area): ([DVec3; 3], &f64)| {
        let squares = [(b, c), (c, a), (a, b)].map(|(p, q)| p.distance_squared(q));
        let more = REGULAR * squares.iter().sum::<f64>() / 3.0;
        let [x, y, z] = squares.map(|square| square + more);
        // Twice the products of the edges at each corner, and 16 A², from lengths alone.
        let products = [y + z - x, z + x - y, x + y - z];
        let sixteen = 2.0 * (x * y + y * z + z * x) - (x * x + y * y + z * z);
        let square = sixteen.max(f64::MIN_POSITIVE) / 4.0;
        let is_flat = *area < least;
        Rest {
            dirichlet: products.map(|p| {
                if is_flat {
                    0.0
                } else {
                    (0.5 * p / square) as f32
                }
            }),
            per_area: if is_flat {
                0.0
            } else {
                square.sqrt().recip() as f32
            },
            share: if is_flat { 0.0 } else { (area / total) as f32 },
        }
    };
    corners().zip(&areas).map(rest).collect()
}
