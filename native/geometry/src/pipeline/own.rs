//! Parts in quads that can stay: these are cut into finer ones, or strips of them are taken out.
//!
//! A crate, a cornice, a model of a body have a modeller's quads already. Cut into rows strip by strip
//! they keep every edge, border and handle where it is, and all loops; without some strips they keep the
//! other loops. A flow would look for them anew. Triangles are paired first, so that it does not matter
//! how quads were cut for a file.

mod judge;
mod places;

use super::Error;
use super::clock::Clock;
use super::flowed::Flowed;
use super::frame::Prepared;
use super::mapless::Came;
use super::marks::Marks;
use super::mirror::Role;
use super::open::Whole;
use super::part::{PartResult, Wanted, embed_mesh};
use super::probe::farthest;
use super::report::Mirrored;
use super::rods::{crosses, images};
use super::settings::{Kind, Primitive, Settings};
use super::uncut::edges;
use crate::chords;
use crate::deform::{Deformed, Target};
use crate::measure::PolygonEdges;
use crate::mesh::{HalfedgeId, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::pair::{self, Cut, Layout};
use crate::progress::Progress;
pub use judge::n_quads;
use places::sphere;

/// The share that the count may be off, and of few quads one in so many, but no more than a few: a cube
/// has 6 n².
const MOST_OFF: f64 = 0.05;
const QUADS_PER_OFF: usize = 8;
const FEW_OFF: usize = 4;
/// And one in so many of quads that came in, where no more than that are asked for: strips are large.
const NEAR_PER_OFF: usize = 8;
/// Of quads so many times as many as asked for strips are taken out.
const MOST_FINER: usize = 3;
/// How far the part may be from quads of which strips were taken out, in their edges.
const FARTHEST: f64 = 0.75;
/// One in so many sharp edges may lie inside of a quad where a part came in quads, nearly all of it.
const KEPT_PER_LOST: usize = 16;

/// The sides of polygons of four corners and more; none of a mesh that is finer than quads may be of
/// which strips are taken out.
pub fn sides(prepared: &Prepared, input: &PolygonMesh, settings: &Settings) -> Marks {
    let mesh = &prepared.mesh;
    if !are_wanted(settings) || mesh.n_faces() > 2 * MOST_FINER * settings.faces {
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

/// Whether parts may keep their own quads.
pub fn are_wanted(settings: &Settings) -> bool {
    let is_flow = settings.kind == Kind::Quads && settings.primitive() == Primitive::Flow;
    settings.own_quads && is_flow
}

/// Whether triangles in pairs are no more than asked for, within the share that counts may be off.
fn is_coarse(mesh: &TriangleMesh, n_asked: usize) -> bool {
    mesh.n_faces() as f64 <= 2.0 * (1.0 + MOST_OFF) * n_asked as f64
}

/// Whether two counts are about the same.
fn is_about(n: usize, other: usize) -> bool {
    n <= most_faces(other) && other <= most_faces(n)
}

/// So many faces are about as many as asked for.
fn most_faces(n_asked: usize) -> usize {
    let few = FEW_OFF.min(n_asked / QUADS_PER_OFF);
    n_asked + few.max((MOST_OFF * n_asked as f64) as usize)
}

impl Wanted<'_> {
    /// The part's own quads, cut into as many as are asked for or without some strips; none where no
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
        let is_wanted = are_wanted(self.settings)
            && self.may_be_own(mesh)
            && self.strokes.is_empty()
            && self.density.on(mesh).is_none();
        if !is_wanted {
            return Ok(None);
        }
        let part = progress.part("pair", 0.0, 0.3);
        let Some(own) = clock.step("pair", || self.own(whole, &part))? else {
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
        let places = own.places(mesh, &fine.cut);
        let sphere = sphere(closed.as_ref(), &fine.cut.mesh, &places, &part);
        let Some(sphere) = sphere? else {
            return Ok(None);
        };
        let along = fine.cut.along(&own.kept);
        let quads = fine.cut.mesh;
        let quads = quads.with_positions(places.iter().map(|place| place.position).collect());
        if own.fewer.is_some() && !stands(&quads, mesh, progress)? {
            return Ok(None);
        }
        let deformed = Deformed::in_space(quads, sphere, along, progress)?;
        let flowed = Flowed::Own {
            n_strips: fine.n_strips,
            n_taken: own.n_taken(),
        };
        let mut made = self.without_map((whole, came), deformed, Some(flowed));
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

    /// Whether there are few enough triangles: twice as many as quads are asked for, more of those that
    /// came in quads, of which strips can be taken out.
    fn may_be_own(&self, mesh: &TriangleMesh) -> bool {
        let most = 2 * MOST_FINER * self.n_faces;
        is_coarse(mesh, self.n_faces)
            || mesh.n_faces() <= most && judge::n_quads(mesh, self.sides).is_some()
    }

    /// The part's own quads, or fewer, if they are good.
    fn own(&self, whole: &Whole, progress: &Progress<'_>) -> Result<Option<Own>, Error> {
        let Some(own) = self.paired(whole, &progress.part("", 0.0, 0.5))? else {
            return Ok(None);
        };
        if !own.is_regular(self.n_faces) {
            return Ok(None);
        }
        if own.quads.n_faces() <= most_faces(self.n_faces) {
            return Ok(Some(own));
        }
        if !own.came_in_quads {
            return Ok(None);
        }
        let is_grid = || pair::Grid::of(&own.quads, &own.kept).is_some();
        if self.may_be_grid(whole) && is_grid() {
            return Ok(None);
        }
        own.fewer(self.n_faces, &progress.part("", 0.5, 1.0))
    }

    /// The part's triangles as quads, if all of them are, none of them across a line that stays, and
    /// they are their own image where they shall be.
    fn paired(&self, whole: &Whole, progress: &Progress<'_>) -> Result<Option<Own>, Error> {
        let mesh = &whole.mesh;
        let is_side = self.sides.on(mesh);
        let mut stay = self.kept(whole, mesh);
        judge::without_diagonals(mesh, &is_side, &mut stay);
        let kept = edges(mesh, &stay);
        for (stays, is_side) in stay.as_mut_slice().iter_mut().zip(&is_side) {
            *stays |= is_side;
        }
        let pairs = pair::pair_open(mesh, &stay, progress)?;
        let has = |edge: &[VertexId; 2]| pairs.kept.binary_search(edge).is_ok();
        let came_in_quads = judge::are_quads(mesh, &is_side);
        let (kept, lost): (Vec<_>, Vec<_>) = kept.into_iter().partition(has);
        let most_lost = usize::from(came_in_quads) * kept.len() / KEPT_PER_LOST;
        let is_all = pairs.quads.positions() == mesh.positions()
            && pairs.quads.n_quads() == pairs.quads.n_faces()
            && lost.len() <= most_lost;
        if !is_all {
            return Ok(None);
        }
        let came_in_quads = came_in_quads && !judge::has_new_poles((mesh, &pairs.quads), &is_side);
        let images = match self.mirror {
            (Role::Whole, Some(plane)) if plane.was_symmetric => images(&pairs.quads, plane.axis),
            _ => None,
        };
        if matches!(self.mirror.0, Role::Whole) && images.is_none() {
            return Ok(None);
        }
        Ok(Some(Own {
            is_border: PolygonEdges::new(&pairs.quads, progress)?
                .border_vertices(mesh.n_vertices()),
            came_in_quads,
            quads: pairs.quads,
            kept,
            images,
            fewer: None,
        }))
    }

    /// The quads cut into finer ones, if these have the count and a good shape.
    fn fine(&self, own: &Own) -> Option<Fine> {
        let layout = Layout::of(&own.quads, own.images.as_deref())?;
        let as_they_are = vec![1; layout.n_strips()];
        let are_right = is_about(own.quads.n_faces(), self.n_faces);
        let counts = if own.is_near(self.n_faces) && are_right {
            as_they_are
        } else {
            layout.counts(self.n_faces)
        };
        let n_quads = layout.n_quads(&counts);
        let most = |n| {
            let near = own.is_near(self.n_faces).then_some(n + n / NEAR_PER_OFF);
            most_faces(n).max(near.unwrap_or(0))
        };
        if n_quads > most(self.n_faces) || self.n_faces > most(n_quads) {
            return None;
        }
        let cut = layout.cut(&counts);
        let asked = (self.settings, self.n_faces);
        own.is_good(&cut.mesh, asked).then(|| Fine {
            n_strips: layout.n_strips(),
            cut,
        })
    }
}

/// A part's triangles as quads, or fewer of them.
struct Own {
    quads: PolygonMesh,
    /// Their edges along sharp and marked ones.
    kept: Vec<[VertexId; 2]>,
    is_border: Vec<bool>,
    /// Whether the part came in quads, nearly all of it.
    came_in_quads: bool,
    /// The image of each vertex, where they are to be their own image.
    images: Option<Vec<VertexId>>,
    /// What the part's own quads were, where strips of them were taken out.
    fewer: Option<Before>,
}

/// The part's own quads, of which strips were taken out.
struct Before {
    n_quads: usize,
    /// Their edges along sharp and marked ones.
    kept: Vec<[VertexId; 2]>,
    /// The vertices that became each of those that are left.
    members: Vec<Vec<VertexId>>,
}

impl Own {
    /// Quads without some strips, about as many as asked for; none where they have no good ones left.
    fn fewer(self, n_asked: usize, progress: &Progress<'_>) -> Result<Option<Self>, Error> {
        let most = most_faces(n_asked);
        let counts = n_asked.saturating_sub(most - n_asked)..=most;
        let rules = chords::Rules {
            lines: &self.kept,
            images: self.images.as_deref(),
        };
        let Some(fewer) = chords::fewer(&self.quads, rules, counts, progress)? else {
            return Ok(None);
        };
        let n = fewer.quads.n_vertices();
        let mut members = vec![Vec::new(); n];
        for (v, new) in fewer.vertex_of.iter().enumerate() {
            members[new.index()].push(VertexId::from_index(v));
        }
        Ok(Some(Self {
            is_border: PolygonEdges::new(&fewer.quads, progress)?.border_vertices(n),
            quads: fewer.quads,
            kept: fewer.lines,
            came_in_quads: self.came_in_quads,
            images: fewer.images,
            fewer: Some(Before {
                n_quads: self.quads.n_faces(),
                kept: self.kept,
                members,
            }),
        }))
    }

    /// How many of the part's own quads were taken out.
    fn n_taken(&self) -> usize {
        let before = self.fewer.as_ref().map(|before| before.n_quads);
        before.map_or(0, |n| n - self.quads.n_faces())
    }
}

/// Whether no point of the part is far from quads.
fn stands(
    quads: &PolygonMesh,
    mesh: &TriangleMesh,
    progress: &Progress<'_>,
) -> Result<bool, Error> {
    let target = Target::new(mesh.clone(), progress)?;
    Ok(farthest(quads, &target) <= FARTHEST)
}

/// The same cut into finer ones.
struct Fine {
    cut: Cut,
    n_strips: usize,
}

#[cfg(test)]
mod tests;
