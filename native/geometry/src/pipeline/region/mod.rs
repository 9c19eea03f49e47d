//! Faces that are kept as they are, and joined by what is made of the others.
//!
//! What is kept is taken out first: what is left is open there, and its borders are kept. Once it is
//! remeshed its borders get the vertices of what is kept (`graft`), which goes out behind it, bit for
//! bit. A part that cannot be joined stays as it came, so that there is no gap.

mod finer;
mod line;
mod settle;
mod told;

use std::collections::{BTreeSet, HashMap};

use super::clock::Clock;
use super::frame::{Frame, Prepared, bits};
use super::join::Joined;
use super::marks::Marks;
use super::report::Mirrored;
use super::settings::MIN_FACES;
use super::split::components;
use super::{Error, Input, Remeshed, Settings, shells};
use crate::deform::{Target, is_inverted};
use crate::embed::OffsetPredictor;
use crate::graft::{self, Border, Counts, Grafted, Part};
use crate::measure::corner_angle;
use crate::mesh::{FaceId, FaceMap, Id, PolygonMesh, TriangleMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use settle::settled;
pub use told::KeptFaces;

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
    let density = region.finer(&given, &own, progress)?;
    let given = Input {
        density: density.as_deref().or(given.density),
        ..given
    };
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
        let names = line::names(mesh);
        let (line, beside) = line::line(mesh, &names, &is_kept);
        let mut is_beside = FaceMap::filled(mesh.n_faces(), false);
        for face in beside {
            is_beside[face] = true;
        }
        let (shared, n_inner) = line::shared(mesh, &names, &is_kept);
        Ok(Some(Self {
            hollow: line::hollow(mesh, &is_kept),
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
        flags
            .filter(|(_, kept)| **kept)
            .map(|(i, _)| FaceId::from_index(i))
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
        for &of in grafted.told.iter().flatten() {
            counts.add(of);
        }
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
        joined.take(&grafted, places);
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

impl Joined {
    /// Takes what was grafted, with vertices at some places.
    fn take(&mut self, grafted: &Grafted, places: PolygonMesh) {
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
        for ((part, &n), told) in self
            .parts
            .iter_mut()
            .zip(&grafted.n_faces)
            .zip(&grafted.told)
        {
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
