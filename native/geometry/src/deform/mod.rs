//! Deforming a sphere into a surface.
//!
//! A primitive, a mesh on the unit sphere, goes where the sphere map says: *sphere point + offset =
//! surface point*. From there on every vertex lives twice, in space and on the sphere:
//!
//! ```text
//! place on the map ─▶ relax, snap to sharp edges ─▶ lift onto the full-resolution target ─▶ straddle ─▶ untangle ─▶ separate
//!      locate           slide, flip, pin                  closest point that agrees        least squares   quads     crossing faces
//! ```
//!
//! A slide moves the sphere point along; one that would fold the primitive on the sphere is
//! refused, so the result covers the sphere, and with it the surface, exactly once from beginning
//! to end. The last four steps move vertices off the map's surface by no more than an edge.
//!
//! Not done here: choosing the primitive (`sphere`), proving that faces do not cross in space.

mod cover;
mod deformed;
mod flips;
mod follow;
mod least_squares;
mod lock;
mod polish;
mod project;
mod reach;
mod relax;
mod route;
mod separate;
mod settings;
mod settle;
mod sheet;
mod sites;
mod skin;
mod snap;
mod springs;
mod squares;
mod straddle;
mod target;
#[cfg(test)]
mod tests;
mod untangle;

use glam::DVec3;
use serde::Serialize;
use thiserror::Error;

use crate::measure::{Seam, vertex_normals};
use crate::mesh::{FaceId, FaceMap, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::sphere_map::{NotACover, SphereMap, check_cover};
use cover::Cover;
use follow::Follower;
use lock::Seams;
pub use polish::lay;
use reach::Span;
pub use settings::{Lines, Settings, Sizes};
pub use settle::settle;
use sheet::Sheet;
pub use straddle::Anchor;
use straddle::{Even, Fit};
pub use target::Target;
pub use untangle::{is_inverted, n_inverted};

/// A primitive that has become a remeshed surface.
#[derive(Clone, PartialEq, Debug)]
pub struct Deformed {
    /// The mesh in space. Triangles may be connected otherwise than in the primitive.
    pub mesh: PolygonMesh,
    /// The sphere point of every vertex, with which the faces cover the sphere once; the origin where
    /// nothing was embedded.
    pub sphere: Vec<DVec3>,
    /// The edges that lie along the target's sharp or marked ones, each once, in order.
    pub features: Vec<[VertexId; 2]>,
    /// Those and the edges that were led there but did not arrive, each once, in order.
    pub led: Vec<[VertexId; 2]>,
    /// What was done.
    pub report: Report,
}

/// What was done.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
pub struct Report {
    /// How many edges were flipped.
    pub n_flips: usize,
    /// How many vertices were to stand on sharp edges and corners.
    pub n_feature_goals: usize,
    /// How many of them do.
    pub n_feature_vertices: usize,
    /// How many vertices could not slide in the last round without folding or spoiling a face.
    pub n_stuck: usize,
    /// How many vertices did not get all the way onto the full-resolution surface.
    pub n_unprojected: usize,
    /// How many quads that flow were inverted when they had been fitted.
    pub n_knotted: usize,
    /// How many moves of vertices in space it took to open inverted quads that flow.
    pub n_opened: usize,
    /// How many pairs of triangles crossed before they were moved apart.
    pub n_crossing: usize,
    /// And how many still cross.
    pub n_crossing_left: usize,
    /// How many quads have a corner that turns the wrong way all the same.
    pub n_inverted: usize,
}

/// Why a primitive cannot be deformed.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// The primitive does not cover the sphere once.
    #[error("the primitive is not a sphere: {0}")]
    Primitive(#[from] NotACover),
    /// A face has more than four corners.
    #[error("face {face} of the primitive has {n_corners} corners; at most 4 can be deformed")]
    TooManyCorners {
        /// The first such face.
        face: FaceId,
        /// How many corners it has.
        n_corners: usize,
    },
    /// Not one wanted position per vertex, or not one cross and size per face of the map.
    #[error("{counts:?} wanted positions, crosses and sizes; {needed:?} are needed")]
    Counts {
        /// What was given.
        counts: [usize; 3],
        /// How many vertices the quads have, and how many faces the map.
        needed: [usize; 3],
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Deforms a primitive into the target's surface by way of a sphere map of a coarser version of it.
///
/// The target must lie in the same coordinates as the map's mesh. Kept: the counts of vertices and
/// faces, closedness, and that the faces cover the sphere once. Quads keep their connections,
/// triangles may flip edges. Linear in the number of faces but for the logarithm of the target's.
///
/// # Errors
/// A primitive that is not a sphere of triangles and quads, and [`Cancelled`].
pub fn deform(
    map: &SphereMap,
    primitive: &PolygonMesh,
    target: &Target,
    settings: &Settings,
    progress: &Progress,
) -> Result<Deformed, Error> {
    let primitive = (primitive, &Held::default());
    deform_held(map, primitive, target, settings, progress)
}

/// Vertices that have their place from the beginning, and edges that stay.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Held {
    /// The edges, each once, smaller end first, in order.
    pub edges: Vec<[VertexId; 2]>,
    /// Where in space vertices are put, and stay.
    pub goals: Vec<(VertexId, DVec3)>,
}

/// The same of a primitive some of whose vertices and edges are held.
///
/// # Errors
/// As above.
pub fn deform_held(
    map: &SphereMap,
    (primitive, held): (&PolygonMesh, &Held),
    target: &Target,
    settings: &Settings,
    progress: &Progress,
) -> Result<Deformed, Error> {
    progress.check()?;
    check_primitive(primitive)?;
    progress.check()?;
    let mut report = Report::default();
    let mut sheet = Sheet::new(map, vertex_normals(map.mesh()), primitive);
    for &(v, place) in &held.goals {
        sheet.lift(v, place);
        sheet.pin(v);
    }
    for &[a, b] in &held.edges {
        sheet.keep_edge(a, b);
    }
    let mut cover = (primitive.n_quads() > 0).then(|| Cover::new(map, &sheet));
    progress.check()?;
    let n = match cover {
        None => settings.n_relaxations,
        Some(_) => settings.n_quad_relaxations,
    };
    if settings.lines == Lines::Sought {
        slide_and_flip(
            &mut sheet,
            cover.as_mut(),
            (n, settings.sizes, &mut report),
            &progress.part("", 0.0, 0.5),
        )?;
    }
    let part = progress.part("", 0.5, 0.6);
    let [n_goals, n_pinned] = snap::snap(&mut sheet, cover.as_mut(), (target, settings), &part)?;
    (report.n_feature_goals, report.n_feature_vertices) = (n_goals, n_pinned);
    if n_goals > 0 {
        let part = progress.part("", 0.6, 0.7);
        slide_and_flip(
            &mut sheet,
            cover.as_mut(),
            (n.div_ceil(2), settings.sizes, &mut report),
            &part,
        )?;
    }
    let fit = Fit::plain(target, sheet.mean_edge(), settings.anchor);
    report.n_unprojected = project::project(&mut sheet, target, fit.reach, progress)?;
    let part = progress.part("", 0.7, 1.0);
    fit.straddle(&mut sheet, settings.n_straddles, &part)?;
    if cover.is_none() {
        reach::reach(&mut sheet, (target, Span::CUT_OFF), progress)?;
    }
    if settings.separates {
        [report.n_crossing, report.n_crossing_left] = separate::separate(&mut sheet, progress)?;
    }
    Ok(Deformed::new(sheet, report))
}

/// Rounds in which flowing quads are led to where they are wanted; later ones move next to nothing.
const N_LEADS: usize = 8;
/// Sites of the surface that call upon flowing quads, for each quad.
const SITES_PER_QUAD: usize = 6;
/// The share of the wish to be squares of their own size that quads give up where their edges wish
/// for one length: at 0 they keep what they have, at 1 the faces of a thin blade cross.
const OWN_SIZE: f64 = 0.8;
/// How much they wish to be squares of the mean size instead, in units of the usual wish: at 2.4 a
/// hundredth of them is sheared, from 6 on they miss detail.
const MEAN_SIZE: f64 = 4.8;
/// Rounds of relaxation between two moves along sharp lines.
const ROUNDS_PER_SLIDE: usize = 4;

/// Quads on the unit sphere that follow a field of crosses on the map's surface.
#[derive(Clone, Copy, Debug)]
pub struct Flowing<'a> {
    /// The quads; their positions lie on the unit sphere.
    pub quads: &'a PolygonMesh,
    /// Where in space each vertex is wanted, near the map's surface.
    pub wanted: &'a [DVec3],
    /// One arm of the cross of every face of the map's mesh, a unit vector along the face.
    pub crosses: &'a FaceMap<DVec3>,
    /// How long edges are wanted at every face of the map's mesh, up to a common factor.
    pub sizes: &'a FaceMap<f64>,
    /// Vertices that belong on sharp lines of the surface.
    pub seams: &'a [Seam],
}

/// Deforms quads that flow into the target's surface, so that their edges keep to the crosses.
///
/// As [`deform`] but for the relaxation: connections stay, edges turn along the crosses and get
/// one length, and quads that are sheared in the end are mended as far as they can be. The last
/// inverted ones are opened by moves in space, which leave the sphere points as they are.
///
/// # Errors
/// A primitive that is not a sphere of triangles and quads, and [`Cancelled`].
pub fn deform_flow(
    map: &SphereMap,
    flowing: Flowing<'_>,
    target: &Target,
    settings: &Settings,
    progress: &Progress,
) -> Result<Deformed, Error> {
    check_primitive(flowing.quads)?;
    flowing.check(map)?;
    let mut report = Report::default();
    let mut sheet = Sheet::new(map, vertex_normals(map.mesh()), flowing.quads);
    follow::lead(
        &mut sheet,
        flowing.wanted,
        N_LEADS,
        &progress.part("", 0.0, 0.05),
    )?;
    let mut follower = Follower::new(map, &sheet, flowing, settings.evenness);
    let part = progress.part("", 0.05, 0.1);
    let mut seams = Seams::new(&mut sheet, flowing.seams, &mut follower, &part)?;
    let n_rounds = settings.n_flow_relaxations;
    for round in (0..n_rounds).step_by(ROUNDS_PER_SLIDE) {
        let n = ROUNDS_PER_SLIDE.min(n_rounds - round);
        let [from, to] = [round, round + n].map(|r| 0.1 + 0.5 * r as f64 / n_rounds as f64);
        let part = progress.part("", from, to);
        report.n_stuck = follower.follow(&mut sheet, n, &part)?;
        seams.slide(
            &mut sheet,
            follower.stars(),
            settings.lines != Lines::Sought,
        );
    }
    seams.release_bad(&mut sheet);
    [report.n_feature_goals, report.n_feature_vertices] = seams.counts(&sheet);
    let finish = Finish {
        target,
        settings,
        crosses: flowing.crosses,
        progress: &progress.part("", 0.7, 1.0),
    };
    if settings.lines != Lines::Sought && report.n_feature_vertices < report.n_feature_goals {
        let mut forced = sheet.clone();
        seams.force(&mut forced);
        let mut done = report;
        finish.fit(&mut forced, &mut done)?;
        let is_sound =
            || untangle::worse_than(&forced, 0.0).is_empty() && done.n_crossing_left == 0;
        if settings.lines == Lines::Forced || is_sound() {
            done.n_feature_vertices = done.n_feature_goals;
            return Ok(Deformed::new(forced, done));
        }
    }
    finish.fit(&mut sheet, &mut report)?;
    Ok(Deformed::new(sheet, report))
}

/// The last steps of quads that flow, in space.
struct Finish<'a> {
    target: &'a Target,
    settings: &'a Settings,
    crosses: &'a FaceMap<DVec3>,
    progress: &'a Progress<'a>,
}

impl Finish<'_> {
    /// Fits quads that were relaxed to the target and mends what that spoils; pinned vertices stay.
    fn fit(&self, sheet: &mut Sheet, report: &mut Report) -> Result<(), Cancelled> {
        let (target, settings, progress) = (self.target, self.settings, self.progress);
        let edge = sheet.mean_edge();
        report.n_unprojected = project::project(sheet, target, edge, progress)?;
        reach::reach(sheet, (target, Span::MISSED), progress)?;
        let fit = Fit {
            target,
            reach: sheet.mean_edge(),
            anchor: settings.anchor_of_flow(),
            sites: &sites::spread(target, SITES_PER_QUAD * sheet.faces().len()),
            squareness: settings.squareness * (1.0 - OWN_SIZE * settings.evenness),
            even: (settings.evenness > 0.0).then_some(Even {
                crosses: self.crosses,
                springs: settings.evenness,
                squares: MEAN_SIZE * settings.squareness * settings.evenness,
            }),
        };
        fit.straddle(sheet, settings.n_flow_straddles, progress)?;
        if settings.is_inscribed {
            report.n_unprojected = project::project(sheet, target, edge, progress)?;
        }
        [report.n_knotted, report.n_opened] = untangle::untangle(sheet, progress)?;
        reach::reach(sheet, (target, Span::LEFT), progress)?;
        if settings.separates {
            [report.n_crossing, report.n_crossing_left] = separate::separate(sheet, progress)?;
        }
        Ok(())
    }
}

impl Flowing<'_> {
    /// Whether there is a position for every vertex and a cross for every face.
    fn check(&self, map: &SphereMap) -> Result<(), Error> {
        let n_faces = map.mesh().n_faces();
        let counts = [self.wanted.len(), self.crosses.len(), self.sizes.len()];
        let needed = [self.quads.n_vertices(), n_faces, n_faces];
        if counts == needed {
            return Ok(());
        }
        Err(Error::Counts { counts, needed })
    }
}

fn check_primitive(primitive: &PolygonMesh) -> Result<(), Error> {
    for face in primitive.face_ids() {
        let n_corners = primitive.face(face).len();
        if n_corners > 4 {
            return Err(Error::TooManyCorners { face, n_corners });
        }
    }
    Ok(check_cover(primitive, primitive.positions())?)
}

/// Rounds of sliding, with flips in between while there are triangles.
fn slide_and_flip(
    sheet: &mut Sheet,
    mut cover: Option<&mut Cover>,
    (n, sizes, report): (usize, Sizes, &mut Report),
    progress: &Progress,
) -> Result<(), Cancelled> {
    for round in 0..n {
        let [from, to] = [round, round + 1].map(|r| r as f64 / n as f64);
        report.n_flips += flips::flip_edges(sheet);
        let part = progress.part("", from, to);
        report.n_stuck = relax::relax(sheet, cover.as_deref_mut(), (1, sizes), &part)?;
    }
    report.n_flips += flips::flip_edges(sheet);
    Ok(())
}
