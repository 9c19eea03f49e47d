//! Joins sheets that meet along lines: gives them the same vertices there.
//!
//! Each sheet was remeshed by itself, mostly with a line of edges along the line where it met others.
//! A sheet that ends there has one on its border in any case; of one that goes on, the edges that are
//! nearest are taken. Then
//!
//! 1. edges that run to and fro across the line get a row of quads on both sides (`pillow`);
//! 2. counts of edges that differ are brought together by strips of quads (`strips`), a last odd edge
//!    in each by strips that are chosen for all lines together (`parity`);
//! 3. what still differs, by an even number, is met by cutting edges in three (`thirds`);
//! 4. sheets are joined vertex by vertex from the line's start, on the line; an edge of the result
//!    then has as many faces as the input's had.
//!
//! Sheets that touch in a point get one vertex there. Not joined: what a face would lose a corner by.

mod chain;
mod corners;
mod joining;
mod line;
mod posts;
mod room;
mod strips;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ops::Range;

use glam::DVec3;

use crate::mesh::{Id, PolygonMesh, VertexId, VertexMap};
use crate::progress::{Cancelled, Progress};
use chain::Sheets;
use corners::Corners;
use joining::Joining;
use strips::Leveled;

/// A line along which sheets meet.
#[derive(Clone, PartialEq, Debug)]
pub struct Line {
    /// Its points; of a closed line the last is not the first.
    pub points: Vec<DVec3>,
    /// Whether its last point is joined to its first.
    pub is_closed: bool,
    /// What meets there.
    pub strands: Vec<Strand>,
    /// Whether something else stays there that has a vertex at each of its points: so shall these.
    pub stays: bool,
}

/// A sheet at a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Strand {
    /// Which sheet.
    pub sheet: usize,
    /// Whether it ends there.
    pub is_border: bool,
    /// What the sheet calls its corners where the line begins and ends, if it is open.
    pub ends: [usize; 2],
}

/// A point of a sheet at which a line ends or another sheet touches.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Corner {
    /// Which sheet.
    pub sheet: usize,
    /// What the sheet calls it; it may come to the same place twice.
    pub name: usize,
}

/// A point where sheets touch.
#[derive(Clone, PartialEq, Debug)]
pub struct Touch {
    /// Where it is.
    pub place: DVec3,
    /// What touches there.
    pub corners: Vec<Corner>,
}

/// An edge by its ends.
pub type Edge = [VertexId; 2];

/// A sheet of a mesh.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sheet {
    /// Its faces.
    pub faces: Range<usize>,
    /// Whether it is better that others get other faces.
    pub is_kept: bool,
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
    /// Which sheets got other faces.
    pub is_changed: Vec<bool>,
    /// What each vertex that came is called now.
    pub name: VertexMap<VertexId>,
    /// The vertices that came in whose middle each vertex lies.
    pub from: VertexMap<[VertexId; 2]>,
    /// The edges on lines.
    pub features: Vec<Edge>,
    /// The vertices along each line that have the same ones in all its sheets; none where the counts
    /// of edges differ or no edges lie there.
    pub joined: Vec<Option<Vec<VertexId>>>,
    /// The vertex at each point where sheets touch.
    pub touched: Vec<Option<VertexId>>,
}

/// Gives sheets that meet along lines, or touch in points, the same vertices there.
///
/// No face loses a corner: where it would, sheets stay apart. Costs the edges near each line times its
/// points, and for each strip the quads of its sheet.
///
/// # Errors
/// When cancelled.
pub fn rejoin(
    given: &Given<'_>,
    (lines, touches): (&[Line], &[Touch]),
    progress: &Progress<'_>,
) -> Result<Rejoined, Cancelled> {
    let sheets = Sheets::new(given);
    let corners = Corners::new(&sheets, lines, touches);
    let mut taken = corners.vertices();
    let chains = lines
        .iter()
        .map(|line| sheets.chains(line, &corners, &mut taken))
        .collect();
    let leveled = strips::level(given, (lines, chains), progress)?;
    let mut joining = Joining::new(&leveled.mesh);
    let mut joined = Vec::with_capacity(lines.len());
    for (line, chains) in lines.iter().zip(&leveled.chains) {
        progress.check()?;
        joined.push(joining.all_of(line, chains));
    }
    let mut touched = Vec::with_capacity(touches.len());
    for touch in touches {
        let found = touch.corners.iter().filter_map(|&c| corners.vertex(c));
        let now: Vec<VertexId> = found.map(|v| leveled.name[v]).collect();
        touched.push(joining.touch(touch.place, &now).then(|| now[0]));
    }
    joining.make_room(&leveled.features);
    let (mesh, named) = joining.joined();
    Ok(told((leveled, mesh), &named, (joined, touched)))
}

/// Vertices along each line that was joined, and at each point.
type Joined = (Vec<Option<Vec<VertexId>>>, Vec<Option<VertexId>>);

/// What has become of sheets whose vertices have new names.
fn told(
    (leveled, mesh): (Leveled, PolygonMesh),
    named: &VertexMap<VertexId>,
    (joined, touched): Joined,
) -> Rejoined {
    let mut from = vec![None; mesh.n_vertices()];
    for (&name, &of) in named.iter().zip(leveled.from.iter()) {
        from[name.index()].get_or_insert(of);
    }
    let features = leveled.features.iter();
    let features: BTreeSet<Edge> = features
        .map(|ends| sorted(ends.map(|v| named[v])))
        .collect();
    let along = |chain: Vec<VertexId>| chain.into_iter().map(|v| named[v]).collect();
    Rejoined {
        n_faces: leveled.n_faces,
        is_changed: leveled.is_changed,
        name: leveled.name.iter().map(|&v| named[v]).collect(),
        from: from.into_iter().flatten().collect(),
        features: features.into_iter().collect(),
        joined: joined.into_iter().map(|chain| chain.map(along)).collect(),
        touched: touched.iter().map(|v| v.map(|v| named[v])).collect(),
        mesh,
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
