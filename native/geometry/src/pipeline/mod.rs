//! The verbs in order: one mesh in, one mesh out.
//!
//! ```text
//! polygons ─ clean ─▶ triangles ─ split ─▶ part ─┬─ decimate ─▶ embed ─▶ sphere ─┐
//!                                                └──────── target ───────▶ deform ┴─ join ─▶ transfer ─▶ polygons
//! ```
//!
//! Every part is a closed component of genus 0 and gets its share of the faces by area. The map is
//! made on a decimated mesh; the result is laid on the part at full resolution.

mod attempt;
mod carried;
mod clock;
mod crosses;
mod density;
mod error;
mod even;
mod flow;
mod flowed;
mod frame;
mod join;
mod marks;
mod mirror;
mod origins;
mod paired;
mod part;
mod probe;
mod report;
mod settings;
mod split;
mod verbs;

pub use crate::transfer::CarriedEdge;
pub use attempt::Attempt;
pub use carried::CarriedReport;
pub use clock::{Step, peak_memory_mb};
pub use crosses::Cross;
pub use error::Error;
pub use flowed::Flowed;
pub use mirror::{Mirror, Plane, Through};
pub use origins::{Origin, Origins};
pub use paired::Instead;
pub use report::{Mirrored, PartReport, Reduced, Report};
pub use settings::{Kind, MAX_FACES, MIN_FACES, Primitive, Settings, Style};
pub use verbs::{Decimated, EmbedReport, EmbeddedParts, decimate, embed};

use glam::DVec3;

use crate::embed::OffsetPredictor;
use crate::mesh::{PolygonMesh, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::score::{self, Score};
use crate::{measure, transfer};
use clock::Clock;
use density::Density;
use frame::Prepared;
use join::Joined;
use marks::Marks;
use mirror::Role;
use part::{PartJob, PartResult, Wanted};

/// The version of Orbflow.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What comes in.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The mesh.
    pub mesh: &'a PolygonMesh,
    /// The material of each of its faces.
    pub materials: Option<&'a [i32]>,
    /// The same mesh, already reduced by somebody else; used where it is closed, in one piece and
    /// of the same Euler number, and said in the report otherwise.
    pub reduced: Option<&'a PolygonMesh>,
    /// Edges of the mesh, by their ends, along which the result is to have edges however flat the
    /// surface is there.
    pub marked: &'a [[VertexId; 2]],
    /// How small the quads that flow are to be at each of its vertices: from 0, as usual, to 1, with
    /// edges about half as long. The number of faces stays what was asked for.
    pub density: Option<&'a [f64]>,
    /// Edges of the mesh that are to be found again on edges of the result, where these lie on them.
    pub carried: &'a [[VertexId; 2]],
    /// Edges of the mesh along which data on corners is cut, as texture coordinates are along seams.
    /// With them, none or some, the result says where each of its elements comes from.
    pub cuts: Option<&'a [[VertexId; 2]]>,
}

impl<'a> Input<'a> {
    /// A mesh alone.
    pub fn new(mesh: &'a PolygonMesh) -> Self {
        Self {
            mesh,
            materials: None,
            reduced: None,
            marked: &[],
            density: None,
            carried: &[],
            cuts: None,
        }
    }
}

/// What goes out.
#[derive(Clone, Debug)]
pub struct Remeshed {
    /// The new mesh.
    pub mesh: PolygonMesh,
    /// The material of each new face, where the input had materials.
    pub materials: Option<Vec<i32>>,
    /// The point of the unit sphere of each new vertex, each part on a sphere of its own.
    pub sphere: Vec<DVec3>,
    /// The edges that lie on edges of the input that were to be carried.
    pub carried: Vec<CarriedEdge>,
    /// What of the input every element comes from, where that was asked for.
    pub origins: Option<Origins>,
    /// Crosses of the field that the quads follow, as many as were asked for or fewer; of quads that
    /// flow alone.
    pub crosses: Vec<Cross>,
    /// What is told of the run.
    pub report: Report,
}

/// Rebuilds a mesh by deforming a sphere into each of its parts.
///
/// Keeps the topology, the frame of reference, the direction of the faces and their materials;
/// does not keep vertices, edges or anything else that lies on them.
///
/// # Errors
/// What is wrong with the settings or with the mesh, or that the run was cancelled.
pub fn remesh(
    input: Input<'_>,
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    settings.check()?;
    input.check()?;
    let pool = thread_pool(settings.threads)?;
    pool.install(|| run(input, settings, predictor, progress))
}

fn run(
    input: Input<'_>,
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    let mut clock = Clock::default();
    let stage = progress.part("clean", 0.0, 0.02);
    let facing = || Prepared::facing(&input, settings.mirror(), &stage);
    let (prepared, plane) = clock.step("clean", facing)?;
    let marks = Marks::new((input.mesh, input.marked), &prepared.frame);
    let density = Density::new(&input, &prepared.frame);
    let joined = run_parts(
        (&prepared, &marks, &density),
        input.reduced,
        (settings, plane),
        (predictor, progress),
        &mut clock,
    )?;
    let stage = progress.part("transfer", 0.9, 0.92);
    let Carried {
        materials,
        edges: (carried, carried_report),
        origins,
    } = clock.step("transfer", || {
        Carried::new(&input, (&prepared, plane), &joined, &stage)
    })?;
    let mesh = joined
        .mesh
        .with_positions(prepared.frame.leave(joined.mesh.positions()));
    let stage = progress.part("score", 0.92, 1.0);
    let (score, score_refused) = match settings.score() {
        Some(wanted) => {
            let scored = clock.step("score", || score::score(input.mesh, &mesh, &wanted, &stage));
            told(scored)?
        }
        None => (None, None),
    };
    let report = Report {
        version: VERSION,
        settings: settings.clone(),
        input: measure::topology(input.mesh, progress)?,
        clean: prepared.report,
        output: measure::topology(&mesh, progress)?,
        plane,
        embedding: joined.embedding,
        parts: joined.parts,
        carried: carried_report,
        score,
        score_refused,
        steps: clock.into_steps(),
        peak_memory_mb: peak_memory_mb(),
    };
    progress.at(1.0)?;
    Ok(Remeshed {
        mesh,
        materials,
        sphere: joined.sphere,
        carried,
        origins,
        crosses: crosses::leave(joined.crosses, &prepared.frame),
        report,
    })
}

/// Does every part by itself and joins them.
fn run_parts(
    (prepared, marks, density): (&Prepared, &Marks, &Density),
    reduced: Option<&PolygonMesh>,
    (settings, plane): (&Settings, Option<Plane>),
    (predictor, progress): (&dyn OffsetPredictor, &Progress<'_>),
    clock: &mut Clock,
) -> Result<Joined, Error> {
    let parts = clock.step("split", || split::split(&prepared.mesh, progress))?;
    progress.check()?;
    let amounts: Vec<f64> = parts.iter().map(|part| density.amount(part)).collect();
    let shares = split::share(&amounts, settings.faces, settings.kind.fewest_faces());
    let reduced = reduced.filter(|_| parts.len() == 1);
    let reduced = reduced.map(|r| r.with_positions(prepared.frame.enter(r.positions())));
    let total = prepared.mesh.n_faces();
    let mut done = 0;
    let roles = match plane {
        Some(plane) => mirror::roles(&parts, plane, progress)?,
        None => vec![Role::Alone(None); parts.len()],
    };
    let mut results: Vec<Option<PartResult>> = Vec::with_capacity(parts.len());
    for ((part, n_faces), role) in parts.into_iter().zip(shares).zip(&roles) {
        let from = share_of_work(done, total);
        done += part.n_faces();
        if let Role::ImageOf(_) = role {
            results.push(None);
            continue;
        }
        let progress = progress.part("", from, share_of_work(done, total));
        let job = PartJob {
            part,
            wanted: Wanted {
                n_faces,
                settings,
                predictor,
                mirror: (role, plane),
                reduced: reduced.as_ref(),
                marks,
                density,
            },
        };
        results.push(Some(job.run(clock, &progress)?));
    }
    for (i, role) in roles.iter().enumerate() {
        if let (&Role::ImageOf(of), Some(plane)) = (role, plane) {
            let made = results[of].as_ref();
            results[i] = made.map(|made| mirror::image_of(made, of, plane.axis));
        }
    }
    Ok(join::join(results.into_iter().flatten().collect()))
}

/// A result that cannot be scored is a result all the same; only a cancellation ends the run.
fn told(scored: Result<Score, score::Error>) -> Result<(Option<Score>, Option<String>), Cancelled> {
    match scored {
        Ok(score) => Ok((Some(score), None)),
        Err(score::Error::Cancelled(cancelled)) => Err(cancelled),
        Err(error) => Ok((None, Some(error.to_string()))),
    }
}

/// The artist's data on the result.
struct Carried {
    materials: Option<Vec<i32>>,
    edges: (Vec<CarriedEdge>, Option<CarriedReport>),
    origins: Option<Origins>,
}

impl Carried {
    fn new(
        input: &Input<'_>,
        (prepared, plane): (&Prepared, Option<Plane>),
        joined: &Joined,
        progress: &Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let edges = carried::carried(input, (&prepared.frame, plane), joined, progress)?;
        if input.materials.is_none() && input.cuts.is_none() {
            return Ok(Self {
                materials: None,
                edges,
                origins: None,
            });
        }
        let tree = Bvh::build_of_mesh(&prepared.mesh, progress)?;
        let part = progress.part("", 0.0, 0.5);
        let materials = input.materials.map(|of_faces| {
            transfer::materials(&tree, &prepared.materials(of_faces), &joined.mesh, &part)
        });
        let part = progress.part("", 0.5, 1.0);
        Ok(Self {
            materials: materials.transpose()?,
            edges,
            origins: origins::origins(input, (prepared, &tree), &joined.mesh, &part)?,
        })
    }
}

fn transfer_materials(
    prepared: &Prepared,
    of_faces: &[i32],
    new: &PolygonMesh,
    progress: &Progress<'_>,
) -> Result<Vec<i32>, Cancelled> {
    let source = Bvh::build_of_mesh(&prepared.mesh, progress)?;
    transfer::materials(&source, &prepared.materials(of_faces), new, progress)
}

/// Parts take the shares 0.02 to 0.9 of the progress, by their faces.
fn share_of_work(done: usize, total: usize) -> f64 {
    0.02 + 0.88 * done as f64 / total.max(1) as f64
}

fn thread_pool(threads: usize) -> Result<rayon::ThreadPool, Error> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(Error::Threads)
}

impl Input<'_> {
    fn check(&self) -> Result<(), Error> {
        self.check_edges()?;
        self.check_density()?;
        let n_faces = self.mesh.n_faces();
        match self.materials {
            Some(materials) if materials.len() != n_faces => Err(Error::MaterialCount {
                n_materials: materials.len(),
                n_faces,
            }),
            _ => Ok(()),
        }
    }
}
