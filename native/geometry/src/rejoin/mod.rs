//! Joins sheets that meet along lines: gives them the same vertices there.
//!
//! Each sheet was remeshed by itself, with a line of edges along the line where it met others. Those
//! with equally many edges there are joined, vertex by vertex from the line's start, each pair or
//! more in the middle of their places; an edge of the result then has as many faces as the input's
//! had. Not done: sheets with other numbers of edges stay apart, and are counted.

mod chain;
#[cfg(test)]
mod tests;

use std::ops::Range;

use glam::DVec3;

use crate::groups::Groups;
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use chain::Sheet;

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

/// Sheets that were joined.
#[derive(Clone, PartialEq, Debug)]
pub struct Rejoined {
    /// The mesh; its faces are those that came, in the same order.
    pub mesh: PolygonMesh,
    /// What each vertex that came is called now.
    pub name: VertexMap<VertexId>,
    /// How many lines have the same vertices in all their sheets.
    pub n_joined: usize,
    /// How many have not, because the counts of edges differ or no edges lie there.
    pub n_left: usize,
}

/// Gives sheets that meet along lines the same vertices there.
///
/// `mesh` has all sheets, one after the other. No face loses a corner: where it would, sheets stay
/// apart. Costs the edges near each line times its points.
///
/// # Errors
/// When cancelled.
pub fn rejoin(
    mesh: &PolygonMesh,
    lines: &[Line],
    progress: &Progress<'_>,
) -> Result<Rejoined, Cancelled> {
    let mut joining = Joining::new(mesh);
    let [mut n_joined, mut n_left] = [0; 2];
    for line in lines.iter().filter(|line| line.strands.len() > 1) {
        progress.check()?;
        let sheets = line
            .strands
            .iter()
            .map(|strand| Sheet::near(mesh, line, strand));
        let mut chains: Vec<Vec<VertexId>> = sheets.filter_map(|sheet| sheet.along(line)).collect();
        let are_found = chains.len() == line.strands.len();
        chains.sort_by_key(Vec::len);
        // Most alike; of equally many the longest.
        let alike = chains
            .chunk_by(|a, b| a.len() == b.len())
            .max_by_key(|alike| alike.len());
        let is_joined = alike.is_some_and(|alike| joining.join(alike));
        let are_alike = alike.is_some_and(|alike| alike.len() == line.strands.len());
        if is_joined && are_found && are_alike {
            n_joined += 1;
        } else {
            n_left += 1;
        }
    }
    let (mesh, name) = joining.joined(mesh);
    Ok(Rejoined {
        mesh,
        name,
        n_joined,
        n_left,
    })
}

/// Vertices that become one.
struct Joining {
    groups: Groups,
    /// The faces at all vertices of the group of each first vertex, in order.
    faces: Vec<Vec<FaceId>>,
}

impl Joining {
    fn new(mesh: &PolygonMesh) -> Self {
        let mut faces = vec![Vec::new(); mesh.n_vertices()];
        for face in mesh.face_ids() {
            for v in mesh.face(face) {
                faces[v.index()].push(face);
            }
        }
        Self {
            groups: Groups::new(mesh.n_vertices()),
            faces,
        }
    }

    /// Joins lines of equally many vertices, unless a face would lose a corner.
    fn join(&mut self, chains: &[Vec<VertexId>]) -> bool {
        let Some((first, others)) = chains.split_first() else {
            return false;
        };
        let pairs = || {
            let pairs = others.iter().flat_map(|other| first.iter().zip(other));
            pairs.map(|(a, b)| [a.index(), b.index()])
        };
        let mut after = self.groups.clone();
        let mut hit: Vec<usize> = Vec::new();
        for [a, b] in pairs() {
            hit.extend([after.root(a), after.root(b)]);
            after.link(a, b);
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
        self.groups = after;
        for was in hit {
            self.faces[was].clear();
        }
        for of_one in corners.chunk_by(|a, b| a.0 == b.0) {
            self.faces[of_one[0].0] = of_one.iter().map(|&(_, face)| face).collect();
        }
        true
    }

    /// The mesh with its vertices joined, and what they are called.
    fn joined(self, mesh: &PolygonMesh) -> (PolygonMesh, VertexMap<VertexId>) {
        let (group, n) = self.groups.numbered();
        let mut sums = vec![(DVec3::ZERO, 0.0); n];
        for (&p, &group) in mesh.positions().iter().zip(&group) {
            let (sum, count) = &mut sums[group as usize];
            *sum += p;
            *count += 1.0;
        }
        let positions = sums.into_iter().map(|(sum, count)| sum / count).collect();
        let name = VertexMap::from_vec(group.into_iter().map(VertexId).collect());
        let corners = mesh.corners().iter().map(|&v| name[v]).collect();
        let joined = PolygonMesh::new(positions, mesh.starts().to_vec(), corners);
        (joined.expect("no face loses a corner"), name)
    }
}
