//! Faces that are kept as they are, and joined by what is made of the others.
//!
//! What is kept is taken out first: what is left is open there, and its borders are kept. Once it is
//! remeshed its borders get the vertices of what is kept (`graft`), which goes out behind it, bit for
//! bit. A part that cannot be joined stays as it came, so that there is no gap.

use std::collections::{BTreeSet, HashMap};

use serde::Serialize;

use super::clock::Clock;
use super::fault::Fault;
use super::frame::{Frame, Prepared, bits};
use super::join::Joined;
use super::kept::count;
use super::marks::Marks;
use super::open;
use super::report::Mirrored;
use super::settings::MIN_FACES;
use super::split::components;
use super::{Error, Input, Remeshed, Settings, shells};
use crate::deform::{self, Target, is_inverted};
use crate::embed::OffsetPredictor;
use crate::graft::{self, Border, Counts, Grafted, Part};
use crate::measure::{PolygonEdges, corner_angle};
use crate::mesh::{FaceId, FaceMap, Id, PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};

/// Rings of faces beside what is kept whose vertices find better places.
const N_RINGS: usize = 3;
/// Rounds in which these go to the middle of their neighbours.
const N_SMOOTHINGS: usize = 6;
/// Quality up to which faces there are mended.
const ENOUGH: f64 = 0.7;

/// What is kept of a mesh.
pub struct Region {
    is_kept: FaceMap<bool>,
    /// The mesh with faces without area where it is kept: what cleaning drops.
    hollow: PolygonMesh,
    /// The edges between what is kept and what is not.
    line: Vec<[VertexId; 2]>,
    /// Vertices of what is kept at which there is something else.
    shared: Vec<VertexId>,
    /// Which of the other faces are beside it.
    is_beside: FaceMap<bool>,
    /// How many places nothing else has.
    n_inner: usize,
}

/// What became of faces that were to be kept.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct KeptFaces {
    /// How many there are.
    pub n_faces: usize,
    /// How many edges lie between them and what was remeshed.
    pub n_edges: usize,
    /// How many of these were met by one edge of the new mesh; beside the others there are vertices
    /// of another valence.
    pub n_met: usize,
    /// How many triangles were needed beside them among quads.
    pub n_triangles: usize,
    /// How many edges of theirs are beside something that stayed as it came.
    pub n_stayed: usize,
    /// How far what is not kept is from its own image in the plane that was named, in % of the
    /// diagonal, where it was not made so because of what is kept.
    pub plane_off_pct: Option<f64>,
}

/// Remeshes what is not kept.
///
/// # Errors
/// As [`super::remesh`].
pub fn run(
    (given, region): (Input<'_>, &Region),
    settings: &Settings,
    predictor: &dyn OffsetPredictor,
    progress: &Progress<'_>,
) -> Result<Remeshed, Error> {
    let own = region.settings(settings)?;
    let start = (given, Some(region), Clock::default());
    let mut made = shells(start, &own, predictor, progress)?;
    made.report.settings = settings.clone();
    // What was hollow was none that had to be mended.
    let clean = &mut made.report.clean;
    clean.n_degenerate = clean.n_degenerate.saturating_sub(region.n_faces());
    clean.n_isolated = clean.n_isolated.saturating_sub(region.n_inner);
    Ok(made)
}

impl Region {
    /// What is kept of a mesh, if anything is.
    ///
    /// # Errors
    /// Where all is kept, or a solid is to be made.
    pub fn of(input: &Input<'_>, settings: &Settings) -> Result<Option<Self>, Error> {
        let Some(flags) = input.keep_faces.filter(|flags| flags.contains(&true)) else {
            return Ok(None);
        };
        let mesh = input.mesh;
        let n_kept = flags.iter().filter(|&&kept| kept).count();
        if n_kept == flags.len() {
            return Err(Error::AllKept { n_faces: n_kept });
        }
        if settings.solid {
            return Err(Error::KeptInSolid { n_kept });
        }
        let is_kept: FaceMap<bool> = flags.iter().copied().collect();
        let names = names(mesh);
        let (line, beside) = line(mesh, &names, &is_kept);
        let mut is_beside = FaceMap::filled(mesh.n_faces(), false);
        beside.into_iter().for_each(|face| is_beside[face] = true);
        let (shared, n_inner) = shared(mesh, &names, &is_kept);
        Ok(Some(Self {
            hollow: hollow(mesh, &is_kept),
            shared,
            n_inner,
            line,
            is_kept,
            is_beside,
        }))
    }

    /// The same mesh, with faces without area where it is kept.
    pub fn hollow(&self) -> &PolygonMesh {
        &self.hollow
    }

    /// Whether a face is beside what is kept.
    pub fn is_beside(&self, face: FaceId) -> bool {
        self.is_beside[face]
    }

    /// The faces that are kept, in order.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> {
        let flags = self.is_kept.iter().enumerate();
        flags.filter(|(_, kept)| **kept).map(|(i, _)| FaceId::from_index(i))
    }

    pub fn n_faces(&self) -> usize {
        self.faces().count()
    }

    /// The edges at which it ends, in the frame of work.
    pub fn marks(&self, mesh: &PolygonMesh, frame: &Frame) -> Marks {
        Marks::new((mesh, &self.line), frame)
    }

    /// What is asked of the others: all faces but those that are kept.
    fn settings(&self, settings: &Settings) -> Result<Settings, Error> {
        let n_kept = self.n_faces();
        let faces = settings.faces.saturating_sub(n_kept);
        if faces < MIN_FACES {
            let n_faces = settings.faces;
            return Err(Error::KeptTooMany { n_kept, n_faces });
        }
        Ok(Settings {
            faces,
            ..settings.clone()
        })
    }

    /// Joins what was made to what is kept, and says which of the parts that were made cannot be.
    ///
    /// # Errors
    /// When cancelled.
    pub fn joined(
        &self,
        mut joined: Joined,
        (mesh, prepared): (&PolygonMesh, &Prepared),
        progress: &Progress<'_>,
    ) -> Result<Result<Joined, Vec<(usize, String)>>, Cancelled> {
        let places = Places::new(self, (mesh, &prepared.frame));
        let parts = components(&prepared.mesh, progress)?;
        let mut n_held = 0;
        let parts: Vec<Part> = parts
            .iter()
            .zip(&joined.parts)
            .map(|(part, made)| Part {
                n_faces: made.n_faces,
                borders: places.borders(part, &mut n_held),
            })
            .collect();
        let grafted = graft::graft(&joined.mesh, &parts, progress)?;
        let told = grafted.told.iter().enumerate();
        let refused = told.filter_map(|(at, told)| Some((at, told.as_ref().err()?.clone())));
        let refused: Vec<_> = refused.collect();
        if !refused.is_empty() {
            return Ok(Err(refused));
        }
        let mut counts = Counts::default();
        grafted.told.iter().flatten().for_each(|&of| counts.add(of));
        joined.kept_faces = Some(KeptFaces {
            n_faces: self.n_faces(),
            n_edges: counts.n_edges,
            n_met: counts.n_met,
            n_triangles: counts.n_triangles,
            n_stayed: self.line.len().saturating_sub(n_held),
            plane_off_pct: None,
        });
        for (&name, &v) in &grafted.at {
            joined.met.vertices.insert(places.keys[name], v);
        }
        let target = Target::new(prepared.mesh.clone(), progress)?;
        let places = settled(&grafted, &joined.features, &target, progress)?;
        joined.take(grafted, places);
        Ok(Ok(joined))
    }
}

/// Where vertices of what is kept are.
struct Places {
    marks: Marks,
    /// Their names by their places in the frame of work.
    names: HashMap<[u64; 3], usize>,
    /// Their places in the mesh with closed seams.
    keys: Vec<[u64; 3]>,
}

impl Places {
    fn new(region: &Region, (mesh, frame): (&PolygonMesh, &Frame)) -> Self {
        let (mut names, mut keys) = (HashMap::new(), Vec::new());
        for &v in &region.shared {
            let place = frame.enter(&[mesh.position(v)])[0];
            names.entry(bits(place)).or_insert_with(|| {
                keys.push(bits(mesh.position(v)));
                keys.len() - 1
            });
        }
        Self {
            marks: region.marks(mesh, frame),
            names,
            keys,
        }
    }

    /// The borders of a part; counts those of their edges beyond which something is kept.
    fn borders(&self, part: &TriangleMesh, n_held: &mut usize) -> Vec<Border> {
        let is_line = self.marks.on(part);
        let angles = angles(part);
        let border = |border: Vec<_>| {
            let points = border.iter().map(|&h| part.position(part.origin(h)));
            let points: Vec<_> = points.collect();
            let is_held: Vec<bool> = border.iter().map(|&h| is_line[h]).collect();
            *n_held += is_held.iter().filter(|&&held| held).count();
            let name = |p: &_| self.names.get(&bits(*p)).copied();
            Border {
                names: points.iter().map(name).collect(),
                angles: border.iter().map(|&h| angles[part.origin(h)]).collect(),
                points,
                is_held,
            }
        };
        part.border_loops().into_iter().map(border).collect()
    }
}

impl Joined {
    /// Takes what was grafted, with vertices at some places.
    fn take(&mut self, grafted: Grafted, places: PolygonMesh) {
        let middle = |&[a, b]: &[VertexId; 2]| {
            let [a, b] = [a, b].map(|v| self.sphere[v.index()]);
            if a == b { a } else { (a + b).normalize_or(a) }
        };
        self.sphere = grafted.from.iter().map(middle).collect();
        let named = |ends: &[VertexId; 2]| ends.map(|v| grafted.name[v]);
        let features = self.features.iter().map(named);
        let features: BTreeSet<_> = features.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        self.features = features.into_iter().collect();
        let mut faces = places.faces();
        for ((part, &n), told) in self.parts.iter_mut().zip(&grafted.n_faces).zip(&grafted.told) {
            part.n_faces = n;
            let own = faces.by_ref().take(n);
            part.deform.n_inverted = own.filter(|face| is_inverted(&places, face)).count();
            let is_used = matches!(part.mirrored, Some(Mirrored::Used | Mirrored::Image { .. }));
            if is_used && told.as_ref().is_ok_and(|counts| counts.n_edges > 0) {
                let reason = "it was joined to faces that are kept".to_owned();
                part.mirrored = Some(Mirrored::Refused { reason });
            }
        }
        drop(faces);
        self.mesh = places;
    }
}

/// Vertices beside what is kept at better places of the surface; borders and lines stay.
fn settled(
    grafted: &Grafted,
    features: &[[VertexId; 2]],
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    let mesh = &grafted.mesh;
    let mut is_fixed = PolygonEdges::new(mesh, progress)?.border_vertices(mesh.n_vertices());
    for v in features.iter().flatten() {
        is_fixed[grafted.name[*v].index()] = true;
    }
    for &v in grafted.at.values() {
        is_fixed[v.index()] = true;
    }
    let mut is_near = vec![false; mesh.n_vertices()];
    for v in grafted.at.values().chain(&grafted.loose) {
        is_near[v.index()] = true;
    }
    for _ in 0..N_RINGS {
        let touched = mesh.faces().filter(|face| face.iter().any(|v| is_near[v.index()]));
        let more: Vec<VertexId> = touched.flatten().copied().collect();
        more.iter().for_each(|v| is_near[v.index()] = true);
    }
    for (is_fixed, is_near) in is_fixed.iter_mut().zip(&is_near) {
        *is_fixed |= !is_near;
    }
    let smooth = smoothed((mesh, &is_fixed), target, progress)?;
    let settled = deform::settle(&smooth, (&is_fixed, ENOUGH), target, progress)?;
    open::untangled(&settled, target, progress)
}

/// Vertices in the middle of their neighbours, on the surface.
fn smoothed(
    (mesh, is_fixed): (&PolygonMesh, &[bool]),
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    let edges = PolygonEdges::new(mesh, progress)?;
    let mut around: Vec<Vec<VertexId>> = vec![Vec::new(); mesh.n_vertices()];
    for &[a, b] in &edges.ends {
        around[a.index()].push(b);
        around[b.index()].push(a);
    }
    let mut places = mesh.positions().to_vec();
    for _ in 0..N_SMOOTHINGS {
        progress.check()?;
        for v in (0..places.len()).filter(|&v| !is_fixed[v]) {
            let sum: glam::DVec3 = around[v].iter().map(|u| places[u.index()]).sum();
            let wanted = places[v].lerp(sum / around[v].len().max(1) as f64, 0.5);
            places[v] = target.bvh().closest(wanted).position;
        }
    }
    Ok(mesh.with_positions(places))
}

fn ids(mesh: &PolygonMesh) -> impl Iterator<Item = VertexId> + use<> {
    (0..mesh.n_vertices()).map(VertexId::from_index)
}

/// The angle of all faces round every vertex.
fn angles(part: &TriangleMesh) -> VertexMap<f64> {
    let mut angles = VertexMap::filled(part.n_vertices(), 0.0);
    for face in part.face_ids() {
        for (i, v) in part.face(face).into_iter().enumerate() {
            angles[v] += corner_angle(part.triangle(face), i);
        }
    }
    angles
}

/// The first vertex at the place of each.
fn names(mesh: &PolygonMesh) -> Vec<VertexId> {
    let mut first = HashMap::new();
    let name = |v| *first.entry(bits(mesh.position(v))).or_insert(v);
    ids(mesh).map(name).collect()
}

/// The edges that have faces that are kept and others, and these others.
fn line(
    mesh: &PolygonMesh,
    names: &[VertexId],
    is_kept: &FaceMap<bool>,
) -> (Vec<[VertexId; 2]>, Vec<FaceId>) {
    let mut sides = Vec::with_capacity(mesh.corners().len());
    for face in mesh.face_ids() {
        let corners = mesh.face(face);
        let next = corners.iter().cycle().skip(1);
        for (a, b) in corners.iter().zip(next) {
            let [a, b] = [a, b].map(|v| names[v.index()]);
            sides.push(([a.min(b), a.max(b)], face));
        }
    }
    sides.sort_unstable();
    let (mut line, mut beside) = (Vec::new(), Vec::new());
    for run in sides.chunk_by(|a, b| a.0 == b.0) {
        let others = run.iter().map(|&(_, face)| face).filter(|&face| !is_kept[face]);
        let others: Vec<FaceId> = others.collect();
        if !others.is_empty() && others.len() < run.len() && run[0].0[0] != run[0].0[1] {
            line.push(run[0].0);
            beside.extend(others);
        }
    }
    (line, beside)
}

/// The first vertices at places that faces that are kept have with others in common, and how many
/// places they have alone.
fn shared(
    mesh: &PolygonMesh,
    names: &[VertexId],
    is_kept: &FaceMap<bool>,
) -> (Vec<VertexId>, usize) {
    let mut has = [vec![false; mesh.n_vertices()], vec![false; mesh.n_vertices()]];
    for face in mesh.face_ids() {
        for v in mesh.face(face) {
            has[usize::from(is_kept[face])][names[v.index()].index()] = true;
        }
    }
    let [others, kept] = has;
    let of_kept = ids(mesh).filter(|v| kept[v.index()]);
    let (shared, inner): (Vec<_>, Vec<_>) = of_kept.partition(|v| others[v.index()]);
    (shared, inner.len())
}

/// The same mesh with faces that are points where it is kept.
fn hollow(mesh: &PolygonMesh, is_kept: &FaceMap<bool>) -> PolygonMesh {
    let mut corners = mesh.corners().to_vec();
    for face in mesh.face_ids().filter(|&face| is_kept[face]) {
        let [from, to] = [0, 1].map(|k| mesh.starts()[face.index() + k] as usize);
        let first = corners[from];
        corners[from..to].fill(first);
    }
    PolygonMesh::new(mesh.positions().to_vec(), mesh.starts().to_vec(), corners)
        .expect("corners of a mesh are in range")
}

impl KeptFaces {
    /// What is wrong with how they were joined.
    pub fn fault(self) -> Option<Fault> {
        (self.n_triangles > 0).then_some(Fault::KeptTriangles {
            n_triangles: self.n_triangles,
        })
    }

    /// What is wrong with the symmetry that was named.
    pub fn mirror_fault(self) -> Option<Fault> {
        let off_pct = self.plane_off_pct?;
        Some(Fault::KeptUnlikeImage { off_pct })
    }

    /// What became of them, in a line.
    pub fn text(&self) -> String {
        let mut text = format!("{} kept", count(self.n_faces, "face"));
        if self.n_edges > 0 {
            let edges = count(self.n_edges, "edge");
            text += &format!(", joined along {edges} ({} met by one)", self.n_met);
        }
        if self.n_stayed > 0 {
            let edges = count(self.n_stayed, "edge");
            text += &format!(", {edges} of them beside faces that stayed");
        }
        text
    }
}

impl Input<'_> {
    /// Whether it is said of every face whether it is kept, where it is of any.
    pub(super) fn check_keep(&self) -> Result<(), Error> {
        let n_faces = self.mesh.n_faces();
        match self.keep_faces {
            Some(flags) if flags.len() != n_faces => Err(Error::KeepCount {
                n_flags: flags.len(),
                n_faces,
            }),
            _ => Ok(()),
        }
    }
}
