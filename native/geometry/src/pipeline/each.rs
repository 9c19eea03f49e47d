//! Does every part by itself.

use std::collections::HashSet;

use super::clock::Clock;
use super::density::Density;
use super::flowed::Flowed;
use super::frame::Prepared;
use super::join::{self, Joined};
use super::marks::Marks;
use super::meet::Meetings;
use super::mirror::{self, Plane, Role};
use super::own;
use super::part::{PartJob, PartResult, Wanted};
use super::region::Region;
use super::report::{Mirrored, PartReport};
use super::shares::share;
use super::split::{Parts, components};
use super::strokes::Strokes;
use super::{Error, Settings, share_of_work};
use crate::embed::OffsetPredictor;
use crate::mesh::{PolygonMesh, TriangleMesh};
use crate::progress::Progress;

/// All that the parts have in common.
pub struct Common<'a> {
    pub prepared: &'a Prepared,
    pub marks: &'a Marks,
    /// The sides of the polygons that came in, where their quads may stay.
    pub sides: &'a Marks,
    /// Where something is kept beyond it.
    pub line: &'a Marks,
    pub density: &'a Density,
    /// The mesh as somebody else reduced it, where it is one part.
    pub reduced: Option<&'a PolygonMesh>,
    pub settings: &'a Settings,
    pub plane: Option<Plane>,
    pub predictor: &'a dyn OffsetPredictor,
    /// What the artist drew.
    pub strokes: &'a Strokes,
}

/// Of more parts each has to be quick.
const MANY: usize = 32;
/// All parts together may have one face more for so many, where shapes take more: beyond one in 20
/// a warning would say so.
const FACES_PER_SPARE: usize = 25;

/// What became of every part, or why its run failed.
pub struct Each(Vec<Result<PartResult, String>>);

impl Common<'_> {
    /// Runs one part after the other. A part that fails does not stop the others.
    ///
    /// # Errors
    /// When cancelled.
    pub fn run(&self, clock: &mut Clock, progress: &Progress<'_>) -> Result<Each, Error> {
        let mesh = &self.prepared.mesh;
        let parts = clock.step("split", || components(mesh, progress))?;
        let amounts: Vec<f64> = parts.iter().map(|part| self.density.amount(part)).collect();
        let settings = self.settings;
        let least = self.least(&parts);
        let shares = share(&amounts, settings.faces, &least);
        let reduced = self.reduced.filter(|_| parts.len() == 1);
        let entered = |mesh: &PolygonMesh| self.prepared.frame.enter(mesh.positions());
        let reduced = reduced.map(|mesh| mesh.with_positions(entered(mesh)));
        let roles = match self.plane {
            Some(plane) => mirror::roles(&parts, plane, progress)?,
            None => vec![Role::Alone(None); parts.len()],
        };
        let mut work = Work {
            common: self,
            reduced: reduced.as_ref(),
            clock,
            progress,
            done: 0,
            are_many: parts.len() > MANY,
            n_spare: match parts.len() {
                1 => 0,
                _ => settings.faces / FACES_PER_SPARE,
            },
        };
        let mut made = Vec::with_capacity(parts.len());
        let mut images = Vec::new();
        for (at, ((part, n_faces), role)) in parts.into_iter().zip(shares).zip(&roles).enumerate() {
            if let &Role::ImageOf(of) = role {
                images.push((made.len(), of, part, n_faces));
                made.push(Err(String::new()));
            } else {
                made.push(work.run((at, part), n_faces, role)?);
            }
        }
        for (at, of, part, n_faces) in images {
            made[at] = if let (Ok(of_made), Some(plane)) = (&made[of], self.plane) {
                Ok(mirror::image_of(of_made, of, plane.axis))
            } else {
                let alone = "the part whose image it is could not be done".to_owned();
                work.run((at, part), n_faces, &Role::Alone(Some(alone)))?
            };
        }
        Ok(Each(made))
    }

    /// The fewest faces of each part: what closes it; and of one in quads no smaller share of them than
    /// of all faces, so that others get no more at its cost.
    fn least(&self, parts: &[TriangleMesh]) -> Vec<usize> {
        let fewest = self.settings.kind.fewest_faces();
        let mesh = &self.prepared.mesh;
        let polygons: HashSet<_> = mesh
            .face_ids()
            .map(|f| self.prepared.input_face(f))
            .collect();
        let whole = polygons.len().min(mesh.n_faces() / 2);
        let share = (self.settings.faces as f64 / whole.max(1) as f64).min(1.0);
        let own = |part| own::n_quads(part, self.sides).unwrap_or(0) as f64;
        parts
            .iter()
            .map(|part| fewest.max((share * own(part)) as usize))
            .collect()
    }
}

/// The parts on their way.
struct Work<'a, 'b> {
    common: &'a Common<'a>,
    reduced: Option<&'a PolygonMesh>,
    clock: &'a mut Clock,
    progress: &'a Progress<'b>,
    /// How many triangles are done.
    done: usize,
    are_many: bool,
    /// How many faces more parts may still have.
    n_spare: usize,
}

impl Work<'_, '_> {
    /// Runs a part, once more with twice as many faces where its shape takes more than few.
    fn run(
        &mut self,
        (at, part): (usize, TriangleMesh),
        n_faces: usize,
        role: &Role,
    ) -> Result<Result<PartResult, String>, Error> {
        let again = (n_faces <= self.n_spare).then(|| part.clone());
        let made = self.run_once((at, part), n_faces, role)?;
        let is_refused = |made: &PartResult| made.report.is_refused();
        let Some(part) = again.filter(|_| made.as_ref().is_ok_and(is_refused)) else {
            return Ok(made);
        };
        self.n_spare -= n_faces;
        self.done -= part.n_faces();
        let more = self.run_once((at, part), 2 * n_faces, role)?;
        let is_it = more.as_ref().is_ok_and(|more| !is_refused(more));
        Ok(if is_it { more } else { made })
    }

    fn run_once(
        &mut self,
        (at, part): (usize, TriangleMesh),
        n_faces: usize,
        role: &Role,
    ) -> Result<Result<PartResult, String>, Error> {
        let common = self.common;
        let total = common.prepared.mesh.n_faces();
        let from = share_of_work(self.done, total);
        self.done += part.n_faces();
        let progress = self
            .progress
            .part("", from, share_of_work(self.done, total));
        let job = PartJob {
            part,
            wanted: Wanted {
                n_faces,
                settings: common.settings,
                predictor: common.predictor,
                mirror: (role, common.plane),
                reduced: self.reduced,
                marks: common.marks,
                sides: common.sides,
                line: common.line,
                density: common.density,
                strokes: common.strokes.on_part(at),
                has_tubes: false,
                is_one_of_many: self.are_many,
            },
        };
        match job.run(self.clock, &progress) {
            Err(error) if error.is_cancelled() => Err(error),
            Err(error) => Ok(Err(error.to_string())),
            Ok(made) => Ok(Ok(made)),
        }
    }
}

impl Each {
    /// Joins what was made; parts that failed stay as they were, and go from the mesh that data is
    /// carried from.
    ///
    /// # Errors
    /// [`Error::Refused`] where too few parts are left.
    pub fn join(
        self,
        mut prepared: Prepared,
        parts: &mut Parts,
        (mesh, region, settings): (&PolygonMesh, Option<&Region>, &Settings),
        progress: &Progress<'_>,
    ) -> Result<(Prepared, Joined), Error> {
        let is_left: Vec<bool> = self.0.iter().map(Result::is_ok).collect();
        let mut made = Vec::new();
        let mut failed = Vec::new();
        for (at, part) in self.0.into_iter().enumerate() {
            match part {
                Ok(part) => made.push(part),
                Err(text) => failed.push((at, text)),
            }
        }
        let mut is_left = is_left;
        loop {
            if !failed.is_empty() {
                parts.keep_failed(mesh, failed, settings)?;
                prepared = prepared.only(&is_left);
                for part in &mut made {
                    part.rename_image(&is_left);
                }
            }
            let meetings = Meetings::new((mesh, &prepared.frame), parts);
            let Some(region) = region else {
                let joined = meetings.join(join::join(made), progress)?;
                return Ok((prepared, joined));
            };
            let joined = meetings.join(join::join(made.clone()), progress)?;
            failed = match region.joined(joined, (mesh, &prepared), progress)? {
                Ok(joined) => return Ok((prepared, joined)),
                Err(failed) => failed,
            };
            is_left = vec![true; made.len()];
            for &(at, _) in &failed {
                is_left[at] = false;
            }
            let mut left = is_left.iter();
            made.retain(|_| left.next() == Some(&true));
        }
    }
}

impl PartReport {
    /// Whether quads were to flow and do not.
    fn is_refused(&self) -> bool {
        matches!(self.flow, Some(Flowed::Refused { .. }))
    }
}

impl PartResult {
    /// Counts the part whose image it is among those that are left.
    fn rename_image(&mut self, is_left: &[bool]) {
        if let Some(Mirrored::Image { of }) = &mut self.report.mirrored {
            *of = is_left[..*of].iter().filter(|&&left| left).count();
        }
    }
}
