//! Parts with borders and handles: closed before anything else, reopened once quads lie on them.
//!
//! ```text
//! part ─ cut ─▶ genus 0 ─ close ─▶ closed, faces real or virtual ─ flow, borders firm ─▶ quads ─ reopen ─▶ real quads ─ weld twins
//! ```
//!
//! The map is made of the part reduced while it is open, which keeps borders, and closed then.

mod reopen;

use glam::DVec3;

use super::borders::Opened;
use super::even::Marked;
use super::part::embed_mesh;
use super::{Error, Settings};
use crate::close::{self, Closed};
use crate::decimate;
use crate::deform::{Held, Target};
use crate::embed::Solver;
use crate::groups::Groups;
use crate::measure::{FeatureLine, feature_lines};
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId};
use crate::mirror::{Doubled, double_sheet};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;

/// Places nearer to each other than this share of the diagonal are one.
const SAME: f64 = 1e-5;
/// The middle of an edge along a border is no farther from it than this share of the edge.
const BEND: f64 = 0.5;

/// A part that was closed.
pub struct Closing {
    /// The part, open.
    open: TriangleMesh,
    closed: Closed,
    settings: close::Settings,
}

/// A part reduced to the size of the map and closed.
pub struct Small {
    pub mesh: TriangleMesh,
    /// Its edges between real and virtual faces, on both sides of each.
    pub border: HalfedgeMap<bool>,
    pub report: Option<decimate::Report>,
}

impl Closing {
    /// Closes a part; none if it is closed and without handles.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        part: &TriangleMesh,
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<Option<Self>, Error> {
        if part.is_closed() {
            return Ok(None);
        }
        let settings = settings.close();
        let closed = close::close(part, &settings, progress)?;
        Ok(Some(Self {
            open: part.clone(),
            closed,
            settings,
        }))
    }

    /// What is told of it.
    pub fn told(&self) -> Opened {
        Opened::of(&self.closed)
    }

    /// Whether all its borders were filled for good: then nothing is opened again.
    pub fn is_filled(&self) -> bool {
        self.closed.n_capped + self.closed.n_doubled == 0
    }

    /// The triangles that fill borders for good.
    pub fn filling(&self) -> Vec<[DVec3; 3]> {
        let Closed { mesh, is_real, .. } = &self.closed;
        let more = mesh.face_ids().skip(self.open.n_faces());
        let filling = more.filter(|&face| is_real[face] && self.closed.n_filled > 0);
        filling.map(|face| mesh.triangle(face)).collect()
    }

    /// The part, closed; all of it.
    pub fn into_mesh(self) -> TriangleMesh {
        self.closed.mesh
    }

    /// What of the closed part is real: the part itself and what fills borders for good.
    pub fn real(&self) -> TriangleMesh {
        let closed = &self.closed;
        let faces = closed.mesh.face_ids().filter(|&f| closed.is_real[f]);
        let faces = faces.map(|f| closed.mesh.face(f));
        let real = TriangleMesh::of_faces(closed.mesh.positions(), faces);
        real.expect("the real faces of a closed part are a mesh").0
    }

    /// The part, closed.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.closed.mesh
    }

    /// The part reduced to a number of faces, if it has more, and closed.
    ///
    /// # Errors
    /// As above.
    pub fn reduced(&self, n_faces: usize, progress: &Progress<'_>) -> Result<Small, Error> {
        let share = self.closed.mesh.n_faces() as f64 / self.open.n_faces() as f64;
        let n_faces = (n_faces as f64 / share) as usize;
        if self.open.n_faces() <= n_faces {
            return Ok(Small {
                mesh: self.closed.mesh.clone(),
                border: self.closed.border(),
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&self.open, &settings, progress)?;
        // Both have to be closed the same way.
        let way = match self.closed.n_doubled {
            0 => close::Way::Cap,
            _ => close::Way::Double,
        };
        let settings = close::Settings {
            way,
            ..self.settings.clone()
        };
        let closed = close::close(&simplified.mesh, &settings, progress)?;
        Ok(Small {
            border: closed.border(),
            mesh: closed.mesh,
            report: Some(simplified.report),
        })
    }

    /// The edges of the closed part between real and virtual faces, on both sides of each.
    pub fn border(&self) -> HalfedgeMap<bool> {
        self.closed.border()
    }

    /// What the quads have to keep to, and what of them is kept.
    ///
    /// # Errors
    /// When cancelled.
    pub fn opening(
        self,
        (map, border): (&SphereMap, HalfedgeMap<bool>),
        progress: &Progress<'_>,
    ) -> Result<Opening, Cancelled> {
        let on_border = self.closed.border();
        let edges = Marked::new(&self.closed.mesh, &on_border);
        let lines = feature_lines(&self.closed.mesh, &on_border);
        let folds = Marked::new(&self.closed.mesh, &folds(&self.closed));
        let bare = self.real();
        let is_real = self.closed.is_real;
        Ok(Opening {
            corners: corners(&self.closed.mesh, &lines),
            lines: feature_lines(map.mesh(), &border),
            small: border,
            edges,
            folds,
            is_real,
            bare: Target::new(bare, progress)?,
        })
    }
}

/// What of a closed part is real, and where its borders lie.
pub struct Opening {
    /// The borders on the map's mesh, as its edges and as lines.
    pub small: HalfedgeMap<bool>,
    pub lines: Vec<FeatureLine>,
    /// Where they lie on the target.
    pub edges: Marked,
    /// Where a sheet is glued to its other side; empty where there is no other side.
    folds: Marked,
    /// Their corners there.
    corners: Vec<DVec3>,
    /// Which faces of the target are real.
    is_real: FaceMap<bool>,
    /// The real part of the target alone.
    pub bare: Target,
}

impl Opening {
    /// Whether a side lies on another.
    pub fn is_sheet(&self) -> bool {
        !self.folds.is_empty()
    }

    /// An even surface made its own other side exactly, from the side that is real.
    ///
    /// # Errors
    /// When cancelled; the text of the inner error is why that cannot be.
    pub fn doubled(
        &self,
        (map, border): (&SphereMap, &HalfedgeMap<bool>),
        target: &Target,
        progress: &Progress<'_>,
    ) -> Result<Result<(SphereMap, Doubled), String>, Error> {
        let mesh = map.mesh();
        let folds = self.folds.tree(progress)?;
        let lies = |v| folds.closest(mesh.position(v)).distance_squared < SAME * SAME;
        let is_fold = |h| border[h] && lies(mesh.origin(h)) && lies(mesh.target(h));
        let mut groups = Groups::new(mesh.n_faces());
        for h in mesh.halfedge_ids() {
            if let Some(twin) = mesh.twin(h).filter(|_| !is_fold(h)) {
                groups.link(h.face().index(), twin.face().index());
            }
        }
        let (side, n_sides) = groups.numbered();
        if n_sides != 2 {
            return Ok(Err(format!(
                "the even surface has {n_sides} sides, not two"
            )));
        }
        let mut votes = [0.0; 2];
        for face in mesh.face_ids() {
            votes[side[face.index()] as usize] += self.vote(&mesh.triangle(face), target);
        }
        let front = u32::from(votes[1] > votes[0]);
        let own = mesh.face_ids().filter(|face| side[face.index()] == front);
        let own = own.map(|face| mesh.face(face));
        let (half, names) = match TriangleMesh::of_faces(mesh.positions(), own) {
            Ok(half) => half,
            Err(error) => return Ok(Err(error.to_string())),
        };
        let doubled = match double_sheet(&half, &names) {
            Ok(doubled) => doubled,
            Err(error) => return Ok(Err(error.to_string())),
        };
        let embedded = embed_mesh(doubled.mesh().clone(), &Solver::default(), progress)?;
        Ok(Ok((embedded.map, doubled)))
    }

    /// Holds the edges of a primitive that were made along borders, on the target's: corners of the
    /// map's mesh on its corners.
    ///
    /// # Errors
    /// Where an edge is missing; when cancelled.
    pub fn held(
        &self,
        map: &SphereMap,
        made: &Adaptive,
        progress: &Progress<'_>,
    ) -> Result<Held, Error> {
        if made.n_apart > 0 {
            let reason = format!("{} edges along its borders could not be made", made.n_apart);
            return Err(Error::Unopened { reason });
        }
        let border = self.edges.tree(progress)?;
        let corners = (!self.corners.is_empty()).then(|| Bvh::of_points(&self.corners));
        let ends: Vec<DVec3> = self::corners(map.mesh(), &self.lines);
        let own = Marked::new(map.mesh(), &self.small).tree(progress)?;
        let at = |v: VertexId| map.surface_position(map.locate(made.primitive.position(v)));
        // Of a solid's lines not all are borders.
        let lies = |p: DVec3, within: f64| own.closest(p).distance_squared <= within * within;
        let is_border = |[a, b]: &&[VertexId; 2]| {
            let [a, b] = [*a, *b].map(at);
            let bend = BEND * a.distance(b);
            lies(a, SAME) && lies(b, SAME) && lies(a.midpoint(b), bend)
        };
        let edges: Vec<[VertexId; 2]> = made.on_lines.iter().filter(is_border).copied().collect();
        let mut vertices: Vec<VertexId> = edges.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: VertexId| {
            let p = at(v);
            let is_end = ends.iter().any(|end| end.distance_squared(p) < SAME * SAME);
            match &corners {
                Some(corners) if is_end => corners.closest(p).position,
                _ => border.closest(p).position,
            }
        };
        Ok(Held {
            goals: vertices.into_iter().map(|v| (v, place(v))).collect(),
            edges,
        })
    }
}

/// The borders of a closed part across which it was doubled, on both sides of each edge: there most
/// faces have their own images beyond; not all, for some were split.
fn folds(closed: &Closed) -> HalfedgeMap<bool> {
    let (mesh, border) = (&closed.mesh, closed.border());
    let apex = |h: HalfedgeId| mesh.position(mesh.origin(h.prev()));
    let mut groups = Groups::new(mesh.n_vertices());
    for h in mesh.halfedge_ids().filter(|&h| border[h]) {
        groups.link(mesh.origin(h).index(), mesh.target(h).index());
    }
    let (group, n_groups) = groups.numbered();
    let of = |h: HalfedgeId| group[mesh.origin(h).index()] as usize;
    let mut votes = vec![0_i64; n_groups];
    for h in mesh.halfedge_ids().filter(|&h| border[h]) {
        let is_image = mesh.twin(h).is_some_and(|twin| apex(h) == apex(twin));
        votes[of(h)] += if is_image { 1 } else { -1 };
    }
    let is_fold = |h| border[h] && votes[of(h)] > 0;
    mesh.halfedge_ids().map(is_fold).collect()
}

/// Where lines that do not go round begin and end.
fn corners(mesh: &TriangleMesh, lines: &[FeatureLine]) -> Vec<DVec3> {
    let open = lines.iter().filter(|line| !line.is_closed());
    let ends = open.flat_map(|line| [line.vertices[0], line.vertices[line.vertices.len() - 1]]);
    ends.map(|v| mesh.position(v)).collect()
}
