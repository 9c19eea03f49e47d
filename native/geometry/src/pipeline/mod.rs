//! The verbs in order: one mesh in, one mesh out.
//!
//! ```text
//! polygons ─ clean ─▶ triangles ─ split ─▶ part ─┬─ decimate ─▶ embed ─▶ sphere ─┐
//!                                                └──────── target ───────▶ deform ┴─ join ─▶ transfer ─▶ polygons
//! ```
//!
//! Every part that is a surface of two sides gets its share of the faces by area; the others stay as
//! they were. One with borders or handles is closed before it is decimated and opened again once it
//! has its faces (`open`). The map is made on a decimated mesh; the result is laid on the part at full
//! resolution.

mod attempt;
mod borders;
mod caps;
mod carried;
mod clock;
mod closed;
mod crosses;
mod density;
mod diagnosis;
mod each;
mod error;
mod even;
mod fault;
mod few;
mod finish;
mod fixed;
mod flow;
mod flowed;
mod frame;
mod ground;
mod halved;
mod handles;
mod inner;
mod join;
mod kept;
mod laid;
mod mapless;
mod marks;
mod meet;
mod mirror;
mod open;
mod origins;
mod own;
mod paired;
mod part;
mod probe;
mod proposed;
mod reduce;
mod region;
mod report;
mod rods;
mod scored;
mod settings;
mod shares;
mod sheets;
mod sides;
mod small;
mod solid;
mod split;
mod stay;
mod strokes;
mod uncut;
mod verbs;
mod warning;
mod ways;

pub use crate::transfer::CarriedEdge;
pub use attempt::Attempt;
pub use borders::{Borders, Closure, MAX_FILL, Opened};
pub use carried::CarriedReport;
pub use clock::{Step, peak_memory_mb};
pub use crosses::Cross;
pub use error::Error;
pub use fault::Fault;
pub use flowed::Flowed;
pub use handles::Handles;
pub use inner::Inner;
pub use kept::{Flaw, Kept, Outcome, Reason};
pub use laid::Instead;
pub use mirror::{Mirror, Plane, Through};
pub use origins::{Origin, Origins};
pub use proposed::{Asked, Proposed};
pub use region::KeptFaces;
pub use report::{Mirrored, PartReport, Reduced, Rejoined, Report};
pub use scored::score;
pub use settings::{Kind, MAX_FACES, MIN_FACES, Primitive, Settings, Style};
pub use small::{MAX_WELD, SmallParts};
pub use solid::{SOLID_DETAIL, SOLID_DETAILS, Solid};
pub use strokes::{GuideOutcome, GuideReport};
pub use verbs::{Decimated, EmbedReport, EmbeddedParts, decimate, embed};
pub use warning::Warning;

use glam::DVec3;

use crate::clean;
use crate::clean::Apart;
use crate::embed::OffsetPredictor;
use crate::guidance::{GuidancePredictor, NoGuidance, Stroke};
use crate::mesh::{FaceId, PolygonMesh, VertexId};
use crate::progress::Progress;
use clock::Clock;
use density::Density;
use each::Common;
use finish::Made;
use frame::Prepared;
use marks::Marks;
use proposed::Proposals;
use region::Region;
use split::Parts;
use strokes::Strokes;

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
    /// Edges of the mesh along which data on corners is cut, as texture coordinates are along seams:
    /// a set of them for each way in which data is cut. With sets, also without one, the result
    /// says where each of its elements comes from.
    pub cuts: Option<&'a [Vec<[VertexId; 2]>]>,
    /// Strokes near the mesh that edges of quads that flow are to follow.
    pub guides: &'a [Stroke],
    /// Which of its faces are kept as they are; the new ones join them without a gap. Those that are
    /// kept are among the faces asked for.
    pub keep_faces: Option<&'a [bool]>,
    /// Who proposes strokes and a density for each part that quads flow on, beside these.
    pub guidance: &'a dyn GuidancePredictor,
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
            guides: &[],
            keep_faces: None,
            guidance: &NoGuidance,
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
    /// The point of the unit sphere of each new vertex, each part on a sphere of its own; the origin
    /// where a part was not embedded or stays as it was.
    pub sphere: Vec<DVec3>,
    /// The edges that lie on edges of the input that were to be carried.
    pub carried: Vec<CarriedEdge>,
    /// What of the input every element comes from, where that was asked for.
    pub origins: Option<Origins>,
    /// The faces that lie on what filled borders and sealed handles.
    pub filled: Vec<FaceId>,
    /// Crosses of the field that the quads follow, as many as were asked for or fewer; of quads that
    /// flow alone.
    pub crosses: Vec<Cross>,
    /// How many faces at the end are the input's own: those of parts that were kept as they were.
    pub kept_faces: usize,
    /// What is told of the run.
    pub report: Report,
}

/// Rebuilds a mesh by deforming a sphere into each of its parts.
///
/// Keeps the topology, the frame of reference, the direction of the faces and their materials;
/// does not keep vertices, edges or anything else that lies on them. Parts that cannot be done, and
/// those too small for their share of the faces, stay as they were: their faces come last.
///
/// # Errors
/// What is wrong with the settings or with the mesh, that no part of it can be done, or that the
/// run was cancelled.
pub fn remesh(
    input: Input<'_>,
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    settings.check()?;
    input.check()?;
    input.check_guides(settings)?;
    let pool = thread_pool(settings.threads)?;
    pool.install(|| run(input, settings, predictor, progress))
}

fn run(
    given: Input<'_>,
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    if let Some(region) = Region::of(&given, settings)? {
        return region::run((given, &region), settings, predictor, progress);
    }
    if settings.solid {
        return solid::run(given, settings, predictor, progress);
    }
    shells(
        (given, None, Clock::default()),
        settings,
        predictor,
        progress,
    )
}

/// Every part of a mesh as it is, but for faces that are kept.
fn shells(
    (given, region, mut clock): (Input<'_>, Option<&Region>, Clock),
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    let stage = progress.part("clean", 0.0, 0.02);
    let came = region.map_or(given.mesh, Region::hollow);
    let apart = || taken_apart(came, settings.weld, &stage);
    let (apart, moved) = clock.step("clean", apart)?;
    let mesh = moved.as_ref().unwrap_or(came);
    let input = Input { mesh, ..given };
    let sort = || Parts::new(&input, (apart, region), settings, &stage);
    let (mut parts, cleaned) = clock.step("split", sort)?;
    let settings = &parts.staying_small.settings(settings);
    let marked = parts.marked_on_done(&input);
    let input = Input {
        marked: &marked,
        ..input
    };
    let facing = || Prepared::facing(cleaned, &input, settings.mirror(), &stage);
    let (prepared, plane) = clock.step("clean", facing)?;
    // A side that is replaced by the other's image would not join what is kept.
    let (plane, unlike) = match (region, plane) {
        (Some(_), Some(plane)) if !plane.was_symmetric => (None, Some(plane.off_pct)),
        _ => (plane, None),
    };
    let line = region.map(|region| region.marks(mesh, &prepared.frame));
    let ask = || Proposals::ask(&input, &prepared, settings, &stage);
    let proposals = clock.step("clean", ask)?;
    let drawn = || Strokes::new((&input, &proposals), &prepared, (plane, settings), &stage);
    let strokes = clock.step("clean", drawn)?;
    let laid = meet::laid(&marked, &parts);
    let common = Common {
        prepared: &prepared,
        marks: &Marks::new((mesh, &laid), &prepared.frame),
        sides: &own::sides(&prepared, mesh, settings),
        line: &line.unwrap_or_default(),
        density: &proposals.raised(Density::new(&input, &prepared.frame)),
        reduced: given
            .reduced
            .filter(|_| parts.kept.is_empty() && region.is_none()),
        settings,
        plane,
        predictor,
        strokes: &strokes,
    };
    let each = common.run(&mut clock, progress)?;
    let wanted = (mesh, region, settings);
    let (prepared, mut joined) = each.join(prepared, &mut parts, wanted, progress)?;
    if let Some(kept) = &mut joined.kept_faces {
        kept.plane_off_pct = unlike;
    }
    let made = Made {
        given,
        input,
        settings,
        parts,
        prepared,
        plane,
        joined,
        strokes,
        asked: proposals.asked,
        region,
    };
    made.finished(clock, progress)
}

/// The parts of a mesh, and the mesh with its seams closed, where there are any.
fn taken_apart(
    mesh: &PolygonMesh,
    weld: Option<f64>,
    progress: &Progress<'_>,
) -> Result<(Apart, Option<PolygonMesh>), clean::Error> {
    let mut apart = clean::take_apart(mesh, weld, progress)?;
    let moved = apart.moved.take();
    let moved = moved.map(|places| mesh.with_positions(places));
    Ok((apart, moved))
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
        self.check_keep()?;
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
