//! Parts with borders or handles that are to be their own image: made by halves.

use super::Error;
use super::clock::Clock;
use super::flowed::Flowed;
use super::mapless::Came;
use super::marks::Marks;
use super::mirror::{Halved, Plane, Role, halved, joined};
use super::open::{Closing, Whole};
use super::paired::told;
use super::part::{PartResult, Wanted};
use super::probe::farthest;
use super::report::{Mirrored, PartReport};
use super::rods::images;
use crate::deform::{Target, n_inverted};
use crate::measure;
use crate::mesh::{Id, VertexId};
use crate::mirror::mirrored;
use crate::progress::Progress;

/// A symmetric part may have one in so many faces more or less than asked for, and a few, before another
/// is tried.
const FACES_PER_OFF: usize = 33;
const FEW_OFF: usize = 4;

/// A symmetric part may miss the surface by so many edges before another is tried.
const NEAR: f64 = 1.0;
/// And by so many times as much as another one beyond that.
const WORTH: f64 = 2.0;
/// Why a part is not its own image that could be.
const WORSE: &str = "quads of its half are not as good";

impl Wanted<'_> {
    /// Makes the faces of a part with borders or handles, its own image where that is its role and not
    /// worse.
    ///
    /// # Errors
    /// Any of the steps'.
    pub(super) fn open(
        &self,
        part: (&Whole, Came),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        let (Role::Whole, Some(plane)) = self.mirror else {
            return self.in_one(part, clock, progress);
        };
        let judge = Judge::new((part.0, plane), progress)?;
        let mut first = None;
        if self.is_capped(part.0, &progress.part("", 0.0, 0.0))? {
            let made = self.in_one(part, clock, &progress.part("", 0.0, 0.5))?;
            let made = made.exact(plane.axis);
            if made.is_mirrored() && judge.is_good(&made) {
                return Ok(made);
            }
            first = Some(made);
        }
        let stage = progress.part("", 0.5, 0.8);
        let halves = told(self.by_halves(part, plane, clock, &stage))?;
        let (halves, reason) = match halves.and_then(|halves| halves) {
            Ok(halves) if first.is_none() && judge.is_good(&halves) => return Ok(halves),
            Ok(halves) => (Some(halves), WORSE.to_owned()),
            Err(reason) => (None, reason),
        };
        let stage = progress.part("", 0.8, 1.0);
        let usual = match first {
            Some(made) => Ok(made),
            None => self.alone(part, reason.clone(), clock, &stage),
        };
        match (halves, usual.map(|usual| usual.refused(reason))) {
            (_, Err(error)) if error.is_cancelled() => Err(error),
            (Some(halves), Ok(usual)) if judge.prefers(&usual, &halves) => Ok(usual),
            (Some(halves), _) => Ok(halves),
            (None, usual) => usual,
        }
    }

    /// Whether a part is its own image and all that closes it are caps: these do not break its symmetry,
    /// and the flow has the plane as a line.
    fn is_capped(&self, whole: &Whole, progress: &Progress<'_>) -> Result<bool, Error> {
        let was_symmetric = self.mirror.1.is_some_and(|plane| plane.was_symmetric);
        if !was_symmetric || whole.has_handles() {
            return Ok(false);
        }
        let closing = Closing::new(whole, (self.marks, self.n_faces, self.has_tubes), progress)?;
        Ok(!closing.is_doubled())
    }

    /// The faces of a part that cannot be made by halves.
    fn alone(
        &self,
        part: (&Whole, Came),
        reason: String,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        let alone = Role::Alone(Some(reason));
        let usual = Wanted {
            mirror: (&alone, self.mirror.1),
            ..*self
        };
        usual.in_one(part, clock, progress)
    }

    /// The faces of the half on the positive side and their image; why not, as the inner error.
    fn by_halves(
        &self,
        (whole, came): (&Whole, Came),
        plane: Plane,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Result<PartResult, String>, Error> {
        let on_it = (self.marks, self.density);
        let Halved { half, density } = match halved(whole, plane, on_it) {
            Ok(halved) => halved,
            Err(reason) => return Ok(Err(reason)),
        };
        let Some(seam) = half.seam.clone() else {
            return Ok(Err("its half has no seam".to_owned()));
        };
        let n_faces = (self.n_faces / 2).max(1);
        let alone = Role::Alone(None);
        let nothing = Marks::default();
        let wanted = Wanted {
            n_faces,
            mirror: (&alone, None),
            reduced: None,
            marks: &nothing,
            density: &density,
            ..*self
        };
        let own = Came {
            n_input_faces: half.mesh.n_faces(),
            n_asked_faces: n_faces,
            area: measure::total_area(&half.mesh),
        };
        let made = wanted.in_one((&half, own), clock, progress)?;
        let made = match joined(made, &seam, progress)? {
            Ok(made) => made,
            Err(reason) => return Ok(Err(reason)),
        };
        let report = PartReport {
            n_input_faces: came.n_input_faces,
            n_asked_faces: came.n_asked_faces,
            ..made.report
        };
        Ok(Ok(PartResult {
            area: came.area,
            report,
            ..made
        }))
    }
}

impl PartResult {
    fn flows(&self) -> bool {
        !matches!(self.report.flow, Some(Flowed::Refused { .. }))
    }

    /// Whether it has about as many faces as were asked for.
    fn has_count(&self) -> bool {
        let n_asked = self.report.n_asked_faces;
        self.report.n_faces.abs_diff(n_asked) <= FEW_OFF + n_asked / FACES_PER_OFF
    }

    fn is_mirrored(&self) -> bool {
        self.report.mirrored == Some(Mirrored::Used)
    }

    /// The same with vertices that are each other's images to the last bit, which opening has moved;
    /// where faces have no images any more it is none.
    pub(super) fn exact(mut self, axis: usize) -> Self {
        if !self.is_mirrored() {
            return self;
        }
        let Some(images) = images(&self.mesh, axis) else {
            let reason = "what was opened is no longer its own image".to_owned();
            self.report.mirrored = Some(Mirrored::Refused { reason });
            return self;
        };
        let now = self.mesh.positions();
        let place = |(v, image): (usize, &VertexId)| {
            let [own, there] = [now[v], now[image.index()]];
            let mut place = own;
            if image.index() == v {
                place[axis] = 0.0;
            } else if (there[axis], image.index()) > (own[axis], v) {
                place = mirrored(there, axis);
            }
            place
        };
        let places = images.iter().enumerate().map(place).collect();
        self.mesh = self.mesh.with_positions(places);
        self.report.deform.n_inverted = n_inverted(&self.mesh);
        self
    }

    /// The same with the reason why it is not its own image.
    fn refused(mut self, reason: String) -> Self {
        if !self.is_mirrored() {
            self.report.mirrored = Some(Mirrored::Refused { reason });
        }
        self
    }
}

/// What tells good parts from others.
struct Judge {
    /// The part; none where its negative side is replaced.
    target: Option<Target>,
}

impl Judge {
    fn new((whole, plane): (&Whole, Plane), progress: &Progress<'_>) -> Result<Self, Error> {
        let target = plane
            .was_symmetric
            .then(|| Target::new(whole.mesh.clone(), progress));
        Ok(Self {
            target: target.transpose()?,
        })
    }

    fn off(&self, made: &PartResult) -> f64 {
        let target = self.target.as_ref();
        target.map_or(0.0, |target| farthest(&made.mesh, target))
    }

    /// Whether there is nothing to gain by another try.
    fn is_good(&self, made: &PartResult) -> bool {
        let is_sound = made.flows() && made.report.deform.n_inverted == 0;
        is_sound && made.has_count() && self.off(made) <= NEAR
    }

    /// Whether a part is to be preferred to one that is made by halves.
    fn prefers(&self, usual: &PartResult, halves: &PartResult) -> bool {
        let rank = |part: &PartResult| {
            let n_inverted = part.report.deform.n_inverted;
            (n_inverted, !part.flows(), !part.has_count())
        };
        let [own, others] = [usual, halves].map(rank);
        let [off, off_halves] = [usual, halves].map(|part| self.off(part));
        let is_far = off_halves > NEAR && off_halves > WORTH * off;
        own < others || (own == others && (usual.is_mirrored() || is_far))
    }
}
