//! Takes a mesh apart: the parts that are surfaces, and those that are none.

use std::collections::HashSet;

use glam::DVec3;

use super::edges::Twins;
use super::mend::Soup;
use super::pairs::Pairing;
use super::sheets::{self, Parted, SharedLine, SharedPoint, Sorted, Turned};
use super::triangulate::Triangulated;
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
    /// The lines of edges of more than two faces, at which sheets were parted.
    pub shared: Vec<SharedLine>,
    /// The lines of such edges at which solids touch, each of which goes on there.
    pub touching: Vec<SharedLine>,
    /// The points where surfaces touch, and those where lines end.
    pub points: Vec<SharedPoint>,
    /// The parts that are no surfaces, in the order of their first faces.
    pub tangles: Vec<Tangle>,
    /// The input's positions with seams closed, where there were any to close.
    pub moved: Option<Vec<DVec3>>,
    /// What had to be done.
    pub report: Report,
}

/// A part that is no manifold surface, because it has one side only. Vertices and faces are the
/// input's.
#[derive(Clone, PartialEq, Debug)]
pub struct Tangle {
    /// Its faces, in order.
    pub faces: Vec<FaceId>,
    /// Its edges of one face.
    pub border: Vec<[VertexId; 2]>,
    /// An edge where faces disagree whichever way they are turned.
    pub one_sided: [VertexId; 2],
}

impl Apart {
    /// Whether an edge of the input has but one face.
    pub fn is_open(&self) -> bool {
        let mut tangles = self.tangles.iter();
        tangles.any(|tangle| !tangle.border.is_empty())
            || !self.mesh.is_closed() && !self.border().is_empty()
    }

    /// The input's edges of one face that are not in tangles. Borders of sheets along shared lines
    /// are none.
    pub(super) fn border(&self) -> Vec<[VertexId; 2]> {
        let shared: HashSet<_> = self.shared.iter().flat_map(SharedLine::edges).collect();
        let mesh = &self.mesh;
        let is_border = |h: &HalfedgeId| mesh.twin(*h).is_none();
        let ends = |h| [mesh.origin(h), mesh.target(h)].map(|v| self.origin[v]);
        let is_own = |&[a, b]: &[VertexId; 2]| {
            // Halves of an edge that was cut lie on a line, too.
            shared.is_empty() || a != b && !shared.contains(&[a.min(b), a.max(b)])
        };
        let edges = mesh.halfedge_ids().filter(is_border).map(ends);
        edges.filter(is_own).collect()
    }
}

/// Sorts triangles into surfaces and tangles; surfaces that share edges are parted into sheets, the
/// faces of each are turned to agree, and fans that meet in a vertex get one each.
pub(super) fn sort(
    mut soup: Soup,
    mut report: Report,
    progress: &Progress,
) -> Result<Apart, Error> {
    let pairing = Pairing::new(&soup.edges, &soup.triangulated);
    let mut parted = sheets::part(&soup, pairing);
    progress.at(0.8)?;
    let mut faces = soup.triangulated.faces.clone();
    let one_sided = orient::agree(&mut faces, &mut parted.twins);
    progress.at(0.85)?;
    let (tangles, is_sound) = tangles(&soup, &parted.twins, &one_sided);
    let before = std::mem::replace(&mut soup.triangulated.faces, faces);
    let pairs = before.iter().zip(&soup.triangulated.faces);
    let is_reversed: Vec<bool> = pairs.map(|(a, b)| a != b).collect();
    let turned = is_reversed.iter().zip(&is_sound);
    report.n_reoriented = turned.filter(|(turned, sound)| **turned && **sound).count();
    if !tangles.is_empty() {
        parted.twins.keep(&is_sound);
        soup.triangulated.keep(&is_sound);
    }
    progress.at(0.9)?;
    report.n_split = fans::split(&mut soup.triangulated, &parted.twins);
    let turned = Turned {
        before,
        is_reversed,
        is_sound,
    };
    let mut apart = built(soup.triangulated, &parted, &turned, progress)?;
    report.n_shared_edges = apart.shared.iter().map(|line| line.edges().count()).sum();
    report.n_sheets = sheets::count(&apart.shared);
    (apart.tangles, apart.report) = (tangles, report);
    Ok(apart)
}

/// A mesh of triangles that agree, with the lines and points that its sheets share.
fn built(
    mut triangulated: Triangulated,
    parted: &Parted,
    turned: &Turned,
    progress: &Progress,
) -> Result<Apart, Error> {
    let middles = parted
        .is_crowded
        .then(|| sheets::split_at_middles(&mut triangulated, &parted.twins));
    let compacted = compact(
        &triangulated.positions,
        std::mem::take(&mut triangulated.faces),
    );
    let origin = compacted.was.iter();
    let origin: VertexMap<VertexId> = origin.map(|v| triangulated.origins[v.index()]).collect();
    progress.at(0.95)?;
    let mesh = TriangleMesh::build(compacted.positions, compacted.faces, progress)??;
    let lines = middles.map(|middles| {
        let sorted = Sorted::new((turned, &middles), &compacted.was, &mesh);
        [&parted.lines, &parted.touching].map(|lines| sheets::told(lines, &triangulated, &sorted))
    });
    let [shared, touching] = lines.unwrap_or_default();
    let own = |v: VertexId| triangulated.positions[v.index()];
    let points = sheets::points((&mesh, &origin, own), [&shared, &touching]);
    Ok(Apart {
        mesh,
        source: FaceMap::from_vec(triangulated.source),
        origin,
        shared,
        touching,
        points,
        tangles: Vec::new(),
        moved: None,
        report: Report::default(),
    })
}

/// The parts with one side only, and which triangles are in none of them.
fn tangles(soup: &Soup, twins: &Twins, one_sided: &[HalfedgeId]) -> (Vec<Tangle>, Vec<bool>) {
    let n = soup.triangulated.faces.len();
    if one_sided.is_empty() {
        return (Vec::new(), vec![true; n]);
    }
    let (group, n_groups) = groups(n, twins);
    let of = |h: HalfedgeId| group[h.face().index()] as usize;
    let mut place: Vec<Option<usize>> = vec![None; n_groups];
    let mut tangles = Vec::new();
    let mut hit: Vec<HalfedgeId> = one_sided.to_vec();
    hit.sort_by_key(|&h| of(h));
    for h in hit {
        place[of(h)].get_or_insert_with(|| {
            tangles.push(Tangle {
                faces: Vec::new(),
                border: Vec::new(),
                one_sided: soup.ends(h),
            });
            tangles.len() - 1
        });
    }
    for (i, &group) in group.iter().enumerate() {
        if let Some(place) = place[group as usize] {
            tangles[place].push(soup.triangulated.source[i]);
        }
    }
    for run in soup.edges.runs().filter(|run| run.len() == 1) {
        if let Some(place) = place[of(run[0])] {
            tangles[place].border.push(soup.ends(run[0]));
        }
    }
    let is_sound = group.iter().map(|&g| place[g as usize].is_none());
    (tangles, is_sound.collect())
}

/// The group of each triangle, linked over edges, and how many there are.
fn groups(n: usize, twins: &Twins) -> (Vec<u32>, usize) {
    let mut groups = Groups::new(n);
    for h in (0..3 * n).map(HalfedgeId::from_index) {
        if let Some(twin) = twins.of(h) {
            groups.link(h.face().index(), twin.face().index());
        }
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
