//! Parts that are coarser than what is asked for, in quads that can stay: these are cut into finer ones.
//!
//! A crate, a cornice, a coarse model of a body have a modeller's quads already. Cut into rows strip by
//! strip they keep every edge, border and handle where it is, and all loops; a flow would look for them
//! anew. Triangles are paired first, so that it does not matter how quads were cut for a file.

mod places;

use glam::DVec3;

use super::Error;
use super::clock::Clock;
use super::flowed::Flowed;
use super::frame::Prepared;
use super::mapless::Came;
use super::marks::Marks;
use super::mirror::Role;
use super::open::Whole;
use super::part::{PartResult, Wanted, embed_mesh};
use super::report::Mirrored;
use super::rods::{crosses, images};
use super::settings::{Kind, Primitive, Settings};
use super::uncut::edges;
use crate::deform::Deformed;
use crate::elementary::ln;
use crate::measure::PolygonEdges;
use crate::mesh::{HalfedgeId, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::pair::{self, Cut, Layout, squareness};
use crate::progress::Progress;
use places::{places, sphere};

/// The share that the count may be off, and of few quads one in so many, but no more than a few: a cube
/// has 6 n².
const MOST_OFF: f64 = 0.05;
const QUADS_PER_OFF: usize = 8;
const FEW_OFF: usize = 4;
/// Vertices where other than four quads meet: so many, and one in so many of the quads asked for.
const FEW_IRREGULAR: usize = 8;
const QUADS_PER_IRREGULAR: usize = 20;
/// No vertex has more quads.
const MOST_VALENCE: usize = 6;
/// The sine of the worst corner of every quad, and the mean over the area.
const LEAST_SQUARE: f64 = 0.08;
const MEAN_SQUARE: f64 = 0.75;
/// How much longer or shorter edges are than wanted: the mean of the logarithm over the area, and where
/// sharp edges lie close together, which a flow could not follow.
const MOST_UNEVEN: f64 = 0.7;
const MOST_UNEVEN_OF_SHARP: f64 = 1.2;
/// And where edges of one length are asked for.
const MOST_UNEVEN_OF_EVEN: f64 = 0.15;

/// The sides of polygons of four corners and more, of a mesh that has no more triangles than its quads
/// may have; those of others are not asked for.
pub fn sides(prepared: &Prepared, input: &PolygonMesh, settings: &Settings) -> Marks {
    let mesh = &prepared.mesh;
    if !is_coarse(mesh, settings.faces) {
        return Marks::default();
    }
    let corners = |h: HalfedgeId| input.face(prepared.input_face(h.face())).len();
    let is_side = |h: &HalfedgeId| {
        let twin = mesh.twin(*h);
        let is_inside =
            |twin| prepared.input_face(h.face()) == prepared.input_face(HalfedgeId::face(twin));
        corners(*h) > 3 && !twin.is_some_and(is_inside)
    };
    let sides = mesh.halfedge_ids().filter(is_side);
    Marks::at(sides.map(|h| [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v))))
}

/// Whether triangles in pairs are no more than asked for, within the share that counts may be off.
fn is_coarse(mesh: &TriangleMesh, n_asked: usize) -> bool {
    mesh.n_faces() as f64 <= 2.0 * (1.0 + MOST_OFF) * n_asked as f64
}

/// So many faces are about as many as asked for.
fn most_faces(n_asked: usize) -> usize {
    let few = FEW_OFF.min(n_asked / QUADS_PER_OFF);
    n_asked + few.max((MOST_OFF * n_asked as f64) as usize)
}

impl Wanted<'_> {
    /// The part's own quads cut into as many as are asked for; none where they are too many, or no
    /// good ones come of it.
    ///
    /// # Errors
    /// When cancelled.
    pub fn own_quads(
        &self,
        (whole, came): (&Whole, Came),
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Option<PartResult>, Error> {
        let mesh = &whole.mesh;
        let is_wanted = self.settings.own_quads
            && self.settings.kind == Kind::Quads
            && self.settings.primitive() == Primitive::Flow
            && is_coarse(mesh, self.n_faces)
            && self.strokes.is_empty()
            && self.density.on(mesh).is_none();
        if !is_wanted {
            return Ok(None);
        }
        let part = progress.part("pair", 0.0, 0.3);
        let Some(own) = clock.step("pair", || self.paired(whole, &part))? else {
            return Ok(None);
        };
        let Some(fine) = clock.step("pair", || self.fine(&own)) else {
            return Ok(None);
        };
        let part = progress.part("embed", 0.3, 0.9);
        let closed = if whole.is_open() {
            None
        } else {
            let embedded = clock.step("embed", || embed_mesh(mesh.clone(), self.predictor, &part));
            Some(embedded?)
        };
        let places = places(mesh, (&own.quads, &fine.cut));
        let sphere = sphere(closed.as_ref(), &fine.cut.mesh, &places, &part);
        let Some(sphere) = sphere? else {
            return Ok(None);
        };
        let along = fine.cut.along(&own.kept);
        let quads = fine.cut.mesh;
        let quads = quads.with_positions(places.iter().map(|place| place.position).collect());
        let deformed = Deformed::in_space(quads, sphere, along, progress)?;
        let n_strips = fine.n_strips;
        let mut made = self.without_map((whole, came), deformed, Some(Flowed::Own { n_strips }));
        let n_crosses = self.settings.n_crosses * self.n_faces;
        made.crosses = crosses(&made.mesh, n_crosses.div_ceil(self.settings.faces));
        if let Some(embedded) = closed {
            made.report.embedding = embedded.report;
        }
        if let (true, Some(plane)) = (own.images.is_some(), self.mirror.1) {
            made.report.mirrored = Some(Mirrored::Used);
            made = made.exact(plane.axis);
        }
        Ok(Some(made))
    }

    /// The part's triangles as quads, if all of them are, none of them across a line that stays, and
    /// they are their own image where they shall be.
    fn paired(&self, whole: &Whole, progress: &Progress<'_>) -> Result<Option<Own>, Error> {
        let mesh = &whole.mesh;
        let mut stay = self.kept(whole, mesh);
        let kept = edges(mesh, &stay);
        let sides = self.sides.on(mesh);
        for (stays, is_side) in stay.as_mut_slice().iter_mut().zip(&sides) {
            *stays |= is_side;
        }
        let pairs = pair::pair_open(mesh, &stay, progress)?;
        let has = |edge: &[VertexId; 2]| pairs.kept.binary_search(edge).is_ok();
        let is_all = pairs.quads.positions() == mesh.positions()
            && pairs.quads.n_quads() == pairs.quads.n_faces()
            && kept.iter().all(has);
        if !is_all {
            return Ok(None);
        }
        let images = match self.mirror {
            (Role::Whole, Some(plane)) if plane.was_symmetric => images(&pairs.quads, plane.axis),
            _ => None,
        };
        if matches!(self.mirror.0, Role::Whole) && images.is_none() {
            return Ok(None);
        }
        let own = Own {
            is_border: PolygonEdges::new(&pairs.quads, progress)?
                .border_vertices(mesh.n_vertices()),
            quads: pairs.quads,
            kept,
            images,
        };
        Ok(self.is_regular(&own).then_some(own))
    }

    /// Whether few vertices have other than four quads, and none many.
    fn is_regular(&self, own: &Own) -> bool {
        let mut valences = vec![0; own.quads.n_vertices()];
        for v in own.quads.corners() {
            valences[v.index()] += 1;
        }
        let each = || valences.iter().zip(&own.is_border);
        let most = |&is_border: &bool| {
            if is_border {
                MOST_VALENCE / 2
            } else {
                MOST_VALENCE
            }
        };
        // On a border a corner has one quad, a turn inwards three.
        let is_usual = |(&n, &is_border): (&usize, &bool)| if is_border { n <= 3 } else { n == 4 };
        let n_irregular = each().filter(|&pair| !is_usual(pair)).count();
        each().all(|(&n, is_border)| n <= most(is_border))
            && n_irregular <= FEW_IRREGULAR + self.n_faces / QUADS_PER_IRREGULAR
    }

    /// The quads cut into finer ones, if these have the count and a good shape.
    fn fine(&self, own: &Own) -> Option<Fine> {
        let layout = Layout::of(&own.quads, own.images.as_deref())?;
        let counts = layout.counts(self.n_faces);
        let n_quads = layout.n_quads(&counts);
        if n_quads > most_faces(self.n_faces) || self.n_faces > most_faces(n_quads) {
            return None;
        }
        let cut = layout.cut(&counts);
        let most_uneven = if self.settings.style.evenness() > 0.0 {
            MOST_UNEVEN_OF_EVEN
        } else if own.kept.is_empty() {
            MOST_UNEVEN
        } else {
            MOST_UNEVEN_OF_SHARP
        };
        is_good(&cut.mesh, most_uneven).then(|| Fine {
            n_strips: layout.n_strips(),
            cut,
        })
    }
}

/// A part's triangles as quads.
struct Own {
    quads: PolygonMesh,
    /// Their edges along sharp and marked ones.
    kept: Vec<[VertexId; 2]>,
    is_border: Vec<bool>,
    /// The image of each vertex, where they are to be their own image.
    images: Option<Vec<VertexId>>,
}

/// The same cut into finer ones.
struct Fine {
    cut: Cut,
    n_strips: usize,
}

/// Whether quads have square corners and edges of about one length.
fn is_good(quads: &PolygonMesh, most_uneven: f64) -> bool {
    let corners = |face: &[VertexId]| [0, 1, 2, 3].map(|i| quads.position(face[i]));
    let area = |p: &[DVec3; 4]| (p[2] - p[0]).cross(p[3] - p[1]).length() / 2.0;
    let each = || quads.faces().map(corners);
    let whole: f64 = each().map(|p| area(&p)).sum();
    let edge = (whole / quads.n_faces() as f64).sqrt();
    let [mut square, mut uneven] = [0.0, 0.0];
    for p in each() {
        let worst = squareness(p);
        if worst < LEAST_SQUARE {
            return false;
        }
        let longer = |i: usize| ln(p[i].distance(p[(i + 1) % 4]) / edge).abs();
        square += area(&p) * worst;
        uneven += area(&p) * (0..4).map(longer).sum::<f64>() / 4.0;
    }
    square >= MEAN_SQUARE * whole && uneven <= most_uneven * whole
}

#[cfg(test)]
mod tests;
