//! What a predictor proposes, put in order and assessed.

use glam::DVec3;
use serde::Serialize;

use super::Proposal;
use super::energy::try_distortion;
use crate::mesh::{TriangleMesh, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{degree, folded_faces};

/// What was proposed, before any repair.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct ProposalReport {
    /// How many vertices were proposed.
    pub n_vertices: usize,
    /// Its [`distortion`](super::distortion); what is not usable counts as the centre of the sphere.
    pub energy: f64,
    /// How many triangles were folded.
    pub n_folds: usize,
    /// The same in percent.
    pub folds_pct: f64,
    /// How often it covered the sphere.
    pub degree: i64,
    /// How many vertices had no usable point.
    pub n_unusable: usize,
    /// How many relaxations of single vertices the predictor did.
    pub n_relaxations: u64,
}

impl ProposalReport {
    /// Assesses what was proposed, as it is after `unit_vectors`.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        mesh: &TriangleMesh,
        sphere: &VertexMap<DVec3>,
        n_relaxations: u64,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let n_folds = folded_faces(mesh.faces(), sphere).len();
        progress.check()?;
        let energy = try_distortion(mesh, sphere, progress)?;
        let degree = degree(mesh.faces(), sphere);
        progress.check()?;
        Ok(Self {
            n_vertices: mesh.n_vertices(),
            energy,
            n_folds,
            folds_pct: 100.0 * n_folds as f64 / mesh.n_faces() as f64,
            degree,
            n_unusable: sphere.iter().filter(|&&p| p == DVec3::ZERO).count(),
            n_relaxations,
        })
    }

    /// Whether the proposal is a bijection as it stands.
    pub fn is_valid(&self) -> bool {
        self.n_folds == 0 && self.degree == 1
    }
}

/// Which learnt weights proposed.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct WeightsReport {
    /// Their check sum, 16 hexadecimal digits: what tells one file from another.
    pub sum: String,
    /// Whether they are those that every build carries.
    pub shipped: bool,
    /// How they were trained and on what, by their own account.
    pub provenance: String,
}

/// A unit vector for every vertex; zero where the proposal has nothing that can be normalised.
pub fn unit_vectors(proposal: &Proposal, n_vertices: usize) -> VertexMap<DVec3> {
    let given = proposal.sphere.iter().map(|&p| {
        // Scaled first: squares of 1e200 overflow.
        let size = p.abs().max_element();
        let scaled = if p.is_finite() && size > 0.0 {
            p / size
        } else {
            DVec3::ZERO
        };
        scaled.normalize_or_zero()
    });
    let padded = given.chain(std::iter::repeat(DVec3::ZERO));
    padded.take(n_vertices).collect()
}
