//! Takes a mesh apart: the parts that are surfaces, and those that are none.

use glam::DVec3;

use super::edges::{Edges, Twins};
use super::mend::Soup;
use super::pairs::Pairing;
use super::{Error, Report, compact, fans, orient};
use crate::groups::Groups;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, Id, TriangleMesh, VertexId, VertexMap};
use crate::progress::Progress;

/// A mesh taken apart. A part is what hangs together over edges; parts may touch at vertices.
#[derive(Clone, PartialEq, Debug)]
pub struct Apart {
    /// The parts that are manifold surfaces, with or without borders and handles.
    pub mesh: TriangleMesh,
    /// The input polygon of each of its triangles.
    pub source: FaceMap<FaceId>,
    /// The input's vertex that each of its vertices was; of the centre of a polygon, one of its
    /// corners.
    pub origin: VertexMap<VertexId>,
    /// The parts that are none, in the order of their first faces.
    pub tangles: Vec<Tangle>,
    /// The input's positions with seams closed, where there were any to close.
    pub moved: Option<Vec<DVec3>>,
    /// What had to be done.
    pub report: Report,
}

/// A part that is no manifold surface. Vertices and faces are the input's.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tangle {
    /// Its faces, in order.
    pub faces: Vec<FaceId>,
    /// Its edges of more than two faces.
    pub shared: Vec<SharedEdge>,
    /// Its edges of one face.
    pub border: Vec<[VertexId; 2]>,
    /// An edge where faces disagree whichever way they are turned, if there is one.
    pub one_sided: Option<[VertexId; 2]>,
}

/// An edge of more than two faces.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SharedEdge {
    /// How many faces meet.
    pub n_faces: usize,
    /// The ends, the smaller first.
    pub ends: [VertexId; 2],
}

impl Apart {
    /// Whether an edge has but one face.
    pub fn is_open(&self) -> bool {
        !self.mesh.is_closed() || self.tangles.iter().any(|tangle| !tangle.border.is_empty())
    }
}

/// Sorts triangles into surfaces and tangles; the faces of each surface are turned to agree, and
/// fans that meet in a vertex get one each.
pub(super) fn sort(
    mut soup: Soup,
    mut report: Report,
    progress: &Progress,
) -> Result<Apart, Error> {
    let Pairing { mut twins, shared } = Pairing::new(&soup.edges, &soup.triangulated);
    progress.at(0.8)?;
    let mut faces = soup.triangulated.faces.clone();
    let one_sided = orient::agree(&mut faces, &mut twins);
    progress.at(0.85)?;
    let (mut tangles, is_sound) = tangles(&soup, &twins, &shared, &one_sided);
    let old = std::mem::replace(&mut soup.triangulated.faces, faces);
    let turned = old.iter().zip(&soup.triangulated.faces).zip(&is_sound);
    report.n_reoriented = turned.filter(|((a, b), sound)| a != b && **sound).count();
    if !tangles.is_empty() {
        twins.keep(&is_sound);
        soup.triangulated.keep(&is_sound);
    }
    progress.at(0.9)?;
    let split = &mut soup.triangulated;
    report.n_split = fans::split(split, &twins);
    // Solids that touch along an edge between two others have one fan at each of its ends.
    soup.edges = Edges::new(&soup.triangulated.faces);
    let shared = soup.edges.runs().filter(|run| run.len() > 2);
    let shared: Vec<_> = shared.map(<[HalfedgeId]>::to_vec).collect();
    let (more, is_sound) = self::tangles(&soup, &twins, &shared, &[]);
    if !more.is_empty() {
        soup.triangulated.keep(&is_sound);
        tangles.extend(more);
        tangles.sort_by_key(|tangle| tangle.faces[0]);
    }
    let triangulated = soup.triangulated;
    let compacted = compact(&triangulated.positions, triangulated.faces);
    let origin = compacted.was.iter();
    let origin = origin.map(|v| triangulated.origins[v.index()]).collect();
    progress.at(0.95)?;
    Ok(Apart {
        mesh: TriangleMesh::build(compacted.positions, compacted.faces, progress)??,
        source: FaceMap::from_vec(triangulated.source),
        origin,
        tangles,
        moved: None,
        report,
    })
}

/// The parts with edges that more than two faces share or with one side only, and which triangles
/// are in none of them.
fn tangles(
    soup: &Soup,
    twins: &Twins,
    shared: &[Vec<HalfedgeId>],
    one_sided: &[HalfedgeId],
) -> (Vec<Tangle>, Vec<bool>) {
    let n = soup.triangulated.faces.len();
    if shared.is_empty() && one_sided.is_empty() {
        return (Vec::new(), vec![true; n]);
    }
    let (group, n_groups) = groups(n, twins, shared);
    let of = |h: HalfedgeId| group[h.face().index()] as usize;
    let mut place: Vec<Option<usize>> = vec![None; n_groups];
    let first = shared
        .iter()
        .map(|run| run[0])
        .chain(one_sided.iter().copied());
    let mut hit: Vec<usize> = first.map(of).collect();
    hit.sort_unstable();
    hit.dedup();
    for (i, &group) in hit.iter().enumerate() {
        place[group] = Some(i);
    }
    let mut tangles = vec![Tangle::default(); hit.len()];
    for (i, &group) in group.iter().enumerate() {
        if let Some(place) = place[group as usize] {
            tangles[place].push(soup.triangulated.source[i]);
        }
    }
    for run in shared {
        if let Some(place) = place[of(run[0])] {
            tangles[place].shared.push(SharedEdge {
                n_faces: run.len(),
                ends: soup.ends(run[0]),
            });
        }
    }
    for run in soup.edges.runs().filter(|run| run.len() == 1) {
        if let Some(place) = place[of(run[0])] {
            tangles[place].border.push(soup.ends(run[0]));
        }
    }
    for &h in one_sided {
        if let Some(place) = place[of(h)] {
            tangles[place].one_sided.get_or_insert(soup.ends(h));
        }
    }
    let is_sound = group.iter().map(|&g| place[g as usize].is_none());
    (tangles, is_sound.collect())
}

/// The group of each triangle, linked over edges of any number of faces, and how many there are.
fn groups(n: usize, twins: &Twins, shared: &[Vec<HalfedgeId>]) -> (Vec<u32>, usize) {
    let mut groups = Groups::new(n);
    for h in (0..3 * n).map(HalfedgeId::from_index) {
        if let Some(twin) = twins.of(h) {
            groups.link(h.face().index(), twin.face().index());
        }
    }
    for pair in shared.iter().flat_map(|run| run.windows(2)) {
        groups.link(pair[0].face().index(), pair[1].face().index());
    }
    groups.numbered()
}

impl Tangle {
    /// Adds a face, unless it came just before.
    fn push(&mut self, face: FaceId) {
        if self.faces.last() != Some(&face) {
            self.faces.push(face);
        }
    }
}
