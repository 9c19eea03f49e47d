//! One part: decimate, embed, make the sphere, deform it.

use glam::DVec3;

use super::borders::Opened;
use super::clock::Clock;
use super::crosses::Cross;
use super::density::Density;
use super::flow::Asked;
use super::flowed::{Flowed, FlowedPart};
use super::ground::Ground;
use super::laid::{Instead, Laid};
use super::mapless::Came;
use super::marks::Marks;
use super::mirror::{Faced, Plane, Role, face};
use super::open::{Closing, Loose, Whole};
use super::paired::{paired, told};
use super::report::{Mirrored, PartReport};
use super::settings::{Primitive, Settings};
use super::strokes::OnPart;
use super::{Error, ways};
use crate::deform::Deformed;
use crate::embed::{Embedded, OffsetPredictor};
use crate::hierarchy::CollapseHierarchy;
use crate::mesh::{PolygonMesh, TriangleMesh, VertexId};
use crate::progress::Progress;
use crate::sphere_map::SphereMap;
use crate::{decimate, embed, measure, sphere};

/// One part and what is to be made of it.
pub struct PartJob<'a> {
    pub part: TriangleMesh,
    pub wanted: Wanted<'a>,
}

/// What is to be made of a part.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    pub n_faces: usize,
    pub settings: &'a Settings,
    pub predictor: &'a dyn OffsetPredictor,
    /// What the part is to the plane of symmetry, which goes through the origin.
    pub mirror: (&'a Role, Option<Plane>),
    /// The part as somebody else reduced it.
    pub reduced: Option<&'a PolygonMesh>,
    pub marks: &'a Marks,
    /// The sides of the polygons that came in, of a mesh that is as coarse as what is asked for.
    pub sides: &'a Marks,
    /// Where something is kept beyond it: no border that is filled.
    pub line: &'a Marks,
    pub density: &'a Density,
    /// What the artist drew on it.
    pub strokes: OnPart<'a>,
    /// Whether all caps of a part with borders lie at the end of tubes.
    pub has_tubes: bool,
    /// Whether there are so many parts that each has to be quick.
    pub is_one_of_many: bool,
}

/// What has become of a part.
#[derive(Clone)]
pub struct PartResult {
    pub mesh: PolygonMesh,
    pub sphere: Vec<DVec3>,
    /// The edges that lie along sharp or marked ones.
    pub features: Vec<[VertexId; 2]>,
    pub crosses: Vec<Cross>,
    /// What borders were filled with.
    pub filling: Vec<[DVec3; 3]>,
    /// The area of the part, the weight of its figures.
    pub area: f64,
    pub report: PartReport,
}

/// A part that faces can be made on: closed, and its own image where that is its role.
struct Ready<'a> {
    wanted: Wanted<'a>,
    faced: Faced,
    /// How it was closed, where it is to be opened again.
    closing: Option<Closing>,
    /// What is told of its borders.
    opened: Option<Opened>,
}

impl PartJob<'_> {
    pub fn run(self, clock: &mut Clock, progress: &Progress<'_>) -> Result<PartResult, Error> {
        let Self { part, wanted } = self;
        let came = Came {
            n_input_faces: part.n_faces(),
            n_asked_faces: wanted.n_faces,
            area: measure::total_area(&part),
        };
        let stage = progress.part("close", 0.0, 0.02);
        let asked = (wanted.settings, wanted.n_faces);
        let on_it = (wanted.marks, wanted.line);
        let whole = || Whole::new(part, asked, on_it, &stage);
        let mut whole = clock.step("close", whole)?;
        let filling = std::mem::take(&mut whole.filling);
        // It takes no time to speak of, and what comes after it where it fails starts here.
        let part = progress.part("", 0.02, 0.02);
        let own = wanted.own_quads((&whole, came), clock, &part)?;
        let made = if let Some(own) = own {
            own
        } else if whole.is_open() {
            wanted.open((&whole, came), clock, progress)?
        } else {
            wanted.run((whole, came), clock, progress)?
        };
        Ok(PartResult { filling, ..made })
    }
}

impl Wanted<'_> {
    /// Makes the faces of a part with borders or handles in the way that suits it.
    pub(super) fn in_one(
        &self,
        (whole, came): (&Whole, Came),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        if let Some(grid) = self.grid(whole, progress)? {
            return Ok(self.without_map((whole, came), grid, Some(Flowed::Grid)));
        }
        let reason = self.too_few().or_else(|| self.too_many_handles(whole));
        let made = match reason {
            Some(reason) => Err(reason),
            None => told(self.run_open((whole, came), clock, progress))?,
        };
        match made {
            Ok(made) => Ok(made),
            Err(reason) => self.run_uncut((whole, came), reason, clock, progress),
        }
    }

    /// Makes the faces of a part, closed first if it is open.
    pub(super) fn run(
        &self,
        (whole, came): (Whole, Came),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<PartResult, Error> {
        let stage = progress.part("close", 0.02, 0.04);
        let ready = self.ready(whole, clock, &stage)?;
        let (wanted, closing) = (ready.wanted, ready.closing);
        let stage = progress.part("decimate", 0.04, 0.2);
        let reduce = || wanted.reduce((&ready.faced, closing.as_ref()), &stage);
        let reduction = clock.step("decimate", reduce)?;
        let stage = progress.part("embed", 0.2, 0.5);
        let embed = || wanted.embed(reduction.mesh, &stage);
        let (hierarchy, embedded) = clock.step("embed", embed)?;
        let closing = closing.zip(reduction.small);
        let refused = ready.faced.refused.clone();
        let asked = (&wanted, came.n_asked_faces);
        let ground = Ground::new(ready.faced, closing, asked, clock, progress)?;
        let start = (&hierarchy, embedded.map);
        let made = wanted.make(start, &ground, clock, &progress.part("", 0.5, 1.0))?;
        let report = PartReport {
            n_input_faces: came.n_input_faces,
            n_asked_faces: came.n_asked_faces,
            n_faces: made.deformed.mesh.n_faces(),
            reduced: reduction.reduced,
            decimate: reduction.report,
            opened: ready.opened,
            embedding: embedded.report,
            flow: made.flow,
            mirrored: refused.or(made.mirrored),
            sphere: made.sphere,
            deform: made.deformed.report,
        };
        Ok(PartResult {
            mesh: made.deformed.mesh,
            sphere: made.deformed.sphere,
            features: made.deformed.features,
            crosses: made.crosses,
            filling: Vec::new(),
            area: came.area,
            report,
        })
    }

    /// Closes the part and makes it its own image, where it is to be.
    fn ready(
        &self,
        whole: Whole,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Ready<'_>, Error> {
        let closing = if whole.is_open() {
            let asked = (self.marks, self.n_faces, self.has_tubes);
            Some(clock.step("close", || Closing::new(&whole, asked, progress))?)
        } else {
            None
        };
        let opened = match &closing {
            Some(closing) => whole.told.map(|told| told.closed(closing.is_doubled())),
            None => whole.told,
        };
        let part = match &closing {
            Some(closing) => closing.mesh().clone(),
            None => whole.mesh,
        };
        let wanted = match &closing {
            Some(closing) => self.of_closed(closing),
            None => *self,
        };
        let mut marked = wanted.marks.on(&part);
        let pieces = [Some(&whole.pieces), closing.as_ref().map(|c| &c.pieces)];
        for pieces in pieces.into_iter().flatten().filter(|p| !p.is_empty()) {
            let more = pieces.on(&part);
            marked = marked.iter().zip(&more).map(|(a, b)| *a || *b).collect();
        }
        let density = wanted.density.on(&part);
        let (role, plane) = wanted.mirror;
        Ok(Ready {
            wanted,
            faced: face((part, marked, density), (role, plane)),
            closing,
            opened,
        })
    }
}

impl Wanted<'_> {
    /// Makes the faces: those that flow, where they are asked for and can be found, else those of
    /// a primitive.
    fn make(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: &Ground,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Made, Error> {
        let start = (hierarchy, map);
        if self.settings.primitive() != Primitive::Flow {
            let laid = self.fixed(start, ground, clock, progress)?;
            return Ok(self.made((laid, None), ground.axis));
        }
        let wanted = Asked {
            n_quads: self.n_faces,
            settings: self.settings,
            density: ground.density.as_ref(),
            marked: &ground.marked,
            axis: ground.axis,
            opening: ground.opening.as_ref(),
            strokes: self.strokes,
            loose: Loose::Nothing,
        };
        let part = progress.part("", 0.0, 0.9);
        match ways::flow_part(&start.1, &ground.target, wanted, clock, &part)? {
            Ok(part) => Ok(Made::flowing(part)),
            Err(reason) => {
                let part = progress.part("", 0.9, 1.0);
                let resort = self.last_resort(start, ground, clock, &part);
                let (laid, instead) = match resort {
                    // Why they do not flow says more than what came of pairs.
                    Err(Error::Unopened { .. }) => return Err(Error::Unopened { reason }),
                    resort => resort?,
                };
                let flowed = Flowed::Refused { reason, instead };
                Ok(self.made((laid, Some(flowed)), ground.axis))
            }
        }
    }

    /// Records the collapses of a mesh, and embeds it.
    fn embed(
        &self,
        mesh: TriangleMesh,
        progress: &Progress<'_>,
    ) -> Result<(CollapseHierarchy, Embedded), Error> {
        let hierarchy = collapse(mesh, progress)?;
        let embedded = embed_hierarchy(&hierarchy, self.predictor, progress)?;
        Ok((hierarchy, embedded))
    }

    /// What is to be made of a part that was closed: the faces of what is virtual are made too.
    fn of_closed(self, closing: &Closing) -> Self {
        let [real, closed] =
            [&closing.real(), closing.mesh()].map(|mesh| self.density.amount(mesh));
        let n_faces = (self.n_faces as f64 * closed / real.max(f64::MIN_POSITIVE)).round();
        Self {
            n_faces: (n_faces as usize).max(self.n_faces),
            ..self
        }
    }

    /// Faces that do not flow.
    fn made(&self, (laid, flow): (Laid, Option<Flowed>), axis: Option<usize>) -> Made {
        let is_asked = axis.is_some() || self.settings.mirrors_in_vain();
        Made {
            deformed: laid.deformed,
            flow,
            mirrored: is_asked.then(|| mirrored(Err("only quads that flow can be".to_owned()))),
            sphere: laid.sphere,
            crosses: Vec::new(),
        }
    }

    /// Quads where none flow: pairs of triangles, or the quad sphere where it has fewer inverted ones.
    fn last_resort(
        &self,
        start: (&CollapseHierarchy, SphereMap),
        ground: &Ground,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<(Laid, Instead), Error> {
        let part = progress.part("", 0.0, 0.6);
        let pairs = match paired(self, (&start.1, ground), clock, &part)? {
            // The quad sphere has no edges along borders.
            Err(reason) if ground.opening.is_some() => return Err(Error::Unopened { reason }),
            pairs => pairs,
        };
        if let Ok(pairs) = pairs {
            if pairs.n_inverted() == 0 || ground.opening.is_some() {
                return Ok((pairs, Instead::PairedTriangles));
            }
            return match self.fixed(start, ground, clock, &progress.part("", 0.6, 1.0)) {
                Ok(sphere) => Ok(pairs.or_sphere(sphere)),
                Err(error) if error.is_cancelled() => Err(error),
                Err(_) => Ok((pairs, Instead::PairedTriangles)),
            };
        }
        let sphere = self.fixed(start, ground, clock, &progress.part("", 0.6, 1.0))?;
        Ok((sphere, Instead::QuadSphere))
    }
}

/// The faces on the surface, and how they came there.
struct Made {
    deformed: Deformed,
    flow: Option<Flowed>,
    mirrored: Option<Mirrored>,
    sphere: Option<sphere::Report>,
    crosses: Vec<Cross>,
}

impl Made {
    fn flowing(part: FlowedPart) -> Self {
        Self {
            deformed: part.deformed,
            flow: Some(part.flowed),
            mirrored: part.mirrored.map(mirrored),
            sphere: Some(part.sphere),
            crosses: part.crosses,
        }
    }
}

fn mirrored(mirrored: Result<(), String>) -> Mirrored {
    match mirrored {
        Ok(()) => Mirrored::Used,
        Err(reason) => Mirrored::Refused { reason },
    }
}

/// Records the collapses of a mesh and embeds it.
pub fn embed_mesh(
    mesh: TriangleMesh,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Embedded, Error> {
    embed_hierarchy(&collapse(mesh, progress)?, predictor, progress)
}

/// The first fifth of an embedding's progress.
fn collapse(mesh: TriangleMesh, progress: &Progress<'_>) -> Result<CollapseHierarchy, Error> {
    Ok(decimate::collapse_to_tetrahedron(
        mesh,
        &progress.part("", 0.0, 0.2),
    )?)
}

fn embed_hierarchy(
    hierarchy: &CollapseHierarchy,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Embedded, Error> {
    Ok(embed::embed(
        hierarchy,
        predictor,
        &predictor.finish(hierarchy),
        &progress.part("", 0.2, 1.0),
    )?)
}
