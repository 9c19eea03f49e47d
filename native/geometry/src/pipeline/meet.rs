//! Lines along which sheets meet: edges are laid there, and the sheets of the result joined.

use std::collections::{HashMap, HashSet};

use super::fault::Fault;
use super::frame::{Frame, Prepared, bits};
use super::join::Joined;
use super::report::{Mirrored, PartReport, Rejoined};
use super::split::{Fate, Parts};
use super::stay::Met;
use crate::clean::{Fan, SharedLine, Strand};
use crate::deform::is_inverted;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};
use crate::progress::{Cancelled, Progress};
use crate::rejoin::{self, Corner, Given, Line, Rejoined as Joining, Sheet, Touch, rejoin};

/// How often lines beside inverted quads alone are taken out, before all lines of the sheet are.
const MOST_ROUNDS: usize = 3;

/// The lines along which sheets meet and the points where they touch, at which at least one was
/// remeshed.
pub struct Meetings {
    lines: Vec<Line>,
    touches: Vec<Touch>,
    /// The input's places of the points of each line, and of each touch, at which faces stay.
    staying: [Vec<Vec<[u64; 3]>>; 2],
}

impl Meetings {
    /// The lines and points of a mesh, in the frame of work.
    pub fn new((mesh, frame): (&PolygonMesh, &Frame), parts: &Parts) -> Self {
        let mut meetings = Self {
            lines: Vec::new(),
            touches: Vec::new(),
            staying: [Vec::new(), Vec::new()],
        };
        let place = |v: VertexId| frame.enter(&[mesh.position(v)])[0];
        for line in parts.shared.iter().chain(&parts.touching) {
            let fates = line.strands.iter().map(|strand| parts.fate(strand.sheet));
            let strands = line.strands.iter().zip(fates.clone());
            let done = strands.filter_map(|(strand, fate)| match fate {
                Fate::Done(sheet) => Some(rejoin::Strand {
                    sheet,
                    is_border: strand.is_border,
                    ends: strand.ends(),
                }),
                _ => None,
            });
            let done: Vec<rejoin::Strand> = done.collect();
            let n_staying = fates.filter(|&fate| fate == Fate::Stays).count() + line.n_tangled();
            if done.is_empty() || done.len() + n_staying < 2 {
                continue;
            }
            let keys = line.vertices.iter().map(|&v| bits(mesh.position(v)));
            meetings.staying[0].push(keys.filter(|_| n_staying > 0).collect());
            meetings.lines.push(Line {
                points: line.vertices.iter().map(|&v| place(v)).collect(),
                is_closed: line.is_closed,
                strands: done,
                stays: n_staying > 0,
            });
        }
        for point in &parts.points {
            let corner = |fan: &Fan| match parts.fate(fan.sheet) {
                Fate::Done(sheet) => Some(Corner {
                    sheet,
                    name: fan.vertex.index(),
                }),
                _ => None,
            };
            let corners: Vec<Corner> = point.fans.iter().filter_map(corner).collect();
            let stays = |fan: &Fan| parts.fate(fan.sheet) == Fate::Stays;
            let stays = point.fans.iter().any(stays);
            if corners.len() + usize::from(stays) > 1 && !corners.is_empty() {
                let key = Some(bits(mesh.position(point.vertex)));
                meetings.staying[1].push(key.filter(|_| stays).into_iter().collect());
                meetings.touches.push(Touch {
                    place: place(point.vertex),
                    corners,
                });
            }
        }
        meetings
    }

    /// Joins the sheets of a result along them.
    ///
    /// # Errors
    /// When cancelled.
    pub fn join(
        mut self,
        mut joined: Joined,
        progress: &Progress<'_>,
    ) -> Result<Joined, Cancelled> {
        if self.lines.is_empty() && self.touches.is_empty() {
            return Ok(joined);
        }
        let n_shared_lines = self.lines.len();
        let mut start = 0;
        let sheets = joined.parts.iter().map(|part| {
            start += part.n_faces;
            Sheet {
                faces: start - part.n_faces..start,
                is_kept: part.is_mirrored(),
            }
        });
        let given = Given {
            mesh: &joined.mesh,
            sheets: &sheets.collect::<Vec<_>>(),
            features: &joined.features,
        };
        let found = self.sound(&given, progress)?;
        let n_joined = found.joined.iter().flatten().count();
        joined.rejoined = Some(Rejoined {
            n_shared_lines,
            n_joined,
            n_left: n_shared_lines - n_joined,
        });
        joined.met = self.met(&found);
        joined.rename(found);
        Ok(joined)
    }

    /// The sheets joined along those lines at which that inverts no quad; the others are taken out.
    fn sound(&mut self, given: &Given<'_>, progress: &Progress<'_>) -> Result<Joining, Cancelled> {
        let faces = given.sheets.iter().map(|sheet| sheet.faces.len());
        let before = inverted(given.mesh, &faces.collect::<Vec<_>>());
        for n_round in 0.. {
            let found = rejoin(given, (&self.lines, &self.touches), progress)?;
            let spoiled = self.spoiled(&found, &before, n_round < MOST_ROUNDS);
            if !spoiled.contains(&true) {
                return Ok(found);
            }
            let mut lines = spoiled.iter();
            self.lines.retain(|_| lines.next() == Some(&false));
            let mut lines = spoiled.iter();
            self.staying[0].retain(|_| lines.next() == Some(&false));
        }
        unreachable!("there are fewer lines each time")
    }

    /// Which lines are at more inverted quads than there were: those beside them, or all of the sheet.
    fn spoiled(&self, found: &Joining, before: &[Vec<FaceId>], is_near: bool) -> Vec<bool> {
        let after = inverted(&found.mesh, &found.n_faces);
        let mut spoiled = vec![false; self.lines.len()];
        for (sheet, (after, before)) in after.iter().zip(before).enumerate() {
            if after.len() <= before.len() {
                continue;
            }
            let corners = after.iter().flat_map(|&face| found.mesh.face(face));
            let corners: HashSet<VertexId> = corners.copied().collect();
            let is_beside = |joined: &Option<Vec<VertexId>>| {
                let along = joined.as_ref();
                along.is_none_or(|along| along.iter().any(|v| corners.contains(v)))
            };
            let is_of = |line: &Line| line.strands.iter().any(|strand| strand.sheet == sheet);
            let lines = self.lines.iter().zip(&found.joined);
            let beside: Vec<bool> = lines
                .map(|(line, joined)| is_of(line) && is_beside(joined))
                .collect();
            let is_blamed = is_near && beside.contains(&true);
            for (i, line) in self.lines.iter().enumerate() {
                spoiled[i] |= if is_blamed { beside[i] } else { is_of(line) };
            }
        }
        spoiled
    }

    /// What of a result lies where faces stay.
    fn met(&self, found: &Joining) -> Met {
        let mut met = Met::default();
        let [lines, touches] = &self.staying;
        for ((line, keys), along) in self.lines.iter().zip(lines).zip(&found.joined) {
            let Some(along) = along.as_ref().filter(|_| !keys.is_empty()) else {
                continue;
            };
            let posts = line.posts(along.len());
            let next = posts
                .iter()
                .cycle()
                .skip(1)
                .zip(keys.iter().cycle().skip(1));
            let n_sides = keys.len() - usize::from(!line.is_closed);
            for (i, ((&at, &key), (&to, &other))) in posts.iter().zip(keys).zip(next).enumerate() {
                met.vertices.insert(key, along[at]);
                if i == n_sides {
                    continue;
                }
                let to = if to > at { to } else { along.len() };
                let mut between = along[at + 1..to].to_vec();
                met.between.insert([key, other], between.clone());
                between.reverse();
                met.between.insert([other, key], between);
            }
        }
        for (keys, vertex) in touches.iter().zip(&found.touched) {
            let both = keys.iter().zip(*vertex);
            met.vertices
                .extend(both.map(|(&key, vertex)| (key, vertex)));
        }
        met
    }
}

impl Joined {
    /// Takes sheets that were joined; of vertices that are one now the first says where it lies on
    /// its sphere.
    fn rename(&mut self, found: Joining) {
        let middle = |&[a, b]: &[VertexId; 2]| {
            let [a, b] = [a, b].map(|v| self.sphere[v.index()]);
            if a == b { a } else { (a + b).normalize_or(a) }
        };
        self.sphere = found.from.iter().map(middle).collect();
        let counts = found.n_faces.iter().zip(&found.is_changed);
        let inverted = inverted(&found.mesh, &found.n_faces);
        for ((part, (&n, &is_changed)), inverted) in self.parts.iter_mut().zip(counts).zip(inverted)
        {
            part.n_faces = n;
            part.deform.n_inverted = inverted.len();
            if is_changed && part.is_mirrored() {
                let reason = "it got other faces where sheets meet".to_owned();
                part.mirrored = Some(Mirrored::Refused { reason });
            }
        }
        self.features = found.features;
        self.mesh = found.mesh;
    }
}

/// The inverted quads of sheets of so many faces, which lie one after the other.
fn inverted(mesh: &PolygonMesh, n_faces: &[usize]) -> Vec<Vec<FaceId>> {
    let mut faces = mesh.face_ids();
    let of_sheet = |&n: &usize| {
        let of_sheet = faces.by_ref().take(n);
        of_sheet
            .filter(|&face| is_inverted(mesh, mesh.face(face)))
            .collect()
    };
    n_faces.iter().map(of_sheet).collect()
}

impl PartReport {
    /// Whether it would not be symmetric with other faces.
    fn is_mirrored(&self) -> bool {
        matches!(self.mirrored, Some(Mirrored::Used | Mirrored::Image { .. }))
    }
}

impl Strand {
    /// What its sheet calls the vertices where the line begins and ends.
    fn ends(&self) -> [usize; 2] {
        [self.vertices.first(), self.vertices.last()].map(|v| v.map_or(0, |v| v.index()))
    }
}

impl SharedLine {
    /// How many of its faces belong to no sheet.
    fn n_tangled(&self) -> usize {
        let pages = |strand: &Strand| if strand.is_border { 1 } else { 2 };
        self.n_faces - self.strands.iter().map(pages).sum::<usize>()
    }

    /// Whether a sheet that is remeshed goes on there.
    fn goes_through(&self, parts: &Parts) -> bool {
        let mut strands = self.strands.iter();
        strands.any(|s| !s.is_border && matches!(parts.fate(s.sheet), Fate::Done(_)))
    }
}

impl Rejoined {
    /// What is wrong with it.
    pub fn fault(self) -> Option<Fault> {
        let Self {
            n_left,
            n_shared_lines,
            ..
        } = self;
        (n_left > 0).then_some(Fault::Parted {
            n_left,
            n_shared_lines,
        })
    }
}

/// Edges of the input along which edges are laid: the marked ones, and those where sheets end at
/// others that go on.
pub fn laid(marked: &[[VertexId; 2]], parts: &Parts) -> Vec<[VertexId; 2]> {
    let lines = parts.shared.iter().filter(|line| line.goes_through(parts));
    let mut laid = marked.to_vec();
    laid.extend(lines.flat_map(SharedLine::edges));
    laid
}

/// The triangles that are remeshed, with one vertex where sheets meet, but where an edge of theirs
/// was cut in the middle.
pub fn whole(prepared: &Prepared, (mesh, parts): (&PolygonMesh, &Parts)) -> PolygonMesh {
    let lines = parts.shared.iter().chain(&parts.touching);
    let vertices = lines.flat_map(|line| &line.vertices);
    let vertices = vertices.chain(parts.points.iter().map(|point| &point.vertex));
    let points: Vec<_> = vertices.map(|&v| mesh.position(v)).collect();
    let mut first: HashMap<_, Option<u32>> = HashMap::new();
    first.extend(
        prepared
            .frame
            .enter(&points)
            .into_iter()
            .map(|p| (bits(p), None)),
    );
    let own = &prepared.mesh;
    let name = |v: VertexId| match first.get_mut(&bits(own.position(v))) {
        Some(first) => *first.get_or_insert(v.0),
        None => v.0,
    };
    let names: Vec<u32> = own.vertex_ids().map(name).collect();
    let faces = own.faces().iter().map(|f| f.map(|v| names[v.index()]));
    let faces: Vec<[u32; 3]> = faces.collect();
    PolygonMesh::from_faces(own.positions().to_vec(), &faces).expect("corners are told apart")
}
