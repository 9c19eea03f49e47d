//! Opens inverted quads once a part is open again.
//!
//! Borders hold their vertices while quads are fitted, and a weld makes one vertex of two: both may
//! leave a quad inverted. Corners of such quads move in space, those on a border along it alone.
//! Where that does not help, a quad goes: two of its opposite corners become one.

mod collapse;
mod places;

use super::{Opening, is_same};
use crate::deform::{Deformed, Target};
use crate::mesh::{FaceId, Id, PolygonMesh, VertexId};
use crate::nearest::Bvh;
use crate::progress::{Cancelled, Progress};
use places::Places;

/// How many quads may go of a part, and how many more for each so many that it has.
const MOST_GONE: usize = 4;
const QUADS_PER_GONE: usize = 50;
/// How many ways are tried at most, for each quad that may go.
const TRIES: usize = 4;

/// What quads lie on, and where their borders belong.
#[derive(Clone, Copy)]
pub(super) struct Bed<'a> {
    target: &'a Target,
    /// The borders; none where there are none.
    line: Option<&'a Bvh>,
    is_corner: &'a dyn Fn(glam::DVec3) -> bool,
}

impl Opening {
    /// The same with as few inverted quads as can be; where there are none, as it is.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn mended(
        &self,
        opened: Deformed,
        progress: &Progress<'_>,
    ) -> Result<Deformed, Cancelled> {
        if opened.report.n_inverted == 0 {
            return Ok(opened);
        }
        let borders = self.open_borders();
        let line = if borders.is_empty() {
            None
        } else {
            Some(Bvh::build(&borders, progress)?)
        };
        let bed = Bed {
            target: &self.bare,
            line: line.as_ref(),
            is_corner: &|p| self.corners.iter().any(|corner| is_same(corner.goal, p)),
        };
        bed.mended(opened, progress)
    }

    /// The pieces of the borders that the part has in the end.
    fn open_borders(&self) -> Vec<[glam::DVec3; 3]> {
        let is_cut = |[a, b]: &[glam::DVec3; 2]| {
            let middle = a.midpoint(*b);
            self.cuts
                .iter()
                .any(|cut| cut.distance(middle) < super::SAME)
        };
        let long = self.edges.segments().filter(|piece| !is_cut(piece));
        let short = self.punctures.iter().flat_map(super::Puncture::pieces);
        long.chain(short).map(|[a, b]| [a, b, b]).collect()
    }
}

impl Bed<'_> {
    fn mended(self, mut opened: Deformed, progress: &Progress<'_>) -> Result<Deformed, Cancelled> {
        let positions = self.untangled(&opened.mesh, progress)?;
        opened = opened.moved(positions);
        let n_most = MOST_GONE + opened.mesh.n_faces() / QUADS_PER_GONE;
        let mut n_tries = TRIES * n_most;
        let mut n_gone = 0;
        while n_gone < n_most && opened.report.n_inverted > 0 {
            let Some(less) = self.with_one_less(&opened, &mut n_tries, progress)? else {
                break;
            };
            opened = less;
            n_gone += 1;
        }
        Ok(opened)
    }

    /// Where vertices stand once inverted quads are open, as far as they can be.
    fn untangled(
        self,
        mesh: &PolygonMesh,
        progress: &Progress<'_>,
    ) -> Result<Vec<glam::DVec3>, Cancelled> {
        let mut places = Places::new(mesh, self, progress)?;
        places.untangle(progress)?;
        Ok(places.positions)
    }

    /// The same without a quad, fewer of the others inverted; none where no way leads there.
    fn with_one_less(
        self,
        opened: &Deformed,
        n_tries: &mut usize,
        progress: &Progress<'_>,
    ) -> Result<Option<Deformed>, Cancelled> {
        let mesh = &opened.mesh;
        let corners = collapse::Corners::new(mesh, self.is_corner, progress)?;
        for face in places::inverted(mesh) {
            for way in corners.ways(face) {
                if *n_tries == 0 {
                    return Ok(None);
                }
                *n_tries -= 1;
                let (less, names) = corners.collapsed(face, way);
                let positions = self.untangled(&less, progress)?;
                let less = opened
                    .clone()
                    .renamed(less, &names, progress)?
                    .moved(positions);
                if less.report.n_inverted < opened.report.n_inverted {
                    return Ok(Some(less));
                }
            }
        }
        Ok(None)
    }
}

/// The faces at every vertex.
pub(super) fn around(mesh: &PolygonMesh) -> Vec<Vec<FaceId>> {
    let mut around = vec![Vec::new(); mesh.n_vertices()];
    for face in mesh.face_ids() {
        for v in mesh.face(face) {
            around[v.index()].push(face);
        }
    }
    around
}

/// The vertices before and after a corner of a face.
fn beside(face: &[VertexId], v: VertexId) -> Option<[VertexId; 2]> {
    let at = face.iter().position(|&u| u == v)?;
    let n = face.len();
    Some([face[(at + n - 1) % n], face[(at + 1) % n]])
}
