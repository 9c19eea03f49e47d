//! Joins sheets that meet along lines: gives them the same vertices there.
//!
//! Each sheet was remeshed by itself, with a line of edges along the line where it met others. Those
//! with equally many edges there are joined, vertex by vertex from the line's start, on the line where
//! the borders among them are in the middle; an edge of the result then has as many faces as the
//! input's had. Not done: sheets with other numbers of edges stay apart, and so do those of which a
//! face would be turned inside out.

mod chain;
mod strips;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use glam::DVec3;

use crate::groups::Groups;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use chain::{Chain, Sheets};

/// A line along which sheets meet.
#[derive(Clone, PartialEq, Debug)]
pub struct Line {
    /// Its points; of a closed line the last is not the first.
    pub points: Vec<DVec3>,
    /// Whether its last point is joined to its first.
    pub is_closed: bool,
    /// What meets there.
    pub strands: Vec<Strand>,
}

/// A sheet at a line.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Strand {
    /// Its faces in the mesh.
    pub faces: Range<usize>,
    /// Whether it ends there.
    pub is_border: bool,
}

/// An edge by its ends.
pub type Edge = [VertexId; 2];

/// A sheet of a mesh.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sheet {
    /// Its faces.
    pub faces: Range<usize>,
    /// Whether it may get other faces.
    pub may_change: bool,
}

/// What is to be joined.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    /// All sheets, one after the other.
    pub mesh: &'a PolygonMesh,
    /// All of them, in order.
    pub sheets: &'a [Sheet],
    /// Edges that lie on lines.
    pub features: &'a [Edge],
}

/// Sheets that were joined.
#[derive(Clone, PartialEq, Debug)]
pub struct Rejoined {
    /// The mesh, sheet by sheet; a sheet that did not change has its faces in the same order.
    pub mesh: PolygonMesh,
    /// How many faces each sheet has.
    pub n_faces: Vec<usize>,
    /// What each vertex that came is called now.
    pub name: VertexMap<VertexId>,
    /// The vertices that came in whose middle each vertex lies.
    pub from: VertexMap<[VertexId; 2]>,
    /// The edges on lines.
    pub features: Vec<Edge>,
    /// Which lines have the same vertices in all their sheets. The others have not, because the
    /// counts of edges differ or no edges lie there.
    pub is_joined: Vec<bool>,
}

/// Gives sheets that meet along lines the same vertices there.
///
/// Counts that differ are brought together by strips of quads first. No face loses a corner: where
/// it would, sheets stay apart. Costs the edges near each line times its points, and for each strip
/// the quads of its sheet.
///
/// # Errors
/// When cancelled.
pub fn rejoin(
    given: &Given<'_>,
    lines: &[Line],
    progress: &Progress<'_>,
) -> Result<Rejoined, Cancelled> {
    let sheets = Sheets::new(given);
    let chains = lines.iter().map(|line| sheets.chains(line)).collect();
    let leveled = strips::level(given, chains, progress)?;
    let mut joining = Joining::new(&leveled.mesh);
    let mut is_joined = Vec::with_capacity(lines.len());
    for (line, mut chains) in lines.iter().zip(leveled.chains) {
        progress.check()?;
        let are_found = chains.len() == line.strands.len();
        chains.sort_by_key(|chain| (chain.vertices.len(), !chain.is_border));
        // Most alike; of equally many the longest.
        let alike = chains
            .chunk_by(|a, b| a.vertices.len() == b.vertices.len())
            .max_by_key(|alike| alike.len());
        let joins = alike.filter(|alike| alike.len() > 1);
        let joins = joins.is_some_and(|alike| joining.join(line, alike));
        let are_alike = alike.is_some_and(|alike| alike.len() == line.strands.len());
        is_joined.push(joins && are_found && are_alike);
    }
    let (mesh, joined) = joining.joined();
    let mut from = vec![None; mesh.n_vertices()];
    for (&name, &of) in joined.iter().zip(leveled.from.iter()) {
        from[name.index()].get_or_insert(of);
    }
    let features = leveled
        .features
        .iter()
        .map(|ends| sorted(ends.map(|v| joined[v])));
    let features: BTreeSet<Edge> = features.collect();
    Ok(Rejoined {
        mesh,
        n_faces: leveled.n_faces,
        name: leveled.name.iter().map(|&v| joined[v]).collect(),
        from: from.into_iter().flatten().collect(),
        features: features.into_iter().collect(),
        is_joined,
    })
}

/// Vertices that become one.
struct Joining<'a> {
    mesh: &'a PolygonMesh,
    groups: Groups,
    /// The faces at all vertices of the group of each first vertex, in order.
    faces: Vec<Vec<FaceId>>,
    /// Where the group of each first vertex lies.
    places: Vec<DVec3>,
}

impl<'a> Joining<'a> {
    fn new(mesh: &'a PolygonMesh) -> Self {
        let mut faces = vec![Vec::new(); mesh.n_vertices()];
        for face in mesh.face_ids() {
            for v in mesh.face(face) {
                faces[v.index()].push(face);
            }
        }
        Self {
            mesh,
            groups: Groups::new(mesh.n_vertices()),
            faces,
            places: mesh.positions().to_vec(),
        }
    }

    /// Joins chains of equally many vertices on a line, unless a face would lose a corner or turn
    /// inside out.
    fn join(&mut self, line: &Line, chains: &[Chain]) -> bool {
        let mut after = self.groups.clone();
        let mut hit: Vec<usize> = Vec::new();
        let n = chains[0].vertices.len();
        for i in 0..n {
            let first = chains[0].vertices[i].index();
            for chain in chains {
                let v = chain.vertices[i].index();
                hit.push(after.root(v));
                after.link(first, v);
            }
        }
        hit.sort_unstable();
        hit.dedup();
        let mut corners: Vec<(usize, FaceId)> = Vec::new();
        for &was in &hit {
            let now = after.root(was);
            corners.extend(self.faces[was].iter().map(|&face| (now, face)));
        }
        corners.sort_unstable();
        if corners.windows(2).any(|w| w[0] == w[1]) {
            return false;
        }
        let mut places = BTreeMap::new();
        for i in 0..n {
            let root = after.root(chains[0].vertices[i].index());
            places.insert(root, self.goal(line, chains, i));
        }
        let mut touched: Vec<FaceId> = corners.iter().map(|&(_, face)| face).collect();
        touched.sort_unstable();
        touched.dedup();
        if touched.iter().any(|&f| self.turns(f, &mut after, &places)) {
            return false;
        }
        self.groups = after;
        for was in hit {
            self.faces[was].clear();
        }
        for of_one in corners.chunk_by(|a, b| a.0 == b.0) {
            self.faces[of_one[0].0] = of_one.iter().map(|&(_, face)| face).collect();
        }
        for (root, place) in places {
            self.places[root] = place;
        }
        true
    }

    /// Where some vertices of chains are joined: on the line, in the middle of the sheets that end
    /// there, or go on, with counts that were not changed.
    fn goal(&mut self, line: &Line, chains: &[Chain], i: usize) -> DVec3 {
        let last = chains[0].vertices.len() - 1;
        match (line.is_closed, i) {
            (false, 0) => return line.points[0],
            (false, i) if i == last => return line.points[line.points.len() - 1],
            _ => {}
        }
        let key = |chain: &Chain| (chain.is_changed, !chain.is_border);
        let best = chains.iter().map(key).min();
        let counting = chains.iter().filter(|chain| Some(key(chain)) == best);
        let (mut sum, mut n) = (DVec3::ZERO, 0.0);
        for chain in counting {
            sum += self.places[self.groups.root(chain.vertices[i].index())];
            n += 1.0;
        }
        line.closest(sum / n)
    }

    /// Whether a face gets more corners that turn the wrong way.
    fn turns(&mut self, face: FaceId, after: &mut Groups, to: &BTreeMap<usize, DVec3>) -> bool {
        let corners = self.mesh.face(face);
        let place = |v: &VertexId| self.places[self.groups.root(v.index())];
        let before: Vec<DVec3> = corners.iter().map(place).collect();
        let moved = corners.iter().zip(&before);
        let moved = moved.map(|(v, &p)| to.get(&after.root(v.index())).copied().unwrap_or(p));
        let moved: Vec<DVec3> = moved.collect();
        let normal = area(&before);
        n_turned(&moved, normal) > n_turned(&before, normal)
    }

    /// The mesh with its vertices joined, and what they are called.
    fn joined(mut self) -> (PolygonMesh, VertexMap<VertexId>) {
        let roots: Vec<usize> = (0..self.places.len())
            .map(|v| self.groups.root(v))
            .collect();
        let (group, n) = self.groups.numbered();
        let mut positions = vec![DVec3::ZERO; n];
        for (&group, root) in group.iter().zip(roots) {
            positions[group as usize] = self.places[root];
        }
        let name = VertexMap::from_vec(group.into_iter().map(VertexId).collect());
        let corners = self.mesh.corners().iter().map(|&v| name[v]).collect();
        let joined = PolygonMesh::new(positions, self.mesh.starts().to_vec(), corners);
        (joined.expect("no face loses a corner"), name)
    }
}

fn sorted([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

/// The area of a polygon as a vector.
fn area(corners: &[DVec3]) -> DVec3 {
    let next = corners.iter().cycle().skip(1);
    let own = corners.iter().map(|&p| p - corners[0]);
    let sides = own.zip(next).map(|(a, &b)| a.cross(b - corners[0]));
    sides.sum()
}

/// How many corners of a polygon turn against a direction.
fn n_turned(corners: &[DVec3], normal: DVec3) -> usize {
    let n = corners.len();
    let turn = |i: usize| {
        let [a, b, c] = [i, i + 1, i + 2].map(|i| corners[i % n]);
        (b - a).cross(c - b).dot(normal)
    };
    (0..n).filter(|&i| turn(i) <= 0.0).count()
}
