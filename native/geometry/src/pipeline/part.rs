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
use super::paired::{Instead, Laid, paired};
use super::report::{Mirrored, PartReport, Reduced};
use super::settings::{Kind, Primitive, Settings};
use super::{Error, ways};
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
    /// The area of the part, the weight of its figures.
    pub area: f64,
    pub report: PartReport,
}

/// What faces are made on: the target, its marked edges, the density asked for there, and the axis
/// across the plane of symmetry.
type Ground<'a> = (
    &'a deform::Target,
    &'a HalfedgeMap<bool>,
    Option<&'a VertexMap<f64>>,
    Option<usize>,
);

struct Reduction {
    mesh: TriangleMesh,
    reduced: Option<Reduced>,
    report: Option<decimate::Report>,
}

impl PartJob<'_> {
    pub fn run(self, clock: &mut Clock, progress: &Progress<'_>) -> Result<PartResult, Error> {
        let Self { part, wanted } = self;
        let (n_input_faces, area) = (part.n_faces(), measure::total_area(&part));
        let (marked, density) = (wanted.marks.on(&part), wanted.density.on(&part));
        let Faced {
            mesh: part,
            marked,
            density,
            axis,
            refused,
        } = face((part, marked, density), wanted.mirror);
        let stage = progress.part("decimate", 0.0, 0.2);
        let reduction = clock.step("decimate", || wanted.reduce((&part, axis), &stage))?;
        let stage = progress.part("embed", 0.2, 0.5);
        let (hierarchy, embedded) = clock.step("embed", || {
            let hierarchy = collapse(reduction.mesh, &stage)?;
            let embedded = embed_hierarchy(&hierarchy, wanted.predictor, &stage)?;
            Ok::<_, Error>((hierarchy, embedded))
        })?;
        let embedding = embedded.report;
        let target = clock.step("deform", || wanted.target((part, &marked), progress))?;
        let stage = progress.part("", 0.5, 1.0);
        let start = (&hierarchy, embedded.map);
        let ground = (&target, &marked, density.as_ref(), axis);
        let made = wanted.make(start, ground, clock, &stage)?;
        let report = PartReport {
            n_input_faces,
            n_asked_faces: wanted.n_faces,
            n_faces: made.deformed.mesh.n_faces(),
            reduced: reduction.reduced,
            decimate: reduction.report,
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
        (target, marked, density, axis): Ground<'_>,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Made, Error> {
        let start = (hierarchy, map);
        if self.settings.primitive() != Primitive::Flow {
            let laid = self.fixed(start, target, clock, progress)?;
            return Ok(self.made((laid, None), axis));
        }
        let wanted = Asked {
            n_quads: self.n_faces,
            settings: self.settings,
            density,
            marked,
            axis,
        };
        let part = progress.part("", 0.0, 0.9);
        match ways::flow_part(&start.1, target, wanted, clock, &part)? {
            Ok(part) => Ok(Made::flowing(part)),
            Err(reason) => {
                let part = progress.part("", 0.9, 1.0);
                let (laid, instead) = self.last_resort(start, target, clock, &part)?;
                Ok(self.made((laid, Some(Flowed::Refused { reason, instead })), axis))
            }
        }
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
        target: &deform::Target,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<(Laid, Instead), Error> {
        let part = progress.part("", 0.0, 0.6);
        let pairs = paired(self, (&start.1, target), clock, &part)?;
        if let Ok(pairs) = pairs {
            if pairs.n_inverted() == 0 {
                return Ok((pairs, Instead::PairedTriangles));
            }
            return match self.fixed(start, target, clock, &progress.part("", 0.6, 1.0)) {
                Ok(sphere) => Ok(pairs.or_sphere(sphere)),
                Err(error) if error.is_cancelled() => Err(error),
                Err(_) => Ok((pairs, Instead::PairedTriangles)),
            };
        }
        let sphere = self.fixed(start, target, clock, &progress.part("", 0.6, 1.0))?;
        Ok((sphere, Instead::QuadSphere))
    }

    /// The faces of a primitive that is the same for all shapes, or adapts to them.
    fn fixed(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        target: &deform::Target,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Laid, Error> {
        let stage = progress.part("sphere", 0.0, 0.5);
        let placed = clock.step("sphere", || self.place(hierarchy, map, &stage))?;
        let stage = progress.part("deform", 0.5, 1.0);
        let (map, primitive) = (&placed.map, &placed.primitive);
        let deform =
            || deform::deform(map, primitive, target, &deform::Settings::default(), &stage);
        let deformed = clock.step("deform", deform)?;
        Ok(Laid::new(deformed, placed.report, target))
    }

    /// The part with the edges that the result is to have too.
    fn target(
        &self,
        (part, marked): (TriangleMesh, &HalfedgeMap<bool>),
        progress: &Progress<'_>,
    ) -> Result<deform::Target, Cancelled> {
        progress.check()?;
        let sharp = measure::sharp_edges(&part, self.settings.sharp_angle.to_radians());
        let either = sharp.iter().zip(marked.iter()).map(|(a, b)| a | b);
        deform::Target::with_features(part, &either.collect(), progress)
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
                reduced,
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&start, &settings, progress)?;
        Ok(Reduction {
            mesh: simplified.mesh,
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

    /// Makes the primitive and chooses its map: adaptive triangles lie where the surface needs them
    /// on any map; a fixed primitive is even on the sphere and needs a map that keeps areas.
    fn place(
        &self,
        hierarchy: &CollapseHierarchy,
        map: SphereMap,
        progress: &Progress<'_>,
    ) -> Result<Placed, Error> {
        let seed = self.settings.seed;
        let fixed = match self.settings.primitive() {
            Primitive::Adaptive => {
                let n_faces = self.n_faces;
                let settings = sphere::Settings {
                    n_faces,
                    seed,
                    ..sphere::Settings::default()
                };
                let Adaptive { primitive, report } = sphere::adaptive(&map, &settings, progress)?;
                return Ok(Placed {
                    map,
                    primitive,
                    report: Some(report),
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
            report: None,
        })
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
