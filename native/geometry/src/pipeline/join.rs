//! Joins the parts into one mesh.

use std::collections::BTreeSet;

use glam::DVec3;

use super::crosses::Cross;
use super::part::PartResult;
use super::region::KeptFaces;
use super::report::{PartReport, Rejoined};
use super::stay::Met;
use crate::embed;
use crate::mesh::{PolygonMesh, VertexId};

/// All parts together.
pub struct Joined {
    pub mesh: PolygonMesh,
    pub sphere: Vec<DVec3>,
    /// The edges that lie along sharp or marked ones.
    pub features: Vec<[VertexId; 2]>,
    pub crosses: Vec<Cross>,
    /// What borders were filled with.
    pub filling: Vec<[DVec3; 3]>,
    pub embedding: embed::Report,
    pub parts: Vec<PartReport>,
    /// Where sheets met; none where they did nowhere.
    pub rejoined: Option<Rejoined>,
    /// What was made where faces stay as they were.
    pub met: Met,
    /// How faces that are kept were joined; none where none are.
    pub kept_faces: Option<KeptFaces>,
}

/// Puts the parts one after the other; one part stays as it is.
pub fn join(results: Vec<PartResult>) -> Joined {
    let areas: Vec<f64> = results.iter().map(|result| result.area).collect();
    let embeddings: Vec<_> = results.iter().map(|r| r.report.embedding.clone()).collect();
    let mut positions = Vec::new();
    let mut sphere = Vec::new();
    let (mut features, mut crosses, mut filling) = (Vec::new(), Vec::new(), Vec::new());
    let mut starts = vec![0];
    let mut corners = Vec::new();
    let mut parts = Vec::with_capacity(results.len());
    for result in results {
        let [first_vertex, first_corner] = [positions.len() as u32, corners.len() as u32];
        starts.extend(
            result.mesh.starts()[1..]
                .iter()
                .map(|&start| start + first_corner),
        );
        corners.extend(
            result
                .mesh
                .corners()
                .iter()
                .map(|v| VertexId(v.0 + first_vertex)),
        );
        positions.extend_from_slice(result.mesh.positions());
        sphere.extend(result.sphere);
        let named = |ends: &[VertexId; 2]| ends.map(|v| VertexId(v.0 + first_vertex));
        features.extend(result.features.iter().map(named));
        crosses.extend(result.crosses);
        filling.extend(result.filling);
        parts.push(result.report);
    }
    let mesh = PolygonMesh::new(positions, starts, corners).expect("valid meshes make a valid one");
    Joined {
        mesh,
        sphere,
        features,
        crosses,
        filling,
        embedding: join_embeddings(&embeddings, &areas),
        parts,
        rejoined: None,
        met: Met::default(),
        kept_faces: None,
    }
}

/// Who proposed, each once: parts of other sizes may have other predictors.
fn predictors(reports: &[embed::Report]) -> String {
    let names: BTreeSet<&str> = reports.iter().map(|r| r.predictor.as_str()).collect();
    names.into_iter().collect::<Vec<_>>().join(" and ")
}

/// The embeddings of all parts as one: counts are summed, energies are means weighted by area.
pub fn join_embeddings(reports: &[embed::Report], areas: &[f64]) -> embed::Report {
    let total: f64 = areas.iter().sum();
    let mean = |of: fn(&embed::Report) -> f64| {
        let weighted: f64 = reports
            .iter()
            .zip(areas)
            .map(|(r, area)| of(r) * area)
            .sum();
        if total > 0.0 { weighted / total } else { 0.0 }
    };
    let count = |of: fn(&embed::Report) -> usize| reports.iter().map(of).sum::<usize>();
    let sum = |of: fn(&embed::Report) -> f64| reports.iter().map(of).sum::<f64>();
    let long = |of: fn(&embed::Report) -> u64| reports.iter().map(of).sum::<u64>();
    let same = |of: fn(&embed::Report) -> i64| {
        reports
            .iter()
            .map(of)
            .find(|&degree| degree != 1)
            .unwrap_or(1)
    };
    let n_vertices = count(|r| r.n_vertices);
    // Of the levels that were proposed.
    let n_triangles = count(|r| (2 * r.proposal.n_vertices).saturating_sub(4));
    let n_folds = count(|r| r.proposal.n_folds);
    embed::Report {
        n_vertices,
        n_folds: count(|r| r.n_folds),
        degree: same(|r| r.degree),
        energy: mean(|r| r.energy),
        n_relaxations: long(|r| r.n_relaxations),
        n_sweeps: reports.iter().map(|r| r.n_sweeps).max().unwrap_or(0),
        complete: reports.iter().all(|r| r.complete),
        predictor: predictors(reports),
        weights: reports.iter().find_map(|r| r.weights.clone()),
        proposal: embed::ProposalReport {
            n_vertices: count(|r| r.proposal.n_vertices),
            energy: mean(|r| r.proposal.energy),
            n_folds,
            folds_pct: 100.0 * n_folds as f64 / n_triangles.max(1) as f64,
            degree: same(|r| r.proposal.degree),
            n_unusable: count(|r| r.proposal.n_unusable),
            n_relaxations: long(|r| r.proposal.n_relaxations),
        },
        repair: embed::RepairReport {
            mirrored: reports.iter().any(|r| r.repair.mirrored),
            n_moved: count(|r| r.repair.n_moved),
            fell_back_to_solver: reports.iter().any(|r| r.repair.fell_back_to_solver),
        },
        times: embed::Times {
            propose_ms: sum(|r| r.times.propose_ms),
            repair_ms: sum(|r| r.times.repair_ms),
            relax_ms: sum(|r| r.times.relax_ms),
        },
    }
}
