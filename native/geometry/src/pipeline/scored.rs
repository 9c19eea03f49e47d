//! How good a result is: the score, or the little of it that warnings are made of.

use glam::DVec3;

use super::clock::Clock;
use super::even::Marked;
use super::frame::Prepared;
use super::join::Joined;
use super::marks::Marks;
use super::mirror::Plane;
use super::split::Parts;
use super::strokes::GuideReport;
use super::warning::{Made, Warning, warnings};
use super::{Error, Report, Settings, meet};
use crate::clean;
use crate::measure::{Topology, topology, topology_of_triangles};
use crate::mesh::{PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::score::{self, Reference, Score};

/// A result and what it is measured against.
struct Judging<'a> {
    /// The parts of the input that were to be rebuilt, as they came, and what fills their borders.
    input: &'a PolygonMesh,
    parts: &'a Parts,
    prepared: &'a Prepared,
    /// The marked edges of a mesh.
    marked: (&'a PolygonMesh, &'a [[VertexId; 2]]),
    /// What was made of them, in the input's coordinates.
    output: &'a PolygonMesh,
    joined: &'a Joined,
    plane: Option<Plane>,
}

/// What was found.
#[derive(Default)]
pub struct Judged {
    /// None when it was not asked for or could not be measured.
    pub score: Option<Score>,
    /// Why it could not be measured.
    pub refused: Option<String>,
    pub warnings: Vec<Warning>,
}

/// Measures a result and says what is not as it was to be.
///
/// One that cannot be scored is a result all the same; only a cancellation ends the run.
pub fn judge(
    (given, parts): (&PolygonMesh, &Parts),
    (prepared, plane): (&Prepared, Option<Plane>),
    marked: (&PolygonMesh, &[[VertexId; 2]]),
    (output, joined): (&PolygonMesh, &Joined),
    (settings, clock, progress): (&Settings, &mut Clock, &Progress<'_>),
) -> Result<Judged, Cancelled> {
    let done = parts.done_alone(given);
    let done = done.as_ref().unwrap_or(given);
    let filled = filled(done, prepared, joined);
    let judging = Judging {
        input: filled.as_ref().unwrap_or(done),
        parts,
        prepared,
        marked,
        output,
        joined,
        plane,
    };
    judging.judge(settings, clock, progress)
}

impl Judged {
    /// Warns of strokes that were to be met and are not.
    pub fn heed(&mut self, guides: &[GuideReport], settings: &Settings) {
        let faults = guides.iter().filter_map(GuideReport::fault);
        self.warnings.extend(faults.map(|fault| Warning {
            grave: settings.strict,
            ..Warning::from(fault)
        }));
    }
}

impl Judging<'_> {
    fn judge(
        self,
        settings: &Settings,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Judged, Cancelled> {
        let mut judged = Judged::default();
        let glance = match settings.score() {
            None => {
                told(clock.step("score", || score::glance(self.input, self.output, progress)))?.ok()
            }
            Some(wanted) => match told(clock.step("score", || self.score(&wanted, progress)))? {
                Ok(score) => Some(judged.score.insert(score).glance),
                Err(error) => {
                    judged.refused = Some(error.to_string());
                    None
                }
            },
        };
        let made = Made {
            mesh: self.output,
            parts: &self.joined.parts,
            plane: self.plane,
            diagonal: self.prepared.frame.grow(DVec3::X).x,
            glance,
            lost_marks: self.lost_marks(progress)?,
            rejoined: self.joined.rejoined,
            kept_faces: self.joined.kept_faces,
            staying_small: self.parts.staying_small,
        };
        judged.warnings = warnings(&made, settings, progress)?;
        Ok(judged)
    }

    fn score(
        &self,
        wanted: &score::Settings,
        progress: &Progress<'_>,
    ) -> Result<Score, score::Error> {
        let reference = Reference {
            mesh: self.input,
            topology: Some(self.topology(progress)?),
        };
        score::score(reference, self.output, wanted, progress)
    }

    /// How the input hangs together once its borders are filled and its handles sealed that were to be, and sheets joined
    /// where they meet.
    fn topology(&self, progress: &Progress<'_>) -> Result<Topology, Cancelled> {
        let came = match self.joined.rejoined {
            Some(_) => topology(
                &meet::whole(self.prepared, (self.marked.0, self.parts)),
                progress,
            )?,
            None => topology_of_triangles(&self.prepared.mesh),
        };
        let opened = self.joined.parts.iter().filter_map(|part| part.opened);
        let (mut n_filled, mut n_sealed) = (0, 0);
        for opened in opened {
            n_filled += opened.n_filled;
            n_sealed += opened.n_sealed as i64;
        }
        let n_borders = came.n_borders.saturating_sub(n_filled);
        Ok(Topology {
            closed: n_borders == 0,
            n_borders,
            genus: came.genus.map(|genus| genus - n_sealed),
            ..came
        })
    }

    /// The share of the marked edges that no edge lies along.
    fn lost_marks(&self, progress: &Progress<'_>) -> Result<f64, Cancelled> {
        let Prepared { mesh, frame, .. } = self.prepared;
        let marked = Marked::new(mesh, &Marks::new(self.marked, frame).on(mesh));
        marked.lost((&self.joined.mesh, &self.joined.features), progress)
    }
}

/// A mesh with what fills its borders, in corners of its own; none where nothing does.
fn filled(mesh: &PolygonMesh, prepared: &Prepared, joined: &Joined) -> Option<PolygonMesh> {
    if joined.filling.is_empty() {
        return None;
    }
    let mut positions = mesh.positions().to_vec();
    let first = positions.len() as u32;
    positions.extend(prepared.frame.leave(joined.filling.as_flattened()));
    let more = (first..positions.len() as u32).map(VertexId);
    let mut corners = mesh.corners().to_vec();
    let n_before = corners.len() as u32;
    corners.extend(more);
    let n_more = joined.filling.len() as u32;
    let starts = mesh.starts().iter().copied();
    let starts = starts.chain((1..=n_more).map(|i| n_before + 3 * i));
    let filled = PolygonMesh::new(positions, starts.collect(), corners);
    Some(filled.expect("a mesh and triangles are a mesh"))
}

/// The report of a result that is sound, or of any where nobody is strict.
pub fn sound(report: Report, settings: &Settings) -> Result<Report, Error> {
    if !settings.strict || report.warnings.iter().all(|warning| !warning.grave) {
        return Ok(report);
    }
    let warnings = report.warnings.clone();
    let report = Box::new(report);
    Err(Error::Unsound { warnings, report })
}

fn told<T>(found: Result<T, score::Error>) -> Result<Result<T, score::Error>, Cancelled> {
    match found {
        Err(score::Error::Cancelled(cancelled)) => Err(cancelled),
        found => Ok(found),
    }
}

/// Says how good `output` is as a new mesh of `input`, as [`remesh`](super::remesh) does: whether the
/// topology is the same is told of the input once it is cleaned, with borders that lie on each other
/// welded and faces without area or that repeat dropped; of one that cannot be cleaned, as it comes.
///
/// # Errors
/// When one of them has no area, a setting is 0, or cancelled.
pub fn score(
    input: &PolygonMesh,
    output: &PolygonMesh,
    settings: &score::Settings,
    progress: &Progress<'_>,
) -> Result<Score, score::Error> {
    let weld = Settings::default().weld;
    let topology = match clean::take_apart(input, weld, &progress.part("", 0.0, 0.1)) {
        Err(clean::Error::Cancelled(cancelled)) => return Err(cancelled.into()),
        Ok(apart) if apart.tangles.is_empty() && apart.shared.is_empty() => {
            Some(topology_of_triangles(&apart.mesh))
        }
        _ => None,
    };
    let reference = Reference {
        mesh: input,
        topology,
    };
    score::score(reference, output, settings, &progress.part("", 0.1, 1.0))
}
