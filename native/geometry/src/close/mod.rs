//! Closes the borders of a mesh, so that what knows closed surfaces alone can work on it.
//!
//! Each loop of a border is closed by a *cap*, a membrane over it; where that lid would be as large
//! as the mesh itself, as on a sheet, the mesh is *doubled* across the loop instead: glued there to
//! its image, which lies at the same place and faces the other way.
//!
//! ```text
//!      cap                       image
//!    ,-----.                  .==========.      faces that were given come first,
//!    |     |  cup             '----------'      real ones before virtual ones
//!    '-----'                     sheet
//! ```
//!
//! What was given is not changed: its vertices and faces come first and keep their numbers.
//!
//! Not done here: cutting handles, and keeping caps off the rest of the surface; a cap may cross it.

mod cap;
mod double;
mod frame;
pub mod handles;
mod membrane;
mod patch;
mod split;
mod start;
mod tube;

use cap::Sheet;
use frame::Frame;
pub use tube::Tubes;

use crate::mesh::{
    FaceMap, HalfedgeId, HalfedgeMap, Id, TriangleMesh, TriangleMeshError, VertexId,
};
use crate::progress::{Cancelled, Progress};

/// How borders are closed.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Settings {
    /// Which borders are closed for good.
    pub fill: Fill,
    /// What is done with the longest of the other borders.
    pub way: Way,
    /// What lies between each of them and its cap.
    pub tubes: Tubes,
}

/// What is done with the longest border that is not filled; the others get caps in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Way {
    /// Sheets are doubled across it, others get a cap.
    #[default]
    Measured,
    /// It gets a cap.
    Cap,
    /// The mesh is doubled across it. A single triangle gets a cap: its image would have the same
    /// three corners.
    Double,
}

/// Which borders are closed for good: their caps count as real faces.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum Fill {
    /// None of them.
    #[default]
    None,
    /// Those whose loops are no longer than this.
    UpTo(f64),
    /// All of them.
    All,
}

/// Why a mesh cannot be closed.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum Error {
    /// It hangs together in more than one piece, or has no face.
    #[error("{n} components; one at a time can be closed")]
    Components {
        /// How many there are.
        n: usize,
    },
    /// It has handles.
    #[error("{n} handles; they must be cut before borders are closed")]
    Handles {
        /// How many there are.
        n: i64,
    },
    /// What came out is no mesh, as too large a one.
    #[error(transparent)]
    Mesh(#[from] TriangleMeshError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A mesh whose borders were closed.
#[derive(Clone, PartialEq, Debug)]
pub struct Closed {
    /// Closed, in one component, without handles. Vertices and faces that were given come first and
    /// in their order; then the faces that fill borders for good; then virtual ones.
    pub mesh: TriangleMesh,
    /// Whether a face was given or fills a border for good.
    pub is_real: FaceMap<bool>,
    /// How many loops were filled for good.
    pub n_filled: usize,
    /// How many other loops have a cap.
    pub n_capped: usize,
    /// How many loops the mesh was doubled across: one or none.
    pub n_doubled: usize,
}

impl Closed {
    /// The edges between a real and a virtual face, on both sides of each.
    pub fn border(&self) -> HalfedgeMap<bool> {
        let is_real = |h: HalfedgeId| self.is_real[h.face()];
        let is_border = |h| is_real(h) != self.mesh.twin(h).is_some_and(is_real);
        self.mesh.halfedge_ids().map(is_border).collect()
    }
}

/// Closes the borders of a mesh of one component without handles; a closed mesh comes back as it is.
///
/// Filled loops and those that are capped get a membrane, planar where the loop is, its triangles
/// as long as the loop's edges there and longer towards its middle. The longest of the others may
/// be doubled across. Loops of any shape are closed, those on a line or in a point too, by
/// triangles without area. No two edges join the same two vertices, no two faces the same three.
/// About linear in time in the faces made.
///
/// # Errors
/// [`Error`].
pub fn close(
    mesh: &TriangleMesh,
    settings: &Settings,
    progress: &Progress,
) -> Result<Closed, Error> {
    let loops = mesh.border_loops();
    check(mesh, loops.len())?;
    let mut sheet = Sheet::new(mesh);
    let tubes = &settings.tubes;
    let (filled, mut open): (Vec<_>, Vec<_>) = loops
        .into_iter()
        .partition(|border| is_filled(mesh, border, settings.fill));
    for (i, border) in filled.iter().enumerate() {
        progress.at(0.3 * i as f64 / filled.len() as f64)?;
        sheet.cap(border, &Tubes::default(), progress)?;
    }
    sheet.n_real = sheet.faces.len();
    let longest = take_longest(mesh, &mut open);
    for (i, border) in open.iter().enumerate() {
        progress.at(0.3 + 0.3 * i as f64 / open.len() as f64)?;
        sheet.cap(border, tubes, progress)?;
    }
    let mut n_capped = open.len();
    let mut n_doubled = 0;
    if let Some(border) = longest {
        progress.at(0.6)?;
        if is_doubled(&sheet, &border, settings.way) {
            sheet.double(&border, progress)?;
            n_doubled = 1;
        } else {
            sheet.cap(&border, tubes, progress)?;
            n_capped += 1;
        }
    }
    progress.at(0.9)?;
    let n_faces = sheet.faces.len();
    Ok(Closed {
        mesh: TriangleMesh::build(sheet.positions, sheet.faces, progress)??,
        is_real: (0..n_faces).map(|i| i < sheet.n_real).collect(),
        n_filled: filled.len(),
        n_capped,
        n_doubled,
    })
}

fn check(mesh: &TriangleMesh, n_loops: usize) -> Result<(), Error> {
    let (_, n) = mesh.face_components();
    if n != 1 {
        return Err(Error::Components { n });
    }
    match (2 - mesh.euler_number() - n_loops as i64) / 2 {
        0 => Ok(()),
        n => Err(Error::Handles { n }),
    }
}

fn length(mesh: &TriangleMesh, border: &[HalfedgeId]) -> f64 {
    let edge = |&h: &HalfedgeId| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.target(h)))
    };
    border.iter().map(edge).sum()
}

fn is_filled(mesh: &TriangleMesh, border: &[HalfedgeId], fill: Fill) -> bool {
    match fill {
        Fill::None => false,
        Fill::UpTo(most) => length(mesh, border) <= most,
        Fill::All => true,
    }
}

/// The first of the longest loops.
fn take_longest(mesh: &TriangleMesh, loops: &mut Vec<Vec<HalfedgeId>>) -> Option<Vec<HalfedgeId>> {
    let lengths: Vec<f64> = loops.iter().map(|border| length(mesh, border)).collect();
    let longest =
        (0..loops.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]).then(b.cmp(&a)));
    longest.map(|i| loops.remove(i))
}

/// A mesh is a sheet, and doubled, where the circle as long as its longest loop, less the caps of
/// the others, has more than this share of its area.
///
/// A sheet has one or more however it is bent, since that does not change lengths, and whatever
/// windows it has; a shallow bowl 0.75, a hemisphere 0.5, a tube nothing: doubled, it would have its
/// other lid twice. A cap costs less than an image does where it is much smaller, but where both
/// are nearly the same the cap lies on the sheet or crosses it. Below 0.5 cups cost a third more;
/// above 1 terrain and cloth get lids.
const SHEET: f64 = 0.6;

/// Whether a mesh, with caps on all of its loops but the longest, is doubled across that.
fn is_doubled(sheet: &Sheet, border: &[HalfedgeId], way: Way) -> bool {
    sheet.mesh.n_faces() > 1
        && match way {
            Way::Measured => is_sheet(sheet, border),
            Way::Cap => false,
            Way::Double => true,
        }
}

fn is_sheet(sheet: &Sheet, border: &[HalfedgeId]) -> bool {
    let frame = Frame::of(&sheet.positions);
    let at = |v: VertexId| frame.inside(sheet.positions[v.index()]);
    let edges = border.iter().map(|&h| sheet.ends(h).map(at));
    let around: f64 = edges.map(|[a, b]| a.distance(b)).sum();
    let area = |face: &[VertexId; 3]| {
        let [a, b, c] = face.map(at);
        (b - a).cross(c - a).length() / 2.0
    };
    let real: f64 = sheet.faces[..sheet.n_real].iter().map(area).sum();
    let is_tube = |i: &usize| sheet.tubes.iter().any(|tube| tube.contains(i));
    let caps = (sheet.n_real..sheet.faces.len()).filter(|i| !is_tube(i));
    let caps: f64 = caps.map(|i| area(&sheet.faces[i])).sum();
    let circle = around * around / (4.0 * std::f64::consts::PI);
    circle - caps > SHEET * real
}

#[cfg(test)]
mod tests;
