//! Takes the input apart and says what is done with every part: the one place that does.
//!
//! A part is what hangs together over edges. One that is a surface of two sides is remeshed, where
//! the settings allow its borders; any other stays as it was, with every reason, and so do parts too
//! small for their share. Closing borders belongs to the run of a part (`open`).

use std::collections::HashMap;

use super::borders::SphereAlone;
use super::density::Density;
use super::frame::{Frame, bits};
use super::kept::{Flaw, Kept, Outcome, Reason};
use super::region::Region;
use super::small::Beside;
use super::stay::some_faces;
use super::{Error, Inner, Input, Settings, diagnosis, inner, small};
use crate::clean::{Apart, Cleaned, SharedLine, SharedPoint};
use crate::mesh::{FaceId, FaceMap, PolygonMesh, TriangleMesh, VertexId, VertexMap, bounds};
use crate::progress::{Cancelled, Progress};

/// The parts of a mesh.
pub struct Parts {
    /// Those that are remeshed.
    names: Vec<usize>,
    /// Those that are not.
    pub kept: Vec<Kept>,
    /// How many parts there are.
    n: usize,
    /// The part of each face of the input, if it belongs to one.
    part_of: FaceMap<Option<u32>>,
    /// The part that each surface is.
    of_surfaces: Vec<usize>,
    /// The lines along which surfaces met.
    pub shared: Vec<SharedLine>,
    /// Those along which solids touch.
    pub touching: Vec<SharedLine>,
    /// The points where surfaces touch.
    pub points: Vec<SharedPoint>,
    /// The faces that are kept because somebody wants them so.
    region: Vec<FaceId>,
    /// The faces of small parts that stay.
    pub staying_small: Beside,
}

/// What becomes of a surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// It is remeshed, as which of those that are.
    Done(usize),
    /// It goes out as it was.
    Stays,
    /// It is left out.
    Dropped,
}

/// One part.
pub struct Part {
    /// Which component of the surfaces it is; none where it is no surface.
    pub surface: Option<usize>,
    /// Its faces, in order.
    pub faces: Vec<FaceId>,
    /// All that keeps it from being remeshed.
    pub reasons: Vec<Reason>,
}

impl Parts {
    /// Looks at every part and chooses those to be remeshed, and their triangles.
    ///
    /// # Errors
    /// [`Error::Refused`] where no part can be done, or in strict runs not every one that is not
    /// merely small; when cancelled.
    pub fn new(
        input: &Input<'_>,
        (apart, region): (Apart, Option<&Region>),
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<(Self, Cleaned), Error> {
        let (component, n) = apart.mesh.face_components();
        let mut parts = diagnosis::parts(
            (input.mesh, settings, settings.sphere_alone()),
            &apart,
            (&component, n),
        );
        progress.check()?;
        if parts.len() > 1 && settings.inner == Inner::Drop {
            inner::mark(&mut parts, (input.mesh, &apart.mesh), progress)?;
        }
        if parts.len() > 1 {
            let amounts = amounts(input, &apart.mesh, progress)?;
            small::mark(&mut parts, input.mesh, &amounts, settings);
        }
        let given = (input.mesh, region);
        Self::chosen(given, apart, (&component, n), parts, settings)
    }

    /// The same where every part, however small, has to be done and to be closed.
    ///
    /// # Errors
    /// As above.
    pub fn all(mesh: &PolygonMesh, apart: Apart) -> Result<Cleaned, Error> {
        let settings = Settings {
            strict: true,
            ..Settings::default()
        };
        let why = |what| Some(format!("only meshes without {what} can be embedded"));
        let alone = SphereAlone {
            borders: why("borders"),
            handles: why("handles"),
        };
        let (component, n) = apart.mesh.face_components();
        let parts = diagnosis::parts((mesh, &settings, alone), &apart, (&component, n));
        let chosen = Self::chosen((mesh, None), apart, (&component, n), parts, &settings);
        chosen.map(|(_, cleaned)| cleaned)
    }

    fn chosen(
        (mesh, region): (&PolygonMesh, Option<&Region>),
        apart: Apart,
        (component, n_surfaces): (&[u32], usize),
        parts: Vec<Part>,
        settings: &Settings,
    ) -> Result<(Self, Cleaned), Error> {
        let mut is_done = vec![false; n_surfaces];
        let mut chosen = Self {
            names: Vec::new(),
            kept: Vec::new(),
            n: parts.len(),
            part_of: FaceMap::filled(mesh.n_faces(), None),
            of_surfaces: vec![0; n_surfaces],
            shared: apart.shared,
            touching: apart.touching,
            points: apart.points,
            region: Vec::new(),
            staying_small: Beside::default(),
        };
        for (i, part) in parts.into_iter().enumerate() {
            for &face in &part.faces {
                chosen.part_of[face] = Some(i as u32);
            }
            let is_beside = |region: &Region| part.faces.iter().any(|&f| region.is_beside(f));
            let is_beside = region.is_some_and(is_beside);
            if let Some(surface) = part.surface {
                chosen.of_surfaces[surface] = i;
            }
            match part.surface {
                Some(surface) if part.reasons.is_empty() => {
                    is_done[surface] = true;
                    chosen.names.push(i);
                }
                _ => {
                    let mut kept = kept(i, part, settings);
                    if is_beside {
                        // Else there would be a hole beside what is kept.
                        kept.outcome = Outcome::Kept;
                    }
                    chosen.kept.push(kept);
                }
            }
        }
        chosen.check(settings)?;
        chosen.attach(mesh);
        chosen.staying_small = Beside::new(&chosen.kept, settings);
        chosen.keep(region);
        let cleaned = Cleaned {
            mesh: apart.mesh,
            source: apart.source,
            report: apart.report,
        };
        if chosen.names.len() == n_surfaces {
            return Ok((chosen, cleaned));
        }
        let is_done: Vec<bool> = component.iter().map(|&c| is_done[c as usize]).collect();
        Ok((chosen, cleaned.only(&is_done)))
    }

    /// Takes faces that are kept from parts that they were attached to, and keeps them.
    fn keep(&mut self, region: Option<&Region>) {
        let Some(region) = region else {
            return;
        };
        for face in region.faces() {
            if let Some(part) = self.part_of[face].take()
                && let Ok(at) = self.kept.binary_search_by_key(&(part as usize), |k| k.part)
            {
                self.kept[at].n_faces -= 1;
            }
        }
        self.region = region.faces().collect();
    }

    /// Whether what is done is enough.
    fn check(&mut self, settings: &Settings) -> Result<(), Error> {
        if self.names.is_empty() || settings.strict && self.kept.iter().any(Kept::is_bad) {
            return Err(Error::Refused {
                kept: std::mem::take(&mut self.kept),
                n_parts: self.n,
            });
        }
        Ok(())
    }

    /// Gives faces that cleaning drops, such as repeated ones, to the part that stays as it was and
    /// has all their corners but one.
    fn attach(&mut self, mesh: &PolygonMesh) {
        let loose: Vec<FaceId> = mesh
            .face_ids()
            .filter(|&face| self.part_of[face].is_none())
            .collect();
        if loose.is_empty() || self.kept.is_empty() {
            return;
        }
        let mut parts = HashMap::new();
        for face in mesh.face_ids().filter(|&face| !self.is_done(face)) {
            let Some(part) = self.part_of[face] else {
                continue;
            };
            for &v in mesh.face(face) {
                parts.entry(bits(mesh.position(v))).or_insert(part);
            }
        }
        for face in loose {
            let corners = mesh.face(face);
            let of_corner = |v: &VertexId| parts.get(&bits(mesh.position(*v))).copied();
            let found: Vec<u32> = corners.iter().filter_map(of_corner).collect();
            let is_one = found.windows(2).all(|pair| pair[0] == pair[1]);
            if let (Some(&part), true) = (found.first(), is_one && found.len() + 1 >= corners.len())
            {
                self.part_of[face] = Some(part);
                let at = self
                    .kept
                    .binary_search_by_key(&(part as usize), |kept| kept.part);
                if let Ok(at) = at {
                    self.kept[at].n_faces += 1;
                }
            }
        }
    }

    /// Keeps those of the parts that were to be done whose runs failed, by their places among these
    /// and the reasons.
    ///
    /// # Errors
    /// As above.
    pub fn keep_failed(
        &mut self,
        mesh: &PolygonMesh,
        failed: Vec<(usize, String)>,
        settings: &Settings,
    ) -> Result<(), Error> {
        let mut is_left = vec![true; self.names.len()];
        for (at, text) in failed {
            is_left[at] = false;
            let name = self.names[at];
            let is_own = |face: &FaceId| self.part_of[*face] == Some(name as u32);
            let faces: Vec<FaceId> = mesh.face_ids().filter(is_own).collect();
            let reason = Reason::new(mesh, &faces, &[], Flaw::Failed, text);
            self.kept.push(Kept {
                part: name,
                n_faces: faces.len(),
                outcome: Outcome::Kept,
                reasons: vec![reason],
            });
        }
        self.kept.sort_by_key(|kept| kept.part);
        let mut left = is_left.iter();
        self.names.retain(|_| left.next() == Some(&true));
        self.check(settings)
    }

    /// The faces of the input that go out as they were, in order.
    pub fn staying(&self, mesh: &PolygonMesh) -> Vec<FaceId> {
        let stays = |part: u32| self.stays(part as usize);
        let is_kept = |face: &FaceId| self.region.binary_search(face).is_ok();
        let is_staying = |face: &FaceId| self.part_of[*face].is_some_and(stays) || is_kept(face);
        mesh.face_ids().filter(is_staying).collect()
    }

    fn stays(&self, part: usize) -> bool {
        let at = self.kept.binary_search_by_key(&part, |kept| kept.part);
        at.is_ok_and(|at| self.kept[at].outcome == Outcome::Kept)
    }

    /// What becomes of a surface, by its number among all.
    pub fn fate(&self, surface: usize) -> Fate {
        let part = self.of_surfaces[surface];
        match self.names.binary_search(&part) {
            Ok(at) => Fate::Done(at),
            Err(_) if self.stays(part) => Fate::Stays,
            Err(_) => Fate::Dropped,
        }
    }

    /// Those of some edges of the input that have both ends on what is remeshed, by their places.
    pub fn on_done(&self, mesh: &PolygonMesh, edges: &[[VertexId; 2]]) -> Vec<usize> {
        if self.is_all_done() || edges.is_empty() {
            return (0..edges.len()).collect();
        }
        let mut is_there = VertexMap::filled(mesh.n_vertices(), false);
        for face in mesh.face_ids().filter(|&face| self.is_done(face)) {
            for &v in mesh.face(face) {
                is_there[v] = true;
            }
        }
        let lies_there = |&i: &usize| edges[i].iter().all(|&v| is_there[v]);
        (0..edges.len()).filter(lies_there).collect()
    }

    /// The marked edges of the input that do.
    pub fn marked_on_done(&self, input: &Input<'_>) -> Vec<[VertexId; 2]> {
        let which = self.on_done(input.mesh, input.marked).into_iter();
        which.map(|i| input.marked[i]).collect()
    }

    /// The faces of the input that are remeshed, where these are not all.
    pub fn done_alone(&self, mesh: &PolygonMesh) -> Option<PolygonMesh> {
        (!self.is_all_done()).then(|| some_faces(mesh, |face| self.is_done(face)))
    }

    /// Whether nothing stays or goes.
    fn is_all_done(&self) -> bool {
        self.kept.is_empty() && self.region.is_empty()
    }

    /// Whether a face of the input is remeshed.
    fn is_done(&self, face: FaceId) -> bool {
        let is_done = |part: u32| self.names.binary_search(&(part as usize)).is_ok();
        self.part_of[face].is_some_and(is_done)
    }
}

fn kept(part: usize, of: Part, settings: &Settings) -> Kept {
    let mut kept = Kept {
        part,
        n_faces: of.faces.len(),
        outcome: Outcome::Kept,
        reasons: of.reasons,
    };
    if kept.is_small() {
        kept.outcome = settings.small_parts.outcome();
    }
    if kept.is_inner() {
        kept.outcome = Outcome::Dropped;
    }
    kept
}

/// The area of each surface, larger where smaller quads are wanted: what shares go by.
fn amounts(
    input: &Input<'_>,
    mesh: &TriangleMesh,
    progress: &Progress<'_>,
) -> Result<Vec<f64>, Cancelled> {
    let frame = Frame::new(bounds(mesh.positions()));
    let density = Density::new(input, &frame);
    let amount =
        |part: TriangleMesh| density.amount(&part.with_positions(frame.enter(part.positions())));
    let parts = mesh.components(progress)?;
    Ok(parts.into_iter().map(amount).collect())
}

/// The components of a mesh, in the order of their first faces; a single one is the mesh itself,
/// with the numbers of its vertices.
pub fn components(
    whole: &TriangleMesh,
    progress: &Progress<'_>,
) -> Result<Vec<TriangleMesh>, Cancelled> {
    match whole.face_components().1 {
        1 => Ok(vec![whole.clone()]),
        _ => whole.components(progress),
    }
}
