//! Cuts handles, so that what is left has genus 0.
//!
//! ```text
//! search   the shortest loop that does not part the surface, from some roots; a tree and a co-tree
//! tighten  the loop drawn tight across faces, unless it runs along a crease
//! lay      edges along it (split)
//! slit     its vertices doubled: two borders, twins
//! weld     and once there are quads, twins joined again
//!
//! near     short loops near one vertex
//! seal     all handles with short loops cut at once, and both sides of each given a lid
//! ```
//!
//! A handle is cut the short way: a torus round its tube, a mug round its ear.

mod lay;
mod near;
mod seal;
mod search;
mod slit;
mod split;
mod tighten;
mod weld;

use glam::DVec3;
use thiserror::Error;

use crate::measure::topology_of_triangles;
use crate::mesh::{FaceId, FaceMap, HalfedgeId, HalfedgeMap, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

use lay::lay;
pub use seal::{Limits, Sealed, seal};
use search::{Loop, Search};
use slit::slit;
use split::{Pieces, Place};
use tighten::{ends, tighten};
pub use weld::{WeldError, Welded, weld};

/// From so many vertices far from each other loops are looked for: fewer may miss that a handle is
/// narrower elsewhere, more cost time.
const N_ROOTS: usize = 16;
/// From so many vertices of the shortest loop shorter ones are looked for, and again of these.
const N_AGAIN: usize = 3;
/// At most so often.
const MOST_AGAIN: usize = 6;
/// The next loop is looked for up to this multiple of the length of the last first: most often
/// there is one, and the way is short.
const NEXT: f64 = 2.0;
/// Crossings nearer to a vertex than this share of their edge are moved onto it: less leaves
/// slivers beside the cut, more leaves it crooked.
const SNAP: f64 = 0.1;
/// A loop that drawn tight is no shorter than this share of it stays as it is: two edges in a row
/// turn by up to 16 degrees then, and no face is split.
const TIGHT: f64 = 0.99;
/// A stretch along a crease stays where it is if it is this share of its loop.
const STRETCH: f64 = 0.125;

/// A surface without handles, and where they were.
#[derive(Clone, PartialEq, Debug)]
pub struct Cut {
    /// The surface, of genus 0, with two borders more for each handle.
    pub mesh: TriangleMesh,
    /// The face of the old mesh that each face is or was a piece of. The first piece of every face
    /// stands where the face stood.
    pub source: FaceMap<FaceId>,
    /// The halfedge of the old mesh that each halfedge is or was a piece of; none across a face.
    pub sides: HalfedgeMap<Option<HalfedgeId>>,
    /// For each cut its two borders, vertex by vertex at the same places. Along the first the faces
    /// are on the right, along the other on the left.
    pub twins: Vec<[Vec<VertexId>; 2]>,
}

/// Why handles cannot be cut.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// More or less than one surface came in.
    #[error("{n} components; handles are cut of one")]
    Components {
        /// How many components there are.
        n: usize,
    },
}

/// Cuts every handle of one component along a short loop; without handles the mesh as it is.
///
/// Loops touch neither borders nor each other nor themselves. Each is the shortest one found from
/// vertices all over the surface, where edges along creases count as shorter, and drawn tight.
/// Faces that it crosses are split, and inner edges between two vertices of borders, where there
/// are handles. All other faces and all vertices stay, in their order; new ones follow. About n log
/// n for each handle.
///
/// # Errors
/// [`enum@Error`].
pub fn cut(mesh: &TriangleMesh, progress: &Progress) -> Result<Cut, Error> {
    let shape = topology_of_triangles(mesh);
    if shape.n_components != 1 {
        let n = shape.n_components;
        return Err(Error::Components { n });
    }
    let n_handles = shape.genus.unwrap_or(0).max(0) as usize;
    let mut pieces = Pieces::whole(mesh);
    let mut roots: Vec<Root> = Vec::new();
    let mut twins = Vec::with_capacity(n_handles);
    for i in 0..n_handles {
        progress.at(i as f64 / n_handles as f64)?;
        pieces = without_chords(pieces, progress)?;
        let mut search = Search::new(&pieces.mesh, true);
        if i == 0 {
            let spread = search.spread(N_ROOTS, progress)?;
            roots = spread.into_iter().map(Root::new).collect();
        }
        let found = shortest(&mut search, &mut roots, progress)?;
        let (cut, line, copies) = along(&pieces, &search, &found, progress)?;
        pieces = cut;
        twins.push([line, copies]);
    }
    Ok(Cut {
        mesh: pieces.mesh,
        source: pieces.source,
        sides: pieces.sides,
        twins,
    })
}

/// A short loop of one component that does not part it, along its edges, borders among them, to
/// show where a handle is; none without handles.
pub fn short_loop(mesh: &TriangleMesh) -> Option<Vec<VertexId>> {
    if topology_of_triangles(mesh).genus == Some(0) {
        return None;
    }
    let quiet = Progress::none();
    let mut search = Search::new(mesh, false);
    let root = mesh.vertex_ids().next()?;
    let found = search.through(root, f64::INFINITY, &quiet);
    let found = found.expect("nobody cancels")?;
    let found = shortened(&mut search, found, &quiet);
    Some(found.expect("nobody cancels").vertices)
}

/// A vertex from which loops are looked for.
#[derive(Clone, Copy)]
struct Root {
    vertex: VertexId,
    /// No loop through it is shorter: cuts take loops away and bring none.
    least: f64,
}

impl Root {
    fn new(vertex: VertexId) -> Self {
        Self { vertex, least: 0.0 }
    }
}

/// Splits inner edges between two vertices of borders: what the other vertices span is then as the
/// whole surface is, and has a loop round every handle.
fn without_chords(pieces: Pieces, progress: &Progress) -> Result<Pieces, Cancelled> {
    let mesh = &pieces.mesh;
    let is_chord = |h: &HalfedgeId| {
        let is_first = mesh.twin(*h).is_some_and(|twin| *h < twin);
        is_first && ends(mesh, *h).iter().all(|&v| mesh.is_border(v))
    };
    let chords = mesh.halfedge_ids().filter(is_chord);
    let places: Vec<Place> = chords.map(|edge| Place { edge, share: 0.5 }).collect();
    if places.is_empty() {
        return Ok(pieces);
    }
    pieces.split(&places, progress)
}

/// The shortest loop through one of the roots, and then through vertices of it.
fn shortest(
    search: &mut Search,
    roots: &mut Vec<Root>,
    progress: &Progress,
) -> Result<Loop, Cancelled> {
    roots.retain(|root| search.is_free(root.vertex));
    if roots.is_empty() {
        roots.extend(search.spread(1, progress)?.into_iter().map(Root::new));
    }
    roots.sort_by(|a, b| a.least.total_cmp(&b.least));
    let likely = roots.first().map_or(0.0, |root| NEXT * root.least);
    let mut best = through_roots(search, (&mut *roots, likely), progress)?;
    if best.is_none() {
        best = through_roots(search, (roots, f64::INFINITY), progress)?;
    }
    let best = best.expect("a surface with handles has loops that do not part it");
    shortened(search, best, progress)
}

/// The shortest loop through one of the roots, if one is shorter than `limit`.
fn through_roots(
    search: &mut Search,
    (roots, limit): (&mut [Root], f64),
    progress: &Progress,
) -> Result<Option<Loop>, Cancelled> {
    let mut best: Option<Loop> = None;
    for root in roots {
        let limit = best.as_ref().map_or(limit, |best| best.length);
        if root.least >= limit {
            break;
        }
        let found = search.through(root.vertex, limit, progress)?;
        root.least = found.as_ref().map_or(limit, |found| found.length);
        best = found.or(best);
    }
    Ok(best)
}

/// A loop or a shorter one through a vertex of it, and so on.
fn shortened(search: &mut Search, mut best: Loop, progress: &Progress) -> Result<Loop, Cancelled> {
    for _ in 0..MOST_AGAIN {
        let n = best.vertices.len();
        let again: Vec<_> = (0..N_AGAIN)
            .map(|i| best.vertices[i * n / N_AGAIN])
            .collect();
        let before = best.length;
        for root in again {
            let limit = best.length * 0.999;
            best = search.through(root, limit, progress)?.unwrap_or(best);
        }
        if best.length >= before {
            break;
        }
    }
    Ok(best)
}

/// Cuts along a loop, drawn tight where that gives a line that touches nothing.
fn along(
    pieces: &Pieces,
    search: &Search,
    found: &Loop,
    progress: &Progress,
) -> Result<(Pieces, Vec<VertexId>, Vec<VertexId>), Cancelled> {
    let mesh = &pieces.mesh;
    let kept = on_creases(search, mesh, &found.vertices);
    let stops = tighten(mesh, &found.vertices, |i| kept[i]);
    let points = found.vertices.iter().map(|&v| mesh.position(v));
    let tight = stops.iter().map(|stop| stop.position(mesh));
    let is_tight = round(&tight.collect::<Vec<_>>()) > TIGHT * round(&points.collect::<Vec<_>>());
    for snap in [SNAP, 0.0].into_iter().filter(|_| !is_tight) {
        let Some((laid, line)) = lay(pieces, (&stops, snap), progress)? else {
            continue;
        };
        let (cut, copies) = slit(laid, &line, progress)?;
        if cut.mesh.face_components().1 == 1 {
            return Ok((cut, line, copies));
        }
    }
    let (cut, copies) = slit(pieces.clone(), &found.vertices, progress)?;
    Ok((cut, found.vertices.clone(), copies))
}

/// The length of a closed line.
fn round(points: &[DVec3]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(p, q)| p.distance(*q)).sum()
}

/// Whether each vertex of a loop lies on a long stretch of it along sharp edges.
fn on_creases(search: &Search, mesh: &TriangleMesh, line: &[VertexId]) -> Vec<bool> {
    let n = line.len();
    let edge = |i: usize| slit::between(mesh, [line[i % n], line[(i + 1) % n]]);
    let is_sharp = |i: usize| edge(i).is_some_and(|h| search.is_sharp(h));
    let length = |i: usize| {
        mesh.position(line[i % n])
            .distance(mesh.position(line[(i + 1) % n]))
    };
    let whole: f64 = (0..n).map(length).sum();
    let mut kept = vec![false; n];
    let Some(start) = (0..n).find(|&i| !is_sharp(i)) else {
        return vec![true; n];
    };
    let mut from = start + 1;
    while from < start + n {
        let to = (from..start + n)
            .find(|&i| !is_sharp(i))
            .unwrap_or(start + n);
        if (from..to).map(length).sum::<f64>() >= STRETCH * whole && from < to {
            (from..=to).for_each(|i| kept[i % n] = true);
        }
        from = to + 1;
    }
    kept
}

#[cfg(test)]
mod tests;
