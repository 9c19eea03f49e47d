//! Opens inverted quads once a part is open again.
//!
//! Borders hold their vertices while quads are fitted, and a weld makes one vertex of two: both may
//! leave a quad inverted. Corners of such quads move in space, those on a border along it alone.
//! Where that does not help, a quad goes: two of its opposite corners become one.

mod collapse;
mod places;

use super::{Opening, is_same};
use crate::deform::{Deformed, Target, is_inverted};
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

/// A mesh with inverted quads opened as far as vertices inside can do that.
///
/// # Errors
/// When cancelled.
pub fn untangled(
    mesh: &PolygonMesh,
    target: &Target,
    progress: &Progress<'_>,
) -> Result<PolygonMesh, Cancelled> {
    if !mesh.faces().any(|face| is_inverted(mesh, face)) {
        return Ok(mesh.clone());
    }
    let bed = Bed {
        target,
        line: None,
        is_corner: &|_| true,
    };
    Ok(mesh.with_positions(bed.untangled(mesh, progress)?))
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
        let is_bad = |&face: &FaceId| is_inverted(mesh, mesh.face(face));
        for face in mesh.face_ids().filter(is_bad) {
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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::deform::Report;
    use crate::mesh::TriangleMesh;

    /// A flat sheet of n × n unit squares, as a surface and its border.
    fn ground(n: u32) -> (Target, Bvh, Vec<DVec3>) {
        let side = f64::from(n);
        let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
        let corners = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
        let faces = [[0, 1, 2], [0, 2, 3]].map(|face| face.map(VertexId));
        let sheet = TriangleMesh::new(corners.to_vec(), faces.to_vec()).unwrap();
        let target = Target::new(sheet, &Progress::none()).unwrap();
        let sides = (0..4).map(|i| [corners[i], corners[(i + 1) % 4], corners[(i + 1) % 4]]);
        let sides: Vec<_> = sides.collect();
        (target, Bvh::new(&sides), corners.to_vec())
    }

    fn grid(n: u32) -> (Vec<DVec3>, Vec<Vec<u32>>) {
        let points = (0..=n).flat_map(|y| (0..=n).map(move |x| [x, y]));
        let points = points.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0));
        let id = move |x: u32, y: u32| y * (n + 1) + x;
        let squares = (0..n).flat_map(|y| (0..n).map(move |x| [x, y]));
        let quad = |[x, y]: [u32; 2]| vec![id(x, y), id(x + 1, y), id(x + 1, y + 1), id(x, y + 1)];
        (points.collect(), squares.map(quad).collect())
    }

    /// What becomes of some quads on the sheet, and their borders' vertices.
    fn mended(n: u32, points: Vec<DVec3>, quads: &[Vec<u32>]) -> Deformed {
        let (target, line, corners) = ground(n);
        let bed = Bed {
            target: &target,
            line: Some(&line),
            is_corner: &|p| corners.iter().any(|&corner| is_same(corner, p)),
        };
        let mesh = PolygonMesh::from_faces(points, quads).unwrap();
        let sphere = vec![DVec3::Z; mesh.n_vertices()];
        let quiet = Progress::none();
        let positions = mesh.positions().to_vec();
        let before = Deformed {
            mesh,
            sphere,
            features: Vec::new(),
            led: Vec::new(),
            report: Report::default(),
        };
        let before = before.moved(positions);
        assert!(before.report.n_inverted > 0);
        bed.mended(before, &quiet).unwrap()
    }

    #[test]
    fn border_vertices_that_passed_each_other_go_back_along_the_border() {
        let (mut points, quads) = grid(4);
        points[1].x = 2.4;
        points[7].x = 3.4;
        let found = mended(4, points, &quads);
        assert_eq!((found.report.n_inverted, found.mesh.n_faces()), (0, 16));
        let row = &found.mesh.positions()[..5];
        assert!(row.iter().all(|p| p.y.abs() < 1e-9 && p.z.abs() < 1e-9));
        assert!(row.windows(2).all(|pair| pair[0].x < pair[1].x));
    }

    #[test]
    fn a_vertex_between_two_edges_of_one_quad_on_a_straight_border_is_opened() {
        let (points, mut quads) = grid(6);
        // The edge between the middle of a side and the vertex above it is turned.
        quads[2] = vec![2, 3, 4, 11];
        quads[3] = vec![2, 11, 10, 9];
        let found = mended(6, points, &quads);
        assert_eq!(found.report.n_inverted, 0);
        let on_side = |p: &&DVec3| p.y.abs() < 0.1;
        assert_eq!(found.mesh.positions().iter().filter(on_side).count(), 7);
    }

    #[test]
    fn two_quads_round_a_vertex_are_opened() {
        let (mut points, mut quads) = grid(4);
        points.push(DVec3::new(1.5, 1.5, 0.0));
        quads[5] = vec![6, 7, 12, 25];
        quads.push(vec![6, 25, 12, 11]);
        let found = mended(4, points, &quads);
        assert_eq!(found.report.n_inverted, 0);
        assert!((16..=17).contains(&found.mesh.n_faces()));
    }

    #[test]
    fn a_quad_goes_when_two_of_its_corners_become_one() {
        let (points, quads) = grid(4);
        let mesh = PolygonMesh::from_faces(points, &quads).unwrap();
        let is_corner = |_: DVec3| false;
        let corners = collapse::Corners::new(&mesh, &is_corner, &Progress::none()).unwrap();
        let ways = corners.ways(FaceId(5));
        assert_eq!(ways.len(), 2);
        for way in ways {
            let (less, _) = corners.collapsed(FaceId(5), way);
            assert_eq!((less.n_faces(), less.n_vertices()), (15, 24));
        }
    }
}
