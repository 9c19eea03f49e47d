//! The smooth cross field: one linear solve, then diffusion between unit lengths.

use glam::DVec2;

use super::FieldError;
use super::charts::Charts;
use super::shape::{Pull, fourth_power};
use crate::mesh::{FaceId, FaceMap, HalfedgeId, Id, TriangleMesh};
use crate::progress::Progress;
use crate::sparse::{HermitianCholesky, HermitianMatrix};

/// How often each diffusion time is applied, with lengths restored after each.
const N_STEPS: usize = 3;

/// One z = e^{4iθ} per face, θ in the face's chart: smooth across edges and close to the pulls.
///
/// The first solve of (L + λ) z = λ q finds the global picture but lets lengths collapse around
/// singularities; diffusion with restored lengths (Viertel & Osting 2019) then moves each to where
/// it costs least, from far to near.
pub fn smooth(
    mesh: &TriangleMesh,
    charts: &Charts,
    pulls: &FaceMap<Pull>,
    progress: &Progress,
) -> Result<FaceMap<DVec2>, FieldError> {
    let graph = Graph::new(mesh, charts);
    let first = graph.system(|face| pulls[face].weight + 1e-6, 1.0);
    let order = first.order()?;
    progress.at(0.1)?;
    let mut z: FaceMap<DVec2> = pulls.iter().map(|p| p.toward * p.weight).collect();
    first.factorize(&order)?.solve(z.as_mut_slice());
    let mut crosses = FaceMap::filled(z.len(), DVec2::X);
    restore_lengths(&mut crosses, &z);
    let mut time = mesh.n_faces() as f64 / 400.0;
    let mut last: Option<(f64, HermitianCholesky)> = None;
    for round in 0..4 {
        progress.at(0.2 + 0.2 * f64::from(round))?;
        // On coarse meshes the shortest times are one.
        let same = last.take().filter(|(t, _)| t.total_cmp(&time).is_eq());
        let factor = if let Some((_, factor)) = same {
            factor
        } else {
            let system = graph.system(|face| 1.0 + time * pulls[face].weight, time);
            system.factorize(&order)?
        };
        diffuse(&factor, (pulls, time), &mut crosses);
        last = Some((time, factor));
        time = (time / 4.0).max(2.0);
    }
    Ok(crosses)
}

/// Solves (1 + τλ + τL) z' = z + τλq and restores lengths, a few times.
fn diffuse(
    factor: &HermitianCholesky,
    (pulls, time): (&FaceMap<Pull>, f64),
    crosses: &mut FaceMap<DVec2>,
) {
    for _ in 0..N_STEPS {
        let mut z: FaceMap<DVec2> = crosses
            .iter()
            .zip(pulls)
            .map(|(z, pull)| *z + pull.toward * (time * pull.weight))
            .collect();
        factor.solve(z.as_mut_slice());
        restore_lengths(crosses, &z);
    }
}

/// Takes over directions; where a vector vanished the cross stays what it was.
fn restore_lengths(crosses: &mut FaceMap<DVec2>, z: &FaceMap<DVec2>) {
    for (cross, z) in crosses.as_mut_slice().iter_mut().zip(z) {
        *cross = z.normalize_or(*cross);
    }
}

/// The dual graph: for every edge its two faces and the rotation of z from the first to the second.
struct Graph {
    n_faces: usize,
    edges: Vec<(usize, usize, DVec2)>,
}

impl Graph {
    fn new(mesh: &TriangleMesh, charts: &Charts) -> Self {
        let edge = |h: HalfedgeId| {
            let twin = mesh.twin(h).filter(|twin| h < *twin)?;
            let turn = fourth_power(charts.carry(h, twin));
            Some((h.face().index(), twin.face().index(), turn))
        };
        Self {
            n_faces: mesh.n_faces(),
            edges: mesh.halfedge_ids().filter_map(edge).collect(),
        }
    }

    /// `Σ mass |z_f|² + weight Σ |z_g − ρ z_f|²`.
    fn system(&self, mass: impl Fn(FaceId) -> f64, weight: f64) -> HermitianMatrix {
        let mut system = HermitianMatrix::new(self.n_faces);
        let mut diagonal: Vec<f64> = (0..self.n_faces)
            .map(|face| mass(FaceId::from_index(face)))
            .collect();
        for &(from, to, turn) in &self.edges {
            diagonal[from] += weight;
            diagonal[to] += weight;
            system.add(to, from, -turn * weight);
        }
        for (face, value) in diagonal.into_iter().enumerate() {
            system.add(face, face, DVec2::X * value);
        }
        system
    }
}
