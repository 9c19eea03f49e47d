//! The faces in space as triangles, ready to be asked for the closest one.

use glam::DVec3;

use super::sheet::{Face, Sheet};
use super::sites::Site;
use crate::measure::area_vector;
use crate::mesh::{FaceId, Id, VertexId, VertexMap};
use crate::nearest::{Bvh, Closest};
use crate::progress::{Cancelled, Progress};

/// Cosine between the normals of a site and a triangle from which on it is another sheet's.
const LEAST_AGREEMENT: f64 = -0.2;

/// The triangles that faces are cut into.
pub(super) struct Skin {
    pub corners: Vec<[VertexId; 3]>,
    normals: Vec<DVec3>,
    bvh: Bvh,
}

impl Skin {
    pub fn new(sheet: &Sheet, progress: &Progress) -> Result<Self, Cancelled> {
        let corners = triangles(sheet);
        let flat: Vec<_> = corners
            .iter()
            .map(|t| t.map(|v| sheet.position(v)))
            .collect();
        let normal = |&triangle: &[DVec3; 3]| area_vector(triangle).normalize_or_zero();
        Ok(Self {
            corners,
            normals: flat.iter().map(normal).collect(),
            bvh: Bvh::build(&flat, progress)?,
        })
    }

    /// The normal of a triangle.
    pub fn normal(&self, triangle: usize) -> DVec3 {
        self.normals[triangle]
    }

    /// The closest point of the sheet that a site belongs to, up to a distance.
    pub fn closest(&self, site: &Site, reach: f64) -> Option<Closest> {
        let agrees = |face: FaceId| self.normals[face.index()].dot(site.normal) > LEAST_AGREEMENT;
        self.bvh.closest_where(site.position, reach * reach, agrees)
    }
}

/// The faces cut into triangles.
pub(super) fn triangles(sheet: &Sheet) -> Vec<[VertexId; 3]> {
    let faces = sheet.faces().iter();
    let at = |v| sheet.position(v);
    faces.flat_map(|face| cut(face, at)).collect()
}

/// The triangles of a face, a quad's along its shorter diagonal.
pub(super) fn cut<F: Fn(VertexId) -> DVec3>(
    face: &Face,
    at: F,
) -> impl Iterator<Item = [VertexId; 3]> + use<F> {
    let along = |p, q| at(p).distance_squared(at(q));
    let triangles = match *face.corners() {
        [a, b, c, d] if along(a, c) <= along(b, d) => [Some([a, b, c]), Some([a, c, d])],
        [a, b, c, d] => [Some([a, b, d]), Some([b, c, d])],
        ref corners => [Some([corners[0], corners[1], corners[2]]), None],
    };
    triangles.into_iter().flatten()
}

/// The mean of the normals of the triangles at every vertex, weighted by area.
pub(super) fn normals(sheet: &Sheet, triangles: &[[VertexId; 3]]) -> VertexMap<DVec3> {
    let mut sums = VertexMap::filled(sheet.n_vertices(), DVec3::ZERO);
    for corners in triangles {
        let normal = area_vector(corners.map(|v| sheet.position(v)));
        for &v in corners {
            sums[v] += normal;
        }
    }
    sums.iter().map(|sum| sum.normalize_or_zero()).collect()
}
