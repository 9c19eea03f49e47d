//! Pairs of a surface that may have borders and handles, where it lies in space.
//!
//! A surface and its image, glued at the borders, are closed: so all triangles can be paired, if those
//! at a border may be paired with their images (Petersen 1891). Such a triangle becomes a quad by
//! itself: its side on the border gets a vertex in the middle.

use glam::DVec3;

use super::improve::improve;
use super::matching::{NONE, largest};
use super::worth::squareness;
use super::{N_EASINGS, Stay, edges_of, faces_on, held, tips, worth};
use crate::mesh::{FaceId, HalfedgeId, HalfedgeMap, Id, PolygonMesh, TriangleMesh, VertexId};
use crate::progress::{Cancelled, Progress};

/// What a triangle is worth that becomes a quad by itself: less than two pairs may be together.
const ALONE: f64 = -4.0;
/// A pair with a corner that is straight, or turns the wrong way, is worth so much less: where vertices
/// lie on a straight line that is to stay, nothing mends it.
const STRAIGHT: f64 = 2.0;
/// The sine of a corner that counts as straight.
const LEAST_SINE: f64 = 0.05;

/// Quads of pairs of triangles, and of triangles at borders.
#[derive(Clone, PartialEq, Debug)]
pub struct OpenPairs {
    /// The quads in space.
    pub quads: PolygonMesh,
    /// Their edges that were to stay, each once, smaller end first, in order.
    pub kept: Vec<[VertexId; 2]>,
}

/// Pairs the triangles of a surface into quads; as few as can be at its borders become quads alone.
///
/// The topology is that of the surface. Edges that are to stay become diagonals only where nothing
/// else pairs all. About O(n log n).
///
/// # Errors
/// When cancelled.
pub fn pair_open(
    mesh: &TriangleMesh,
    kept: &HalfedgeMap<bool>,
    progress: &Progress,
) -> Result<OpenPairs, Cancelled> {
    let firm: HalfedgeMap<bool> = mesh
        .halfedge_ids()
        .map(|h| mesh.twin(h).is_none())
        .collect();
    let stay = Stay {
        kept,
        firm: Some(&firm),
    };
    let mate = mates(mesh, stay, progress)?;
    let mut quads = worth::quads(mesh, stay, &mate);
    let alone: Vec<FaceId> = mesh
        .face_ids()
        .filter(|f| mate[f.index()] == NONE)
        .collect();
    let corners: Vec<[u32; 3]> = alone.iter().map(|&f| mesh.face(f).map(|v| v.0)).collect();
    let is_held = held(mesh, stay, &corners);
    let is_inside = |quad: [u32; 4]| squareness(quad.map(|v| mesh.position(VertexId(v)))) > 0.0;
    let mut vertices = tips::without(&mut quads, &is_held, &is_inside);
    let mut number = vec![NONE; mesh.n_vertices()];
    for (i, v) in (0..).zip(&vertices) {
        number[v.index()] = i;
    }
    let mut positions: Vec<DVec3> = vertices.iter().map(|&v| mesh.position(v)).collect();
    let named = quads.iter().map(|quad| quad.map(|v| number[v as usize]));
    let mut faces: Vec<Vec<u32>> = named.map(Vec::from).collect();
    for face in alone {
        let around = corners_alone(mesh, face);
        let names = around.map(|v| number[v.index()]);
        faces.push(if let Some(middle) = middle(mesh, face) {
            positions.push(middle);
            // Not a vertex of the mesh.
            vertices.push(VertexId(NONE));
            vec![names[0], positions.len() as u32 - 1, names[1], names[2]]
        } else {
            names.to_vec()
        });
    }
    let quads = faces_on(positions, &faces);
    Ok(OpenPairs {
        kept: edges_of((mesh, kept), (&quads, &vertices)),
        quads,
    })
}

/// The partner of every triangle; none for those that become quads alone.
fn mates(mesh: &TriangleMesh, stay: Stay<'_>, progress: &Progress) -> Result<Vec<u32>, Cancelled> {
    let n = mesh.n_faces();
    let mut arcs = worth::arcs(mesh, stay);
    worth::shun(mesh, &mut arcs, (LEAST_SINE, STRAIGHT));
    let mut both = with_images(mesh, &arcs);
    let mut mate = largest(&both, &progress.part("", 0.0, 0.6))?;
    let own = |mate: &[u32]| -> Vec<u32> {
        let own = mate[..n].iter();
        own.map(|&m| if (m as usize) < n { m } else { NONE })
            .collect()
    };
    for easing in 0..N_EASINGS {
        progress.at(0.6 + 0.3 * f64::from(easing) / f64::from(N_EASINGS))?;
        if !worth::ease(mesh, stay, &mut arcs, &own(&mate)) {
            break;
        }
        both = with_images(mesh, &arcs);
        improve(&both, &mut mate, &progress.part("", 0.9, 0.9))?;
    }
    Ok(own(&mate))
}

/// The same neighbours for a surface with its image; at a border each triangle has its own there.
fn with_images(mesh: &TriangleMesh, arcs: &[[(u32, f64); 3]]) -> Vec<[(u32, f64); 3]> {
    let n = arcs.len() as u32;
    let is_open = |face: FaceId| border_side(mesh, face).is_some();
    let mut both = Vec::with_capacity(2 * arcs.len());
    for side in [0, n] {
        for (face, own) in mesh.face_ids().zip(arcs) {
            let mut own = *own;
            let free = own.iter().position(|arc| arc.0 == NONE);
            for arc in own.iter_mut().filter(|arc| arc.0 != NONE) {
                arc.0 += side;
            }
            if let Some(free) = free.filter(|_| is_open(face)) {
                own[free] = (face.0 + (n - side), ALONE);
            }
            both.push(own);
        }
    }
    both
}

/// The longest side of a face on the border.
fn border_side(mesh: &TriangleMesh, face: FaceId) -> Option<HalfedgeId> {
    let first = mesh.halfedge(face);
    let length = |h: HalfedgeId| {
        let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
        a.distance_squared(b)
    };
    let sides = [first, first.next(), first.prev()].into_iter();
    let open = sides.filter(|&h| mesh.twin(h).is_none());
    open.max_by(|&g, &h| length(g).total_cmp(&length(h)))
}

/// The corners of a face, from the start of its longest side on the border.
fn corners_alone(mesh: &TriangleMesh, face: FaceId) -> [VertexId; 3] {
    let h = border_side(mesh, face).unwrap_or_else(|| mesh.halfedge(face));
    [mesh.origin(h), mesh.target(h), mesh.origin(h.prev())]
}

/// The middle of its longest side on the border.
fn middle(mesh: &TriangleMesh, face: FaceId) -> Option<DVec3> {
    let h = border_side(mesh, face)?;
    let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
    Some(a.midpoint(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{topology, topology_of_triangles};
    use crate::shapes;

    /// Some faces of a mesh alone, where they are one surface.
    fn some(mesh: &TriangleMesh, is_left: impl Fn(usize) -> bool) -> Option<TriangleMesh> {
        let faces = mesh.faces().iter().enumerate();
        let faces = faces.filter(|(i, _)| is_left(*i)).map(|(_, face)| *face);
        let (piece, _) = TriangleMesh::of_faces(mesh.positions(), faces).ok()?;
        (piece.face_components().1 == 1).then_some(piece)
    }

    fn check(name: &str, mesh: &TriangleMesh) -> OpenPairs {
        let nothing = HalfedgeMap::filled(3 * mesh.n_faces(), false);
        let pairs = pair_open(mesh, &nothing, &Progress::none()).unwrap();
        let n = pairs.quads.n_faces();
        assert_eq!(pairs.quads.n_quads(), n, "{name}");
        assert!(
            2 * n >= mesh.n_faces() - 2 * (mesh.n_faces() / 10),
            "{name}"
        );
        let found = topology(&pairs.quads, &Progress::none()).unwrap();
        let came = topology_of_triangles(mesh);
        assert_eq!(
            (found.genus, found.n_borders, found.n_components),
            (came.genus, came.n_borders, came.n_components),
            "{name}"
        );
        pairs
    }

    #[test]
    fn all_triangles_become_quads_of_the_same_topology() {
        check("torus", &shapes::torus(9, 5));
        let ball = shapes::blob(3, 6);
        let torus = shapes::torus(12, 8);
        let mut n_pieces = 0;
        for n in 1..90 {
            let pieces = [
                ("first faces", some(&ball, |i| i < 2 * n)),
                ("ball without faces", some(&ball, |i| i % 97 != n)),
                ("torus without faces", some(&torus, |i| i % 61 != n % 61)),
            ];
            for (name, piece) in pieces {
                let Some(piece) = piece else { continue };
                check(name, &piece);
                n_pieces += 1;
            }
        }
        assert!(n_pieces > 150, "{n_pieces}");
    }

    #[test]
    fn a_box_of_halved_squares_gets_its_squares_back() {
        let cube = shapes::cuboid(5);
        let pairs = check("cube", &cube);
        let quads = &pairs.quads;
        let is_square = |face: &[VertexId]| {
            squareness([0, 1, 2, 3].map(|i| quads.position(face[i]))) > 1.0 - 1e-9
        };
        assert!(quads.faces().all(is_square));
        assert_eq!(quads.n_faces(), 150);
    }
}
