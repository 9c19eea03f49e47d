//! One side of a mesh of any shape, and where it goes on beyond the plane.

use std::collections::HashSet;

use glam::DVec3;

use super::DoubleError;
use super::cut::positive_side;
use super::glue::largest_piece;
use crate::mesh::{HalfedgeId, HalfedgeMap, Id, TriangleMesh, VertexId, VertexMap, bounds};

/// This share of the area may lie in other pieces than the largest.
const LOST: f64 = 0.1;

/// Vertices nearer to the plane than this share of the diagonal lie in it.
const ROUNDING: f64 = 1e-9;

/// What of a mesh lies on the positive side of a plane.
#[derive(Clone, PartialEq, Debug)]
pub struct Half {
    /// The side, with borders where the mesh has some and where it goes on beyond the plane.
    pub mesh: TriangleMesh,
    /// The ends of the edge of the whole that each vertex lies on; one vertex twice where it is that.
    pub sources: Vec<[VertexId; 2]>,
    /// Its edges in the plane beyond which the whole goes on.
    pub is_seam: HalfedgeMap<bool>,
}

/// The largest piece of a mesh on the positive side of the plane where a coordinate is 0.
///
/// The mesh may have borders and handles. Vertices nearer to the plane than the share `snap` of an
/// edge across it are moved onto it, those of borders along these. Linear in time.
///
/// # Errors
/// [`DoubleError`].
pub fn half(mesh: &TriangleMesh, axis: usize, snap: f64) -> Result<Half, DoubleError> {
    let is_border = |h: HalfedgeId| mesh.twin(h).is_none();
    let border: HalfedgeMap<bool> = mesh.halfedge_ids().map(is_border).collect();
    let mesh = &rounded(mesh, axis);
    let side = positive_side(mesh, (axis, snap), Some(&border));
    let (piece, sources) = largest_piece(&side)?;
    let at = |v: VertexId| side.positions[v.index()];
    let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
    let all: f64 = side.faces.iter().map(|face| area(face.map(at))).sum();
    let own: f64 = piece.face_ids().map(|f| area(piece.triangle(f))).sum();
    if own < (1.0 - LOST) * all {
        let pct = 100.0 * (1.0 - own / all);
        return Err(DoubleError::Pieces { pct });
    }
    let ends = mesh.halfedge_ids().filter(|&h| border[h]);
    let ends: HashSet<[VertexId; 2]> = ends.map(|h| [mesh.origin(h), mesh.target(h)]).collect();
    let was_border = |h: HalfedgeId| {
        let [a, b] = [piece.origin(h), piece.target(h)].map(|v| sources[v.index()]);
        a[0] == a[1] && b[0] == b[1] && ends.contains(&[a[0], b[0]])
    };
    let is_seam = |h: HalfedgeId| {
        let mut ends = [piece.origin(h), piece.target(h)].into_iter();
        let lies = ends.all(|v| piece.position(v)[axis] == 0.0);
        piece.twin(h).is_none() && lies && !was_border(h)
    };
    let is_seam: HalfedgeMap<bool> = piece.halfedge_ids().map(is_seam).collect();
    if is_seam.iter().all(|is_seam| !is_seam) {
        return Err(DoubleError::NotCut);
    }
    Ok(Half {
        mesh: piece,
        sources,
        is_seam,
    })
}

/// A mesh whose vertices lie in the plane where they do but for rounding.
fn rounded(mesh: &TriangleMesh, axis: usize) -> TriangleMesh {
    let [low, high] = bounds(mesh.positions());
    let least = ROUNDING * low.distance(high);
    let round = |mut p: DVec3| {
        if p[axis].abs() <= least {
            p[axis] = 0.0;
        }
        p
    };
    mesh.with_positions(mesh.positions().iter().map(|&p| round(p)).collect())
}

impl Half {
    /// Edges of the whole, on both sides of each, found again: those on the positive side or what is
    /// left of them.
    pub fn carried(&self, whole: &TriangleMesh, edges: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
        let chosen = whole.halfedge_ids().filter(|&h| edges[h]);
        let chosen: HashSet<[VertexId; 2]> =
            chosen.map(|h| [whole.origin(h), whole.target(h)]).collect();
        let is_on = |h: HalfedgeId| super::lies_on_one(self.sources_of(h), &chosen);
        self.mesh.halfedge_ids().map(is_on).collect()
    }

    /// Values at the vertices of the whole, found again.
    pub fn carried_values(&self, whole: &TriangleMesh, values: &VertexMap<f64>) -> VertexMap<f64> {
        let vertices = self.mesh.vertex_ids().zip(&self.sources);
        let value = |(v, &source): (VertexId, &[VertexId; 2])| {
            super::value_between(source, (whole, values), self.mesh.position(v))
        };
        vertices.map(value).collect()
    }

    fn sources_of(&self, h: HalfedgeId) -> [[VertexId; 2]; 2] {
        [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.sources[v.index()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::topology_of_triangles;
    use crate::shapes;

    #[test]
    fn half_a_torus_is_a_ring_or_a_bent_tube() {
        let torus = shapes::torus(24, 12);
        for (axis, n_seams) in [(0, 2), (2, 2)] {
            let half = half(&torus, axis, 0.02).unwrap();
            let shape = topology_of_triangles(&half.mesh);
            assert_eq!((shape.genus, shape.n_borders), (Some(0), n_seams));
            let border = half.mesh.border_loops().concat();
            assert!(border.iter().all(|&h| half.is_seam[h]));
        }
    }

    #[test]
    fn borders_in_the_plane_are_no_seam() {
        let cube = shapes::cuboid(8);
        let faces = cube.faces().iter();
        // Slit along the plane at the top: the two sides of the slit have vertices of their own.
        let top = cube.positions().iter().map(|p| p.z).fold(0.0, f64::max);
        let on_slit = |v: VertexId| {
            let p = cube.position(v);
            p.x.abs() < 1e-9 && (p.z - top).abs() < 1e-9 && p.y.abs() < 0.6 * top
        };
        let mut positions = cube.positions().to_vec();
        let mut faces: Vec<[VertexId; 3]> = faces.copied().collect();
        for v in cube.vertex_ids().filter(|&v| on_slit(v)) {
            let copy = VertexId(positions.len() as u32);
            positions.push(cube.position(v));
            for face in &mut faces {
                let middle: f64 = face.iter().map(|u| positions[u.0 as usize].x).sum();
                if middle < 0.0 {
                    *face = face.map(|u| if u == v { copy } else { u });
                }
            }
        }
        let slit = TriangleMesh::new(positions, faces).unwrap();
        assert_eq!(slit.border_loops().len(), 1);
        let half = half(&slit, 0, 0.02).unwrap();
        let border = half.mesh.border_loops();
        assert_eq!(border.len(), 1);
        let n_seam = border[0].iter().filter(|&&h| half.is_seam[h]).count();
        let n_slit = slit.border_loops()[0].len() / 2;
        assert_eq!(border[0].len() - n_seam, n_slit);
    }
}
