//! Single verbs on whole meshes: the embedding alone, the decimation alone.

use glam::DVec3;
use serde::Serialize;

use super::clock::{Clock, Step, peak_memory_mb};
use super::frame::Prepared;
use super::join::join_embeddings;
use super::origins::origins;
use super::part::embed_mesh;
use super::settings::check_faces;
use super::split::{Parts, components};
use super::{Error, Input, Mirror, Origins, VERSION, share_of_work, taken_apart, thread_pool};
use crate::embed::OffsetPredictor;
use crate::measure::{self, Topology};
use crate::mesh::PolygonMesh;
use crate::nearest::Bvh;
use crate::progress::Progress;
use crate::{clean, decimate as decimation, embed as embedding, transfer};

/// A mesh and its map to the sphere, vertex by vertex.
#[derive(Clone, Debug)]
pub struct EmbeddedParts {
    /// The triangles of the cleaned input, part after part.
    pub mesh: PolygonMesh,
    /// The point of the unit sphere of each vertex; each part on a sphere of its own.
    pub sphere: Vec<DVec3>,
    /// What is told of the run.
    pub report: EmbedReport,
}

/// What is told of an embedding.
#[derive(Clone, Debug, Serialize)]
pub struct EmbedReport {
    /// The version of Orbflow.
    pub version: &'static str,
    /// The mesh that came in.
    pub input: Topology,
    /// What had to be mended in it.
    pub clean: clean::Report,
    /// The embeddings of all parts together.
    pub embedding: embedding::Report,
    /// The embedding of each part.
    pub parts: Vec<embedding::Report>,
    /// How long each step took.
    pub steps: Vec<Step>,
    /// The most memory that the process held, in MiB; none where the system does not tell.
    pub peak_memory_mb: Option<f64>,
}

/// Maps every vertex of a mesh to the unit sphere, at full resolution.
///
/// # Errors
/// What is wrong with the mesh, or that the run was cancelled.
pub fn embed(
    mesh: &PolygonMesh,
    threads: usize,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<EmbeddedParts, Error> {
    thread_pool(threads)?.install(|| embed_parts(mesh, predictor, progress))
}

fn embed_parts(
    mesh: &PolygonMesh,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<EmbeddedParts, Error> {
    let mut clock = Clock::default();
    let stage = progress.part("clean", 0.0, 0.02);
    let apart = || taken_apart(mesh, Some(clean::WELD), &stage);
    let (apart, moved) = clock.step("clean", apart)?;
    let cleaned = Parts::all(mesh, apart)?;
    let input = Input::new(moved.as_ref().unwrap_or(mesh));
    let (prepared, _) = Prepared::facing(cleaned, &input, Mirror::Off, &stage)?;
    let parts = clock.step("split", || components(&prepared.mesh, progress))?;
    let total = prepared.mesh.n_faces();
    let mut done = 0;
    let mut maps = Vec::with_capacity(parts.len());
    for part in parts {
        let from = share_of_work(done, total);
        done += part.n_faces();
        let progress = progress.part("embed", from, share_of_work(done, total));
        maps.push(clock.step("embed", || embed_mesh(part, predictor, &progress))?);
    }
    let areas: Vec<f64> = maps
        .iter()
        .map(|m| measure::total_area(m.map.mesh()))
        .collect();
    progress.check()?;
    let (mut positions, mut sphere, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for embedded in &maps {
        let first = positions.len() as u32;
        positions.extend_from_slice(embedded.map.mesh().positions());
        sphere.extend_from_slice(embedded.map.sphere().as_slice());
        faces.extend(
            embedded
                .map
                .mesh()
                .faces()
                .iter()
                .map(|f| f.map(|v| v.0 + first)),
        );
    }
    progress.check()?;
    let reports: Vec<_> = maps.into_iter().map(|embedded| embedded.report).collect();
    let topology = measure::topology(mesh, progress)?;
    progress.at(1.0)?;
    Ok(EmbeddedParts {
        mesh: polygons(prepared.frame.leave(&positions), &faces),
        sphere,
        report: EmbedReport {
            version: VERSION,
            input: topology,
            clean: prepared.report,
            embedding: join_embeddings(&reports, &areas),
            parts: reports,
            steps: clock.into_steps(),
            peak_memory_mb: peak_memory_mb(),
        },
    })
}

/// A mesh with fewer triangles.
#[derive(Clone, Debug)]
pub struct Decimated {
    /// The triangles.
    pub mesh: PolygonMesh,
    /// The material of each triangle, where the input had materials.
    pub materials: Option<Vec<i32>>,
    /// What of the input every element comes from, where cuts are given.
    pub origins: Option<Origins>,
    /// What had to be mended in the input.
    pub clean: clean::Report,
    /// How it was reduced.
    pub report: decimation::Report,
}

/// Lowers the number of triangles of a mesh; borders and handles are welcome.
///
/// # Errors
/// What is wrong with the count or the mesh, or that the run was cancelled.
pub fn decimate(
    input: Input<'_>,
    n_faces: usize,
    progress: &Progress<'_>,
) -> Result<Decimated, Error> {
    check_faces(n_faces)?;
    input.check()?;
    let prepared = Prepared::new(input.mesh, &progress.part("clean", 0.0, 0.1))?;
    let settings = decimation::Settings { n_faces };
    let stage = progress.part("decimate", 0.1, 0.9);
    let simplified = decimation::simplify(&prepared.mesh, &settings, &stage)?;
    let small = PolygonMesh::from(&simplified.mesh);
    let stage = progress.part("transfer", 0.9, 1.0);
    let (mut materials, mut whence) = (None, None);
    if input.materials.is_some() || input.cuts.is_some() {
        let tree = Bvh::build_of_mesh(&prepared.mesh, &stage)?;
        let carried = input.materials.map(|of_faces| {
            transfer::materials(&tree, &prepared.materials(of_faces), &small, &stage)
        });
        materials = carried.transpose()?;
        whence = origins(&input, (&prepared, &tree), &small, &stage)?;
    }
    Ok(Decimated {
        mesh: small.with_positions(prepared.frame.leave(small.positions())),
        materials,
        origins: whence,
        clean: prepared.report,
        report: simplified.report,
    })
}

fn polygons(positions: Vec<DVec3>, faces: &[[u32; 3]]) -> PolygonMesh {
    PolygonMesh::from_faces(positions, faces).expect("a triangle mesh is a polygon mesh")
}
