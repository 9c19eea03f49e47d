//! Parts with borders and handles: closed before anything else, reopened once quads lie on them.
//!
//! ```text
//! part ─ cut ─▶ genus 0 ─ close ─▶ closed, faces real or virtual ─ flow, borders firm ─▶ quads ─ reopen ─▶ real quads ─ weld twins
//! ```
//!
//! The map is made of the part reduced while it is open, which keeps borders, and closed then.

mod filling;
mod hold;
mod loops;
mod puncture;
mod reopen;
mod weld;

use std::f64::consts::TAU;

use glam::DVec3;

use super::borders::Opened;
use super::even::Marked;
use super::part::embed_mesh;
use super::{Error, Settings};
use crate::close::handles;
use crate::close::{self, Closed};
use crate::decimate;
use crate::deform::{Held, Target};
use crate::embed::Solver;
use crate::flow::FirmEdges;
use crate::groups::Groups;
use crate::measure::{FeatureLine, Polyline, Topology, topology_of_triangles, total_area};
use crate::mesh::{FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap};
use crate::mirror::{Doubled, double_sheet};
use crate::progress::{Cancelled, Progress};
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;
use loops::Loops;
use puncture::Puncture;

/// Places nearer to each other than this share of the diagonal are one.
const SAME: f64 = 1e-5;
/// The middle of an edge along a border is no farther from it than this share of the edge.
const BEND: f64 = 0.5;

/// A part that was closed.
pub struct Closing {
    /// The part, open and without handles.
    open: TriangleMesh,
    closed: Closed,
    /// Where handles were cut.
    cuts: Vec<Polyline>,
    /// The borders that are made once there are quads, for they are shorter than a few of them.
    punctures: Vec<Puncture>,
    /// The shape that is to come out.
    wanted: Topology,
    /// What is told of its borders.
    told: Option<Opened>,
    /// Those up to this length are filled for good.
    asked: f64,
}

/// A part reduced to the size of the map and closed.
pub struct Small {
    pub mesh: TriangleMesh,
    /// Its edges between real and virtual faces, on both sides of each.
    pub border: HalfedgeMap<bool>,
    /// The same as loops.
    loops: Loops,
    /// Which of its vertices are inside caps.
    is_in_cap: VertexMap<bool>,
    pub report: Option<decimate::Report>,
}

impl Closing {
    /// Cuts the handles of a part that is to get so many faces, and closes its borders; none if it
    /// has neither.
    ///
    /// # Errors
    /// A part that cannot be closed; when cancelled.
    pub fn new(
        part: &TriangleMesh,
        (settings, n_faces): (&Settings, usize),
        progress: &Progress<'_>,
    ) -> Result<Option<Self>, Error> {
        let mut wanted = topology_of_triangles(part);
        if wanted.closed && wanted.genus == Some(0) {
            return Ok(None);
        }
        let cut = handles::cut(part, progress)?;
        let loops = Loops::new(
            &cut.mesh,
            &HalfedgeMap::filled(3 * cut.mesh.n_faces(), true),
        );
        let area = total_area(part);
        let edge = (area / n_faces.max(1) as f64).sqrt();
        let twins = cut.twins.iter().map(|[one, _]| length(&cut.mesh, one));
        let shortest_cut = twins.fold(f64::INFINITY, f64::min);
        let asked = settings.close().fill;
        let fill = Filled {
            asked: match asked {
                close::Fill::None => 0.0,
                close::Fill::UpTo(longest) => longest,
                close::Fill::All => f64::INFINITY,
            },
            puncture: (puncture::LONGEST * edge).min((puncture::LARGEST * area * TAU * 2.0).sqrt()),
            below: shortest_cut * (1.0 - SAME),
        };
        let lengths = loops.lengths(&cut.mesh);
        let n_filled = lengths
            .iter()
            .filter(|&&length| length <= fill.asked())
            .count();
        let n_filled = n_filled.min(wanted.n_borders);
        let n_borders = wanted.n_borders;
        wanted.n_borders -= n_filled;
        wanted.closed = wanted.n_borders == 0;
        let is_puncture = |length: &f64| *length > fill.asked() && *length <= fill.all();
        let punctures = loops.closed_lines(&cut.mesh).zip(&lengths);
        let punctures = punctures.filter(|(_, length)| is_puncture(length));
        let punctures = punctures
            .map(|(line, _)| Puncture::new(line, edge))
            .collect();
        let settings = close::Settings {
            fill: close::Fill::UpTo(fill.all()),
            ..close::Settings::default()
        };
        let closed = close::close(&cut.mesh, &settings, progress)?;
        let cuts = cut.twins.iter().map(|[one, _]| polyline(&cut.mesh, one));
        Ok(Some(Self {
            cuts: cuts.collect(),
            punctures,
            wanted,
            told: Opened::new([n_borders, n_filled], closed.n_doubled > 0),
            asked: fill.asked(),
            closed,
            open: cut.mesh,
        }))
    }

    /// What is told of it.
    pub fn told(&self) -> Option<Opened> {
        self.told
    }

    /// Whether all its borders were filled for good: then nothing is opened again.
    pub fn is_filled(&self) -> bool {
        let n_open = self.closed.n_capped + self.closed.n_doubled + self.punctures.len();
        n_open == 0
    }

    /// The part, closed; all of it.
    pub fn into_mesh(self) -> TriangleMesh {
        self.closed.mesh
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
            let border = self.closed.border();
            return Ok(Small {
                mesh: self.closed.mesh.clone(),
                loops: Loops::new(&self.open, &border),
                is_in_cap: in_caps(&self.open, &self.closed),
                border,
                report: None,
            });
        }
        let settings = decimate::Settings { n_faces };
        let simplified = decimate::simplify(&self.open, &settings, progress)?;
        let closed = close::close(&simplified.mesh, &self.alike(&simplified.mesh), progress)?;
        let border = closed.border();
        Ok(Small {
            loops: Loops::new(&simplified.mesh, &border),
            is_in_cap: in_caps(&simplified.mesh, &closed),
            border,
            mesh: closed.mesh,
            report: Some(simplified.report),
        })
    }

    /// How a coarser version is closed the same way: the shortest loops are filled, as many.
    fn alike(&self, coarse: &TriangleMesh) -> close::Settings {
        let all = HalfedgeMap::filled(3 * coarse.n_faces(), true);
        let mut lengths = Loops::new(coarse, &all).lengths(coarse);
        lengths.sort_by(f64::total_cmp);
        let fill = match self.closed.n_filled {
            0 => close::Fill::None,
            n if n >= lengths.len() => close::Fill::All,
            n => close::Fill::UpTo(f64::midpoint(lengths[n - 1], lengths[n])),
        };
        let way = match self.closed.n_doubled {
            0 => close::Way::Cap,
            _ => close::Way::Double,
        };
        close::Settings { fill, way }
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
        small: &Small,
        n_faces: usize,
        progress: &Progress<'_>,
    ) -> Result<Opening, Cancelled> {
        let on_border = self.closed.border();
        let edges = Marked::new(&self.closed.mesh, &on_border);
        let edge = (total_area(&self.closed.mesh) / n_faces.max(1) as f64).sqrt();
        // Where a handle was cut the surface goes on.
        let is_cut = |p: DVec3| self.cuts.iter().any(|cut| cut.distance(p) < SAME);
        let loops = Loops::new(&self.open, &on_border);
        let mut corners = loops.corners(&self.closed.mesh, edge);
        corners.retain(|&corner| !is_cut(corner));
        let between = small.loops.lines(&small.mesh, (&corners, edge));
        let place = |v: VertexId| small.mesh.position(v);
        let ends = between.iter().flat_map(|line| {
            let own = &line.line.vertices;
            let own = [own[0], own[own.len() - 1]].map(place);
            line.ends
                .map(|corners| [(own[0], corners[0]), (own[1], corners[1])])
        });
        let ends: Vec<(DVec3, DVec3)> = ends.flatten().collect();
        let folds = Marked::new(&self.closed.mesh, &folds(&self.closed));
        let bare = self.real();
        let is_real = self.closed.is_real;
        Ok(Opening {
            lines: between.into_iter().map(|line| line.line).collect(),
            ends,
            small: small.border.clone(),
            is_in_cap: small.is_in_cap.clone(),
            edges,
            folds,
            cuts: self.cuts,
            punctures: self.punctures,
            wanted: self.wanted,
            is_real,
            bare: Target::new(bare, progress)?,
        })
    }
}

/// What of a closed part is real, and where its borders lie.
pub struct Opening {
    /// The borders on the map's mesh, as its edges and as lines.
    pub small: HalfedgeMap<bool>,
    /// Which vertices of the map's mesh are inside caps, where singularities need room.
    pub is_in_cap: VertexMap<bool>,
    pub lines: Vec<FeatureLine>,
    /// Where they lie on the target.
    pub edges: Marked,
    /// Where a sheet is glued to its other side; empty where there is no other side.
    folds: Marked,
    /// Where handles were cut.
    cuts: Vec<Polyline>,
    punctures: Vec<Puncture>,
    /// The shape that is to come out.
    wanted: Topology,
    /// Where their corners are on the map's mesh, and where they belong.
    ends: Vec<(DVec3, DVec3)>,
    /// Which faces of the target are real.
    is_real: FaceMap<bool>,
    /// The real part of the target alone.
    pub bare: Target,
}

impl Opening {
    /// Whether what is virtual may lie on what is real or on itself: the other side of a sheet, the caps
    /// of a cut.
    pub fn overlaps(&self) -> bool {
        self.is_sheet() || !self.cuts.is_empty()
    }

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

    /// Some edges of a surface that was made along the borders, with the borders' corners.
    pub fn firm(&self, mesh: &TriangleMesh, is_on: HalfedgeMap<bool>) -> FirmEdges {
        let mut is_corner = VertexMap::filled(mesh.n_vertices(), false);
        for h in mesh.halfedge_ids().filter(|&h| is_on[h]) {
            let v = mesh.origin(h);
            let p = mesh.position(v);
            let mut ends = self.ends.iter();
            is_corner[v] = ends.any(|(_, corner)| corner.distance_squared(p) < SAME * SAME);
        }
        FirmEdges {
            twins: self.twins(mesh, &is_on),
            is_on,
            is_corner,
        }
    }

    /// The two loops of edges along each cut, where there are two.
    fn twins(&self, mesh: &TriangleMesh, is_on: &HalfedgeMap<bool>) -> Vec<[Vec<HalfedgeId>; 2]> {
        if self.cuts.is_empty() {
            return Vec::new();
        }
        let mut groups = Groups::new(mesh.n_vertices());
        let on = || mesh.halfedge_ids().filter(|&h| is_on[h]);
        for h in on() {
            groups.link(mesh.origin(h).index(), mesh.target(h).index());
        }
        let (group, n_groups) = groups.numbered();
        let mut loops = vec![Vec::new(); n_groups];
        for h in on() {
            loops[group[mesh.origin(h).index()] as usize].push(h);
        }
        let along = |cut: &Polyline| {
            let lies = |edges: &&Vec<HalfedgeId>| {
                let mut places = edges.iter().map(|&h| mesh.position(mesh.origin(h)));
                !edges.is_empty() && places.all(|p| cut.distance(p) < SAME)
            };
            loops.iter().filter(lies).cloned().collect::<Vec<_>>()
        };
        let twins = self.cuts.iter().map(along);
        twins.filter_map(|two| two.try_into().ok()).collect()
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
        if self.edges.is_empty() {
            return Ok(Held::default());
        }
        let border = self.edges.tree(progress)?;
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
            let mut ends = self.ends.iter();
            let end = ends.find(|(own, _)| own.distance_squared(p) < SAME * SAME);
            end.map_or_else(|| border.closest(p).position, |(_, corner)| *corner)
        };
        Ok(Held {
            goals: vertices.into_iter().map(|v| (v, place(v))).collect(),
            edges,
        })
    }
}

/// Which vertices of a closed mesh came with caps; none where a side lies on another.
fn in_caps(open: &TriangleMesh, closed: &Closed) -> VertexMap<bool> {
    let is_new = |v: VertexId| closed.n_doubled == 0 && v.index() >= open.n_vertices();
    closed.mesh.vertex_ids().map(is_new).collect()
}

/// Up to which length borders are closed before quads are made.
struct Filled {
    /// Those that stay closed.
    asked: f64,
    /// Those that are opened again.
    puncture: f64,
    /// But none as long as this: those of cuts are needed.
    below: f64,
}

impl Filled {
    fn asked(&self) -> f64 {
        self.asked.min(self.below)
    }

    fn all(&self) -> f64 {
        self.asked.max(self.puncture).min(self.below)
    }
}

/// A closed line through vertices.
fn polyline(mesh: &TriangleMesh, vertices: &[VertexId]) -> Polyline {
    let round = vertices.iter().chain(vertices.first());
    Polyline::new(round.map(|&v| mesh.position(v)).collect(), true)
}

fn length(mesh: &TriangleMesh, vertices: &[VertexId]) -> f64 {
    polyline(mesh, vertices).length()
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
