//! One part: decimate, embed, make the sphere, deform it.

use std::borrow::Cow;

use glam::DVec3;

use super::clock::Clock;
use super::crosses::Cross;
use super::density::Density;
use super::flow::Asked;
use super::flowed::{Flowed, FlowedPart};
use super::marks::Marks;
use super::mirror::{self, Faced, Plane, Role, face};
use super::open::{Closing, Opening, Small};
use super::paired::{Instead, Laid, paired};
use super::report::{Mirrored, PartReport, Reduced};
use super::settings::{Kind, Primitive, Settings};
use super::{Error, ways};
use crate::deform::{Deformed, Held};
use crate::embed::{Embedded, OffsetPredictor};
use crate::hierarchy::CollapseHierarchy;
use crate::mesh::{HalfedgeMap, PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;
use crate::{decimate, deform, embed, measure, sphere};

/// The map's mesh has this many vertices for each vertex of the result: below 2 the map misses
/// detail that the faces could show, above 4 only time grows.
const MAP_VERTICES_PER_VERTEX: f64 = 2.0;
/// Fewer vertices than this are not worth saving.
const LEAST_MAP_VERTICES: usize = 3_000;

/// Along borders the number of triangles is met roughly: they are made so often at most, until they
/// are off by no more than a share.
const N_COUNTS: usize = 4;
const NEAR_COUNT: f64 = 0.01;

/// A part with borders is not made its own image.
const OPEN_REASON: &str = "it has borders and is not its own image in the plane";

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
    pub density: &'a Density,
}

/// What has become of a part.
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

/// What faces are made on.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    pub target: &'a deform::Target,
    /// The target's marked edges.
    marked: &'a HalfedgeMap<bool>,
    /// The density asked for there.
    density: Option<&'a VertexMap<f64>>,
    /// The axis across the plane of symmetry.
    axis: Option<usize>,
    /// How many faces are wanted on what is real.
    n_asked: usize,
    /// What is real of the target, where it was closed.
    pub opening: Option<&'a Opening>,
}

struct Reduction {
    mesh: TriangleMesh,
    /// The same with its borders, where it was closed.
    small: Option<Small>,
    reduced: Option<Reduced>,
    report: Option<decimate::Report>,
}

impl PartJob<'_> {
    pub fn run(self, clock: &mut Clock, progress: &Progress<'_>) -> Result<PartResult, Error> {
        let Self { part, wanted } = self;
        let n_asked = wanted.n_faces;
        let (n_input_faces, area) = (part.n_faces(), measure::total_area(&part));
        let closing = Closing::new(&part, (wanted.settings, n_asked), progress)?;
        let opened = closing.as_ref().and_then(Closing::told);
        let filling = closing.as_ref().map(Closing::filling).unwrap_or_default();
        let (part, closing) = match closing {
            Some(closing) if closing.is_filled() => (closing.into_mesh(), None),
            Some(closing) => (closing.mesh().clone(), Some(closing)),
            None => (part, None),
        };
        let wanted = match &closing {
            Some(closing) => wanted.of_closed(closing),
            None => wanted,
        };
        let (marked, density) = (wanted.marks.on(&part), wanted.density.on(&part));
        let Faced {
            mesh: part,
            marked,
            density,
            axis,
            refused,
        } = face(
            (part, marked, density),
            (&wanted.role(closing.as_ref()), wanted.mirror.1),
        );
        let stage = progress.part("decimate", 0.0, 0.2);
        let reduction = clock.step("decimate", || match &closing {
            Some(closing) => wanted.reduce_open(closing, &stage),
            None => wanted.reduce((&part, axis), &stage),
        })?;
        let stage = progress.part("embed", 0.2, 0.5);
        let (hierarchy, embedded) = clock.step("embed", || {
            let hierarchy = collapse(reduction.mesh, &stage)?;
            let embedded = embed_hierarchy(&hierarchy, wanted.predictor, &stage)?;
            Ok::<_, Error>((hierarchy, embedded))
        })?;
        let embedding = embedded.report;
        let border = closing.as_ref().map(Closing::border);
        let lines = (&marked, border.as_ref());
        let target = clock.step("deform", || wanted.target((part, lines), progress))?;
        let opening = match (closing, reduction.small) {
            (Some(closing), Some(small)) => {
                Some(closing.opening(&small, wanted.n_faces, progress)?)
            }
            _ => None,
        };
        let stage = progress.part("", 0.5, 1.0);
        let start = (&hierarchy, embedded.map);
        let ground = Ground {
            target: &target,
            marked: &marked,
            density: density.as_ref(),
            axis,
            n_asked,
            opening: opening.as_ref(),
        };
        let made = wanted.make(start, ground, clock, &stage)?;
        let report = PartReport {
            n_input_faces,
            n_asked_faces: n_asked,
            n_faces: made.deformed.mesh.n_faces(),
            reduced: reduction.reduced,
            decimate: reduction.report,
            opened,
            embedding,
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
            filling,
            area,
            report,
        })
    }
}

impl Wanted<'_> {
    /// Makes the faces: those that flow, where they are asked for and can be found, else those of
    /// a primitive.
    fn make(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: Ground<'_>,
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
            density: ground.density,
            marked: ground.marked,
            axis: ground.axis,
            opening: ground.opening,
        };
        let part = progress.part("", 0.0, 0.9);
        match ways::flow_part(&start.1, ground.target, wanted, clock, &part)? {
            Ok(part) => Ok(Made::flowing(part)),
            Err(reason) => {
                let part = progress.part("", 0.9, 1.0);
                let (laid, instead) = self.last_resort(start, ground, clock, &part)?;
                let flowed = Flowed::Refused { reason, instead };
                Ok(self.made((laid, Some(flowed)), ground.axis))
            }
        }
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

    /// What the part is to the plane of symmetry; one with borders has to be its own image already.
    fn role(&self, closing: Option<&Closing>) -> Role {
        match self.mirror {
            (Role::Whole, Some(plane)) if closing.is_some() && !plane.was_symmetric => {
                Role::Alone(Some(OPEN_REASON.to_owned()))
            }
            (role, _) => role.clone(),
        }
    }

    /// Brings a part with borders down to the size of the map, and closes it.
    fn reduce_open(&self, closing: &Closing, progress: &Progress<'_>) -> Result<Reduction, Error> {
        let small = closing.reduced(self.n_map_faces(), progress)?;
        let reason = "the part is open, and has to be closed first".to_owned();
        Ok(Reduction {
            mesh: small.mesh.clone(),
            reduced: self.reduced.map(|_| Reduced::Refused { reason }),
            report: small.report.clone(),
            small: Some(small),
        })
    }

    /// Faces that do not flow.
    fn made(&self, (laid, flow): (Laid, Option<Flowed>), axis: Option<usize>) -> Made {
        let is_asked = axis.is_some() || self.settings.mirrors_in_vain();
        Made {
            deformed: laid.deformed,
            flow,
            mirrored: is_asked.then(|| told(Err("only quads that flow can be".to_owned()))),
            sphere: laid.sphere,
            crosses: Vec::new(),
        }
    }

    /// Quads where none flow: pairs of triangles, or the quad sphere where it has fewer inverted ones.
    fn last_resort(
        &self,
        start: (&CollapseHierarchy, SphereMap),
        ground: Ground<'_>,
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

    /// The faces of a primitive that is the same for all shapes, or adapts to them.
    fn fixed(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: Ground<'_>,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Laid, Error> {
        let stage = progress.part("sphere", 0.0, 0.5);
        let placed = clock.step("sphere", || self.place((hierarchy, map), ground, &stage))?;
        let stage = progress.part("deform", 0.5, 1.0);
        let (map, primitive) = (&placed.map, (&placed.primitive, &placed.held));
        let settings = ground.deform();
        let deform = || deform::deform_held(map, primitive, ground.target, &settings, &stage);
        let deformed = clock.step("deform", deform)?;
        let deformed = ground.opened(map, deformed, &placed.held.edges, progress)?;
        let deformed = deformed.map_err(|reason| Error::Unopened { reason })?;
        Ok(Laid::new(deformed, placed.report, ground.bare()))
    }

    /// The part with the edges that the result is to have too.
    fn target(
        &self,
        (part, (marked, border)): (
            TriangleMesh,
            (&HalfedgeMap<bool>, Option<&HalfedgeMap<bool>>),
        ),
        progress: &Progress<'_>,
    ) -> Result<deform::Target, Cancelled> {
        progress.check()?;
        let sharp = measure::sharp_edges(&part, self.settings.sharp_angle.to_radians());
        // Borders are held from the beginning.
        let is_border = |h| border.is_some_and(|border| border[h]);
        let halfedges = part.halfedge_ids();
        let either = halfedges.map(|h| (sharp[h] || marked[h]) && !is_border(h));
        let either = either.collect();
        deform::Target::with_features(part, &either, progress)
    }

    /// Brings the part down to the size of the map.
    fn reduce(
        &self,
        (part, axis): (&TriangleMesh, Option<usize>),
        progress: &Progress<'_>,
    ) -> Result<Reduction, Error> {
        let full = Cow::Borrowed(part);
        let (start, reduced) = match self.reduced.map(|mesh| usable(mesh, (&full, axis))) {
            Some(Ok(mesh)) => {
                let n_faces = mesh.n_faces();
                (Cow::Owned(mesh), Some(Reduced::Used { n_faces }))
            }
            Some(Err(reason)) => (full, Some(Reduced::Refused { reason })),
            None => (full, None),
        };
        let n_faces = self.n_map_faces();
        if start.n_faces() <= n_faces {
            return Ok(Reduction {
                mesh: start.into_owned(),
                small: None,
                reduced,
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&start, &settings, progress)?;
        Ok(Reduction {
            mesh: simplified.mesh,
            small: None,
            reduced,
            report: Some(simplified.report),
        })
    }

    fn n_map_faces(&self) -> usize {
        let per_face = match self.settings.kind {
            Kind::Triangles => 0.5,
            Kind::Quads => 1.0,
        };
        let wanted = self.n_faces as f64 * per_face * MAP_VERTICES_PER_VERTEX;
        2 * (wanted as usize).max(LEAST_MAP_VERTICES)
    }

    /// Triangles that are even on the part, as many as are wanted on what is real.
    fn adaptive(
        &self,
        map: &SphereMap,
        ground: Ground<'_>,
        progress: &Progress<'_>,
    ) -> Result<(Adaptive, Held), Error> {
        let density = VertexMap::filled(map.mesh().n_vertices(), 1.0);
        let lines = ground.opening.map_or(&[][..], |opening| &opening.lines);
        let (mut n_faces, n_asked) = (self.n_faces, ground.n_asked(self) as f64);
        for n_left in (0..N_COUNTS).rev() {
            let settings = sphere::Settings {
                n_faces,
                seed: self.settings.seed,
                ..sphere::Settings::default()
            };
            let made = sphere::sized(map, (&density, lines), &settings, progress)?;
            let held = ground.held(map, &made, progress)?;
            let faces = (&made.primitive, made.primitive.positions());
            let share = ground.real_share(map, faces, &held.edges, progress)?;
            let found = share * made.primitive.n_faces() as f64;
            let next = (n_faces as f64 * n_asked / found.max(1.0)).round() as usize;
            let is_near = (found - n_asked).abs() <= NEAR_COUNT * n_asked;
            if lines.is_empty() || is_near || n_left == 0 || next == n_faces {
                return Ok((made, held));
            }
            n_faces = next;
        }
        unreachable!("the last count is taken as it is")
    }

    /// Makes the primitive and chooses its map: adaptive triangles lie where the surface needs them
    /// on any map; a fixed primitive is even on the sphere and needs a map that keeps areas.
    fn place(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: Ground<'_>,
        progress: &Progress<'_>,
    ) -> Result<Placed, Error> {
        let seed = self.settings.seed;
        let fixed = match self.settings.primitive() {
            Primitive::Adaptive => {
                let (made, held) = self.adaptive(&map, ground, progress)?;
                return Ok(Placed {
                    map,
                    primitive: made.primitive,
                    held,
                    report: Some(made.report),
                });
            }
            Primitive::Flow | Primitive::QuadSphere => {
                sphere::quad_sphere(sphere::quad_sphere_counts(self.n_faces))
            }
            Primitive::Icosphere => sphere::icosphere(sphere::icosphere_frequency(self.n_faces)),
        };
        let map = embed::even(hierarchy, &progress.part("", 0.0, 0.8))?;
        let settings = sphere::SpreadSettings {
            seed,
            ..sphere::SpreadSettings::default()
        };
        let primitive = sphere::spread(&map, &fixed, &settings, &progress.part("", 0.8, 1.0))?;
        Ok(Placed {
            map,
            primitive,
            held: Held::default(),
            report: None,
        })
    }
}

impl Ground<'_> {
    /// The part as it came, open or not.
    pub fn bare(&self) -> &deform::Target {
        self.opening.map_or(self.target, |opening| &opening.bare)
    }

    /// How faces are laid on it that do not flow.
    pub fn deform(&self) -> deform::Settings {
        deform::Settings {
            separates: self.opening.is_none_or(|opening| !opening.overlaps()),
            ..deform::Settings::default()
        }
    }

    /// Faces that lie on it, those on what is real alone; or why these are not the part. The edges along
    /// its borders are given, and the map whose sphere they cover.
    pub fn opened(
        &self,
        map: &SphereMap,
        deformed: Deformed,
        border: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<Result<Deformed, String>, Cancelled> {
        let Some(opening) = self.opening else {
            return Ok(Ok(deformed));
        };
        let faces = (&deformed.mesh, &deformed.sphere[..]);
        let is_real = opening.real(map, faces, border, progress)?;
        opening.kept(&deformed, &is_real, progress)
    }

    /// What of a primitive was made along its borders, held there.
    pub fn held(
        &self,
        map: &SphereMap,
        made: &Adaptive,
        progress: &Progress<'_>,
    ) -> Result<Held, Error> {
        match self.opening {
            Some(opening) => opening.held_all(map, made, progress),
            None => Ok(Held::default()),
        }
    }

    /// How many faces are wanted on what is real, of so many on all.
    pub fn n_asked(&self, wanted: &Wanted<'_>) -> usize {
        match self.opening {
            Some(_) => self.n_asked,
            None => wanted.n_faces,
        }
    }

    /// The share of a surface's faces that lie on what is real, between the edges along borders.
    pub fn real_share(
        &self,
        map: &SphereMap,
        faces: (&PolygonMesh, &[DVec3]),
        border: &[[VertexId; 2]],
        progress: &Progress<'_>,
    ) -> Result<f64, Cancelled> {
        let Some(opening) = self.opening else {
            return Ok(1.0);
        };
        let is_real = opening.real(map, faces, border, progress)?;
        let n_real = is_real.iter().filter(|is_real| **is_real).count();
        Ok(n_real as f64 / is_real.len().max(1) as f64)
    }
}

#[cfg(test)]
impl<'a> Ground<'a> {
    /// A closed part of which nothing is marked.
    pub fn closed(target: &'a deform::Target, marked: &'a HalfedgeMap<bool>) -> Self {
        Self {
            target,
            marked,
            density: None,
            axis: None,
            n_asked: 0,
            opening: None,
        }
    }
}

/// The faces on the surface, and how they came there.
struct Made {
    deformed: deform::Deformed,
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
            mirrored: part.mirrored.map(told),
            sphere: Some(part.sphere),
            crosses: part.crosses,
        }
    }
}

fn told(mirrored: Result<(), String>) -> Mirrored {
    match mirrored {
        Ok(()) => Mirrored::Used,
        Err(reason) => Mirrored::Refused { reason },
    }
}

/// A primitive and the map that carries it to the surface.
struct Placed {
    map: SphereMap,
    primitive: PolygonMesh,
    held: Held,
    report: Option<sphere::Report>,
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

/// The triangles of a mesh that was reduced outside, or why they cannot stand for the part.
fn usable(
    reduced: &PolygonMesh,
    (full, axis): (&TriangleMesh, Option<usize>),
) -> Result<TriangleMesh, String> {
    let faces: Option<Vec<[VertexId; 3]>> =
        reduced.faces().map(|face| face.try_into().ok()).collect();
    let faces = faces.ok_or("it has faces that are not triangles")?;
    let mesh = TriangleMesh::new(reduced.positions().to_vec(), faces).map_err(|e| e.to_string())?;
    if !mesh.is_closed() {
        return Err("it is not closed".to_owned());
    }
    let n_parts = mesh.face_components().1;
    if n_parts != 1 {
        return Err(format!("it has {n_parts} parts"));
    }
    let [found, wanted] = [mesh.euler_number(), full.euler_number()];
    if found != wanted {
        return Err(format!("its Euler number is {found}, not {wanted}"));
    }
    match axis {
        Some(axis) => mirror::doubled(&mesh, axis),
        None => Ok(mesh),
    }
}
